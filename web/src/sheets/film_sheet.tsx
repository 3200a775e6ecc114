import { useState } from 'preact/hooks';
import { stateFilm } from '../document/film';
import type { State } from '../document/store';
import { DISPLAYS, type KnownFilm, type StatedFilm } from '../document/types';
import { NumberField } from '../controls/number_field';
import { Segments } from '../controls/segments';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';

/** Blur that a film can have, px: a pixel's own width is the least. */
const BLUR = { least: 0.3, most: 3 };

/** What the frames tell of their film, and what a person states instead. */
export function FilmSheet({ state }: { state: State }) {
  const { store } = useApp().services;
  const { known, stated } = state.history.present.film;
  const [trouble, setTrouble] = useState('');
  const words = texts.film;
  const say = (change: Partial<StatedFilm>) => store.perform(stateFilm({ ...stated, ...change }));
  const setBlur = (blur: number) => {
    const possible = Number.isNaN(blur) || (blur >= BLUR.least && blur <= BLUR.most);
    setTrouble(possible ? '' : words.wrongBlur);
    if (possible) say({ blur: Number.isNaN(blur) ? null : blur });
  };
  return (
    <div class="sheet-body">
      <p class="sheet-text" role="status">
        {known ? `${words.known(known.words)} ${words.from(known.profiles)}` : words.nothing}
      </p>
      {known && isUntold(known) && <p class="sheet-text">{words.untold}</p>}
      <Segments
        label={words.display}
        shown
        options={(['frames', ...DISPLAYS] as const).map((value) => ({ value, title: words.displays[value], hint: words.hints[value] }))}
        value={stated.display ?? 'frames'}
        onChoose={(value) => say({ display: value === 'frames' ? null : value })}
      />
      <div class="fields">
        <NumberField label={words.blur} unit="px" value={stated.blur ?? NaN} placeholder={known?.blur.toFixed(2) ?? ''} onChange={setBlur} />
      </div>
      <p class="sheet-trouble" role="alert">
        {trouble}
      </p>
      <p class="sheet-text quiet">{words.blurMeaning}</p>
      <p class="sheet-text quiet">{words.about}</p>
    </div>
  );
}

/** The frames gave no display, and nobody stated one: its curvature is then nothing, and uncertain. */
function isUntold({ curved, stated }: KnownFilm): boolean {
  return curved === 0 && stated.display === null;
}
