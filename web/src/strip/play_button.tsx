import { useEffect, useState } from 'preact/hooks';
import { useApp } from '../commands/app';
import { Icon } from '../controls/icons';
import type { State } from '../document/store';
import { texts } from '../texts/texts';

/** Frames a second where nobody said how fast the film was taken. */
const USUAL_RATE = 10;

/** The film goes on by itself, as fast as it was taken, and begins anew at its end. */
export function PlayButton({ state }: { state: State }) {
  const { store } = useApp().services;
  const [plays, setPlays] = useState(false);
  const { frames, rate } = state.history.present;
  const can = frames.length > 1;
  useEffect(() => {
    if (!plays || !can) return undefined;
    const timer = setInterval(() => store.goTo((store.ui.frameIndex + 1) % store.doc.frames.length), 1000 / (rate ?? USUAL_RATE));
    return () => clearInterval(timer);
  }, [plays, can, rate, store]);
  const label = plays ? texts.work.pause : texts.work.play;
  return (
    <button type="button" class="button square" aria-label={label} title={label} disabled={!can} onClick={() => setPlays(!plays)}>
      <Icon name={plays ? 'pause' : 'play'} />
    </button>
  );
}
