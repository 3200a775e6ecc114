/** Which way components lie in their files: found from the shape, said by a person or a study, asked where nobody can tell. */
import assert from 'node:assert/strict';
import { atRest, pageTest, says, screenshot, step, until } from './support/browser.mjs';
import { exported } from './support/exporting.mjs';
import { choose, drop, file } from './support/files.mjs';
import { plate, stlOf, trianglesOf } from './support/models.mjs';
import * as panel from './support/panel.mjs';
import { demoFile, framePath } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */

const FOUND = 'Found from its shape: x anterior, y superior, \u2212z lateral.';

pageTest('which way a component lies', async (page, t) => {
  await panel.openDemonstration(page);
  await choose(page, await demoFile('femur.jts'), await demoFile('tibia.jts'));
  await panel.waitForWords(page, /as poses of the (femur|tibia)/);
  await page.getByRole('button', { name: 'Joint curves' }).first().click();

  await step(page, t, 'is found from its shape and said in words, with arrows', async () => {
    const axes = await openAxes(page, 'Femur');
    await axes.getByText(FOUND).waitFor();
    await axes.getByRole('application', { name: /^Femur with its axes: Found from its shape: x anterior/ }).waitFor();
    await atRest(page);
    await screenshot(page, 'axes sheet');
    await page.keyboard.press('Escape');
  });

  await step(page, t, 'is a person’s word instead, which joint angles follow; undone, and done again', async () => {
    const before = await curve(page);
    await sayAxes(page, 'Femur', 'y', 'z');
    await axesSay(page, 'Femur', /As you said: y anterior, z superior, \u2212x lateral\./);
    const after = await until(() => curve(page), (label) => label !== before, 'the curve to change');
    await page.getByRole('button', { name: 'Undo: change the axes of the femur' }).click();
    await until(() => curve(page), (label) => label === before, 'the curve as before');
    await page.keyboard.press('Control+y');
    await until(() => curve(page), (label) => label === after, 'the other curve');
  });

  await step(page, t, 'a session keeps it', async () => {
    const saved = await exported(page, 'Session');
    const { version, document } = JSON.parse(saved.buffer.toString());
    assert.equal(version, 5);
    assert.deepEqual(document.components.femur.axes, { directions: [[0, 1, 0], [0, 0, 1], [1, 0, 0]], from: 'person', told: 'all' });
    const axes = await openAxes(page, 'Femur');
    await axes.getByRole('button', { name: 'As its shape tells' }).click();
    await axes.getByText(FOUND).waitFor();
    await page.keyboard.press('Escape');
    await drop(page, saved);
    await panel.waitForWords(page, /^Opened the session/);
    await axesSay(page, 'Femur', /As you said: y anterior/);
  });

  await step(page, t, 'the view in space has the arrows and looks along them', async () => {
    await page.getByRole('radio', { name: 'Tibia', exact: true }).click();
    await page.getByRole('radio', { name: '3-D' }).click();
    const space = page.getByRole('region', { name: 'Models in space' });
    await space.getByText('x anterior, y superior, \u2212z lateral').waitFor();
    const canvas = space.getByRole('application');
    /** @type {Buffer | null} */
    let before = null;
    for (const from of ['Front', 'Side', 'Above']) {
      await space.getByRole('button', { name: from, exact: true }).click();
      await atRest(page);
      const last = before;
      before = await until(() => canvas.screenshot(), (picture) => !last?.equals(picture), `another look from ${from}`);
    }
    await screenshot(page, 'axes space');
  });
});

pageTest('files with axes of their own', async (page, t) => {
  const [femur, tibia] = [await demoFile('femur.stl'), await demoFile('tibia.stl')];
  await step(page, t, 'are known by their shape', async () => {
    // x, y and z of the part are written as the file's y, z and x.
    const turned = stlOf(trianglesOf(femur.buffer).map((corners) => corners.map(([x, y, z]) => [z, x, y])));
    await choose(page, await demoFile(framePath(1)), await demoFile('calibration.txt'), file('femur.stl', turned));
    await panel.waitForFrames(page, 1);
    await page.getByRole('combobox', { name: 'Side of the body' }).selectOption('right');
    await axesSay(page, 'Femur', /Found from its shape: y anterior, z superior, x lateral\./);
  });

  await step(page, t, 'a study file says which file is what, the side, and the axes; undone in one step', async () => {
    const study = 'name = "my knee"\nside = "left"\n[[component]]\nname = "femur"\nmodel = "part-1.stl"\n[[component]]\nname = "tibia"\nmodel = "part-2.stl"\naxes = "-x y -z"\n';
    const [one, two] = [{ ...femur, name: 'part-1.stl' }, { ...tibia, name: 'part-2.stl' }];
    await drop(page, two, one, file('study.toml', study));
    await panel.waitForWords(page, /^Opened part-1\.stl as the model of the femur, part-2\.stl as the model of the tibia, the study my knee\.$/);
    await until(() => page.getByRole('textbox', { name: 'Name of the study' }).inputValue(), (name) => name === 'my knee', 'the name of the study');
    await until(() => page.getByRole('combobox', { name: 'Side of the body' }).inputValue(), (side) => side === 'left', 'the side of the body');
    await axesSay(page, 'Tibia', /As the study file says: \u2212x anterior, y superior, z lateral\./);
    await page.getByRole('button', { name: 'Undo: read study.toml' }).click();
    await axesSay(page, 'Tibia', /Found from its shape: x anterior, y superior/);
  });

  await step(page, t, 'a study file that is wrong is told with its place, and the rest is opened', async () => {
    await drop(page, file('study.toml', '[[component]]\nname = "femur"\naxes = "x y -z"\n'), file('tibia.jts', 'JT_EULER_312\n0, 0, -900, 0, 0, 0\n'));
    await panel.waitForWords(page, /^study\.toml: the axes of the femur, "x y -z", are not three of x, -x/);
  });
});

pageTest('a tray whose front nobody can tell from its shape', async (page, t) => {
  await choose(page, await demoFile(framePath(1)), await demoFile('calibration.txt'), file('tray.stl', plate()));
  await panel.waitForFrames(page, 1);
  await page.getByRole('radio', { name: 'Tibia', exact: true }).click();
  const card = page.getByRole('region', { name: 'Axes to be told' });

  await step(page, t, 'is asked about, without being in the way', async () => {
    await card.getByText('Which way is the front of the tibia?').waitFor();
    await screenshot(page, 'axes asked');
    await card.getByRole('button', { name: 'Look and say' }).click();
    const sheet = page.getByRole('dialog', { name: 'Tibia' });
    await sheet.getByText(/or facing the other way\. Its shape does not tell front from back\./).waitFor();
    await atRest(page);
    await screenshot(page, 'axes question');
  });

  await step(page, t, 'the answer is taken, and undone', async () => {
    const sheet = page.getByRole('dialog', { name: 'Tibia' });
    const found = /Found from its shape: (\S+) anterior, (\S+) superior/;
    const [, anterior, superior] = found.exec(await says(sheet, found)) ?? [];
    await sheet.getByRole('group', { name: 'Which way is the front?' }).getByRole('button', { name: 'The other way' }).click();
    const other = anterior.startsWith('\u2212') ? anterior.slice(1) : `\u2212${anterior}`;
    await sheet.getByText(new RegExp(`As you said: ${other} anterior, ${superior} superior`)).waitFor();
    await card.waitFor({ state: 'detached' });
    await page.keyboard.press('Escape');
    await page.keyboard.press('Control+z');
    await card.waitFor();
  });
});

pageTest('what was done to a model', async (page, t) => {
  const { buffer } = await demoFile('femur.stl');
  const card = page.getByRole('region', { name: 'About the model' });

  await step(page, t, 'is said where it is opened and beside its pose, until it is put away', async () => {
    const holed = stlOf(trianglesOf(buffer).slice(3));
    await choose(page, await demoFile(framePath(1)), await demoFile('calibration.txt'), file('femur.stl', holed));
    await panel.waitForFrames(page, 1);
    await panel.waitForWords(page, /femur\.stl as the model of the femur \(the surface has holes or cracks/);
    await card.getByText(/^femur\.stl: The surface has holes or cracks \(\d+ sides of triangles have no neighbour\)/).waitFor();
    await screenshot(page, 'remarks');
    await card.getByRole('button', { name: 'Dismiss' }).click();
    await card.waitFor({ state: 'detached' });
    await page.getByRole('button', { name: /^Femur: / }).click();
    await page.getByRole('dialog', { name: 'Femur' }).getByRole('list', { name: 'About the model' }).getByText(/^The surface has holes/).waitFor();
    await page.keyboard.press('Escape');
    // Once, on a busy machine, no file chooser came where the page was pressed at that moment.
    await page.getByRole('dialog', { name: 'Femur' }).waitFor({ state: 'hidden' });
  });

  await step(page, t, 'a size that is no knee’s is said with the unit that it may be in', async () => {
    const metres = stlOf(trianglesOf(buffer).map((corners) => corners.map((corner) => corner.map((value) => value / 1000))));
    await choose(page, file('femur.stl', metres));
    await card.getByText(/is the file in metres\? Write it again in millimetres/).waitFor();
  });

  await step(page, t, 'and written again in millimetres where a person says so, as one step', async () => {
    await screenshot(page, 'unit asked');
    await card.getByRole('button', { name: 'It is in metres' }).click();
    await page.getByRole('button', { name: 'Femur: femur_mm.stl' }).waitFor();
    await card.getByText(/is the file in metres/).waitFor({ state: 'detached' });
    await page.keyboard.press('Control+z');
    await card.getByRole('button', { name: 'It is in metres' }).waitFor();
  });

  await step(page, t, 'of which inches and centimetres look alike', async () => {
    const inches = stlOf(trianglesOf(buffer).map((corners) => corners.map((corner) => corner.map((value) => value / 25.4))));
    await choose(page, file('femur.stl', inches));
    await card.getByRole('button', { name: 'It is in centimetres' }).waitFor();
    await card.getByRole('button', { name: 'It is in inches' }).click();
    await page.getByRole('button', { name: 'Femur: femur_mm.stl' }).waitFor();
    await until(() => card.getByRole('button', { name: /^It is in/ }).count(), (count) => count === 0, 'nothing more to be asked');
  });
});

/** The axes of a component in its sheet. @param {Page} page @param {'Femur' | 'Tibia'} component */
async function openAxes(page, component) {
  await page.getByRole('button', { name: new RegExp(`^${component}: `) }).click();
  return page.getByRole('dialog', { name: component }).getByRole('region', { name: 'Axes' });
}

/** Waits until that is said of them. @param {Page} page @param {'Femur' | 'Tibia'} component @param {RegExp} words */
async function axesSay(page, component, words) {
  await says(await openAxes(page, component), words);
  await page.keyboard.press('Escape');
  await page.getByRole('dialog', { name: component }).waitFor({ state: 'hidden' });
}

/** @param {Page} page @param {'Femur' | 'Tibia'} component @param {string} anterior @param {string} superior */
async function sayAxes(page, component, anterior, superior) {
  const axes = await openAxes(page, component);
  await axes.getByRole('combobox', { name: 'Anterior' }).selectOption(anterior);
  await axes.getByRole('combobox', { name: 'Superior' }).selectOption(superior);
  await axes.getByRole('button', { name: 'Use these axes' }).click();
  await page.keyboard.press('Escape');
  await page.getByRole('dialog', { name: component }).waitFor({ state: 'hidden' });
}

/** What the joint's curve says. @param {Page} page */
async function curve(page) {
  return (await page.getByRole('img', { name: /^Flexion over frame in \d+ frames/ }).getAttribute('aria-label')) ?? '';
}
