import { useState } from 'preact/hooks';
import type { State } from '../document/store';
import { COMPONENT_NAMES, titleOf } from '../terms/component';
import { useApp } from '../commands/app';
import { EarlierWork } from '../steps/open/earlier_work';
import { texts } from '../texts/texts';

/** The whole work as one file, or the poses of one component. */
export function SessionSheet({ state }: { state: State }) {
  const { actions } = useApp();
  const [include, setInclude] = useState(true);
  const empty = state.history.present.frames.length === 0;
  return (
    <div class="sheet-body">
      <p class="sheet-text">{texts.session.meaning}</p>
      <label class="check">
        <input type="checkbox" checked={include} onChange={(event) => setInclude(event.currentTarget.checked)} />
        {texts.session.include}
      </label>
      <div class="sheet-buttons">
        <button type="button" class="button primary" disabled={empty} onClick={() => void actions.saveSession(include)}>
          {texts.session.save}
        </button>
        {COMPONENT_NAMES.map((component) => (
          <button
            key={component}
            type="button"
            class="button"
            disabled={!actions.hasPoses(component)}
            onClick={() => actions.savePoses(component)}
          >
            {texts.session.poses(titleOf(component))}
          </button>
        ))}
        {COMPONENT_NAMES.map((component) => (
          <button
            key={component}
            type="button"
            class="button"
            title={texts.session.tableTitle}
            disabled={!actions.hasPoses(component)}
            onClick={() => actions.saveTable(component)}
          >
            {texts.session.table(titleOf(component))}
          </button>
        ))}
      </div>
      <OutlineButtons />
      <p class="sheet-text quiet">{texts.keep.meaning}</p>
      <EarlierWork state={state} />
    </div>
  );
}

/** Outlines for other programs. */
function OutlineButtons() {
  const { exchange } = useApp().actions;
  const none = !exchange.hasOutlines();
  const forms = [
    [texts.exchange.saveOutlines, () => exchange.saveOutlines()],
    [texts.exchange.saveCoco, () => exchange.saveCoco()],
    [texts.exchange.saveMasks, () => void exchange.saveMasks()],
  ] as const;
  return (
    <div class="sheet-buttons" role="group" aria-label={texts.exchange.region}>
      {forms.map(([name, save]) => (
        <button key={name} type="button" class="button" disabled={none} onClick={save}>
          {name}
        </button>
      ))}
    </div>
  );
}
