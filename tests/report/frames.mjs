// How fast a report's two views are drawn by software, at 800×600 each.
//
//     node frames.mjs PAGE MODULES
//
// PAGE is a report. Prints the triangles and the frames a second, in JSON. A frame is both views, turned a little, drawn
// and read back, so that nothing of it is left to do.
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { launch } from './browser.mjs';

const [file, modules] = process.argv.slice(2);
const frames = 10;

/// The time of `count` turns, each drawn and read back from `ids`.
const measure = (page, ids, count) => page.evaluate(async ([names, turns]) => {
  const canvases = names.map((name) => document.getElementById(name));
  const drawn = () => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); });
  const pixel = new Uint8Array(4);
  const turn = async () => {
    canvases[0].dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight' }));
    await drawn();
    for (const canvas of canvases) {
      const gl = canvas.getContext('webgl2');
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    }
  };
  await turn();
  const start = performance.now();
  for (let i = 0; i < turns; ++i) await turn();
  return (performance.now() - start) / 1000;
}, [ids, count]);

const browser = await launch(createRequire(join(resolve(modules), 'x.js')));
const page = await browser.newPage({ viewport: { width: 1700, height: 1000 } });
await page.goto(pathToFileURL(resolve(file)).href);
await page.locator('#views').evaluate((views) => {
  for (const figure of views.querySelectorAll('figure')) Object.assign(figure.style, { width: '800px', height: '600px' });
  views.style.gridTemplateColumns = '800px 800px';
});
await page.waitForTimeout(500);
const seconds = await measure(page, ['canvas-left', 'canvas-right'], frames);
const about = await page.evaluate(() => ({
  sizes: ['canvas-left', 'canvas-right'].map((id) => [document.getElementById(id).width, document.getElementById(id).height]),
  triangles: ['caption-left', 'caption-right'].map((id) => document.getElementById(id).textContent),
}));
console.log(JSON.stringify({ ...about, frames_per_second: Number((frames / seconds).toFixed(2)) }, null, 2));
await browser.close();
