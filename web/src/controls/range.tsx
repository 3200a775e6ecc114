interface RangeProps {
  readonly label: string;
  /** Where the label is too long for the strip. */
  readonly shown?: string;
  readonly short?: boolean;
  readonly title?: string;
  readonly value: number;
  readonly text: string;
  readonly min: number;
  readonly max: number;
  readonly step: number;
  readonly onInput: (value: number) => void;
}

/** A slider between its name and its value in words. */
export function Range({ label, shown, short, title, value, text, min, max, step, onInput }: RangeProps) {
  return (
    <label class={short ? 'range short' : 'range'} title={title ?? label}>
      <span>{shown ?? label}</span>
      <input
        type="range"
        aria-label={label}
        aria-valuetext={text}
        min={min}
        max={max}
        step={step}
        value={value}
        onInput={(event) => onInput(event.currentTarget.valueAsNumber)}
      />
      <span class="range-value">{text}</span>
    </label>
  );
}
