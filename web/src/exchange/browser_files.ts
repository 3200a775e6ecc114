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

/** Is told of what the browser does not give: a right is missing, a disk or a file of the cloud is away. */
export type TellTrouble = (path: string, error: unknown) => void;

/** Files of a drop on their way, and what the browser does not give of it. */
export interface Dropped {
  readonly files: Promise<readonly Located[]>;
  readonly troubles: readonly (readonly [path: string, error: unknown])[];
}

/**
 * Takes every drop of files from now on, and hands it on once there is something that opens it: a browser that is left alone with a drop shows the
 * file in the page's place.
 */
export function takeDrops(open: Promise<(dropped: Dropped) => void>): void {
  addEventListener('dragover', (event) => carriesFiles(event) && event.preventDefault());
  addEventListener('drop', (event) => {
    event.preventDefault();
    if (!event.dataTransfer) return;
    const troubles: [string, unknown][] = [];
    const files = droppedFiles(event.dataTransfer, (...trouble) => troubles.push(trouble));
    void open.then((take) => take({ files, troubles }));
  });
}

export function carriesFiles({ dataTransfer }: DragEvent): boolean {
  return dataTransfer?.types.includes('Files') ?? false;
}

/** The files of a drop, those in dropped folders too. What cannot be had leaves the others. */
export async function droppedFiles(transfer: DataTransfer, tell: TellTrouble): Promise<Located[]> {
  // Entries must be taken before anything is awaited: the transfer is emptied when the event ends.
  const entries = Array.from(transfer.items).map((item) => item.webkitGetAsEntry());
  if (entries.every((entry) => entry === null)) return Array.from(transfer.files, located);
  const files = await Promise.all(entries.filter((entry) => entry !== null).map((entry) => filesOf(entry, tell)));
  return files.flat();
}

function located(file: File): Located {
  return { file, path: file.webkitRelativePath || file.name };
}

async function filesOf(entry: FileSystemEntry, tell: TellTrouble): Promise<Located[]> {
  const files: Located[] = [];
  try {
    if (entry.isFile) files.push({ file: await fileOf(entry as FileSystemFileEntry), path: entry.fullPath });
    else for await (const inner of entriesOf(entry as FileSystemDirectoryEntry)) files.push(...(await filesOf(inner, tell)));
  } catch (error) {
    tell(entry.fullPath, error);
  }
  return files;
}

function fileOf(entry: FileSystemFileEntry): Promise<File> {
  return new Promise((resolve, reject) => entry.file(resolve, reject));
}

async function* entriesOf(folder: FileSystemDirectoryEntry): AsyncGenerator<FileSystemEntry> {
  const reader = folder.createReader();
  for (;;) {
    // A reader gives a hundred entries at most each time.
    const entries = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (entries.length === 0) return;
    yield* entries;
  }
}
