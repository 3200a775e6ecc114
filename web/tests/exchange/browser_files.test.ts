import { describe, expect, it } from 'vitest';
import { droppedFiles } from '../../src/exchange/browser_files';

type Give = (resolve: (file: File) => void, reject: (error: Error) => void) => void;

const fileEntry = (path: string, give: Give) => ({ isFile: true, fullPath: path, file: give });
const given = (path: string) => fileEntry(path, (resolve) => resolve(new File(['x'], path.split('/').at(-1)!)));
const refused = (path: string) => fileEntry(path, (_, reject) => reject(new DOMException('gone', 'NotFoundError')));

/** A folder that gives its entries two at a time, and ends with an error where it should. */
function folderEntry(path: string, inner: readonly unknown[], error?: Error) {
  const createReader = () => {
    let from = 0;
    const readEntries = (resolve: (entries: readonly unknown[]) => void, reject: (error: Error) => void) => {
      if (error && from >= inner.length) return reject(error);
      resolve(inner.slice(from, (from += 2)));
    };
    return { readEntries };
  };
  return { isFile: false, fullPath: path, createReader };
}

async function dropped(...entries: readonly unknown[]) {
  const troubles: string[] = [];
  const transfer = { items: entries.map((entry) => ({ webkitGetAsEntry: () => entry })), files: [] };
  const files = await droppedFiles(transfer as unknown as DataTransfer, (path, error) => troubles.push(`${path}: ${(error as Error).message}`));
  return { paths: files.map(({ path }) => path), troubles };
}

describe('what is dropped', () => {
  it('has the files of folders, and of folders in these', async () => {
    const inner = folderEntry('/study/frames', [given('/study/frames/1.png'), given('/study/frames/2.png'), given('/study/frames/3.png')]);
    const { paths, troubles } = await dropped(folderEntry('/study', [given('/study/a.txt'), inner]), given('/b.stl'));
    expect(paths).toEqual(['/study/a.txt', '/study/frames/1.png', '/study/frames/2.png', '/study/frames/3.png', '/b.stl']);
    expect(troubles).toEqual([]);
  });

  it('is there but for the file that the browser does not give, which is told', async () => {
    const { paths, troubles } = await dropped(folderEntry('/study', [refused('/study/bad.png'), given('/study/good.png')]), refused('/away.stl'));
    expect(paths).toEqual(['/study/good.png']);
    expect(troubles.sort()).toEqual(['/away.stl: gone', '/study/bad.png: gone']);
  });

  it('is there as far as a folder could be read', async () => {
    const { paths, troubles } = await dropped(folderEntry('/study', [given('/study/1.png'), given('/study/2.png')], new Error('away')), given('/b.stl'));
    expect(paths).toEqual(['/study/1.png', '/study/2.png', '/b.stl']);
    expect(troubles).toEqual(['/study: away']);
  });
});
