import { useEffect } from 'preact/hooks';
import { importProposal } from '../../document/importing';
import { assignments, componentNamed, isOfMask, unevenSubjects, type Assignment, type FrameMatching, type Proposal } from '../../document/proposal';
import type { State, Store } from '../../document/store';
import { COMPONENT_NAMES, type ComponentName, titleOf } from '../../terms/component';
import { later } from '../../texts/later';
import { texts } from '../../texts/texts';
import { useApp } from '../../commands/app';

const MATCHES: readonly FrameMatching[] = ['name', 'order'];

/** Changes a part of the proposal as it is at that moment. */
type Change = (of: (now: Proposal) => Partial<Proposal>) => void;

/** Where outlines from files would go, before they do. */
export function ImportSheet({ state }: { state: State }) {
  const { store } = useApp().services;
  const { proposal } = state.ui;
  const { exchange } = later;
  useEffect(() => () => tellWaiting(store), []);
  if (!proposal) return <p class="sheet-body sheet-text">{exchange.nothing}</p>;
  const rows = assignments(state.history.present, proposal);
  const going = rows.filter(({ destination }) => destination.kind === 'to').length;
  const change: Change = (of) => {
    // Not what was drawn last: two changes may come between two drawings.
    const now = store.ui.proposal;
    if (now) store.show({ proposal: { ...now, ...of(now) } });
  };
  return (
    <form
      class="sheet-body"
      onSubmit={(event) => {
        event.preventDefault();
        apply(store, proposal, going);
      }}
    >
      <Subjects proposal={proposal} change={change} />
      <Options proposal={proposal} change={change} />
      {unevenSubjects(state.history.present, proposal).map(({ subject, images }) => (
        <p key={subject} class="sheet-text">
          {exchange.uneven(subject, images, state.history.present.frames.length)}
        </p>
      ))}
      <Assignments rows={rows} proposal={proposal} />
      {proposal.remarks.length > 0 && (
        <ul class="remarks" aria-label={exchange.remarks}>
          {proposal.remarks.map((remark) => (
            <li key={remark}>{remark}</li>
          ))}
        </ul>
      )}
      <div class="sheet-buttons">
        <button type="submit" class="button primary" disabled={going === 0}>
          {exchange.apply(going)}
        </button>
        <button type="button" class="button" onClick={() => close(store)}>
          {texts.cancel}
        </button>
        {proposal.asFrames && (
          <button
            type="button"
            class="button"
            onClick={() => {
              close(store);
              proposal.asFrames?.();
            }}
          >
            {exchange.asFrames}
          </button>
        )}
        <span class="sheet-text quiet">{exchange.leftOut(rows.length - going)}</span>
      </div>
    </form>
  );
}

/** A sheet that was left without an answer is not gone. */
function tellWaiting(store: Store): void {
  const { exchange } = later;
  if (store.ui.proposal) store.say('info', exchange.waiting, { label: exchange.goOn, take: () => store.show({ popover: 'import' }) });
}

function close(store: Store): void {
  store.show({ proposal: null, popover: null });
}

function apply(store: Store, proposal: Proposal, going: number): void {
  store.perform(importProposal(store.doc, proposal));
  close(store);
  store.say('info', later.exchange.applied(going));
}

/** How outlines are put to frames, and whether they are taken point for point. */
function Options({ proposal, change }: { proposal: Proposal; change: Change }) {
  const { exchange } = later;
  return (
    <div class="import-options">
      <fieldset class="choices">
        <legend>{exchange.matching}</legend>
        {MATCHES.map((match) => (
          <label key={match} class="check">
            <input type="radio" name="match" checked={proposal.match === match} onChange={() => change(() => ({ match }))} />
            {exchange.match[match]}
          </label>
        ))}
      </fieldset>
      {proposal.items.some(isOfMask) && (
        <>
          <label class="check">
            <input type="checkbox" checked={proposal.exact} onChange={({ currentTarget: { checked } }) => change(() => ({ exact: checked }))} />
            {exchange.exact}
          </label>
          <label class="check" title={exchange.onFramesTitle}>
            <input type="checkbox" checked={proposal.onFrames} onChange={({ currentTarget: { checked } }) => change(() => ({ onFrames: checked }))} />
            {exchange.onFrames}
          </label>
        </>
      )}
    </div>
  );
}

/** Which component each name in the files means. */
function Subjects({ proposal, change }: { proposal: Proposal; change: Change }) {
  const { exchange } = later;
  const set = (subject: string, value: string) => {
    const component = (value || null) as ComponentName | null;
    change(({ subjects }) => ({ subjects: { ...subjects, [subject]: component } }));
  };
  return (
    <div class="subjects" role="group" aria-label={exchange.subjects}>
      {severalSets(proposal).map((sentence) => (
        <p key={sentence} class="sheet-text">
          {sentence}
        </p>
      ))}
      {Object.entries(proposal.subjects).map(([subject, component]) => (
        <label key={subject} class="subject">
          <span>{exchange.subject(subject)}</span>
          <select aria-label={exchange.subjectIs(subject)} value={component ?? ''} onChange={(event) => set(subject, event.currentTarget.value)}>
            <option value="">{exchange.leaveOut}</option>
            {COMPONENT_NAMES.map((name) => (
              <option key={name} value={name}>
                {titleOf(name)}
              </option>
            ))}
          </select>
        </label>
      ))}
    </div>
  );
}

/** Of several sources of one component's outlines one is used, and a person says which. */
function severalSets({ subjects }: Proposal): readonly string[] {
  return COMPONENT_NAMES.flatMap((component) => {
    const names = Object.keys(subjects).filter((subject) => componentNamed(subject) === component);
    return names.length > 1 ? [later.exchange.severalSets(texts.component[component], texts.listed(names))] : [];
  });
}

function Assignments({ rows, proposal }: { rows: readonly Assignment[]; proposal: Proposal }) {
  const { exchange } = later;
  return (
    <div class="work-scroll">
      <table class="work-table" aria-label={exchange.table}>
        <thead>
          <tr>
            <th scope="col">{exchange.columns.from}</th>
            <th scope="col">{exchange.columns.to}</th>
            <th scope="col">{exchange.columns.notes}</th>
          </tr>
        </thead>
        <tbody>
          {rows.map(({ item, destination }, index) => (
            <tr key={index} class={destination.kind === 'to' ? destination.component : 'nowhere'}>
              <th scope="row">{item.label}</th>
              <td>
                {destination.kind === 'to'
                  ? exchange.to(destination.number, destination.frame.name, texts.component[destination.component])
                  : exchange.nowhere(destination.reason)}
              </td>
              <td>
                {[
                  ...(proposal.exact ? item.notes.filter((note) => !note.startsWith(exchange.simplifiedTo)) : item.notes),
                  ...(destination.kind === 'to' && destination.replaces ? [exchange.replaces] : []),
                ].join('; ')}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
