import { useState } from 'preact/hooks';
import * as commands from '../document/commands';
import type { LibraryState, State } from '../document/store';
import { DEFAULT_WINDOW, type LibrarySpec, type ViewWindow } from '../document/types';
import type { ComponentName } from '../terms/component';
import { useApp } from '../commands/app';
import { AxesSection } from './axes_section';
import { NumberField } from '../controls/number_field';
import { Segments } from '../controls/segments';
import { UnitButtons } from '../pose/component_notes';
import { asSentence } from '../texts/sentences';
import { later } from '../texts/later';
import { texts } from '../texts/texts';

/** A component's model and library. */
export function ComponentSheet({ state, component }: { state: State; component: ComponentName }) {
  const { actions, librarian, services } = useApp();
  const { store } = services;
  const { model, libraryFile, librarySpec } = state.history.present.components[component];
  const library = state.ui.libraries[component];
  return (
    <div class="sheet-body">
      <p class="sheet-text">
        {model ? texts.library.model(model.name) : texts.library.noModel} {libraryText(library, libraryFile?.name ?? null)}
      </p>
      <div class="sheet-buttons">
        <button type="button" class="button" onClick={() => void actions.openPicked(component)}>
          {texts.library.open}
        </button>
        {libraryFile ? (
          <button type="button" class="button" disabled={!model} onClick={() => store.perform(commands.setLibraryFile(component, null))}>
            {texts.library.fromModel}
          </button>
        ) : (
          <button type="button" class="button" disabled={library.state !== 'stopped'} onClick={() => librarian.retry(component)}>
            {texts.library.build}
          </button>
        )}
      </div>
      <Remarks remarks={model ? services.studio.remarksOn(model.sha256) : []} />
      {model && <UnitButtons component={component} sha256={model.sha256} />}
      <AxesSection state={state} component={component} />
      <LibraryForm key={JSON.stringify(librarySpec)} component={component} spec={librarySpec} />
    </div>
  );
}

/** What was found and done when the model was opened. */
function Remarks({ remarks }: { remarks: readonly string[] }) {
  if (remarks.length === 0) return null;
  return (
    <ul class="model-remarks" aria-label={later.models.card}>
      {remarks.map((remark) => (
        <li key={remark}>{asSentence(remark)}</li>
      ))}
    </ul>
  );
}

function libraryText(library: LibraryState, file: string | null): string {
  switch (library.state) {
    case 'none':
      return texts.library.needs;
    case 'building':
      return texts.library.building;
    case 'stopped':
      return texts.library.stopped(library.reason);
    case 'ready': {
      const origin = file ?? (library.seconds === null ? '' : texts.library.builtIn(library.seconds.toFixed(1)));
      return texts.library.ready(library.views, (library.bytes / 1e6).toFixed(1), origin);
    }
  }
}

/** Which views: a change takes effect when it is asked for, as building takes a moment. */
function LibraryForm({ component, spec }: { component: ComponentName; spec: LibrarySpec }) {
  const { store } = useApp().services;
  const [views, setViews] = useState(spec.views);
  const [distance, setDistance] = useState(spec.distance);
  const [window, setWindow] = useState(spec.views === 'window' ? spec : DEFAULT_WINDOW);
  const draft: LibrarySpec = views === 'window' ? { ...window, distance } : { views, distance };
  const usable = Object.values(draft).every((value) => typeof value !== 'number' || Number.isFinite(value));
  const count = views === 'window' ? axisLength(window.xFrom, window.xTo, window.xStep) * axisLength(window.yFrom, window.yTo, window.yStep) : NaN;
  return (
    <form
      class="library-form"
      onSubmit={(event) => {
        event.preventDefault();
        store.perform(commands.setLibrarySpec(component, draft));
      }}
    >
      <h3>{texts.library.views}</h3>
      <Segments label={texts.library.views} options={KINDS} value={views} onChoose={setViews} />
      <p class="sheet-text quiet">{texts.library.kindSays[views]}</p>
      <div class="fields">
        {views === 'window' && <WindowFields window={window} onChange={setWindow} />}
        <NumberField
          label={texts.library.distance}
          unit="mm"
          value={distance ?? NaN}
          placeholder={texts.library.automatic}
          onChange={(value) => setDistance(Number.isNaN(value) ? null : value)}
        />
      </div>
      <div class="sheet-buttons">
        <button type="submit" class="button" disabled={!usable || JSON.stringify(draft) === JSON.stringify(spec)}>
          {texts.library.use}
        </button>
        <span class="sheet-text quiet">{count > 0 ? texts.library.count(count) : ''}</span>
      </div>
    </form>
  );
}

const KINDS = (['all directions', 'window'] as const).map((value) => ({ value, title: texts.library.kinds[value] }));

/** What only a window asks for. */
function WindowFields({ window, onChange }: { window: ViewWindow; onChange: (window: ViewWindow) => void }) {
  const set = (field: Exclude<keyof ViewWindow, 'views'>) => (value: number) => onChange({ ...window, [field]: value });
  return (
    <>
      <NumberField label={texts.library.nominal('x')} unit="°" value={window.nominalX} onChange={set('nominalX')} />
      <NumberField label={texts.library.nominal('y')} unit="°" value={window.nominalY} onChange={set('nominalY')} />
      <NumberField label={texts.library.from('x')} unit="°" value={window.xFrom} onChange={set('xFrom')} />
      <NumberField label={texts.library.from('y')} unit="°" value={window.yFrom} onChange={set('yFrom')} />
      <NumberField label={texts.library.to('x')} unit="°" value={window.xTo} onChange={set('xTo')} />
      <NumberField label={texts.library.to('y')} unit="°" value={window.yTo} onChange={set('yTo')} />
      <NumberField label={texts.library.step('x')} unit="°" value={window.xStep} onChange={set('xStep')} />
      <NumberField label={texts.library.step('y')} unit="°" value={window.yStep} onChange={set('yStep')} />
      <NumberField label={texts.library.area} unit="px" value={window.area} onChange={set('area')} />
    </>
  );
}

function axisLength(from: number, to: number, step: number): number {
  return step > 0 && to >= from ? Math.floor((to - from) / step + 1e-9) + 1 : NaN;
}
