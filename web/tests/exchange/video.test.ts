import { describe, expect, it } from 'vitest';
import { greyPng } from '../../src/exchange/grey_png';
import { rateFrom, timesOf } from '../../src/exchange/video';

describe('pictures of a video', () => {
  it('come at the least step between any two, whatever was left out', () => {
    expect(rateFrom([0, 0.04, 0.08, 0.16, 0.2])).toBeCloseTo(25);
    // Rounded to milliseconds, one left out.
    expect(rateFrom([0, 0.033, 0.067, 0.1, 0.167, 0.2])).toBeCloseTo(30, 0);
    expect(rateFrom([0.5])).toBe(25);
  });

  const video = { duration: 2, rate: 10 };

  it('are met in their middle', () => {
    const times = timesOf(video, { from: 0, to: 2, every: 1 });
    expect(times).toHaveLength(20);
    expect(times[0]).toBeCloseTo(0.05);
    expect(times[19]).toBeCloseTo(1.95);
  });

  it('may be every so many, from any place to any other', () => {
    const times = timesOf(video, { from: 0.52, to: 1.5, every: 3 });
    expect(times.map((time) => time.toFixed(2))).toEqual(['0.55', '0.85', '1.15', '1.45']);
    expect(timesOf(video, { from: 1.5, to: 1, every: 1 })).toEqual([]);
    expect(timesOf(video, { from: NaN, to: 1, every: 1 })).toEqual([]);
    expect(timesOf(video, { from: 0, to: 99, every: 1 })).toHaveLength(20);
  });
});

describe('a grey PNG', () => {
  const [width, height] = [5, 3];
  const grey = Array.from({ length: width * height }, (_, at) => (37 * at) % 256);

  async function inflated(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  it('holds the grey values exactly', async () => {
    const rgba = Uint8ClampedArray.from(grey.flatMap((value) => [value, value, value, 255]));
    const file = await greyPng(rgba, width, height);
    const view = new DataView(file.buffer);
    expect(Array.from(file.subarray(0, 8))).toEqual([137, 80, 78, 71, 13, 10, 26, 10]);
    expect([view.getUint32(16), view.getUint32(20), file[24], file[25]]).toEqual([width, height, 8, 0]);
    const rows = await inflated(file.slice(41, 41 + view.getUint32(33)));
    const found: number[] = [];
    for (let row = 0; row < height; row++) {
      const start = row * (width + 1);
      expect(rows[start]).toBe(2);
      for (let column = 0; column < width; column++) {
        const above = row === 0 ? 0 : (found[(row - 1) * width + column] ?? 0);
        found.push(((rows[start + 1 + column] ?? 0) + above) & 255);
      }
    }
    expect(found).toEqual(grey);
  });

  it('takes colours for their luminance', async () => {
    const file = await greyPng(Uint8ClampedArray.of(255, 0, 0, 255), 1, 1);
    const rows = await inflated(file.slice(41, 41 + new DataView(file.buffer).getUint32(33)));
    expect(Array.from(rows)).toEqual([2, 76]);
  });
});
