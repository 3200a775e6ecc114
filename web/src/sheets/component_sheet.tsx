import { useState } from 'preact/hooks';
import * as commands from '../document/commands';
import type { LibraryState, State } from '../document/store';
import type { LibrarySpec } from '../document/types';
import type { ComponentName } from '../terms/component';
import { useApp } from '../commands/app';
import { NumberField } from '../controls/number_field';
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
      <LibraryForm key={JSON.stringify(librarySpec)} component={component} spec={librarySpec} />
    </div>
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
      <h3>{texts.library.views}</h3>
      <div class="fields">
        <NumberField label={texts.library.nominal('x')} unit="°" value={draft.nominalX} onChange={set('nominalX')} />
        <NumberField label={texts.library.nominal('y')} unit="°" value={draft.nominalY} onChange={set('nominalY')} />
        <NumberField label={texts.library.from('x')} unit="°" value={draft.xFrom} onChange={set('xFrom')} />
        <NumberField label={texts.library.from('y')} unit="°" value={draft.yFrom} onChange={set('yFrom')} />
        <NumberField label={texts.library.to('x')} unit="°" value={draft.xTo} onChange={set('xTo')} />
        <NumberField label={texts.library.to('y')} unit="°" value={draft.yTo} onChange={set('yTo')} />
        <NumberField label={texts.library.step('x')} unit="°" value={draft.xStep} onChange={set('xStep')} />
        <NumberField label={texts.library.step('y')} unit="°" value={draft.yStep} onChange={set('yStep')} />
        <NumberField
          label={texts.library.distance}
          unit="mm"
          value={draft.distance ?? NaN}
          placeholder={texts.library.automatic}
          onChange={(value) => setDraft({ ...draft, distance: Number.isNaN(value) ? null : value })}
        />
        <NumberField label={texts.library.area} unit="px" value={draft.area} onChange={set('area')} />
      </div>
      <div class="sheet-buttons">
        <button type="submit" class="button" disabled={!usable || draft === spec}>
          {texts.library.use}
        </button>
        <span class="sheet-text quiet">{Number.isFinite(views) && views > 0 ? texts.library.count(views) : ''}</span>
      </div>
    </form>
  );
}

function axisLength(from: number, to: number, step: number): number {
  return step > 0 && to >= from ? Math.floor((to - from) / step + 1e-9) + 1 : NaN;
}
