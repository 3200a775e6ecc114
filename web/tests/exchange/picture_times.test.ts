import { describe, expect, it } from 'vitest';
import { pictureTimes } from '../../src/exchange/picture_times';

const { signal } = new AbortController();

describe('times of the pictures of a video', () => {
  it('are those of its file, which has neither a duration nor an index', async () => {
    const times = await pictureTimes(webm([0, 40, 120]), signal);
    expect(times).toEqual([0, 0.04, 0.12]);
  });

  it('are none where the file is no video, or is cut', async () => {
    expect(await pictureTimes(new Blob(['RIFF once upon a time']), signal)).toEqual([]);
    expect(await pictureTimes(webm([0, 40]).slice(0, 20), signal)).toEqual([]);
  });

  it('are no longer looked for when it was called off', async () => {
    await expect(pictureTimes(webm([0, 40]), AbortSignal.abort(new Error('called off')))).rejects.toThrow('called off');
  });
});

/** A WebM with a picture of one byte at each time, ms: that is no picture, but nobody decodes it. */
function webm(times: readonly number[]): Blob {
  const video = element('e0', element('b0', [0, 16]), element('ba', [0, 16]));
  const track = element('ae', element('d7', [1]), element('73c5', [1]), element('83', [1]), element('86', letters('V_VP8')), video);
  const blocks = times.map((time) => element('a3', [0x81, time >> 8, time & 255, 0x80, 0]));
  const content = [
    ...element('1a45dfa3', element('4282', letters('webm'))),
    ...endless('18538067'),
    ...element('1549a966', element('2ad7b1', [0x0f, 0x42, 0x40])),
    ...element('1654ae6b', track),
    ...endless('1f43b675'),
    ...element('e7', [0]),
    ...blocks.flat(),
  ];
  return new Blob([Uint8Array.from(content)]);
}

/** An element of EBML (RFC 8794) of fewer than 16384 bytes. */
function element(id: string, ...content: readonly (readonly number[])[]): number[] {
  const body = content.flat();
  return [...bytes(id), 0x40 | (body.length >> 8), body.length & 255, ...body];
}

/** One that goes on to the end. */
function endless(id: string): number[] {
  return [...bytes(id), ...bytes('01ffffffffffffff')];
}

function bytes(hexadecimal: string): number[] {
  return Array.from({ length: hexadecimal.length / 2 }, (_, at) => parseInt(hexadecimal.slice(2 * at, 2 * at + 2), 16));
}

function letters(text: string): number[] {
  return [...text].map((letter) => letter.charCodeAt(0));
}
