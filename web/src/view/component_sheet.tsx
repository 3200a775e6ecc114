import { useState } from 'preact/hooks';
import * as commands from '../document/commands';
import type { LibraryState, State } from '../document/store';
import type { ComponentName, LibrarySpec } from '../document/types';
import { useApp } from './app';
import { NumberField } from './number_field';

/** A component's model and library. */
export function ComponentSheet({ state, component }: { state: State; component: ComponentName }) {
  const { actions, librarian, services } = useApp();
  const { store } = services;
  const { model, libraryFile, librarySpec } = state.history.present.components[component];
  const library = state.ui.libraries[component];
  return (
    <div class="sheet-body">
      <p class="sheet-text">
        {model ? `Model ${model.name}.` : 'No model yet.'} {libraryText(library, libraryFile?.name ?? null)}
      </p>
      <div class="sheet-buttons">
        <button type="button" class="button" onClick={() => void actions.openPicked(component)}>
          Open a model, library or poses
        </button>
        {libraryFile ? (
          <button type="button" class="button" disabled={!model} onClick={() => store.perform(commands.setLibraryFile(component, null))}>
            Build from the model instead
          </button>
        ) : (
          <button type="button" class="button" disabled={library.state !== 'stopped'} onClick={() => librarian.retry(component)}>
            Build the library
          </button>
        )}
      </div>
      <LibraryForm key={JSON.stringify(librarySpec)} component={component} spec={librarySpec} />
    </div>
  );
}

function libraryText(library: LibraryState, file: string | null): string {
  switch (library.state) {
    case 'none':
      return 'A library needs the model, a calibration and a frame; it is built as soon as they are here.';
    case 'building':
      return 'Its library is being built.';
    case 'stopped':
      return `No library: ${library.reason}.`;
    case 'ready': {
      const origin = file ?? (library.seconds === null ? '' : `built in ${library.seconds.toFixed(1)} s`);
      return `Library: ${library.views} views, ${(library.bytes / 1e6).toFixed(1)} MB, ${origin}.`;
    }
  }
}

/** Which views: a change takes effect when it is asked for, as building takes a moment. */
function LibraryForm({ component, spec }: { component: ComponentName; spec: LibrarySpec }) {
  const { store } = useApp().services;
  const [draft, setDraft] = useState(spec);
  const set = (field: keyof LibrarySpec) => (value: number) => setDraft({ ...draft, [field]: value });
  const apply = () => store.perform(commands.setLibrarySpec(component, draft));
  const usable = Object.values(draft).every((value) => value === null || Number.isFinite(value));
  const views = axisLength(draft.xFrom, draft.xTo, draft.xStep) * axisLength(draft.yFrom, draft.yTo, draft.yStep);
  return (
    <form
      class="library-form"
      onSubmit={(event) => {
        event.preventDefault();
        apply();
      }}
    >
      <h3>Views of the library</h3>
      <div class="fields">
        <NumberField label="Nominal x" unit="°" value={draft.nominalX} onChange={set('nominalX')} />
        <NumberField label="Nominal y" unit="°" value={draft.nominalY} onChange={set('nominalY')} />
        <NumberField label="x from" unit="°" value={draft.xFrom} onChange={set('xFrom')} />
        <NumberField label="y from" unit="°" value={draft.yFrom} onChange={set('yFrom')} />
        <NumberField label="x to" unit="°" value={draft.xTo} onChange={set('xTo')} />
        <NumberField label="y to" unit="°" value={draft.yTo} onChange={set('yTo')} />
        <NumberField label="x step" unit="°" value={draft.xStep} onChange={set('xStep')} />
        <NumberField label="y step" unit="°" value={draft.yStep} onChange={set('yStep')} />
        <NumberField
          label="Distance"
          unit="mm"
          value={draft.distance ?? NaN}
          placeholder="auto"
          onChange={(value) => setDraft({ ...draft, distance: Number.isNaN(value) ? null : value })}
        />
        <NumberField label="Canonical area" unit="px" value={draft.area} onChange={set('area')} />
      </div>
      <div class="sheet-buttons">
        <button type="submit" class="button" disabled={!usable || draft === spec}>
          Use these views
        </button>
        <span class="sheet-text quiet">{Number.isFinite(views) && views > 0 ? `${views} views` : ''}</span>
      </div>
    </form>
  );
}

function axisLength(from: number, to: number, step: number): number {
  return step > 0 && to >= from ? Math.floor((to - from) / step + 1e-9) + 1 : NaN;
}
