/** The keyboard's way through the page and its sheets, and what lies on what in a narrow window; names, roles and contrast of what is open and of sheets: `axe.test.mjs`. */
import assert from 'node:assert/strict';
import { bringAxe, isAccessible } from './support/axe.mjs';
import { atRest, drawn, pageTest, screenshot, step, until } from './support/browser.mjs';
import { focused, hasFocus } from './support/focus.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { trueOutline } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */

/** Controls that Tab has to reach once there is a pose, in this order. */
const MAIN_CONTROLS = [
  'Name of the study',
  'Side of the body',
  'Calibration: calibration.txt',
  'Femur: femur.stl',
  'Tibia: tibia.stl',
  'Undo: close the outline',
  'Open files',
  'Save and export',
  'Keys and mouse',
  'Edit points',
  'Trace points',
  'Fit the frame to the window',
  /Femur outline$/,
  'Femur',
  /^x \S+ mm$/,
  /^y rotation \S+ degrees$/,
  'Best candidate',
  'Overlay opacity',
  'Window width',
  'Window level',
  'Save femur poses…',
  'Delete outline',
  'Next frame',
  'Frame',
  'Frame 1, femur: posed',
  'Frame 8, tibia: empty',
  'Log',
];

pageTest('accessibility', async (page, t) => {
  await bringAxe(page);
  await step(page, t, 'the empty page', async () => {
    // Neither a way to go nor anything to save.
    assert.equal(await page.getByRole('button', { name: 'Save session', exact: true }).count(), 0);
    assert.equal(await page.getByRole('list', { name: 'Steps' }).count(), 0);
  });

  await step(page, t, 'the step is not read as a second button', async () => {
    await panel.openDemonstration(page);
    const usual = page.viewportSize();
    await page.setViewportSize({ width: 1440, height: 900 });
    await page.getByText('Step 2 of 5: First frame', { exact: true }).waitFor();
    const steps = await page.getByRole('list', { name: 'Steps' }).boundingBox();
    assert(steps && steps.width <= 1, 'names of steps stand beside the button that leads on');
    if (usual) await page.setViewportSize(usual);
  });

  await step(page, t, 'with a pose', async () => {
    await isAccessible(page);
    await panel.waitForLibraries(page, 'Femur', 'Tibia');
    const stage = new Stage(page);
    await stage.learn();
    await stage.trace(await trueOutline('femur', 1));
    await panel.waitForPose(page);
  });

  for (const [opener, sheet] of [['Calibration: calibration.txt', 'Calibration'], ['Femur: femur.stl', 'Femur'], ['Save and export', 'Save and export'], ['Keys and mouse', 'Keys and mouse'], ['Log', 'Log']]) {
    await step(page, t, `the sheet ${sheet}`, async () => {
      const button = page.getByRole('button', { name: opener, exact: true });
      await button.press('Enter');
      await page.getByRole('dialog', { name: sheet }).waitFor();
      await screenshot(page, `sheet ${sheet}`);
      await page.keyboard.press('Escape');
      await page.getByRole('dialog', { name: sheet }).waitFor({ state: 'hidden' });
      // It goes back to where it was.
      await hasFocus(page, opener);
    });
  }

  await step(page, t, 'Tab reaches the main controls in order', async () => {
    // What is under way has buttons of its own, which go when it is done.
    await atRest(page);
    const reached = await tabThrough(page);
    let at = -1;
    for (const control of MAIN_CONTROLS) {
      const matches = (/** @type {string} */ name) => (typeof control === 'string' ? name === control : control.test(name));
      const next = reached.findIndex((name, index) => index > at && matches(name));
      assert(next >= 0, `${control} is not reached after ${reached[at] ?? 'the beginning'}: ${reached.join(' | ')}`);
      at = next;
    }
  });

  for (const width of [1440, 1024, 700]) {
    await step(page, t, `${width} px: nothing lies on what is to be pressed`, async () => {
      await page.setViewportSize({ width, height: 700 });
      await drawn(page);
      for (const name of [/^Calibration: /, /^Femur: /, /^Tibia: /, 'Open files', 'Save and export', 'Keys and mouse', 'Next frame', 'Log']) {
        await page.getByRole('button', { name, exact: true }).first().click({ trial: true });
      }
      if (width > 860) await until(() => cutNames(page), (cut) => cut.length === 0, 'every name in the top bar to have room');
      await screenshot(page, `narrow ${width}`);
    });

    await step(page, t, `${width} px: all that a tool can be set to is in sight`, async () => {
      for (const key of ['t', 'l', 'b', 'm', 'k', 'o', 'p']) {
        await page.keyboard.press(key);
        await drawn(page);
        assert.deepEqual(await cutOptions(page), [], `of the tool at ${key}`);
      }
    });

    await step(page, t, `${width} px: sheets and numbers lie inside the window and their card`, async () => {
      // A tool that begins outlines has turned to the other one.
      await page.getByRole('radio', { name: 'Femur' }).click();
      await atRest(page);
      for (const [opener, sheet] of [['View', 'View'], ['Convergence', 'Convergence'], ['Work list', 'Work list'], ['Keys and mouse', 'Keys and mouse'], ['Save and export', 'Save and export'], [/^Shape the outline/, 'Shape']]) {
        await page.getByRole('button', { name: opener, exact: true }).first().press('Enter');
        const box = await page.getByRole('dialog', { name: sheet }).boundingBox();
        assert(box && box.x >= 0 && box.x + box.width <= width, `${sheet} lies at ${box?.x}, ${box?.width} px wide`);
        await page.keyboard.press('Escape');
        await page.getByRole('dialog', { name: sheet }).waitFor({ state: 'hidden' });
        await drawn(page);
      }
      assert.deepEqual(await numbersBeyondTheirCard(page), []);
    });
  }
});

/** Names of everything that Tab reaches, from the first control to the last. @param {Page} page */
async function tabThrough(page) {
  await page.getByRole('textbox', { name: 'Name of the study' }).focus();
  const reached = [await focused(page)];
  while (reached.at(-1) !== 'Log' && reached.length < 80) {
    await page.keyboard.press('Tab');
    reached.push(await focused(page));
  }
  return reached;
}

/** Names in the top bar that there is no room for. @param {Page} page */
function cutNames(page) {
  return page.evaluate(() =>
    Array.from(document.querySelectorAll('.chip .cut-head'))
      .filter((head) => head.scrollWidth > head.clientWidth)
      .map((head) => head.parentElement?.textContent),
  );
}

/** What of the strip above the frame lies outside of it, or is cut by what it stands in. @param {Page} page */
function cutOptions(page) {
  return page.evaluate(() => {
    const strip = document.querySelector('.tool-strip');
    const parts = Array.from(strip?.querySelectorAll('button, input, label') ?? []);
    const isCut = (/** @type {Element} */ part) => {
      const { left, right, top, bottom } = part.getBoundingClientRect();
      for (let around = part.parentElement; around && around !== strip?.parentElement; around = around.parentElement) {
        const room = around.getBoundingClientRect();
        // It has no place of its own.
        if (room.width === 0) continue;
        if (left < room.left - 1 || right > room.right + 1 || top < room.top - 1 || bottom > room.bottom + 1) return true;
      }
      return false;
    };
    return parts.filter(isCut).map((part) => part.getAttribute('aria-label') ?? part.textContent);
  });
}

/** Numbers of the pose whose unit stands on or beyond the border of their card. @param {Page} page */
function numbersBeyondTheirCard(page) {
  return page.evaluate(() => {
    const card = document.querySelector('.card.pose');
    const edge = card ? card.getBoundingClientRect().right - parseFloat(getComputedStyle(card).paddingRight) : 0;
    return Array.from(card?.querySelectorAll('.number') ?? [])
      .filter((number) => number.getBoundingClientRect().right > edge || number.scrollWidth > number.clientWidth)
      .map((number) => number.textContent);
  });
}
