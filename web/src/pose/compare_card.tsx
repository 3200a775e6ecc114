import { referencePose } from '../document/reference';
import { currentCell, currentPlace, type State } from '../document/store';
import { chosenCandidate } from '../document/types';
import { turnBetween } from '../geometry/pose_motion';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';

/** Another set of poses beside the one on view: kept from here, or read from a file. */
export function CompareCard({ state }: { state: State }) {
  const { hand } = useApp();
  const { reference } = state.history.present;
  const { comparing } = state.ui.seeing;
  const own = chosenCandidate(currentCell(state))?.pose ?? null;
  const other = referencePose(state.history.present, currentPlace(state));
  const words = texts.hand.compare;
  const turn = comparing && own && other ? ` · ${words.rotation(turnBetween(own, other).toFixed(2))}` : '';
  return (
    <section class="card compare" aria-label={words.region}>
      {reference && (
        <button type="button" class="button small" aria-pressed={comparing} aria-keyshortcuts="Q" title={words.showTitle} onClick={() => hand.toggleCompare()}>
          {words.show}
        </button>
      )}
      {reference && <span class="compare-with">{`${words.with(reference.name)}${other ? turn : ` · ${words.noneHere}`}`}</span>}
      <button type="button" class="button small" title={words.keepTitle} disabled={!own} onClick={() => hand.keepReference()}>
        {words.keep}
      </button>
      {reference && (
        <button type="button" class="button small" title={words.forgetTitle} onClick={() => hand.forgetReference()}>
          {words.forget}
        </button>
      )}
    </section>
  );
}
