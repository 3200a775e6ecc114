import { useState } from 'preact/hooks';
import { isBlur, isCurvature, stateFilm } from '../document/film';
import type { State } from '../document/store';
import { DISPLAYS, type Doc, type Film, type FilmConstants, type KnownFilm, type StatedFilm } from '../document/types';
import { NumberField } from '../controls/number_field';
import { Segments } from '../controls/segments';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';

/** What the frames tell of their film, and what a person states instead. */
export function FilmSheet({ state }: { state: State }) {
  const { store } = useApp().services;
  const { film, components } = state.history.present;
  const { known, stated } = film;
  const [trouble, setTrouble] = useState('');
  const words = later.filmSheet;
  const say = (change: Partial<StatedFilm>) => store.perform(stateFilm({ ...stated, ...change }));
  const setBlur = (blur: number) => {
    const possible = Number.isNaN(blur) || isBlur(blur);
    setTrouble(possible ? '' : words.wrongBlur);
    if (possible) say({ blur: Number.isNaN(blur) ? null : blur });
  };
  return (
    <div class="sheet-body">
      <p class="sheet-text" role="status">
        {known ? [texts.film.known(known.words), ...(known.stated.constants ? [] : [words.from(known.profiles)])].join(' ') : words.nothing}
      </p>
      {known && isUntold(known) && <p class="sheet-text">{words.untold}</p>}
      {stated.constants ? (
        <Constants constants={stated.constants} onChange={(constants) => say({ constants })} />
      ) : (
        <>
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
          <div class="sheet-buttons">
            <button type="button" class="button small" title={words.fixTitle} onClick={() => say({ constants: asKnown(film, components) })}>
              {words.fix}
            </button>
          </div>
        </>
      )}
      <p class="sheet-text quiet">{words.about}</p>
    </div>
  );
}

interface ConstantsProps {
  readonly constants: FilmConstants;
  readonly onChange: (constants: FilmConstants | null) => void;
}

/** All of a film, number by number. */
function Constants({ constants, onChange }: ConstantsProps) {
  const [trouble, setTrouble] = useState('');
  const words = later.filmSheet;
  const { curvature, blur, attenuation } = constants;
  const set = (change: Partial<FilmConstants>) => {
    const next = { ...constants, ...change };
    const possible = isPossible(next);
    setTrouble(possible ? '' : words.wrongConstants);
    if (possible) onChange(next);
  };
  const setAttenuation = (component: ComponentName, value: number) => set({ attenuation: { ...attenuation, [component]: Number.isNaN(value) ? null : value } });
  return (
    <>
      <div class="fields">
        <NumberField label={words.curvature} unit={words.curvatureUnit} value={curvature} onChange={(value) => set({ curvature: value })} />
        <NumberField label={words.blur} unit="px" value={blur} onChange={(value) => set({ blur: value })} />
        {COMPONENT_NAMES.map((component) => (
          <NumberField key={component} label={words.metal(texts.component[component])} unit={words.metalUnit} value={attenuation[component] ?? NaN} onChange={(value) => setAttenuation(component, value)} />
        ))}
      </div>
      <p class="sheet-trouble" role="alert">
        {trouble}
      </p>
      <p class="sheet-text quiet">{words.constantsMeaning}</p>
      <div class="sheet-buttons">
        <button type="button" class="button small" title={words.unfixTitle} onClick={() => onChange(null)}>
          {words.unfix}
        </button>
      </div>
    </>
  );
}

function isPossible({ curvature, blur, attenuation }: FilmConstants): boolean {
  const metal = COMPONENT_NAMES.map((component) => attenuation[component] ?? 1);
  return isCurvature(curvature) && isBlur(blur) && metal.every((value) => value > 0);
}

/** What the frames tell, as a person would state it; a linear film of usual blur where they do not. */
function asKnown({ known }: Film, components: Doc['components']): FilmConstants {
  const numbers = (component: ComponentName) => {
    const model = known?.models[component];
    return model && model.of === components[component].model?.sha256 ? model.numbers : null;
  };
  const attenuation = { femur: rounded(numbers('femur')?.[2]), tibia: rounded(numbers('tibia')?.[2]) };
  const [curvature] = numbers('femur') ?? numbers('tibia') ?? [];
  return { curvature: Math.max(0, rounded(curvature) ?? 0), blur: rounded(known?.blur) ?? 1, attenuation };
}

/** Four digits: more are not known. */
function rounded(value: number | undefined): number | null {
  return value === undefined ? null : Number(value.toPrecision(4));
}

/** The frames gave no display, and nobody stated one: its curvature is then nothing, and uncertain. */
function isUntold({ curved, stated }: KnownFilm): boolean {
  return curved === 0 && stated.display === null && stated.constants === null;
}
