import type { Located } from './reading';

/** Asks for files, or for a folder with all it holds; an empty list when the person thinks better of it. */
export function pickFiles(what: 'files' | 'folder' = 'files'): Promise<Located[]> {
  return new Promise((resolve) => {
    const input = document.createElement('input');
    input.type = 'file';
    input.multiple = true;
    input.webkitdirectory = what === 'folder';
    input.setAttribute('aria-label', 'Files to open');
    input.onchange = () => resolve(Array.from(input.files ?? [], located));
    input.oncancel = () => resolve([]);
    input.click();
  });
}

export function download(parts: BlobPart[], name: string, type: string): void {
  const address = URL.createObjectURL(new Blob(parts, { type }));
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  // The browser has taken hold of the blob by then.
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** The files of a drop, those in dropped folders too. */
export async function droppedFiles(transfer: DataTransfer): Promise<Located[]> {
  // Entries must be taken before anything is awaited: the transfer is emptied when the event ends.
  const entries = Array.from(transfer.items).map((item) => item.webkitGetAsEntry());
  if (entries.every((entry) => entry === null)) return Array.from(transfer.files, located);
  const files = await Promise.all(entries.filter((entry) => entry !== null).map(filesOf));
  return files.flat();
}

function located(file: File): Located {
  return { file, path: file.webkitRelativePath || file.name };
}

async function filesOf(entry: FileSystemEntry): Promise<Located[]> {
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
    return [{ file, path: entry.fullPath }];
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const files: Located[] = [];
  for (;;) {
    // A reader gives a hundred entries at most each time.
    const entries = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (entries.length === 0) return files;
    for (const inner of entries) files.push(...(await filesOf(inner)));
  }
}
