/** Names of files that are markup, run from right to left or never end make nothing of the page but text. */
import assert from 'node:assert/strict';
import { drawn, pageTest, step } from './support/browser.mjs';
import { choose, file } from './support/files.mjs';
import { png } from './support/frames.mjs';
import * as panel from './support/panel.mjs';

const MARKUP = '<img src=x onerror="globalThis.reached=1"><script>globalThis.reached=1</script>';
const NAMES = [`${MARKUP}.png`, `${'x'.repeat(10_000)}.png`, '\u202egnp.tfel'];

pageTest('hostile names', async (page, t) => {
  await step(page, t, 'are names of frames', async () => {
    await choose(page, ...NAMES.map((name) => ({ ...png(8), name })));
    await panel.waitForFrames(page, NAMES.length);
  });

  await step(page, t, 'make no element, run nothing and widen nothing', () => harmless(page));

  await step(page, t, 'are cut in their middle: what tells frames apart stands at the end', async () => {
    const title = () => page.locator('.frame-name').getAttribute('title');
    const frames = page.getByRole('slider', { name: 'Frame' });
    for (let turn = 0; turn < NAMES.length && (await title()) !== NAMES[1]; turn++) {
      await frames.press('ArrowRight');
      await drawn(page);
    }
    assert.equal(await title(), NAMES[1]);
    const [room, end] = [await page.locator('.frame-name').boundingBox(), await page.locator('.frame-name').getByText('xxxxx.png', { exact: true }).boundingBox()];
    assert(room && end && end.x >= room.x && end.x + end.width <= room.x + room.width + 1, 'the end of the name is in sight');
  });

  await step(page, t, 'of files that are none of ours are told as text', async () => {
    for (const name of NAMES) {
      await choose(page, file(`${name}.docx`, 'nothing of ours'));
      await panel.waitForWords(page, /not recognised/);
      await harmless(page);
      if (name.startsWith('<')) assert((await page.evaluate(() => document.body.textContent)).includes(MARKUP), 'it is shown as it is');
    }
  });
});

/** @param {import('playwright-core').Page} page */
async function harmless(page) {
  const found = await page.evaluate(() => ({
    made: document.querySelectorAll('[onerror], img[src="x"], body script').length,
    reached: 'reached' in globalThis,
    wider: document.documentElement.scrollWidth - document.documentElement.clientWidth,
  }));
  assert.deepEqual(found, { made: 0, reached: false, wider: 0 });
}
