import { currentCell, currentFrame, type State, type Store } from '../document/store';
import { type Cell, cellOf, chosenCandidate } from '../document/types';
import { COMPONENT_NAMES, type ComponentName, titleOf } from '../terms/component';
import { isOutdated, missingForPose } from '../results/missing';
import { useApp } from '../commands/app';
import { later } from '../commands/later';
import { Display } from './display';
import { PoseNumbersCard } from '../pose/pose_card';
import { Candidates } from '../pose/candidates';
import { ComponentNotes } from '../pose/component_notes';
import { FilmNote } from '../pose/film_note';
import { texts } from '../texts/texts';

const CompareCard = later(async () => (await import('../pose/compare_card')).CompareCard);
const Pictures = later(async () => (await import('../pose/pictures')).Pictures);

/**
 * The right side: the selected component's pose, how far to trust it, and how the frame is shown. A card is there when it
 * has something to say and takes no room otherwise.
 */
export function Panel({ state }: { state: State }) {
  const { actions, services } = useApp();
  const { component } = state.ui;
  const cell = currentCell(state);
  const { reference } = state.history.present;
  const posed = chosenCandidate(cell) !== null;
  // Poses of a file or by hand have neither rivals nor a score.
  const found = cell.result?.kind === 'posed' && cell.result.from === 'outline' ? cell.result : null;
  return (
    <aside class={`panel ${component}`} aria-label={texts.panel.region}>
      <div class="switch" role="radiogroup" aria-label={texts.panel.component}>
        {COMPONENT_NAMES.map((name) => (
          <button
            key={name}
            type="button"
            role="radio"
            class={`switch-side ${name}`}
            aria-checked={component === name}
            title={texts.panel.switchTitle(titleOf(name))}
            onClick={() => services.store.selectComponent(name)}
          >
            <span class={`state-dot ${dotOf(state, name)}`} aria-hidden="true" />
            {titleOf(name)}
          </button>
        ))}
      </div>
      <PoseNumbersCard cell={cell} missing={missingForPose(state, component)} outdated={isOutdated(state)} />
      <FilmNote state={state} />
      <ComponentNotes state={state} />
      {reference && <CompareCard state={state} />}
      {found && <Candidates cell={cell} result={found} />}
      {isPictured(state, cell) && <Pictures state={state} />}
      <Display state={state} />
      {posed && !reference && <CompareCard state={state} />}
      <div class="panel-foot">
        {actions.hasPoses(component) && (
          <button type="button" class="button" title={texts.panel.savePosesTitle} aria-haspopup="dialog" onClick={() => openPoses(services.store, component)}>
            {texts.panel.savePoses(texts.component[component])}
          </button>
        )}
        {cell.outline && (
          <button type="button" class="button" title={texts.panel.deleteOutlineTitle} onClick={() => actions.deleteOutline()}>
            {texts.panel.deleteOutline}
          </button>
        )}
      </div>
    </aside>
  );
}

function openPoses(store: Store, component: ComponentName): void {
  store.show({ popover: 'export', exporting: { ...store.ui.exporting, kind: 'poses', component } });
}

/** Scores of a closed outline that may have a pose, or models with one. */
function isPictured(state: State, cell: Cell): boolean {
  const isScored = cell.outline?.closed === true && cell.result?.kind !== 'failed';
  return isScored || COMPONENT_NAMES.some((name) => chosenCandidate(cellHere(state, name)) !== null);
}

function dotOf(state: State, name: ComponentName): string {
  const { outline, result } = cellHere(state, name);
  if (result?.kind === 'failed') return 'failed';
  if (result) return 'posed';
  return outline ? 'traced' : 'none';
}

function cellHere(state: State, component: ComponentName): Cell {
  return cellOf(state.history.present, currentFrame(state)?.id, component);
}
