import { texts } from '../texts/texts';
import { sentenceOf } from '../jobs/services';

/** The storage was cleared, and with it the only copies of files. */
export class FilesGone extends Error {
  constructor(readonly names: readonly string[]) {
    super(texts.keep.filesGone(texts.listed(names), names.length));
  }
}

/** What a connection to the storage says that the browser has closed, and one that it opens while it clears. */
const TAKEN_AWAY: readonly string[] = ['AbortError', 'InvalidStateError', 'UnknownError'];

export function isTakenAway(error: unknown): boolean {
  return error instanceof DOMException && TAKEN_AWAY.includes(error.name);
}

/** What the browser's refusal means for the person. */
export function refusal(error: unknown): string {
  if (error instanceof FilesGone) return error.message;
  if (error instanceof DOMException && error.name === 'QuotaExceededError') return texts.keep.full;
  return texts.keep.refused(sentenceOf(error));
}
