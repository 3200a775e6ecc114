import { byArrows } from './radios';

interface SegmentsProps<T extends string> {
  readonly label: string;
  /** The label stands beside the buttons, not only in their name. */
  readonly shown?: boolean;
  readonly options: readonly { readonly value: T; readonly title: string; readonly key?: string; readonly hint?: string }[];
  readonly value: T;
  readonly onChoose: (value: T) => void;
}

/** One of a few: a row of buttons. */
export function Segments<T extends string>({ label, shown = false, options, value, onChoose }: SegmentsProps<T>) {
  // The group is one stop of the Tab key, whatever is chosen.
  const stop = options.some((option) => option.value === value) ? value : options[0]?.value;
  return (
    <div class="segments-row">
      {shown && <span class="segments-label">{label}</span>}
      <div class="segments" role="radiogroup" aria-label={label} onKeyDown={byArrows}>
        {options.map(({ value: option, title, key, hint }) => (
          <button
            key={option}
            type="button"
            role="radio"
            class="segment"
            aria-checked={option === value}
            tabIndex={option === stop ? 0 : -1}
            aria-keyshortcuts={key}
            title={hint ?? (key ? `${title} (${key})` : title)}
            onClick={() => onChoose(option)}
          >
            {title}
          </button>
        ))}
      </div>
    </div>
  );
}

interface SwitchProps {
  readonly label: string;
  readonly keyShown: string;
  readonly on: boolean;
  readonly disabled?: boolean;
  readonly onToggle: () => void;
}

/** On or off, with its key. */
export function Toggle({ label, keyShown, on, disabled, onToggle }: SwitchProps) {
  return (
    <div class="toggle-row">
      <button type="button" role="switch" class="toggle" aria-checked={on} aria-label={label} aria-keyshortcuts={keyShown} disabled={disabled ?? false} onClick={onToggle}>
        <span class="toggle-knob" aria-hidden="true" />
        <span class="toggle-label">{label}</span>
      </button>
      <kbd aria-hidden="true">{keyShown}</kbd>
    </div>
  );
}
