import { describe, expect, it } from 'vitest';
import { checkComponent, checkHints, checkOptions, checkOutline, checkSources, checkSquare, checkStated } from '../../npm/src/asked';

const OPTIONS = { model: new Uint8Array(), calibration: '', frame: { width: 1024, height: 1024 } };
const { frame: FRAME } = OPTIONS;
const POSE = { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };

describe('what the npm module is asked', () => {
  it('is taken where it is right', () => {
    checkOptions({ ...OPTIONS, views: { nominal: [0, 0] }, library: undefined, onProgress: () => undefined });
    checkOptions({ ...OPTIONS, model: { vertices: new Float32Array(9), triangles: Uint32Array.of(0, 1, 2) }, signal: new AbortController().signal });
    for (const bytes of [new ArrayBuffer(8), Buffer.from('abc'), new Uint8Array()]) checkOptions({ ...OPTIONS, model: bytes, library: bytes });
    checkOutline([[1, 2], [3, 4.5]]);
    checkHints({}, FRAME, 'pose');
    checkHints({ femur: POSE, neighbours: [POSE], unknownSides: [1], laidBy: 'tool', film: undefined }, FRAME, 'pose');
  });

  it('has the other component by its pose, or by its implant and that', () => {
    const implant = { axes: () => new Float64Array(9) };
    for (const tibia of [POSE, { implant, pose: POSE }]) checkHints({ tibia }, FRAME, 'pose');
    expect(() => checkHints({ femur: POSE, tibia: POSE }, FRAME, 'pose')).toThrow(/femur and tibia are each the other component; give the one/);
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
    [{ ...OPTIONS, frame: { width: 2 ** 32 + 1024, height: 1024 } }, /whole pixels, not 4294968320 x 1024/],
    [{ ...OPTIONS, model: {} }, /model should be the bytes/],
    [{ ...OPTIONS, model: new Uint16Array(9) }, /model should be the bytes/],
    [{ ...OPTIONS, model: { vertices: new Float32Array(9) } }, /model should have vertices, .* and triangles/],
    [{ ...OPTIONS, model: { vertices: new Float32Array(9), triangles: [0, 1, 2 ** 32] } }, /triangles, three vertex numbers of each from 0/],
    [{ ...OPTIONS, library: 'abc' }, /library should be the bytes of Implant\.library/],
    [{ ...OPTIONS, library: [1, 2] }, /library should be the bytes/],
    [{ ...OPTIONS, library: new Uint8Array(), views: {} }, /views says what to render, and a library is rendered/],
    [{ ...OPTIONS, views: { nominal: [NaN, 0] } }, /views: nominal should be \[x, y\], numbers in degrees/],
    [{ ...OPTIONS, views: { x: [0, 1] } }, /views: x should be \[from, to, step\]/],
    [{ ...OPTIONS, views: { distance: 'far' } }, /views: distance should be a number in mm/],
    [{ ...OPTIONS, onProgress: 1 }, /onProgress should be a function/],
    [{ ...OPTIONS, signal: {} }, /signal should be that of an AbortController/],
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
    for (const unknownSides of [['a'], [NaN], [1.5], [-1], [2 ** 32 + 3], 2]) expect(() => checkHints({ unknownSides }, FRAME, 'pose')).toThrow(/unknownSides should be an array of whole numbers/);
    expect(() => checkHints({ unknownSides: [0, 7], film: null }, FRAME, 'pose')).not.toThrow();
    expect(() => checkHints({ film: { curvature: 0, blur: 1, attenuation: 0.3 } }, FRAME, 'pose')).toThrow(/give the image too/);
  });

  it('has hints of their types, with or without an image', () => {
    const image = Uint8Array.of(1, 2, 3, 4);
    const hinted = (hints: object) => () => checkHints({ image, ...hints }, { width: 2, height: 2 }, 'pose');
    for (const bright of ['no', 0]) expect(hinted({ bright })).toThrow(/pose: bright should be true or false/);
    expect(hinted({ bright: false })).not.toThrow();
    for (const laidBy of ['robot', 5]) expect(hinted({ laidBy })).toThrow(/pose: laidBy should be one of hand, drawn, tool, mixed/);
    const stated = { curvature: 0, blur: 1, attenuation: 0.3 };
    for (const film of [stated, null, { words: '', blur: 1, profiles: 9, models: new Map() }]) expect(hinted({ film })).not.toThrow();
    for (const film of ['log', {}, { ...stated, curvature: -1 }, { ...stated, attenuation: NaN }, { ...stated, attenuation: 0 }, { models: [] }]) {
      expect(hinted({ film })).toThrow(/film should be what estimateFilm gave|film has no option models/);
    }
    expect(hinted({ film: { ...stated, blurr: 1 } })).toThrow(/pose: film has no option blurr; it has curvature, blur, attenuation/);
    for (const blur of [0, 12.5, 1e9]) expect(hinted({ film: { ...stated, blur } })).toThrow(/film: blur should be a number of pixels above 0, and at most 12/);
  });

  it('has frames and what is stated of their film', () => {
    checkSources([{ implant: { profiles: () => new Float32Array() }, image: new Uint8Array(), pose: POSE }]);
    for (const sources of [undefined, null, {}]) expect(() => checkSources(sources)).toThrow(/estimateFilm takes an array of \{ implant, image, pose \}/);
    expect(() => checkSources([null])).toThrow(/each of its frames should be \{ implant, image, pose \}/);
    expect(() => checkSources([{ implant: {}, pose: POSE }])).toThrow(/estimateFilm: implant should be what openImplant gave/);
    for (const stated of [{}, { display: 'linear' }, { blur: 0.8 }]) checkStated(stated);
    expect(() => checkStated({ displya: 'linear' })).toThrow(/estimateFilm, .* has no option displya; it has display, blur/);
    expect(() => checkStated({ display: 1 })).toThrow(/display should be linear, between or logarithmic/);
    for (const blur of ['1', NaN, -3, 1e9]) expect(() => checkStated({ blur })).toThrow(/estimateFilm: blur should be a number of pixels above 0/);
    for (const wrong of ['knee', undefined]) expect(() => checkComponent(wrong)).toThrow(/component should be femur or tibia/);
    for (const wrong of [0, 1.5, 2 ** 32 + 2]) expect(() => checkSquare(wrong)).toThrow(/squarePx should be a whole number of pixels from 1/);
  });

  it.each([
    [new Float32Array(4), /image is of type Float32Array; it should be .* Uint8Array .* Uint16Array/],
    [Uint8Array.of(1, 2, 3), /image has 3 values, and a frame of 2 x 2 pixels has 4/],
    [new Uint16Array(4).fill(7), /image has the grey value 7 everywhere/],
  ])('has an image of grey values (%#)', (image, sentence) => {
    expect(() => checkHints({ image }, { width: 2, height: 2 }, 'pose')).toThrow(sentence);
  });
});
