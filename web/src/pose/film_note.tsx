import type { Place } from '../document/command';
import { filmNumbers } from '../document/film';
import { checkState, markOf } from '../document/marks';
import { currentCell, currentPlace, type State } from '../document/store';
import { cellOf, type Posed } from '../document/types';
import { filmMissed } from '../results/film';
import { asSentence } from '../texts/sentences';
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
      <p class="card-note">{sentence(state, currentPlace(state), posed)}</p>
      <button type="button" class="button small" aria-haspopup="dialog" aria-expanded={open} title={texts.film.openTitle} onClick={() => store.show({ popover: open ? null : 'film' })}>
        {texts.film.open}
      </button>
    </section>
  );
}

/** The film in words; first what a person should know of the pose on view. */
function sentence({ history: { present: doc }, ui }: State, place: Place | null, posed: Posed | null): string {
  const { known } = doc.film;
  const words = known ? texts.film.known(known.words) : ui.clipped === null ? texts.film.unknown : asSentence(ui.clipped);
  const missed = place && posed?.onFrame ? filmMissed(posed.onFrame.film, filmNumbers(doc, place.component)) : null;
  if (!place || !posed || !missed) return words;
  const isChecked = checkState(cellOf(doc, place.frameId, place.component), markOf(doc, place)) === 'yes';
  if (posed.from === 'hand') return `${words} ${texts.film.refined[missed]}`;
  return isChecked ? `${words} ${texts.film.checked[missed]}` : words;
}
