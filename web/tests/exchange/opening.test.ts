import { describe, expect, it } from 'vitest';
import { at, pageOfFiles, unreadable } from './page_of_files';

describe('one file of many', () => {
  it.each([2, 20])('that cannot be read is named, and the %d others are opened all the same', async (others) => {
    const { frames, said, open } = pageOfFiles();
    await open(unreadable('/study/broken.png'), ...Array.from({ length: others }, (_, k) => at(`/study/f${k}.png`)));
    expect(frames()).toHaveLength(others);
    expect(said()).toContain('broken.png: The requested file could not be read');
  });
});
