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
  return (
    <label class="field">
      <span class="field-label">{label}</span>
      <input
        type="number"
        step="any"
        inputMode="decimal"
        aria-label={`${label} (${unit})`}
        placeholder={placeholder ?? ''}
        value={Number.isNaN(value) ? '' : value}
        onInput={(event) => onChange(event.currentTarget.valueAsNumber)}
      />
      <span class="unit">{unit}</span>
    </label>
  );
}
