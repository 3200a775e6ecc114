import { filmNumbers } from '../document/film';
import { currentCell, type State } from '../document/store';
import type { Doc, Posed } from '../document/types';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';

/** What is known of the film that the pose rests on, where it was found on the frame itself. */
export function FilmNote({ state }: { state: State }) {
  const { store } = useApp().services;
  const doc = state.history.present;
  const { result } = currentCell(state);
  const posed = result?.kind === 'posed' && result.onFrame ? result : null;
  if (!posed && !doc.film.known) return null;
  const open = state.ui.popover === 'film';
  return (
    <section class="card note" aria-label={texts.film.card}>
      <p class="card-note">{sentence(doc, state.ui.component, posed)}</p>
      <button type="button" class="button small" aria-haspopup="dialog" aria-expanded={open} title={texts.film.openTitle} onClick={() => store.show({ popover: open ? null : 'film' })}>
        {texts.film.open}
      </button>
    </section>
  );
}

/** The film in words; first what a person should know of the pose on view. */
function sentence(doc: Doc, component: ComponentName, posed: Posed | null): string {
  const { known } = doc.film;
  const words = known ? texts.film.known(known.words) : texts.film.unknown;
  if (!posed?.onFrame || posed.onFrame.film || !filmNumbers(doc, component)) return words;
  return `${words} ${posed.from === 'hand' ? texts.film.before : texts.film.stays}`;
}
