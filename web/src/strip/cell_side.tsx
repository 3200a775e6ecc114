import { useEffect, useRef } from 'preact/hooks';
import { CutName } from '../controls/cut_name';
import { checkState, markOf, NO_MARK } from '../document/marks';
import { currentCell, currentFrame, currentPlace, type State } from '../document/store';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';

/** What a person says of the selected cell: checked, flagged, a note. */
export function CellSide({ state }: { state: State }) {
  const { actions } = useApp();
  const place = currentPlace(state);
  const frame = currentFrame(state);
  const mark = place ? markOf(state.history.present, place) : NO_MARK;
  const check = checkState(currentCell(state), mark);
  const { work } = texts;
  return (
    <div class={`cell-side ${state.ui.component}`}>
      <div class="cell-side-head">
        <span class="frame-name" title={frame?.name}>
          <CutName text={frame?.name ?? ''} />
        </span>
        <button
          type="button"
          class="button small"
          aria-haspopup="dialog"
          aria-expanded={state.ui.popover === 'work'}
          title={work.listTitle}
          disabled={!place}
          onClick={() => actions.work.run('work-list')}
        >
          {work.list}
        </button>
      </div>
      <div class="cell-side-marks">
        <button
          type="button"
          class="button small mark"
          aria-pressed={check === 'yes'}
          aria-keyshortcuts="y"
          title={check === 'changed since' ? work.changedTitle : work.checkTitle}
          disabled={!place}
          onClick={() => place && actions.work.toggleChecked(place)}
        >
          <span aria-hidden="true">{check === 'changed since' ? '≠' : '✓'}</span> {work.check}
        </button>
        <button
          type="button"
          class="button small mark"
          aria-pressed={mark.flagged}
          aria-keyshortcuts="Shift+Y"
          title={work.flagTitle}
          disabled={!place}
          onClick={() => place && actions.work.toggleFlagged(place)}
        >
          <span aria-hidden="true">⚑</span> {work.flag}
        </button>
      </div>
      <NoteField state={state} note={mark.note} />
    </div>
  );
}

function NoteField({ state, note }: { state: State; note: string }) {
  const { actions } = useApp();
  const place = currentPlace(state);
  const field = useRef<HTMLInputElement>(null);
  useEffect(() => {
    actions.work.noteField = field.current;
    return () => void (actions.work.noteField = null);
  }, [actions]);
  const label = texts.work.noteLabel(state.ui.frameIndex + 1, texts.component[state.ui.component]);
  const leave = (event: KeyboardEvent) => {
    if (event.key !== 'Enter' && event.key !== 'Escape') return;
    // Who leaves the note means no tool.
    event.stopPropagation();
    actions.stage?.focus();
  };
  return (
    <input
      ref={field}
      class="note-field"
      aria-label={label}
      title={texts.withKey(label, 'Shift+J')}
      placeholder={texts.work.notePlaceholder}
      value={note}
      disabled={!place}
      onInput={(event) => place && actions.work.setNote(place, event.currentTarget.value)}
      onKeyDown={leave}
    />
  );
}
