import { useEffect, useRef, useState } from 'preact/hooks';
import { chosenCandidate, type Cell, type PoseNumbers } from '../document/types';
import { decimalsFor, formatDeviation, formatNumber } from './numbers';
import { inWords } from '../engine/missing';
import { useApp } from './app';

interface Quantity {
  readonly field: keyof PoseNumbers;
  readonly name: string;
  readonly label: string;
  readonly unit: 'mm' | '°';
  readonly decimals: number;
}

/** Decimals while the uncertainty is not known: hundredths in the plane, tenths along the view. */
const TRANSLATIONS: readonly Quantity[] = [
  { field: 'x', name: 'x', label: 'x', unit: 'mm', decimals: 2 },
  { field: 'y', name: 'y', label: 'y', unit: 'mm', decimals: 2 },
  { field: 'z', name: 'z', label: 'z', unit: 'mm', decimals: 1 },
];

const ROTATIONS: readonly Quantity[] = [
  { field: 'zRot', name: 'z rotation', label: 'z rot', unit: '°', decimals: 2 },
  { field: 'xRot', name: 'x rotation', label: 'x rot', unit: '°', decimals: 2 },
  { field: 'yRot', name: 'y rotation', label: 'y rot', unit: '°', decimals: 2 },
];

interface PoseNumbersCardProps {
  readonly cell: Cell;
  /** What a new pose would need. */
  readonly missing: readonly string[];
  readonly outdated: boolean;
}

export function PoseNumbersCard({ cell, missing, outdated }: PoseNumbersCardProps) {
  const { pose = null, deviations = null, residual = null } = chosenCandidate(cell) ?? {};
  const { poser } = useApp();
  const refusal = poser.findings(cell.outline)?.refusal ?? null;
  const source = outdated
    ? `Found with another model, calibration or library. ${needs(cell, missing)}`
    : sourceOf(cell, refusal);
  return (
    <section class="card pose" aria-label="Pose numbers">
      <dl class="numbers">
        {[...TRANSLATIONS, ...ROTATIONS].map((quantity) => (
          <NumberRow
            key={quantity.field}
            quantity={quantity}
            value={pose && pose[quantity.field]}
            deviation={deviations && deviations[quantity.field]}
          />
        ))}
      </dl>
      <div class="pose-source">
        <p class="card-note">{pose ? source : needs(cell, missing)}</p>
        <ConvergenceButton disabled={residual === null} />
      </div>
    </section>
  );
}

/** Where the pose that is shown comes from. */
function sourceOf(cell: Cell, refusal: string | null): string {
  if (cell.result?.kind !== 'posed') return '';
  if (cell.result.from === 'file') return `From ${cell.result.origin}.`;
  const { residual = null, deviations = null } = chosenCandidate(cell) ?? {};
  if (residual !== null) return `refined, ${residual.toFixed(2)} px; ${deviations ? PLUS_MINUS : NOT_DETERMINED}`;
  return refusal === null ? 'library' : `library. Not refined: ${refusal}`;
}

const PLUS_MINUS = '± is one standard deviation';
const NOT_DETERMINED = 'the outline does not determine how sure';

function needs(cell: Cell, missing: readonly string[]): string {
  if (missing.length > 0) return `For a pose: ${inWords(missing)}.`;
  return cell.result?.kind === 'failed' ? 'No pose from this outline; the bottom line says why.' : 'Finding it ...';
}

interface NumberRowProps {
  readonly quantity: Quantity;
  readonly value: number | null;
  /** One standard deviation. */
  readonly deviation: number | null;
}

function NumberRow({ quantity, value, deviation }: NumberRowProps) {
  const { store } = useApp().services;
  const decimals = decimalsFor(deviation, quantity.decimals);
  const text = value === null ? '–' : formatNumber(value, decimals);
  const unit = quantity.unit === '°' ? 'degrees' : 'mm';
  const flashing = useFlash(text);
  const copy = () => {
    if (value === null) return;
    void navigator.clipboard.writeText(String(value)).then(
      () => store.say('info', `${quantity.name} copied: ${value}`),
      () => store.say('error', 'The browser did not let the page copy to the clipboard.'),
    );
  };
  return (
    <div class="number">
      <dt>{quantity.label}</dt>
      <dd>
        <button
          type="button"
          class={flashing ? 'value flash' : 'value'}
          aria-label={`${quantity.name} ${text} ${unit}`}
          title="Click to copy with all its decimals"
          disabled={value === null}
          onClick={copy}
        >
          {text}
        </button>
        <Deviation name={quantity.name} unit={unit} text={value === null || deviation === null ? null : formatDeviation(deviation, decimals)} />
        <span class="unit">{quantity.unit}</span>
      </dd>
    </div>
  );
}

/** Its place is kept while there is none: nothing jumps when it comes. */
function Deviation({ name, unit, text }: { name: string; unit: string; text: string | null }) {
  if (text === null) return <span class="deviation" />;
  return (
    <span class="deviation" role="group" aria-label={`${name} plus or minus ${text} ${unit}`} title="One standard deviation; the truth lies within two of them 95 times in 100">
      ±{text}
    </span>
  );
}

function ConvergenceButton({ disabled }: { disabled: boolean }) {
  const { store } = useApp().services;
  const open = store.ui.popover === 'convergence';
  return (
    <button
      type="button"
      class="button small"
      aria-haspopup="dialog"
      aria-expanded={open}
      title="How refinement came to this pose, step by step"
      disabled={disabled}
      onClick={() => store.show({ popover: open ? null : 'convergence' })}
    >
      Convergence
    </button>
  );
}

/** True for a moment after a change that was not part of a stream of changes. */
function useFlash(text: string): boolean {
  const [flashing, setFlashing] = useState(false);
  const last = useRef({ text, at: 0 });
  useEffect(() => {
    if (last.current.text === text) return undefined;
    const now = performance.now();
    const quiet = now - last.current.at > FLASH_PAUSE;
    last.current = { text, at: now };
    if (!quiet || text === '–') return undefined;
    setFlashing(true);
    // Not cleared when the text changes again: the flash ends all the same.
    setTimeout(() => setFlashing(false), FLASH_LENGTH);
    return undefined;
  }, [text]);
  return flashing;
}

const FLASH_PAUSE = 400;
const FLASH_LENGTH = 350;
