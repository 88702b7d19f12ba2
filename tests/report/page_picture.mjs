// The README’s pictures of reports: a run’s views with their lines by kind and a patch that was asked for, or a study’s.
//
//     node page_picture.mjs PAGE MODULES PICTURE
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { launch } from './browser.mjs';

const [file, modules, picture] = process.argv.slice(2);
const browser = await launch(createRequire(join(resolve(modules), 'x.js')));
// Small enough to look at beside text.
const page = await browser.newPage({ viewport: { width: 1200, height: 1130 }, deviceScaleFactor: 0.72, colorScheme: 'light' });
await page.goto(pathToFileURL(resolve(file)).href);
for (const box of await page.locator('#kinds input').all()) await box.check();
if (await page.locator('#canvas-left').count()) await page.locator('#canvas-left').press('Enter');
await page.locator('h1').click();
await page.waitForTimeout(500);
await page.screenshot({ path: picture });
await browser.close();
