import type { State } from '../document/store';
import { type Step, standingOf, STEPS } from '../results/steps';
import { texts } from '../texts/texts';

/** How far the work is, from opening files to the joint. */
export function StepBar({ state }: { state: State }) {
  const doc = state.history.present;
  // What is corrected while checking frees frames for following, which is no step back.
  const step = state.ui.checking ? 'check' : standingOf(doc).step;
  const shown: readonly Step[] = doc.frames.length > 1 ? STEPS : STEPS.filter((one) => one !== 'follow');
  const { region, names, count } = texts.first.steps;
  return (
    <>
      <ol class="way" aria-label={region}>
        {shown.map((one) => (
          <li key={one} class="step" aria-current={one === step ? 'step' : undefined}>
            {names[one]}
          </li>
        ))}
      </ol>
      <span class="way-count" aria-hidden="true" title={shown.map((one) => names[one]).join(' › ')}>
        {count(1 + shown.indexOf(step), shown.length)}
        <span class="way-name">: {names[step]}</span>
      </span>
    </>
  );
}
