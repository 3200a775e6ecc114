import { describe, expect, it } from 'vitest';
import { fileName } from '../../src/exchange/paths';
import { readStudy } from '../../src/exchange/study_file';
import { writeStudy } from '../../src/exchange/study_text';
import { setCalibration, setModel } from '../../src/document/commands';
import { takeStudy } from '../../src/document/study';
import { Store } from '../../src/document/store';
import { NOTHING_STATED } from '../../src/document/types';
import { wordsOf } from '../../src/geometry/axes';

const STUDY = `
# a comment
name = "my study"
side = "left"
frames_per_s = 15
calibration = "calibration.txt"
[[component]]
name = "fem size 4"
model = "cad/femur.stl"
reference = "femur.jts"
masks.hand = "masks/femur"
axes = "y z x"
[[component]]
name = "insert"
role = "tibia"
model = "tray.stl"
nominal = [5.0, -90]
distance_mm = 1080.0
[[component]]
name = "patella"
model = "patella.stl"
`;

describe('a study file', () => {
  it('says which file is what, and what is known of the models; undone in one step', () => {
    const study = readStudy(STUDY);
    expect(study.calibration).toBe('calibration.txt');
    expect(study.parts.map(({ component, model, reference }) => [component, model, reference])).toEqual([
      ['femur', 'cad/femur.stl', 'femur.jts'],
      ['tibia', 'tray.stl', null],
    ]);
    const store = new Store();
    store.perform(takeStudy(study, 'study.toml'));
    const { name, side, rate, components } = store.doc;
    expect([name, side, rate]).toEqual(['my study', 'left', 15]);
    expect(components.femur.axes).toMatchObject({ from: 'study', told: 'all' });
    expect(wordsOf(components.femur.axes!.directions)).toEqual(['y', 'z', 'x']);
    expect(components.tibia.axes).toBeNull();
    expect(components.tibia.librarySpec).toMatchObject({ views: 'window', nominalX: 5, nominalY: -90, distance: 1080 });
    store.undo();
    expect(store.doc.components.femur.axes).toBeNull();
    expect(store.doc.side).toBe('unknown');
  });

  const WHOLE = '[film]\ncurvature = 0.025\nblur_px = 0.8\n[[component]]';

  it('states a film in whole, or in part', () => {
    const film = (text: string) => readStudy(STUDY.replace('[[component]]', text).replace('masks.hand', 'attenuation = 0.7\nmasks.hand')).film;
    expect(film('[[component]]')).toBeNull();
    expect(film(WHOLE)).toEqual({ ...NOTHING_STATED, constants: { curvature: 0.025, blur: 0.8, attenuation: { femur: 0.7, tibia: null } } });
    expect(film('[film]\ndisplay = "logarithmic"\n[[component]]')).toEqual({ ...NOTHING_STATED, display: 'logarithmic' });
    expect(film('[film]\nblur_px = 1.3\n[[component]]')).toEqual({ ...NOTHING_STATED, blur: 1.3 });
  });

  it.each([[WHOLE], ['[film]\ndisplay = "between"\nblur_px = 1.3\n[[component]]'], ['[[component]]']])('is written as it is read: %s', (text) => {
    const study = readStudy(STUDY.replace('[[component]]', text).replace('masks.hand', 'attenuation = 0.7\nmasks.hand'));
    const store = new Store();
    store.perform(setCalibration({ name: 'calibration.txt', text: '' }));
    store.perform(setModel('femur', { name: 'femur.stl', sha256: 'f' }));
    store.perform(setModel('tibia', { name: 'tray.stl', sha256: 't' }));
    store.perform(takeStudy(study, 'study.toml'));
    const written = writeStudy(store.doc);
    expect(written).toMatch(/^name = "my study"\nside = "left"\ncalibration = "calibration.txt"\nframes_per_s = 15/);
    const { parts, ...rest } = readStudy(written);
    expect(rest).toEqual({ name: study.name, side: study.side, rate: study.rate, film: study.film, calibration: study.calibration });
    expect(parts).toEqual(study.parts.map((part) => ({ ...part, model: fileName(part.model!), reference: null })));
  });

  it.each([
    ['[[component]]', '[film]\ncurvature = 0.025\n[[component]]', /of \[film\] either curvature/],
    ['[[component]]', '[film]\nblur_px = 0\n[[component]]', /of \[film\] either curvature/],
    ['[[component]]', '[film]\nblur_px = 12.1\n[[component]]', /blur_px \(above 0, at most 12\)/],
    ['[[component]]', '[film]\ncurvature = 1.1\nblur_px = 1\n[[component]]', /curvature \(0 to 1\)/],
    ['[[component]]', '[film]\ndisplay = "bent"\n[[component]]', /^study\.film\.display should be/],
    ['axes = "y z x"', 'axes = "y x z"', /the axes of the femur, "y x z", are not three/],
    ['side = "left"', 'side = "west"', /^study\.side should be "left" or "right"/],
    ['side = "left"', 'side = left', /^it is not read as a study: Invalid TOML/],
    ['distance_mm = 1080.0', 'distance_mm = "far"', /^study\.component\[1\]\.distance_mm should be a finite number/],
    ['distance_mm = 1080.0', 'distance_mm = 0', /^study\.component\[1\]\.distance_mm should be a number above 0/],
    ['frames_per_s = 15', 'frames_per_s = -15', /^study\.frames_per_s should be a number above 0/],
    ['nominal = [5.0, -90]', 'nominal = [5.0]', /^study\.component\[1\]\.nominal should be two numbers/],
    ['nominal = [5.0, -90]', 'attenuation = -1', /^study\.component\[1\]\.attenuation should be a number above 0/],
  ])('is refused with its place: %s as %s', (from, to, sentence) => {
    expect(() => readStudy(STUDY.replace(from, to))).toThrow(sentence);
  });
});
