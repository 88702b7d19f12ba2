const formats = new Map();

/// With so many significant digits; very large and very small ones as 1.2e-7.
export function significant(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return Number(value.toPrecision(digits)).toExponential();
  if (!formats.has(digits)) formats.set(digits, new Intl.NumberFormat('en', { maximumSignificantDigits: digits }));
  return formats.get(digits).format(value);
}

export const whole = (value) => significant(value, 15);

/// A share as per cent.
export const percent = (share) => `${significant(100 * share, 3)} %`;

/// An element with text and attributes: never markup, whatever the text is.
export function element(name, text, attributes = {}) {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

/// A table of rows [name, value, value, …], with a line of heads if there is one. Values are texts, or {text, exact}.
export function table(rows, heads) {
  const made = element('table', undefined, heads ? { class: 'values' } : {});
  const cell = (value) => {
    const number = typeof value === 'object';
    return element('td', number ? value.text : value, number ? { 'data-exact': value.exact } : {});
  };
  if (heads) {
    const row = element('tr');
    heads.forEach((head) => row.append(element(head ? 'th' : 'td', head, head ? { scope: 'col' } : {})));
    const top = element('thead');
    top.append(row);
    made.append(top);
  }
  const body = element('tbody');
  for (const [name, ...values] of rows) {
    const row = element('tr');
    row.append(element('th', name, { scope: 'row' }), ...values.map(cell));
    body.append(row);
  }
  made.append(body);
  return made;
}

export const number = (value, digits) => ({ text: significant(value, digits), exact: value });
