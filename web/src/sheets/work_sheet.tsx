import { useState } from 'preact/hooks';
import { entriesOf, FILTERS, passes, type Entry, type Filter, type Stage } from '../results/progress';
import type { State } from '../document/store';
import { cellOf } from '../document/types';
import { poseKeys } from '../results/keys';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { byArrows } from '../controls/radios';
import { CellSigns, detailsOf, lookOf } from '../strip/cell_row';

/** Every frame and component with what is done and what somebody said of it, filtered. */
export function WorkSheet({ state }: { state: State }) {
  const [filter, setFilter] = useState<Filter>('all');
  const doc = state.history.present;
  const entries = entriesOf(doc, poseKeys(doc));
  const shown = entries.filter((entry) => passes(entry, filter));
  const { work } = texts;
  return (
    <div class="sheet-body">
      <div class="filters" role="radiogroup" aria-label={work.filterGroup} onKeyDown={byArrows}>
        {FILTERS.map((name) => (
          <button key={name} type="button" role="radio" class="button small" aria-checked={filter === name} tabIndex={filter === name ? 0 : -1} onClick={() => setFilter(name)}>
            {work.filter(work.filters[name], entries.filter((entry) => passes(entry, name)).length)}
          </button>
        ))}
      </div>
      {shown.length === 0 ? <p class="sheet-text quiet">{work.nothing[filter]}</p> : <EntryTable key={filter} state={state} entries={shown} />}
      <Legend />
    </div>
  );
}

function EntryTable({ state, entries }: { state: State; entries: readonly Entry[] }) {
  const { columns } = texts.work;
  const [count, setCount] = useState(AT_ONCE);
  const onScroll = ({ currentTarget: { scrollTop, scrollHeight, clientHeight } }: { currentTarget: HTMLElement }) => {
    if (count < entries.length && scrollTop + 2 * clientHeight > scrollHeight) setCount(count + AT_ONCE);
  };
  return (
    <div class="work-scroll" onScroll={onScroll}>
      <table class="work-table" aria-label={texts.work.list} aria-rowcount={entries.length + 1}>
        <thead>
          <tr>
            {Object.values(columns).map((column) => (
              <th key={column} scope="col">
                {column}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {entries.slice(0, count).map((entry) => (
            <EntryRow key={`${entry.frame.id}/${entry.place.component}`} state={state} entry={entry} />
          ))}
        </tbody>
      </table>
    </div>
  );
}

/** A long film has thousands of rows: more come as somebody scrolls. */
const AT_ONCE = 160;

function EntryRow({ state, entry }: { state: State; entry: Entry }) {
  const { actions } = useApp();
  const { place, index, progress, frame } = entry;
  const { work } = texts;
  const component = texts.component[place.component];
  const current = index === state.ui.frameIndex && place.component === state.ui.component;
  const words = [work.stages[progress.stage], ...detailsOf({ ...progress, stage: 'posed', note: '' }, cellOf(state.history.present, frame.id, place.component))];
  if (progress.check === 'changed since') words.push(work.changedSince);
  return (
    <tr class={place.component} aria-current={current ? 'true' : undefined}>
      <th scope="row">
        <button type="button" class="button small place" aria-label={work.goTo(index + 1, component)} title={frame.name} onClick={() => actions.work.goTo(place)}>
          {work.place(index + 1, component)}
        </button>
      </th>
      <td>
        <span class="work-state">
          <i class={`cell ${lookOf(progress)}`} aria-hidden="true">
            <CellSigns progress={progress} />
          </i>
          {words.join('; ')}
        </span>
      </td>
      <td>
        <input type="checkbox" aria-label={work.checkRow(index + 1, component)} checked={progress.check === 'yes'} onChange={() => actions.work.toggleChecked(place)} />
      </td>
      <td>
        <input type="checkbox" aria-label={work.flagRow(index + 1, component)} checked={progress.flagged} onChange={() => actions.work.toggleFlagged(place)} />
      </td>
      <td>
        <input
          class="note-field"
          aria-label={work.noteLabel(index + 1, component)}
          value={progress.note}
          onInput={(event) => actions.work.setNote(place, event.currentTarget.value)}
        />
      </td>
    </tr>
  );
}

/** All of them: one that is forgotten here is no type. */
const IN_LEGEND: Readonly<Record<Exclude<Stage, 'empty'>, true>> = {
  draft: true,
  traced: true,
  posed: true,
  refined: true,
  'by hand': true,
  followed: true,
  'followed so far': true,
  'pose loaded': true,
  'no pose': true,
};
const STAGES = Object.keys(IN_LEGEND) as readonly Stage[];
const PLAIN = { stage: 'refined', outdated: false, doubtful: false, posed: true, check: 'no', flagged: false, note: '' } as const;

/** What the marks in the cells mean. */
function Legend() {
  const { marks, stages, legend } = texts.work;
  const signs = [
    [marks.checked, { ...PLAIN, check: 'yes' }],
    [marks.changed, { ...PLAIN, check: 'changed since' }],
    [marks.doubtful, { ...PLAIN, doubtful: true }],
    [marks.outdated, { ...PLAIN, outdated: true }],
    [marks.flagged, { ...PLAIN, flagged: true }],
    [marks.noted, { ...PLAIN, note: marks.noted }],
  ] as const;
  return (
    <section class="cell-key femur" aria-label={legend}>
      {STAGES.map((stage) => (
        <span key={stage}>
          <i class={`cell ${lookOf({ stage })}`} aria-hidden="true">
            <CellSigns progress={{ ...PLAIN, stage }} />
          </i>
          {stages[stage]}
        </span>
      ))}
      {signs.map(([word, progress]) => (
        <span key={word}>
          <i class={`cell ${lookOf(progress)}`} aria-hidden="true">
            <CellSigns progress={progress} />
          </i>
          {word}
        </span>
      ))}
    </section>
  );
}
