// Drives a study's report in headless Chromium from file://, as a user would, at two widths.
//
//     node study_page_test.mjs PATCHLIGHT SCENE MODULES OUTPUT
//
// Runs a small study of SCENE with the program PATCHLIGHT, writes its report, and looks at it. MODULES is the folder
// whose node_modules hold playwright-core and axe-core; screenshots stay in OUTPUT.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { axeSource, countedPixels, launch } from './browser.mjs';

const [patchlight, scene, modules, output] = process.argv.slice(2);
const require = createRequire(join(modules, 'x.js'));
const study = join(output, 'study.toml'), folder = join(output, 'folder');
const sizes = [200, 400, 800];

const command = (words, more = {}) => execFileSync(patchlight, words, { stdio: 'pipe', encoding: 'utf8', ...more });

/// Two refinements, three sizes; a gate that holds and one that can't. Its name must not become markup.
function makeStudy() {
  rmSync(output, { recursive: true, force: true });
  mkdirSync(output, { recursive: true });
  writeFileSync(study, `title = "Meshes </script><b>& more"
scene = ${JSON.stringify(scene)}
unit = "mm"
[options]
rays = 64
[vary]
refine = ["none", "intensity"]
max_elements = [${sizes.join(', ')}]
[reference]
kind = "path-traced"
points = 200
paths = 256
[gates]
max_energy_residual = 0.5
max_error = 1e-9
[[compare]]
at = "elements"
values = [300]
[pictures]
views = ["front"]
size = "120x120"
`);
  try {
    command(['study', 'run', study, '-o', folder, '--quiet']);
  } catch (failure) {
    assert.equal(failure.status, 4, `the gate can't hold: ${failure.stderr}`);
  }
}

function makePage(file, environment = {}) {
  const env = { ...process.env, ...environment };
  command(['study', 'report', study, '--dir', folder, '-o', file], { env });
  return readFileSync(file);
}

/// Everything that must stay silent.
function watch(page, file) {
  const heard = [];
  page.on('console', (message) => heard.push(`console ${message.type()}: ${message.text()}`));
  page.on('pageerror', (error) => heard.push(`error: ${error.message}`));
  page.on('request', (request) => {
    const url = request.url();
    if (url !== file && !url.startsWith('data:') && !url.startsWith('blob:')) heard.push(`request: ${url}`);
  });
  return heard;
}

const drawn = (page) => page.evaluate(() => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); }));

async function expectChange(page, what, act, place) {
  await drawn(page);
  const before = await page.locator(place).screenshot();
  await act();
  await drawn(page);
  assert.ok(!before.equals(await page.locator(place).screenshot()), `${what} changes the picture`);
}

const column = (page, at) => page.locator('#cells tbody tr').evaluateAll((rows, c) => rows.map((row) => row.cells[c].textContent), at);

/// Heads sort, up and then down; what the table says is what the table in Markdown is made of.
async function tryTable(page, table) {
  const heads = await page.locator('#cells thead th').allTextContents();
  const error = heads.indexOf('Error, %');
  const told = await page.locator('#cells tbody tr').evaluateAll((rows, c) => rows.map((row) => Number(row.cells[c].dataset.exact)), error);
  assert.deepEqual(told, table.cells.map(({ result }) => 100 * result.error), 'errors as study table has them');
  const button = page.locator('#cells thead th').nth(error).locator('button');
  await button.focus();
  await page.keyboard.press('Enter');
  const up = (await column(page, error)).map(Number);
  assert.deepEqual(up, [...up].sort((a, b) => a - b));
  await page.keyboard.press('Enter');
  assert.deepEqual((await column(page, error)).map(Number), up.reverse());
  assert.equal(await page.locator('#cells thead th').nth(error).getAttribute('aria-sort'), 'descending');
}

async function tryPlots(page) {
  for (const id of ['elements', 'seconds']) {
    const place = `#chart-${id}`;
    assert.match(await page.locator(`#legend-${id}`).textContent(), /refine=none: (no )?rate/);
    await expectChange(page, `hiding a series over ${id}`, () => page.locator(`#legend-${id} input`).first().press(' '), place);
    await page.locator(`#legend-${id} input`).first().press(' ');
    const { colours } = await countedPixels(page, await page.locator(place).screenshot());
    assert.ok(colours > 20, `${place} shows ${colours} colours`);
  }
  await page.locator('#chart-elements').scrollIntoViewIfNeeded();
  const box = await page.locator('#chart-elements .u-over').boundingBox();
  const hover = page.locator('#hover-elements');
  let found = '';
  // A point tells of itself from 40 pixels around.
  for (let y = 10; y < box.height && !found; y += 50) {
    for (let x = 10; x < box.width && !found; x += 50) {
      await page.mouse.move(box.x + x, box.y + y);
      found = await hover.textContent();
    }
  }
  assert.match(found, /^refine=\w+ max-elements=\d+: [\d,]+ elements, error [\d.]+ %/);
}

async function tryPictures(page, table) {
  assert.equal(await page.locator('#sheet img').count(), table.cells.length);
  const sizesShown = await page.locator('#sheet img').evaluateAll((all) => all.map(({ naturalWidth, naturalHeight }) => [naturalWidth, naturalHeight]));
  assert.deepEqual(sizesShown, table.cells.map(() => [120, 120]));
  const { colours } = await countedPixels(page, readFileSync(join(folder, 'pictures', '000-front.png')));
  assert.ok(colours > 200, `the box has ${colours} colours`);
  await page.locator('input[value=side]').check();
  await expectChange(page, 'another cell on the left', () => page.locator('#left').selectOption({ index: 3 }), '#figure-left');
  await expectChange(page, 'a click in the sheet', () => page.locator('#sheet button').nth(1).click(), '#figure-left');
  assert.equal(await page.locator('#sheet button[aria-pressed=true]').count(), 2);
  await expectChange(page, 'wipe', () => page.locator('input[value=wipe]').check(), '#views');
  await expectChange(page, 'the wipe slider', () => page.locator('#wipe').press('Home'), '#views');
}

async function expectAccessible(page, width) {
  await page.evaluate(axeSource(require));
  const { violations } = await page.evaluate(() => window.axe.run(document));
  const grave = violations.filter(({ impact }) => impact === 'serious' || impact === 'critical');
  assert.deepEqual(grave.map(({ id, nodes }) => `${id}: ${nodes.map((n) => n.html).join(' ')}`), [], `axe at ${width} px`);
  const tooWide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  assert.ok(tooWide <= 0, `at ${width} px the page is ${tooWide} px too wide`);
}

async function lookAt(browser, file, width, colorScheme, table) {
  const url = pathToFileURL(file).href;
  const page = await browser.newPage({ viewport: { width, height: 900 }, colorScheme });
  const heard = watch(page, url);
  await page.goto(url);
  await page.screenshot({ path: join(output, `study-${width}.png`), fullPage: true });
  assert.equal(await page.locator('h1').textContent(), table.name);
  await tryPlots(page);
  await tryPictures(page, table);
  await tryTable(page, table);
  assert.match(await page.locator('#comparisons').textContent(), /At equal elements.*\(best\)/);
  assert.equal(await page.locator('#gates .good').count(), 6, 'energy holds in all cells');
  assert.equal(await page.locator('#gates .bad').count(), 6, 'no error is that small');
  await page.locator('summary').evaluateAll((all) => all.forEach((one) => one.click()));
  await expectAccessible(page, width);
  await page.screenshot({ path: join(output, `study-${width}-open.png`), fullPage: true });
  assert.deepEqual(heard, [], 'no message, no request');
  await page.close();
}

makeStudy();
const file = join(output, 'report.html');
const bytes = makePage(file);
assert.deepEqual(bytes, makePage(join(output, 'again.html')), 'the same study gives the same bytes');
// Three megabytes for twelve cells of the usual size.
assert.ok(bytes.length < 1_000_000, `${bytes.length} bytes`);
const reproducible = makePage(join(output, 'reproducible.html'), { SOURCE_DATE_EPOCH: '0' });
assert.ok(!reproducible.includes('"seconds":'), 'no seconds where they are left out');
command(['report', folder, '-o', join(output, 'from-folder.html')]);
assert.deepEqual(readFileSync(join(output, 'from-folder.html')), bytes, 'the folder alone is enough');

const table = JSON.parse(command(['study', 'table', study, '-o', folder, '--format', 'json']));
const browser = await launch(require);
try {
  await lookAt(browser, file, 1280, 'light', table);
  await lookAt(browser, file, 390, 'dark', table);
  console.log('the study\'s report is in order; screenshots are in', output);
} finally {
  await browser.close();
}
