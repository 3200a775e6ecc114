import { useEffect, useState } from 'preact/hooks';

/** Words and numbers are renewed at most so often, ms: the film follows the hand in every screen frame, but nobody reads faster. */
const PERIOD = 100;

const waiting = new Set<() => void>();
let renewedAt = -Infinity;
let scheduled = false;

/** All that waits is renewed at once: the page is laid out once. */
function renew(): void {
  scheduled = false;
  renewedAt = performance.now();
  const renewals = [...waiting];
  waiting.clear();
  for (const renewal of renewals) renewal();
}

function schedule(): void {
  if (scheduled) return;
  scheduled = true;
  const rest = renewedAt + PERIOD - performance.now();
  if (rest <= 0) requestAnimationFrame(renew);
  // In a stream of changes between two screen frames, where there is time left.
  else setTimeout(renew, rest);
}

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
