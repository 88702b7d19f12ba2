// Drives a report in headless Chromium from file://, as a user would, at two widths.
//
//     node page_test.mjs PATCHLIGHT SCENE MODULES OUTPUT
//
// Solves SCENE with the program PATCHLIGHT, writes its report, and looks at it. MODULES is the folder whose node_modules
// hold playwright-core and axe-core; screenshots stay in OUTPUT.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { axeSource, countedPixels, expectChange, launch, picture, watch } from './browser.mjs';
import { firstHit, levelOf, readSolution } from './solution.mjs';

const [patchlight, scene, modules, output] = process.argv.slice(2);
const require = createRequire(join(modules, 'x.js'));
const run = join(output, 'run');
const shots = [1, 2, 3, 16];

function made(file) {
  execFileSync(patchlight, ['report', run, '-o', file], { stdio: 'pipe' });
  return readFileSync(file);
}

/// A run with everything a page can show, and its page.
function makePage() {
  rmSync(output, { recursive: true, force: true });
  mkdirSync(output, { recursive: true });
  execFileSync(patchlight, ['solve', scene, '--unit', 'mm', '--max-elements', '2500', '--snapshots', shots.join(','),
    '--size', '64x64', '-o', run, '--quiet'], { stdio: 'pipe' });
  const file = join(output, 'report.html');
  assert.deepEqual(made(file), made(join(output, 'again.html')), 'the same run gives the same bytes');
  return file;
}

const slide = (page, id, value) => page.locator(id).evaluate((slider, to) => {
  slider.value = to;
  slider.dispatchEvent(new Event('input', { bubbles: true }));
}, String(value));

async function expectBothViewsShowSomething(page) {
  for (const id of ['#canvas-left', '#canvas-right']) {
    const { all, background, colours } = await countedPixels(page, await picture(page, id));
    // The box fills most of either view; a blank canvas has one colour.
    assert.ok(background < 0.6 * all && colours > 200, `${id}: ${background} of ${all} are background, ${colours} colours`);
  }
}

async function tryControls(page) {
  const press = (selector) => () => page.locator(selector).click();
  await page.locator('input[value=side]').click();
  await expectChange(page, 'flat', press('input[value=flat]'));
  await expectChange(page, 'Gouraud', press('input[value=gouraud]'));
  await expectChange(page, 'wireframe', press('#wire'));
  await expectChange(page, 'no wireframe', press('#wire'));
  for (const id of await page.locator('#kinds input').evaluateAll((all) => all.map((one) => `#${one.id}`))) {
    await expectChange(page, id, press(id));
    await page.locator(id).click();
  }
  for (const quantity of ['lux', 'radiosity', 'error', 'light']) {
    await expectChange(page, quantity, () => page.locator('#quantity').selectOption(quantity));
    assert.equal(await page.locator('#legend').isVisible(), quantity !== 'light');
    if (quantity !== 'light') await expectChange(page, `${quantity}, other scale`, press('#log'));
  }
  await expectChange(page, 'exposure', () => slide(page, '#exposure', 1.5));
  await slide(page, '#exposure', 0);
  await expectChange(page, 'cycle before', () => slide(page, '#left', 3), '#canvas-left');
  await slide(page, '#left', 0);
  await expectChange(page, 'cycle after', () => slide(page, '#right', 3), '#canvas-right');
  await slide(page, '#right', 1000);
  for (let i = 1; i <= shots.length; ++i) {
    await expectChange(page, `shots ${shots[i - 1]}`, () => slide(page, '#shots', i), '#canvas-right');
    assert.equal(await page.locator('#shots-out').textContent(), String(shots[i - 1]));
  }
  await slide(page, '#shots', 0);
  await expectChange(page, 'wipe', press('input[value=wipe]'));
  await expectChange(page, 'the wipe slider', () => slide(page, '#wipe', 80));
  await page.locator('input[value=side]').click();
}

async function tryCamera(page) {
  const start = await picture(page, '#canvas-right');
  for (const key of ['ArrowLeft', 'ArrowUp', '+', 'w', 'd']) {
    // Keys on one view move the other: there is one camera.
    await expectChange(page, key, () => page.locator('#canvas-left').press(key), '#canvas-right');
  }
  await page.locator('#reset').click();
  assert.ok(start.equals(await picture(page, '#canvas-right')), 'the camera goes back');
  const box = await page.locator('#canvas-right').boundingBox();
  await expectChange(page, 'dragging', async () => {
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 60, box.y + box.height / 2 + 20, { steps: 4 });
    await page.mouse.up();
  }, '#canvas-left');
  await page.locator('#reset').click();
}

/// The panel's values of one column, by row.
const panel = (page, column) => page.locator('#patch tbody tr').evaluateAll((rows, at) => Object.fromEntries(rows.map(({ cells }) => [
  cells[0].textContent, { text: cells[at].textContent, exact: Number(cells[at].dataset.exact) }])), column);

/// The patch in the middle of both views, against the stored solutions.
async function expectPickEqualsSolution(page, ask) {
  await ask();
  const view = JSON.parse(readFileSync(join(run, 'run.json'))).options.pictures.view;
  const files = [join(run, 'cycles/00/solution.glb'), join(run, 'solution.glb')];
  for (const [i, file] of files.entries()) {
    const solution = readSolution(file);
    const told = await panel(page, i + 1);
    const patch = told.Patch.exact;
    assert.equal(patch, firstHit(solution, view.from, view.forward), 'the patch that a ray through the middle hits');
    assert.equal(told.Surface.exact, solution.patch_surface[patch]);
    assert.equal(told['Level (halvings of its surface)'].exact, levelOf(solution, patch));
    for (const [band, name] of ['red', 'green', 'blue'].entries()) {
      const stored = solution.patch_radiosity[3 * patch + band], { exact, text } = told[`Radiosity, ${name} (W/m²)`];
      // The page holds floats: half a unit of their last place is 6e-8.
      assert.ok(Math.abs(exact - stored) <= 6e-8 * stored, `${name}: ${exact} is ${stored}`);
      // Six digits are shown.
      assert.ok(Math.abs(Number(text.replaceAll(',', '')) - stored) <= 5.1e-6 * stored, `${name}: ${text} is ${stored}`);
    }
    assert.ok(Math.abs(told['Estimated error η (W/m²·m)'].exact - solution.eta[patch]) <= 6e-8 * solution.eta[patch]);
  }
}

async function expectAccessible(page, width) {
  await page.evaluate(axeSource(require));
  const { violations } = await page.evaluate(() => window.axe.run(document));
  const grave = violations.filter(({ impact }) => impact === 'serious' || impact === 'critical');
  assert.deepEqual(grave.map(({ id, nodes }) => `${id}: ${nodes.map((n) => n.html).join(' ')}`), [], `axe at ${width} px`);
  const tooWide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  assert.ok(tooWide <= 0, `at ${width} px the page is ${tooWide} px too wide`);
}

async function lookAt(browser, file, width, colorScheme) {
  const url = pathToFileURL(file).href;
  const page = await browser.newPage({ viewport: { width, height: 900 }, colorScheme });
  const heard = watch(page, url);
  await page.goto(url);
  await page.screenshot({ path: join(output, `report-${width}.png`), fullPage: true });
  await expectBothViewsShowSomething(page);
  await tryControls(page);
  await tryCamera(page);
  await expectPickEqualsSolution(page, () => page.locator('#canvas-left').press('Enter'));
  await expectPickEqualsSolution(page, () => page.locator('#canvas-right').click());
  await page.locator('summary').evaluateAll((all) => all.forEach((one) => one.click()));
  await expectAccessible(page, width);
  await page.locator('#wire').click();
  await page.locator('#quantity').selectOption('error');
  await page.screenshot({ path: join(output, `report-${width}-open.png`), fullPage: true });
  assert.deepEqual(heard, [], 'no message, no request');
  await page.close();
}

const file = makePage();
const browser = await launch(require);
try {
  await lookAt(browser, file, 1280, 'light');
  await lookAt(browser, file, 390, 'dark');
  console.log('the report is in order; screenshots are in', output);
} finally {
  await browser.close();
}
