import { useEffect, useRef } from 'preact/hooks';
import type { Steps } from '../document/seeing';
import type { PoseNumbers } from '../document/types';
import { texts } from '../texts';
import { isTurn } from '../geometry/pose_motion';
import { useApp } from './app';
import { Icon } from './icons';
import { formatNumber } from './numbers';
import { QUANTITIES, unitWord, type Quantity } from './quantities';
import { Segments } from './segments';

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
  readonly step: number;
  readonly text: string;
  readonly disabled: boolean;
  readonly onType: (value: number) => void;
}

/** Takes over when the person is done: with Enter, with the field's own arrows, or by leaving it. */
function Typed({ name, step, text, disabled, onType }: TypedProps) {
  const input = useRef<HTMLInputElement>(null);
  // What is being typed is left alone while the number changes under it.
  useEffect(() => {
    const field = input.current;
    if (field && Number(field.value) !== Number(text)) field.value = text;
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
      value={text}
      onKeyDown={(event) => {
        const sign = event.key === 'ArrowUp' ? 1 : event.key === 'ArrowDown' ? -1 : 0;
        if (sign === 0) return;
        event.preventDefault();
        onType(Number(text) + sign * step);
      }}
      onChange={(event) => {
        const { valueAsNumber } = event.currentTarget;
        if (Number.isNaN(valueAsNumber)) event.currentTarget.value = text;
        onType(valueAsNumber);
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
  const change = (part: Partial<Steps>) => store.setHand({ [grain]: { ...steps, ...part } });
  const field = (key: keyof Steps, what: string, unit: '°' | 'mm') => (
    <label class="step-field">
      <span>{what}</span>
      <input
        type="number"
        class="typed"
        step="any"
        min="0"
        aria-label={words.step(words[grain], what, unitWord(unit))}
        value={steps[key]}
        onChange={({ currentTarget }) => {
          const value = currentTarget.valueAsNumber;
          if (value > 0) change({ [key]: value });
          else currentTarget.value = String(steps[key]);
        }}
      />
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
