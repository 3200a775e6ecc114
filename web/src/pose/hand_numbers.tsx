import { useLayoutEffect, useRef } from 'preact/hooks';
import type { Steps } from '../terms/seeing';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { texts } from '../texts/texts';
import { isTurn } from '../geometry/pose_motion';
import { useApp } from '../commands/app';
import { Icon } from '../controls/icons';
import { formatNumber } from '../texts/numbers';
import { QUANTITIES, unitWord, type Quantity } from './quantities';
import { Segments } from '../controls/segments';

/** The six numbers to be typed, each with its lock, and how far a key goes. */
export function HandNumbers({ pose }: { pose: PoseNumbers | null }) {
  return (
    <div class="hand-numbers">
      <div class="hand-grid">
        {QUANTITIES.map((quantity) => (
          <HandNumber key={quantity.field} quantity={quantity} value={pose && pose[quantity.field]} />
        ))}
      </div>
      <StepSettings />
    </div>
  );
}

function HandNumber({ quantity, value }: { quantity: Quantity; value: number | null }) {
  const { hand, services } = useApp();
  const { locks, grain, ...settings } = services.store.ui.hand;
  const { field, label, unit, decimals } = quantity;
  const name = texts.hand.names[field];
  const locked = locks[field];
  const steps = settings[grain];
  const step = isTurn(field) ? steps.turn : field === 'z' ? steps.depth : steps.plane;
  return (
    <div class={locked ? 'hand-number locked' : 'hand-number'}>
      <button
        type="button"
        class="lock"
        aria-label={texts.hand.lock(name)}
        aria-pressed={locked}
        title={texts.hand.lockTitle}
        onClick={() => hand.toggleLock(field)}
      >
        <Icon name={locked ? 'lock' : 'unlocked'} />
      </button>
      <span class="label" aria-hidden="true">
        {label}
      </span>
      <Typed
        name={texts.hand.number(name, unitWord(unit))}
        step={step}
        text={value === null ? '' : formatNumber(value, decimals).replace('\u2212', '-')}
        disabled={value === null || locked}
        onType={(typed) => hand.type(field, typed)}
      />
      <span class="unit">{unit}</span>
    </div>
  );
}

interface TypedProps {
  readonly name: string;
  /** By how much the field's own arrows change the number. */
  readonly step: number;
  readonly text: string;
  readonly disabled?: boolean;
  /** False where the number was not taken: the field goes back to the one before. */
  readonly onType: (value: number) => boolean;
}

/**
 * A number that is taken over when the person is done: with Enter, with the arrows, or by leaving the field. The field is
 * set when the number changes and not with every drawing of the page, which would take away what is being typed.
 */
function Typed({ name, step, text, disabled = false, onType }: TypedProps) {
  const input = useRef<HTMLInputElement>(null);
  useLayoutEffect(() => {
    if (input.current) input.current.value = text;
  }, [text]);
  return (
    <input
      ref={input}
      type="number"
      inputMode="decimal"
      class="typed"
      step="any"
      aria-label={name}
      disabled={disabled}
      onKeyDown={(event) => {
        const sign = event.key === 'ArrowUp' ? 1 : event.key === 'ArrowDown' ? -1 : 0;
        if (sign === 0) return;
        event.preventDefault();
        onType(Number(text) + sign * step);
      }}
      onChange={({ currentTarget }) => {
        if (!onType(currentTarget.valueAsNumber)) currentTarget.value = text;
      }}
    />
  );
}

/** Fine and coarse, and what each means. */
function StepSettings() {
  const { hand, services } = useApp();
  const { store } = services;
  const { grain } = store.ui.hand;
  const words = texts.hand;
  const steps = store.ui.hand[grain];
  const take = (key: keyof Steps) => (value: number) => {
    if (value > 0) store.setHand({ [grain]: { ...steps, [key]: value } });
    return value > 0;
  };
  const field = (key: keyof Steps, what: string, unit: Quantity['unit']) => (
    <label class="step-field">
      <span>{what}</span>
      <Typed name={words.step(words[grain], what, unitWord(unit))} step={steps[key] / 10} text={String(steps[key])} onType={take(key)} />
      <span class="unit">{unit}</span>
    </label>
  );
  return (
    <div class="steps" role="group" aria-label={words.steps}>
      <Segments
        label={words.steps}
        options={[
          { value: 'fine', title: words.fine, key: '-', hint: words.fineTitle },
          { value: 'coarse', title: words.coarse, key: '+', hint: words.coarseTitle },
        ]}
        value={grain}
        onChoose={(chosen) => hand.setGrain(chosen)}
      />
      {field('plane', words.plane, 'mm')}
      {field('depth', words.depth, 'mm')}
      {field('turn', words.turn, '°')}
    </div>
  );
}
