// Chromium without a screen, and what is asked of its pages and pictures.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';

const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';

/// WebGL in software: the same everywhere, no graphics hardware needed.
export const launch = (require) => require('playwright-core').chromium.launch({
  executablePath,
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

export const axeSource = (require) => readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

/// Of a PNG's pixels: how many there are, how many show the views' background (#14171d), how many colours.
export const countedPixels = (page, png) => page.evaluate(async (base64) => {
  const image = new Image();
  image.src = `data:image/png;base64,${base64}`;
  await image.decode();
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [image.width, image.height];
  const context = canvas.getContext('2d');
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  const colours = new Set();
  let background = 0;
  for (let i = 0; i < data.length; i += 4) {
    colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
    background += Math.abs(data[i] - 0x14) + Math.abs(data[i + 1] - 0x17) + Math.abs(data[i + 2] - 0x1d) < 4 ? 1 : 0;
  }
  return { all: data.length / 4, background, colours: colours.size };
}, png.toString('base64'));

/// Everything that must stay silent.
export function watch(page, file) {
  const heard = [];
  page.on('console', (message) => heard.push(`console ${message.type()}: ${message.text()}`));
  page.on('pageerror', (error) => heard.push(`error: ${error.message}`));
  page.on('request', (request) => {
    const url = request.url();
    if (url !== file && !url.startsWith('data:') && !url.startsWith('blob:')) heard.push(`request: ${url}`);
  });
  return heard;
}

/// What is seen once all has been drawn.
export async function picture(page, place = '#views') {
  await page.evaluate(() => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); }));
  return page.locator(place).screenshot();
}

export async function expectChange(page, what, act, place) {
  const before = await picture(page, place);
  await act();
  assert.ok(!before.equals(await picture(page, place)), `${what} changes the picture`);
}
