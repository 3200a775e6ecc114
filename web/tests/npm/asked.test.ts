import { describe, expect, it } from 'vitest';
import { checkHints, checkOptions, checkOutline } from '../../npm/src/asked';

const OPTIONS = { model: new Uint8Array(), calibration: '', frame: { width: 1024, height: 1024 } };
const { frame: FRAME } = OPTIONS;
const POSE = { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };

describe('what the npm module is asked', () => {
  it('is taken where it is right', () => {
    checkOptions({ ...OPTIONS, views: { nominal: [0, 0] }, library: undefined, onProgress: () => undefined });
    checkOutline([[1, 2], [3, 4.5]]);
    checkHints({}, FRAME, 'pose');
    checkHints({ femur: POSE, neighbours: [POSE], unknownSides: [1], laidBy: 'tool', film: undefined }, FRAME, 'pose');
  });

  it('has the other component by its pose, or by its implant and that', () => {
    const implant = { axes: () => new Float64Array(9) };
    for (const tibia of [POSE, { implant, pose: POSE }]) checkHints({ tibia }, FRAME, 'pose');
    for (const [tibia, sentence] of [
      [{ implant: {}, pose: POSE }, /tibia: implant should be what openImplant gave/],
      [{ implant, pose: { x: 1 } }, /tibia: pose should be a pose \{ x, y, z/],
      [{ implant, pose: POSE, axes: [] }, /tibia has no option axes; it has implant, pose/],
    ] as const) {
      expect(() => checkHints({ tibia }, FRAME, 'pose')).toThrow(sentence);
    }
  });

  it.each([
    [undefined, /openImplant takes an object with model, calibration, frame/],
    [{ ...OPTIONS, frame: undefined }, /frame should be \{ width, height \}/],
    [{ ...OPTIONS, frame: { width: 1.5, height: 4 } }, /whole pixels/],
    [{ ...OPTIONS, model: 'femur.stl' }, /model should be the bytes/],
    [{ ...OPTIONS, calibration: new Uint8Array() }, /calibration should be the text/],
    [{ ...OPTIONS, side: 'left' }, /openImplant has no option side; it has model/],
    [{ ...OPTIONS, views: { step: 2 } }, /views has no option step; it has nominal, x, y, distance/],
  ])('is told in a sentence that says what to give (%#)', (options, sentence) => {
    expect(() => checkOptions(options)).toThrow(sentence);
  });

  it('has an outline of points and hints that there are', () => {
    for (const outline of ['x', [1, 2, 3, 4], [['1', '2']], [[1, 2, 3]], null]) expect(() => checkOutline(outline)).toThrow(/array of points \[column, row\]/);
    expect(() => checkHints({ other: POSE }, FRAME, 'pose')).toThrow(/pose has no option other; it has unknownSides/);
    expect(() => checkHints({ femur: { pose: POSE } }, FRAME, 'pose')).toThrow(/femur should be a pose/);
    expect(() => checkHints({ neighbours: POSE }, FRAME, 'pose')).toThrow(/neighbours should be an array of poses/);
    for (const unknownSides of [['a'], [NaN], [1.5], [-1], 2]) expect(() => checkHints({ unknownSides }, FRAME, 'pose')).toThrow(/unknownSides should be an array of whole numbers/);
    expect(() => checkHints({ unknownSides: [0, 7], film: null }, FRAME, 'pose')).not.toThrow();
    expect(() => checkHints({ film: { curvature: 0, blur: 1, attenuation: 0.3 } }, FRAME, 'pose')).toThrow(/give the image too/);
  });

  it.each([
    [new Float32Array(4), /image is of type Float32Array; it should be .* Uint8Array .* Uint16Array/],
    [Uint8Array.of(1, 2, 3), /image has 3 values, and a frame of 2 x 2 pixels has 4/],
    [new Uint16Array(4).fill(7), /image has the grey value 7 everywhere/],
  ])('has an image of grey values (%#)', (image, sentence) => {
    expect(() => checkHints({ image }, { width: 2, height: 2 }, 'pose')).toThrow(sentence);
  });
});
