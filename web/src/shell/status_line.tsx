import { useEffect, useState } from 'preact/hooks';
import { currentCell, currentFrame, type Job, type State } from '../document/store';
import { chosenCandidate } from '../document/types';
import type { Motion } from '../interaction/adjust';
import { isInCheck } from '../commands/check_keys';
import { handHint } from '../commands/hand_bindings';
import { hint } from '../interaction/hints';
import { guideOf } from '../results/steps';
import { useApp } from '../commands/app';
import { usePointer } from '../commands/pointer';
import { texts } from '../texts/texts';

/** One line: what the next click does, or what just went wrong and what to do. */
export function StatusLine({ state }: { state: State }) {
  const { store } = useApp().services;
  const pointer = usePointer();
  const { text, kind } = message(state, pointer?.hit ?? { kind: 'nothing' }, pointer?.motion ?? null);
  useInfoExpires(state);
  return (
    <footer class="status" aria-label={texts.status.region}>
      <p class={`status-text ${kind}`} role="status" aria-live="polite" title={text}>
        {text}
      </p>
      <OfferButton state={state} />
      {state.ui.jobs.map((job) => (
        <JobBar key={job.id} job={job} />
      ))}
      <PointerReadout state={state} />
      <button
        type="button"
        class="button small"
        aria-haspopup="dialog"
        aria-expanded={state.ui.popover === 'log'}
        onClick={() => store.show({ popover: state.ui.popover === 'log' ? null : 'log' })}
      >
        {texts.status.log}
      </button>
    </footer>
  );
}

function message(state: State, hit: Parameters<typeof hint>[3], motion: Motion | null): { text: string; kind: 'hint' | 'info' | 'error' } {
  const { notice, tool, component } = state.ui;
  if (notice) return notice;
  const { outline, result } = currentCell(state);
  if (result?.kind === 'failed' && outline?.closed) return { text: result.sentence, kind: 'error' };
  if (!currentFrame(state)) return { text: texts.status.begin, kind: 'hint' };
  if (isInCheck(state)) return { text: result?.kind === 'failed' ? texts.check.lackingHint : texts.check.hint(Math.min(result?.candidates.length ?? 0, 3)), kind: 'hint' };
  if (tool === 'pose') return { text: handHint(component, chosenCandidate(currentCell(state)) !== null, motion), kind: 'hint' };
  // The card on the film may ask for the other one.
  const guide = guideOf(state);
  const asked = guide?.ask === 'click' ? guide.component : component;
  const situation = { erase: state.ui.tracing.erase, adjusting: state.ui.thresholdLevel !== null, posed: asked === component && result?.kind === 'posed' };
  return { text: hint(tool, asked, outline, hit, situation), kind: 'hint' };
}

/** News passes; errors stay until something is done. */
function useInfoExpires(state: State): void {
  const { store } = useApp().services;
  const { notice } = state.ui;
  useEffect(() => {
    // What offers something waits for an answer, and who let a film be followed may look elsewhere meanwhile.
    if (notice?.kind !== 'info' || notice.offer || notice.of === 'film') return undefined;
    const timer = setTimeout(() => store.ui.notice === notice && store.quiet(), INFO_LENGTH);
    return () => clearTimeout(timer);
  }, [notice, store]);
}

const INFO_LENGTH = 6000;

/** What can be done about the news. */
function OfferButton({ state }: { state: State }) {
  const { store } = useApp().services;
  const offer = state.ui.notice?.offer;
  if (!offer) return null;
  const take = () => {
    store.quiet();
    offer.take();
  };
  return (
    <button type="button" class="button small" onClick={take}>
      {offer.label}
    </button>
  );
}

/** A clock that stands still while a job has nothing to report looks like a page that hangs. */
function useTicking(): void {
  const [, setTick] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => setTick((tick) => tick + 1), TICK);
    return () => clearInterval(timer);
  }, []);
}

const TICK = 1000;

function JobBar({ job }: { job: Job }) {
  useTicking();
  const seconds = ((performance.now() - job.startedAt) / 1000).toFixed(1);
  const text = texts.status.job(job.title, countOf(job), seconds);
  return (
    <div class="job">
      <span class="job-text" title={text}>
        {text}
      </span>
      <progress aria-label={job.title} value={job.total > 0 ? job.done : undefined} max={job.total > 0 ? job.total : 1} />
      <button type="button" class="button small" aria-label={texts.status.cancelJob(job.title)} onClick={job.cancel}>
        {texts.cancel}
      </button>
    </div>
  );
}

/** How much there is to do may not be known; of what is one step, only its time is. */
function countOf({ done, total, unit }: Job): string {
  if (total > 0) return texts.status.count(done, total, unit);
  if (unit === '') return '';
  return done > 0 ? texts.status.countOnly(done, unit) : texts.status.preparing;
}

function PointerReadout({ state }: { state: State }) {
  const { studio } = useApp().services;
  const pointer = usePointer();
  const frame = currentFrame(state);
  if (!frame || !pointer) return <span class="readout" />;
  const { column, row } = pointer.at;
  const grey = studio.greyAt(frame.id, column, row);
  return (
    <span class="readout">{texts.status.pointer(column.toFixed(1), row.toFixed(1), grey)}</span>
  );
}
