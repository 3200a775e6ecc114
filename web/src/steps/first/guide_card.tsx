import { currentCell, type State } from '../../document/store';
import { otherThan, type ComponentName } from '../../terms/component';
import { useApp } from '../../commands/app';
import { verdictOf } from '../../document/types';
import { type Guide, guideOf, standingOf } from '../../results/steps';
import { texts } from '../../texts/texts';

/** On the film while one click is the tool in hand: what to click next, and then the way on. It takes no click from the film. */
export function GuideCard({ state }: { state: State }) {
  const guide = guideOf(state);
  if (!guide) return null;
  return (
    <section class={guide.ask === 'click' ? `guide ${guide.component}` : 'guide'} aria-label={texts.first.card.region}>
      {guide.ask === 'click' ? <ClickCard guide={guide} state={state} /> : <FollowCard state={state} />}
    </section>
  );
}

function ClickCard({ guide: { component, isPreparing }, state }: { guide: Extract<Guide, { ask: 'click' }>; state: State }) {
  const { card } = texts.first;
  const name = texts.component[component];
  const isSecond = isBegun(state, component);
  const isDoubtful = verdictOf(currentCell(state).result)?.word === 'doubtful';
  return (
    <>
      <p class="guide-title">{isSecond ? card.now(name) : card.click(name)}</p>
      <p class="guide-text">{isPreparing ? card.preparing(name) : card.clickText}</p>
      {isDoubtful && <LookAtIt />}
      <TraceInstead words={currentCell(state).outline ? card.notRight : card.trace} />
    </>
  );
}

function FollowCard({ state }: { state: State }) {
  const { actions } = useApp();
  const { card } = texts.first;
  const { free, shaky } = standingOf(state.history.present);
  const [first] = shaky;
  return (
    <>
      <button type="button" class="button primary" title={texts.follow.title} onClick={() => actions.run({ name: 'work', command: 'follow-film' })}>
        {card.follow}
      </button>
      <p class="guide-text">{first ? card.shaky(texts.listed(shaky.map((name) => texts.component[name]))) : card.followText(free)}</p>
      {first && <LookAtIt />}
      <TraceInstead words={card.notRight} />
    </>
  );
}

/** Its rivals, side by side. */
function LookAtIt() {
  const { actions } = useApp();
  return (
    <button type="button" class="button small" onClick={() => actions.work.check()}>
      {texts.first.card.look}
    </button>
  );
}

function TraceInstead({ words }: { words: string }) {
  const { actions } = useApp();
  return (
    <button type="button" class="guide-other" title={texts.first.card.traceTitle} aria-keyshortcuts="p" onClick={() => actions.traceInstead()}>
      {words}
    </button>
  );
}

/** Has the other component been clicked, or its pose? */
function isBegun(state: State, component: ComponentName): boolean {
  const { present: doc } = state.history;
  const other = otherThan(component);
  const isClicked = state.ui.jobs.some(({ place, at }) => at && place?.component === other);
  return isClicked || (doc.components[other].model !== null && !standingOf(doc).unposed.includes(other));
}
