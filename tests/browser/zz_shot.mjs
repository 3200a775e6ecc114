import { openWindow, visit, atRest, AS_IT_IS } from './support/browser.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { trueOutline, polygonWithin } from './support/study.mjs';
const page = await openWindow({ serviceWorkers: 'block' });
await visit(page);
await panel.openDemonstration(page);
await panel.waitForLibraries(page, 'Femur', 'Tibia');
const stage = new Stage(page);
for (const frame of [1, 2, 3]) {
  for (const [name, component] of [['Femur', 'femur'], ['Tibia', 'tibia']]) {
    await page.getByRole('radio', { name, exact: true }).click();
    await page.keyboard.press('p');
    const outline = await polygonWithin(component, frame, 0.7);
    await page.keyboard.press('0');
    await stage.zoomTo(outline);
    await stage.trace(outline);
    await panel.waitForPose(page);
  }
  if (frame < 3) await page.getByRole('button', { name: 'Next frame' }).click();
}
await page.getByRole('radio', { name: 'Femur', exact: true }).click();
await page.keyboard.press('0');
await page.mouse.move(5, 5);
await atRest(page);
await page.screenshot({ ...AS_IT_IS, path: '/tmp/b/pagew-shots/readme-unmatched.png' });
await page.getByRole('radio', { name: '3-D' }).click();
await atRest(page);
await page.waitForTimeout(1500);
await page.mouse.move(5, 5);
await page.evaluate(() => document.activeElement?.blur());
await page.waitForTimeout(6500);
await page.screenshot({ ...AS_IT_IS, path: '/tmp/b/pagew-shots/readme-space.png' });
await page.getByRole('button', { name: /^Tibia: / }).click();
await page.waitForTimeout(1500);
await page.screenshot({ ...AS_IT_IS, path: '/tmp/b/pagew-shots/readme-sheet.png' });
await page.context().browser().close();
process.exit(0);
