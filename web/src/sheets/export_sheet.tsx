import { useEffect, useState } from 'preact/hooks';
import { fileName, write } from '../commands/exporting';
import { useApp } from '../commands/app';
import { byArrows } from '../controls/radios';
import { Segments } from '../controls/segments';
import type { State } from '../document/store';
import { COMPONENT_NAMES, titleOf } from '../terms/component';
import { EXPORTS, type Exporting, FORMS, isOfBoth } from '../terms/exporting';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import { EarlierWork } from '../steps/open/earlier_work';
import { RateField } from '../steps/joint/rate_field';
import { ExportFaults } from './export_faults';
import { ExportPreview } from './export_preview';
import { lackOf } from './export_lack';
import { useFilmType } from './export_film';
import '../styles/export.css';

/** Everything that leaves the page as a file: what it is, what is wrong with it, how it looks, and the button that writes it. */
export function ExportSheet({ state }: { state: State }) {
  const { store } = useApp().services;
  const { exporting } = state.ui;
  const words = later.exporting;
  return (
    <div class="sheet-body export">
      <div class="export-kinds" role="radiogroup" aria-label={words.kinds} onKeyDown={byArrows}>
        {EXPORTS.map((kind) => (
          <button
            key={kind}
            type="button"
            role="radio"
            class="export-kind"
            aria-checked={kind === exporting.kind}
            tabIndex={kind === exporting.kind ? 0 : -1}
            onClick={() => store.show({ exporting: { ...exporting, kind } })}
          >
            {words.kind[kind]}
          </button>
        ))}
      </div>
      <div class="export-pane">
        <p class="sheet-text">{words.meaning[exporting.kind]}</p>
        <Options state={state} />
        {exporting.kind === 'session' && (
          <>
            <p class="sheet-text quiet">{texts.keep.meaning}</p>
            <EarlierWork state={state} />
          </>
        )}
        <Contents state={state} />
      </div>
    </div>
  );
}

/** What is wrong with it, how it looks, and the button; or why there is nothing to write. */
function Contents({ state }: { state: State }) {
  const app = useApp();
  const film = useFilmType(state);
  const [busy, setBusy] = useState(false);
  const { exporting, frameIndex } = state.ui;
  const doc = state.history.present;
  const lack = lackOf(state, app.joint.numbers, film);
  const name = fileName(doc, exporting, frameIndex, film ?? null);
  const isOff = lack !== null || busy;
  const save = async () => {
    if (isOff) return;
    setBusy(true);
    await write(app, exporting, film ?? null).finally(() => setBusy(false));
  };
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      if (event.key !== 'Enter' || !(event.ctrlKey || event.metaKey)) return;
      event.preventDefault();
      void save();
    };
    window.addEventListener('keydown', onKey);
    return () => window.removeEventListener('keydown', onKey);
  });
  return (
    <>
      <ExportFaults state={state} />
      {lack ? <div class="sheet-text">{lack}</div> : <ExportPreview state={state} film={film} />}
      <div class="sheet-buttons export-write">
        {/* Keys reach it, and stay on it, also while there is nothing to write yet. */}
        <button type="button" class="button primary" aria-disabled={isOff} aria-keyshortcuts="Control+Enter" title={later.exporting.writeKey} onClick={() => void save()}>
          {later.exporting.write(name)}
        </button>
      </div>
    </>
  );
}

/** The form, and what it asks for. */
function Options({ state }: { state: State }) {
  const { joint, services } = useApp();
  const { exporting } = state.ui;
  const { kind, forms, component, column } = exporting;
  const words = later.exporting;
  const set = (change: Partial<Exporting>) => services.store.show({ exporting: { ...exporting, ...change } });
  const titles: Readonly<Record<string, string>> = words.forms[kind];
  const options = FORMS[kind].map((form) => ({ value: form as string, title: titles[form] ?? form, hint: words.hints[`${kind} ${form}`] ?? titles[form] ?? form }));
  const hint = words.hints[`${kind} ${forms[kind]}`];
  const isTimed = (kind === 'joint' && forms.joint !== 'cycle') || kind === 'report' || kind === 'results' || (kind === 'film' && forms.film === 'video');
  return (
    <div class="export-options">
      {options.length > 1 && <Segments label={words.form} options={options} value={forms[kind]} onChoose={(form) => set({ forms: { ...forms, [kind]: form } })} />}
      {kind === 'poses' && !isOfBoth(forms.poses) && (
        <Segments label={words.component} options={COMPONENT_NAMES.map((value) => ({ value, title: titleOf(value) }))} value={component} onChoose={(value) => set({ component: value })} />
      )}
      {kind === 'joint' && forms.joint === 'cycle' && (
        <label class="field">
          <span class="field-label">{words.column}</span>
          <select aria-label={words.column} value={column} onChange={(event) => set({ column: event.currentTarget.value })}>
            {joint.numbers.columns.filter((name) => !/^(sd|p)_/.test(name)).map((name) => (
              <option key={name}>{name}</option>
            ))}
          </select>
        </label>
      )}
      {isTimed && <RateField doc={state.history.present} />}
      {hint && <p class="sheet-text quiet">{hint}</p>}
    </div>
  );
}
