import { describe, expect, it } from 'vitest';
import { AXIS_WORDS, directionsFromWords, directionsOf, facingTheOtherWay, fromTheRight, isFrame, tiltAlike, viewpointOf, wordsOf, type Directions } from '../../src/geometry/axes';
import { inCamera, rotationOf, type Vector } from '../../src/geometry/pose_motion';

const IDENTITY = rotationOf({ x: 0, y: 0, z: 0, zRot: 0, xRot: 0, yRot: 0 });

describe('axes', () => {
  it('are one of 24 frames of a file, and their words lead back', () => {
    const frames = AXIS_WORDS.flatMap((a) => AXIS_WORDS.map((s) => directionsOf(a, s)).filter((frame) => frame !== null));
    expect(frames.length).toBe(24);
    for (const frame of frames) {
      expect(isFrame(frame)).toBe(true);
      expect(directionsFromWords(wordsOf(frame)!.join(' '))).toEqual(frame);
    }
  });

  it.each(['x y -z', 'x x y', 'x y', 'x y z x', 'a b c', '', '(1, 1, 0) y z', 'x y (0, 0.02, 1)', '(1, 0) y z', '(1, 0, ) y z', '(0, 0, 0) y z', '(8, 6, 0) (-6, 8, 0) -z', '(1, 0, 0 y z'])('are not "%s"', (words) => {
    expect(directionsFromWords(words)).toBeNull();
  });

  it('are read as a study writes them', () => {
    expect(directionsFromWords(' +x  y z ')).toEqual([[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    expect(wordsOf(facingTheOtherWay(directionsFromWords('-z y x')!))).toEqual(['z', 'y', '-x']);
    const oblique = directionsFromWords('(8.05, 6, 0)(-6, 8, 0) z')!;
    expect(isFrame(oblique)).toBe(true);
    expect(oblique.flat().map((number) => 0 + Number(number.toFixed(3)))).toEqual([0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, 1]);
  });

  it('that are none of the file’s have no words, and tilt alike when they face the other way', () => {
    const skew: Directions = [[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1]];
    expect(isFrame(skew)).toBe(true);
    expect(wordsOf(skew)).toBeNull();
    expect(tiltAlike(skew, facingTheOtherWay(skew))).toBe(true);
    expect(tiltAlike(skew, directionsFromWords('x y z')!)).toBe(false);
    expect(isFrame([[0.8, 0.6, 0], [0.6, 0.8, 0], [0, 0, 1]])).toBe(false);
  });

  it.each(['x y z', 'y z x', '-x -y z', 'z -x -y'])('%s: a model is seen from its right, anterior to the right and superior up', (words) => {
    const directions = directionsFromWords(words)!;
    const middle: Vector = [3, -20, 7];
    const pose = fromTheRight(directions, middle, 500);
    const [x, y, z] = inCamera(pose, middle);
    expect([x, y, z + 500].every((value) => Math.abs(value) < 1e-9)).toBe(true);
    const seen = directions.map((direction) => {
      const tip = inCamera(pose, [middle[0] + direction[0], middle[1] + direction[1], middle[2] + direction[2]]);
      return tip.map((value, axis) => Math.round(value - [x, y, z][axis]!) + 0);
    });
    expect(seen).toEqual([[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
  });

  it('say where to look from, lateral by the side of the body', () => {
    const directions = directionsFromWords('y z x')!;
    expect(viewpointOf('front', IDENTITY, directions, 'left')).toEqual({ from: [0, 1, 0], up: [0, 0, 1] });
    expect(viewpointOf('side', IDENTITY, directions, 'left').from).toEqual([-1, 0, 0]);
    expect(viewpointOf('side', IDENTITY, directions, 'right').from).toEqual([1, 0, 0]);
    expect(viewpointOf('above', IDENTITY, null, 'unknown')).toEqual({ from: [0, 1, 0], up: [0, 0, -1] });
  });
});
