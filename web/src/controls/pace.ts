import { useEffect, useState } from 'preact/hooks';
import { renewals } from '../workers/activity';

/**
 * While something moves, words and numbers are renewed at most so often, ms: the stage follows the hand in every screen
 * frame, but nobody reads faster.
 */
const PERIOD = 100;

/** A person who presses or types something wants to see at once what came of it. */
const DEEDS = ['keydown', 'pointerdown', 'pointerup', 'click', 'input', 'change', 'drop'] as const;

const waiting = new Set<() => void>();
let renewedAt = -Infinity;
let frame = 0;
let timer: ReturnType<typeof setTimeout> | undefined;
let renewed: () => void = () => undefined;

/** All that waits is renewed at once: the page is laid out once. */
function renew(): void {
  frame = 0;
  timer = undefined;
  renewedAt = performance.now();
  const due = [...waiting];
  waiting.clear();
  for (const renew of due) renew();
  renewed();
}

function schedule(): void {
  if (frame !== 0 || timer !== undefined) return;
  renewed();
  renewed = renewals.begin();
  const rest = renewedAt + PERIOD - performance.now();
  if (rest <= 0) frame = requestAnimationFrame(renew);
  // In a stream of changes between two screen frames, where there is time left.
  else timer = setTimeout(renew, rest);
}

function hurry(): void {
  renewedAt = -Infinity;
  clearTimeout(timer);
  timer = undefined;
  if (waiting.size > 0) schedule();
}

for (const deed of DEEDS) addEventListener(deed, hurry, { capture: true, passive: true });

/** What `read` gives, renewed soon after `subscribe` tells of a change. Both have to stay the same functions. */
export function useAtReadingPace<T>(subscribe: (listener: () => void) => () => void, read: () => T): T {
  const [value, setValue] = useState(read);
  useEffect(() => {
    const renewal = () => setValue(read);
    const update = () => {
      waiting.add(renewal);
      schedule();
    };
    update();
    const unsubscribe = subscribe(update);
    return () => {
      unsubscribe();
      waiting.delete(renewal);
    };
  }, [subscribe, read]);
  return value;
}
