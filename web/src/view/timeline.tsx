import type { State } from '../document/store';
import { cellOf, COMPONENT_NAMES, titleOf, type Cell, type ComponentName, type FrameEntry } from '../document/types';
import { useApp } from './app';
import { Icon } from './icons';

/** The frames in time, and what is done in each for each component. */
export function Timeline({ state }: { state: State }) {
  const { actions, services } = useApp();
  const { frames } = state.history.present;
  const { frameIndex } = state.ui;
  const last = Math.max(0, frames.length - 1);
  const frame = frames[frameIndex];
  return (
    <section class="timeline" aria-label="Frames" style={{ '--count': Math.max(1, frames.length) }}>
      <div class="frame-steps">
        <button type="button" class="button square" aria-label="Previous frame" title="Previous frame (D)" disabled={frameIndex <= 0} onClick={() => actions.run({ name: 'previous-frame' })}>
          <Icon name="previous" />
        </button>
        <button type="button" class="button square" aria-label="Next frame" title="Next frame (F)" disabled={frameIndex >= last} onClick={() => actions.run({ name: 'next-frame' })}>
          <Icon name="next" />
        </button>
        <span class="frame-count">
          {frames.length === 0 ? '–' : frameIndex + 1} / {frames.length}
        </span>
      </div>
      <input
          type="range"
          class="frame-slider"
          aria-label="Frame"
          aria-valuetext={frame ? `${frameIndex + 1} of ${frames.length}, ${frame.name}` : 'no frames'}
          min={0}
          max={last}
          step={1}
          value={frameIndex}
          disabled={frames.length < 2}
          onInput={(event) => services.store.goTo(event.currentTarget.valueAsNumber)}
        />
      <span class="frame-name">{frame?.name ?? ''}</span>
      <table class="cells" aria-label="Frames and components">
        <tbody>
          {COMPONENT_NAMES.map((component) => (
            <CellRow key={component} state={state} component={component} />
          ))}
        </tbody>
      </table>
      <CellKey />
    </section>
  );
}

const CELL_KEY = [
  ['draft', 'draft'],
  ['posed', 'posed'],
  ['pose-loaded', 'loaded'],
  ['no-pose', 'no pose'],
] as const;

/** What a cell's look means; shapes, not colours alone. */
function CellKey() {
  return (
    <div class="cell-key" aria-hidden="true">
      {CELL_KEY.map(([look, word]) => (
        <span key={look}>
          <i class={`cell is-${look}`} />
          {word}
        </span>
      ))}
    </div>
  );
}

function CellRow({ state, component }: { state: State; component: ComponentName }) {
  const { frames } = state.history.present;
  return (
    <tr class={component}>
      <th scope="row">{titleOf(component)}</th>
      {frames.map((frame, index) => (
        <td key={frame.id}>
          <CellButton state={state} component={component} frame={frame} index={index} />
        </td>
      ))}
    </tr>
  );
}

interface CellButtonProps {
  readonly state: State;
  readonly component: ComponentName;
  readonly frame: FrameEntry;
  readonly index: number;
}

function CellButton({ state, component, frame, index }: CellButtonProps) {
  const { store } = useApp().services;
  const word = stateOf(cellOf(state.history.present, frame.id, component));
  const current = index === state.ui.frameIndex;
  const selected = current && component === state.ui.component;
  return (
    <button
      type="button"
      class={`cell is-${word.replace(' ', '-')}${current ? ' column' : ''}`}
      aria-label={`Frame ${index + 1}, ${component}: ${word}`}
      aria-current={selected ? 'true' : undefined}
      title={`Frame ${index + 1}, ${component}: ${word}`}
      onClick={() => {
        store.goTo(index);
        store.selectComponent(component);
      }}
    />
  );
}

function stateOf({ outline, result }: Cell): 'empty' | 'draft' | 'traced' | 'posed' | 'pose loaded' | 'no pose' {
  if (result?.kind === 'failed') return 'no pose';
  if (result?.kind === 'posed') return result.from === 'file' ? 'pose loaded' : 'posed';
  if (!outline) return 'empty';
  return outline.closed ? 'traced' : 'draft';
}
