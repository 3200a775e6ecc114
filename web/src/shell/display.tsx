import * as commands from '../document/commands';
import { currentFrame, type State } from '../document/store';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { Icon } from '../controls/icons';

/** Opacity of the overlay, window and level of the frame. */
export function Display({ state }: { state: State }) {
  const { actions, seeing, services } = useApp();
  const { store, studio } = services;
  const frame = currentFrame(state);
  const facts = frame && studio.frameFacts(frame.id);
  const window = state.history.present.window ?? facts?.window ?? { centre: 128, width: 256 };
  const [least, greatest] = [facts?.least ?? 0, facts?.greatest ?? 255];
  const span = Math.max(1, greatest - least);
  // The window of the moment, not that of the last drawing: two sliders may move between two drawings.
  const change = (part: Partial<typeof window>) =>
    store.perform(commands.setWindow({ ...(store.doc.window ?? window), ...part }));
  return (
    <section class="card display" aria-label={texts.panel.display.region}>
      <Slider
        label={texts.panel.display.opacity}
        shown={texts.panel.display.opacityShown}
        text={texts.panel.display.percent(Math.round(state.ui.overlayOpacity * 100))}
        min={0}
        max={1}
        step={0.01}
        value={state.ui.overlayOpacity}
        onInput={(overlayOpacity) => store.show({ overlayOpacity })}
      />
      <Slider
        label={texts.panel.display.width}
        text={String(Math.round(window.width))}
        min={1}
        max={Math.max(2 * span, window.width)}
        step={1}
        value={window.width}
        disabled={!facts}
        onInput={(width) => change({ width })}
      />
      <Slider
        label={texts.panel.display.level}
        text={String(Math.round(window.centre))}
        min={Math.min(least - span / 2, window.centre)}
        max={Math.max(greatest + span / 2, window.centre)}
        step={1}
        value={window.centre}
        disabled={!facts}
        onInput={(centre) => change({ centre })}
      />
      <div class="display-buttons">
        <button
          type="button"
          class="button small"
          aria-haspopup="dialog"
          aria-expanded={state.ui.popover === 'view'}
          aria-keyshortcuts="9"
          title={texts.seeing.openTitle}
          onClick={() => seeing.run({ name: 'view-sheet' })}
        >
          <Icon name="eye" /> {texts.seeing.open}
        </button>
        <button type="button" class="button small" disabled={!state.history.present.window} title={texts.panel.display.resetTitle} onClick={() => actions.run({ name: 'reset-window' })}>
          {texts.panel.display.reset}
        </button>
      </div>
    </section>
  );
}

interface SliderProps {
  readonly label: string;
  /** A shorter label for the eye. */
  readonly shown?: string;
  readonly text: string;
  readonly min: number;
  readonly max: number;
  readonly step: number;
  readonly value: number;
  readonly disabled?: boolean;
  readonly onInput: (value: number) => void;
}

function Slider({ label, shown, text, min, max, step, value, disabled, onInput }: SliderProps) {
  return (
    <label class="slider">
      <span class="slider-label">{shown ?? label}</span>
      <input
        type="range"
        aria-label={label}
        aria-valuetext={text}
        min={min}
        max={max}
        step={step}
        value={value}
        disabled={disabled ?? false}
        onInput={(event) => onInput(event.currentTarget.valueAsNumber)}
      />
      <span class="slider-value">{text}</span>
    </label>
  );
}
