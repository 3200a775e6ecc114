import { texts } from '../texts/texts';
import { Aborted } from '../workers/bridge';
import type { Incoming } from './incoming';
import { pathOf } from './paths';
import { troubleOf } from './trouble';

/** What came of files that were opened together, in words. */
export interface Outcome {
  readonly opened: string[];
  readonly failed: string[];
  /** What there is to know of what came. */
  readonly news: string[];
  readonly leftOut: string[];
}

export function noOutcome(): Outcome {
  return { opened: [], failed: [], news: [], leftOut: [] };
}

/** Opens a file by `open`, which says what it was; what is amiss with it is said in place of that. */
export async function attempt({ name }: Incoming, open: () => Promise<string>, { opened, failed }: Pick<Outcome, 'opened' | 'failed'>): Promise<void> {
  try {
    opened.push(await open());
  } catch (error) {
    if (!(error instanceof Aborted)) failed.push(troubleOf(name, error));
  }
}

/** A few names, and how many more there are. */
export function fewNames(files: readonly Incoming[]): string {
  const names = files.slice(0, 3).map(pathOf);
  const rest = files.length - names.length;
  return texts.listed(rest > 0 ? [...names, texts.files.andMore(rest)] : names);
}
