import type { Incoming } from '../engine/opener';

/** Asks for files; an empty list when the person thinks better of it. */
export function pickFiles(): Promise<Incoming[]> {
  return new Promise((resolve) => {
    const input = document.createElement('input');
    input.type = 'file';
    input.multiple = true;
    input.setAttribute('aria-label', 'Files to open');
    input.onchange = () => resolve(readAll(Array.from(input.files ?? [])));
    input.oncancel = () => resolve([]);
    input.click();
  });
}

export function download(parts: string[], name: string, type: string): void {
  const address = URL.createObjectURL(new Blob(parts, { type }));
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  // The browser has taken hold of the blob by then.
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** The files of a drop, those in dropped folders too. */
export async function droppedFiles(transfer: DataTransfer): Promise<Incoming[]> {
  // Entries must be taken before anything is awaited: the transfer is emptied when the event ends.
  const entries = Array.from(transfer.items).map((item) => item.webkitGetAsEntry());
  const loose = Array.from(transfer.files);
  if (entries.every((entry) => entry === null)) return readAll(loose);
  const files = await Promise.all(entries.filter((entry) => entry !== null).map(filesOf));
  return readAll(files.flat());
}

async function filesOf(entry: FileSystemEntry): Promise<File[]> {
  if (entry.isFile) return [await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject))];
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const files: File[] = [];
  for (;;) {
    // A reader gives a hundred entries at most each time.
    const entries = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (entries.length === 0) return files;
    for (const inner of entries) files.push(...(await filesOf(inner)));
  }
}

async function readAll(files: readonly File[]): Promise<Incoming[]> {
  return Promise.all(files.map(async (file) => ({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) })));
}
