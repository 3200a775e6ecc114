import { cellOf, type Doc } from '../document/types';
import { COMPONENT_NAMES } from '../terms/component';
import { fileStem } from '../terms/file_name';
import { later } from '../texts/later';
import { asJob, type Services } from '../jobs/services';
import { masksWorker } from '../workers/start';
import type { MaskToWrite } from '../workers/protocol/masks';

/** A zip of PNG masks, a folder a component; null where no outline is closed. */
export async function exportMasks({ store }: Services): Promise<Uint8Array<ArrayBuffer> | null> {
  const masks = masksOf(store.doc);
  if (masks.length === 0) return null;
  const abort = new AbortController();
  const worker = masksWorker();
  const job = { title: later.exchange.writing, unit: later.exchange.masks, total: masks.length, cancel: () => abort.abort() };
  try {
    return await asJob(store, job, (report) =>
      worker.call('write', { masks }, { signal: abort.signal, onProgress: ({ done, total }) => report(done, total) }),
    );
  } finally {
    worker.dispose();
  }
}

export function masksOf(doc: Doc): MaskToWrite[] {
  const names = namesOf(doc);
  return COMPONENT_NAMES.flatMap((component) =>
    doc.frames.flatMap((frame, index): MaskToWrite[] => {
      const { outline } = cellOf(doc, frame.id, component);
      if (!outline?.closed) return [];
      const points = Float64Array.from(outline.points.flatMap(({ column, row }) => [column, row]));
      return [{ path: `${component}/${names[index]}.png`, width: frame.width, height: frame.height, points }];
    }),
  );
}

/** Names of the frames as names of files, each once whatever the case. "film.tif #3" becomes "film_0003". */
function namesOf(doc: Doc): string[] {
  const used = new Set<string>();
  const counts = new Map<string, number>();
  return doc.frames.map(({ name }) => {
    const [, file = name, page] = /^(.*?)(?: #(\d{1,9}))?$/s.exec(name) ?? [];
    const stem = fileStem(file.replace(/\.[a-z0-9]+$/i, ''), 'frame');
    const wanted = page === undefined ? stem : `${stem}_${page.padStart(4, '0')}`;
    const folded = wanted.toLowerCase();
    let count = counts.get(folded) ?? 0;
    let own = wanted;
    do own = ++count === 1 ? wanted : `${wanted}_${count}`;
    while (used.has(own.toLowerCase()));
    counts.set(folded, count);
    used.add(own.toLowerCase());
    return own;
  });
}
