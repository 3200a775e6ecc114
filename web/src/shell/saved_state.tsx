import { useEffect, useState } from 'preact/hooks';
import type { Keeping, State } from '../document/store';
import { texts } from '../texts/texts';

/** Whether the work is safe in this browser, and since when. */
export function SavedState({ state }: { state: State }) {
  const { keeping } = state.ui;
  const now = useClock(keeping.state === 'kept' ? keeping.at : null);
  return (
    <span class={`saved ${keeping.state}`} role="group" aria-label={texts.keep.label} title={titleOf(keeping)}>
      {textOf(keeping, now)}
    </span>
  );
}

function textOf(keeping: Keeping, now: number): string {
  switch (keeping.state) {
    case 'nothing':
      return '';
    case 'pending':
      return texts.keep.pending;
    case 'refused':
      return texts.keep.refusedShort;
    case 'kept':
      return ago(now - keeping.at);
  }
}

function titleOf(keeping: Keeping): string {
  return keeping.state === 'refused' ? keeping.sentence : texts.keep.meaning;
}

function ago(milliseconds: number): string {
  const seconds = Math.max(0, Math.floor(milliseconds / 1000));
  if (seconds < 2) return texts.keep.keptNow;
  if (seconds < 60) return texts.keep.kept(texts.keep.seconds(seconds));
  const minutes = Math.floor(seconds / 60);
  return texts.keep.kept(minutes < 60 ? texts.keep.minutes(minutes) : texts.keep.hours(Math.floor(minutes / 60)));
}

/** The time, told each second for a minute after `since` and each minute from then on; not at all where that is null. */
function useClock(since: number | null): number {
  const [now, setNow] = useState(Date.now());
  useEffect(() => {
    if (since === null) return undefined;
    let timer: ReturnType<typeof setTimeout>;
    const tick = () => {
      setNow(Date.now());
      timer = setTimeout(tick, Date.now() - since < 60_000 ? 1000 : 60_000);
    };
    tick();
    return () => clearTimeout(timer);
  }, [since]);
  return now;
}
