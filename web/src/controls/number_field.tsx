import { useLayoutEffect, useRef } from 'preact/hooks';

interface NumberFieldProps {
  readonly label: string;
  readonly unit: string;
  /** NaN shows an empty field. */
  readonly value: number;
  readonly placeholder?: string;
  readonly onChange: (value: number) => void;
}

/** A number with its unit. An empty field is NaN: whoever uses the number says what is wrong with it. */
export function NumberField({ label, unit, value, placeholder, onChange }: NumberFieldProps) {
  const input = useRef<HTMLInputElement>(null);
  const show = () => {
    if (input.current && !Object.is(input.current.valueAsNumber, value)) input.current.value = Number.isNaN(value) ? '' : String(value);
  };
  useLayoutEffect(() => {
    // What is being typed, as "0.", is a number already, or none yet: written back it would lose its end.
    if (document.activeElement !== input.current) show();
  }, [value]);
  return (
    <label class="field">
      <span class="field-label">{label}</span>
      <input
        ref={input}
        type="number"
        step="any"
        inputMode="decimal"
        aria-label={`${label} (${unit})`}
        placeholder={placeholder ?? ''}
        onBlur={show}
        onInput={(event) => onChange(event.currentTarget.valueAsNumber)}
      />
      <span class="unit">{unit}</span>
    </label>
  );
}
