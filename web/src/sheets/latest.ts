import { useEffect, useRef, useState } from 'preact/hooks';
import { sentenceOf } from '../jobs/services';
import { work } from '../workers/activity';
import { Aborted } from '../workers/bridge';

export interface Latest<T> {
  readonly value: T | null;
  /** Why it could not be made. */
  readonly trouble: string | null;
}

/** What was made of the latest of these; one thing is made at a time, however often they change meanwhile. */
export function useLatest<T>(make: () => Promise<T>, of: readonly unknown[]): Latest<T> | null {
  const [made, setMade] = useState<Latest<T> | null>(null);
  const now = useRef({ make, isStale: false, isBusy: false, isGone: false });
  now.current.make = make;
  useEffect(() => {
    const one = now.current;
    one.isGone = false;
    one.isStale = true;
    if (!one.isBusy) void renew();
    async function renew(): Promise<void> {
      one.isBusy = true;
      const over = work.begin();
      while (one.isStale && !one.isGone) {
        one.isStale = false;
        const latest = await one.make().then((value): Latest<T> => ({ value, trouble: null }), (error: unknown) => (error instanceof Aborted ? null : { value: null, trouble: sentenceOf(error) }));
        if (latest && !one.isGone) setMade(latest);
      }
      one.isBusy = false;
      over();
    }
    return undefined;
  }, of);
  useEffect(
    () => () => {
      now.current.isGone = true;
    },
    [],
  );
  return made;
}
