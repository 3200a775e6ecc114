import { useState } from 'preact/hooks';
import type { State } from '../document/store';
import { COMPONENT_NAMES, titleOf } from '../document/types';
import { useApp } from './app';

/** The whole work as one file, or the poses of one component. */
export function SessionSheet({ state }: { state: State }) {
  const { actions } = useApp();
  const [include, setInclude] = useState(true);
  const empty = state.history.present.frames.length === 0;
  return (
    <div class="sheet-body">
      <p class="sheet-text">
        A session holds frames, calibration, models, outlines, poses, window and level: everything, in one file. A table
        holds poses with their standard deviations and the reason of each choice.
      </p>
      <label class="check">
        <input type="checkbox" checked={include} onChange={(event) => setInclude(event.currentTarget.checked)} />
        Include images and models (otherwise named by their SHA-256)
      </label>
      <div class="sheet-buttons">
        <button type="button" class="button primary" disabled={empty} onClick={() => actions.saveSession(include)}>
          Save session file
        </button>
        {COMPONENT_NAMES.map((component) => (
          <button
            key={component}
            type="button"
            class="button"
            disabled={!actions.hasPoses(component)}
            onClick={() => actions.savePoses(component)}
          >
            {titleOf(component)} poses (.jts)
          </button>
        ))}
        {COMPONENT_NAMES.map((component) => (
          <button
            key={component}
            type="button"
            class="button"
            title="With standard deviations and the reason of the choice, a row a frame"
            disabled={!actions.hasPoses(component)}
            onClick={() => actions.saveTable(component)}
          >
            {titleOf(component)} table (.csv)
          </button>
        ))}
      </div>
    </div>
  );
}
