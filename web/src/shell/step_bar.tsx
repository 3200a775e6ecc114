import type { State } from '../document/store';
import { type Step, standingOf, STEPS } from '../results/steps';
import { texts } from '../texts/texts';

/** How far the work is, from opening files to the joint. */
export function StepBar({ state }: { state: State }) {
  const doc = state.history.present;
  const { step } = standingOf(doc);
  const shown: readonly Step[] = doc.frames.length > 1 ? STEPS : STEPS.filter((one) => one !== 'follow');
  return (
    <ol class="way" aria-label={texts.first.steps.region}>
      {shown.map((one) => (
        <li key={one} class="step" aria-current={one === step ? 'step' : undefined}>
          {texts.first.steps.names[one]}
        </li>
      ))}
    </ol>
  );
}
