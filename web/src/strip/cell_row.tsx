import { useMemo } from 'preact/hooks';
import { markOf } from '../document/marks';
import { progressOf, type Progress } from '../results/progress';
import type { State } from '../document/store';
import { type Cell, cellOf, chosenCandidate, verdictOf } from '../document/types';
import { type ComponentName, titleOf } from '../terms/component';
import { poseKeys } from '../results/keys';
import { texts } from '../texts/texts';
import type { Stretch } from '../controls/in_view';
import { useApp } from '../commands/app';

/** One component's cells, a column a frame; of those out of sight their room alone. */
export function CellRow({ state, component, columns: { first, last } }: { state: State; component: ComponentName; columns: Stretch }) {
  const doc = state.history.present;
  const { frameIndex, jobs } = state.ui;
  const keyOf = poseKeys(doc);
  return (
    <tr class={component}>
      <th scope="row">{titleOf(component)}</th>
      {spacers(first)}
      {doc.frames.slice(first, last).map((frame, at) => {
        const index = first + at;
        return (
          <CellButton
            key={frame.id}
            component={component}
            index={index}
            cell={cellOf(doc, frame.id, component)}
            mark={markOf(doc, { frameId: frame.id, component })}
            poseKey={keyOf(component, frame)}
            isBusy={jobs.some(({ place }) => place?.frameId === frame.id && place.component === component)}
            column={index === frameIndex}
            selected={index === frameIndex && component === state.ui.component}
            isStop={isStop(doc.frames.length, index === frameIndex && component === state.ui.component)}
          />
        );
      })}
      {spacers(doc.frames.length - last)}
    </tr>
  );
}

/** A cell of a table spans no more columns than this. */
const WIDEST = 1000;

/** Room for columns that are out of sight. */
function spacers(count: number) {
  return Array.from({ length: Math.ceil(count / WIDEST) }, (_, at) => (
    <td key={`room ${at}`} colSpan={Math.min(WIDEST, count - at * WIDEST)} aria-hidden="true" />
  ));
}

/** Of more cells than this the selected one alone is a stop of the Tab key: D, F and C lead to the others. */
const STOPS = 40;

function isStop(frames: number, selected: boolean): boolean {
  return selected || frames <= STOPS;
}

interface CellButtonProps {
  readonly component: ComponentName;
  /** From 0. */
  readonly index: number;
  readonly cell: Cell;
  readonly mark: ReturnType<typeof markOf>;
  readonly poseKey: string | null;
  /** Work for it is under way. */
  readonly isBusy: boolean;
  /** In the current frame. */
  readonly column: boolean;
  readonly selected: boolean;
  /** The Tab key stops at it. */
  readonly isStop: boolean;
}

/** Made again only when something of it changes: a film has hundreds. */
function CellButton({ component, index, cell, mark, poseKey, isBusy, column, selected, isStop }: CellButtonProps) {
  const { store } = useApp().services;
  return useMemo(() => {
    const progress = progressOf(cell, mark, poseKey);
    const name = texts.work.cell(index + 1, texts.component[component], nameOf(progress));
    const go = () => {
      store.goTo(index);
      store.selectComponent(component);
    };
    return (
      <td aria-colindex={index + 2}>
        <button
          type="button"
          tabIndex={isStop ? undefined : -1}
          class={classOf(progress, column, isBusy)}
          aria-busy={isBusy}
          aria-label={name}
          aria-current={selected ? 'true' : undefined}
          title={[name, ...detailsOf(progress, cell)].join('; ')}
          onClick={go}
        >
          <CellSigns progress={progress} />
        </button>
      </td>
    );
  }, [store, component, index, cell, mark, poseKey, isBusy, column, selected, isStop]);
}

/** Everything that is marked has a sign of its own: none is told by colour alone. */
export function CellSigns({ progress }: { progress: Progress }) {
  const { stage, check, doubtful, outdated, flagged, note } = progress;
  const sign = check === 'yes' ? '✓' : check === 'changed since' ? '≠' : stage === 'no pose' ? '✕' : stage === 'followed so far' ? '…' : doubtful ? '?' : outdated ? '!' : '';
  return (
    <>
      {sign && <span class={check === 'yes' ? 'cell-sign is-checked' : 'cell-sign'}>{sign}</span>}
      {flagged && <span class="cell-flag" />}
      {note !== '' && <span class="cell-note" />}
    </>
  );
}

/** The look of a stage: how full the cell is. */
export function lookOf({ stage }: Pick<Progress, 'stage'>): string {
  return `is-${stage.replaceAll(' ', '-')}`;
}

function classOf(progress: Progress, column: boolean, isBusy: boolean): string {
  return ['cell', lookOf(progress), column ? 'column' : '', isBusy ? 'busy' : ''].filter(Boolean).join(' ');
}

/** Whether a pose was refined is a detail; that there is one, and a doubtful one, is what a list is looked through for. */
function nameOf({ stage, check, doubtful, flagged }: Progress): string {
  const word = stage === 'refined' || stage === 'by hand' ? texts.work.stages.posed : texts.work.stages[stage];
  const checked = check === 'yes' ? texts.work.checked : check === 'changed since' ? texts.work.changedSince : null;
  return [word, doubtful && stage !== 'followed so far' ? texts.work.marks.doubtful : null, checked, flagged ? texts.work.flagged : null].filter((part) => part !== null).join(', ');
}

/** What the name leaves out, for the cell's description. */
export function detailsOf(progress: Progress, cell: Cell): readonly string[] {
  const { work } = texts;
  const residual = chosenCandidate(cell)?.residual ?? null;
  return [
    progress.stage === 'refined' || progress.stage === 'by hand' ? work.stages[progress.stage] : null,
    residual === null ? null : work.residual(residual.toFixed(2)),
    cell.result?.kind === 'failed' ? cell.result.sentence.replace(/\.$/, '') : null,
    progress.doubtful ? work.doubtful(verdictOf(cell.result)?.because ?? null) : null,
    progress.outdated ? work.outdated : null,
    progress.note === '' ? null : work.note(progress.note),
  ].filter((part) => part !== null);
}
