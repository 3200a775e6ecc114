import type { ComponentChildren } from 'preact';
import { currentCell, type State } from '../document/store';
import type { TracingTools } from '../tracing/tracing_tools';
import { RADIUS } from '../terms/tracing';
import type { TracingCommand } from '../commands/tracing_keys';
import { TOOLS } from '../interaction/tools';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { Range } from '../controls/range';
import { Icon, type IconName } from '../controls/icons';

/** Above the frame, always there: what the tool in hand can be set to, and what can be done with the whole outline. */
export function ToolStrip({ state }: { state: State }) {
  const { tool } = state.ui;
  return (
    <div class="tool-strip" role="region" aria-label={texts.tracing.strip.region}>
      <span class="tool-strip-tool">{TOOLS.find(({ name }) => name === tool)?.title}</span>
      <div class="tool-strip-options">
        <ToolOptions state={state} />
      </div>
      <OutlineCommands state={state} />
    </div>
  );
}

function ToolOptions({ state }: { state: State }) {
  switch (state.ui.tool) {
    case 'wire':
      return <WireOptions state={state} />;
    case 'threshold':
      return <ThresholdOptions state={state} />;
    case 'one-click':
      return <Polarity state={state} />;
    case 'brush':
      return <BrushOptions state={state} />;
    case 'stretch':
      return <StretchOptions state={state} />;
    default:
      return null;
  }
}

function WireOptions({ state }: { state: State }) {
  const { store } = useApp().services;
  const { strip } = texts.tracing;
  const draft = currentCell(state).outline?.closed === false;
  return (
    <>
      <Check label={strip.cooling} title={strip.coolingTitle} checked={state.ui.tracing.cooling} onChange={(cooling) => store.setTracing({ cooling })} />
      <Command command={{ what: 'take-back' }} label={strip.takeBack} title={strip.takeBackTitle} disabled={!draft} />
      <Command command={{ what: 'accept' }} label={strip.closeOutline} title="Enter" disabled={!draft} />
      <Polarity state={state} />
    </>
  );
}

function ThresholdOptions({ state }: { state: State }) {
  const { tracingTools, services } = useApp();
  const { store } = services;
  const { strip } = texts.tracing;
  const { thresholdLevel, tracing: options } = state.ui;
  const ends = thresholdLevel ?? endsOf(tracingTools);
  const level = thresholdLevel?.level ?? options.level ?? (ends.least + ends.greatest) / 2;
  const automatic = options.level === null;
  return (
    <>
      <Range
        label={strip.level}
        shown={strip.levelShort}
        value={level}
        text={automatic && !thresholdLevel ? '–' : String(Math.round(level))}
        min={ends.least}
        max={ends.greatest}
        step={(ends.greatest - ends.least) / 500}
        onInput={(value) => tracingTools.setLevel(value)}
      />
      <Check label={strip.automatic} shown={strip.automaticShort} title={strip.automaticTitle} checked={automatic} onChange={(on) => store.setTracing({ level: on ? null : level })} />
      <Range
        label={strip.bridge}
        shown={strip.bridgeShort}
        short
        title={strip.bridgeTitle}
        value={options.bridge}
        text={strip.pixels(2 * options.bridge)}
        min={0}
        max={8}
        step={1}
        onInput={(bridge) => {
          store.setTracing({ bridge });
          tracingTools.takeAgain();
        }}
      />
      <Polarity state={state} />
    </>
  );
}

function endsOf(tools: TracingTools): { readonly least: number; readonly greatest: number } {
  return tools.levelEnds ?? { least: 0, greatest: 255 };
}

function BrushOptions({ state }: { state: State }) {
  const { store } = useApp().services;
  const { strip } = texts.tracing;
  const { radius, erase } = state.ui.tracing;
  return (
    <>
      <div class="tool-strip-segments" role="radiogroup" aria-label={strip.mode}>
        {([false, true] as const).map((mode) => (
          <button key={String(mode)} type="button" role="radio" class="tool-strip-segment" aria-checked={erase === mode} title="E" onClick={() => store.setTracing({ erase: mode })}>
            {mode ? strip.erase : strip.add}
          </button>
        ))}
      </div>
      <Range
        label={strip.radius}
        shown={strip.radiusShort}
        value={radius}
        text={strip.pixels(radius)}
        min={RADIUS.least}
        max={RADIUS.most}
        step={1}
        onInput={(value) => store.setTracing({ radius: value })}
      />
    </>
  );
}

function StretchOptions({ state }: { state: State }) {
  const { outline } = currentCell(state);
  return <Command command={{ what: 'all-known' }} label={texts.tracing.strip.allKnown} disabled={!outline || outline.unknownSides.length === 0} />;
}

function Polarity({ state }: { state: State }) {
  const { store } = useApp().services;
  const { strip } = texts.tracing;
  const { bright } = state.ui.tracing;
  return (
    <div class="tool-strip-segments" role="radiogroup" aria-label={strip.polarity} title={strip.polarityTitle}>
      <span class="tool-strip-segments-label" aria-hidden="true">
        {strip.polarity}
      </span>
      {([null, false, true] as const).map((value) => (
        <button key={String(value)} type="button" role="radio" class="tool-strip-segment" aria-checked={bright === value} onClick={() => store.setTracing({ bright: value })}>
          {value === null ? strip.told : value ? strip.bright : strip.dark}
        </button>
      ))}
    </div>
  );
}

/** What is done with the outline as a whole, whatever the tool. */
function OutlineCommands({ state }: { state: State }) {
  const { strip } = texts.tracing;
  const closed = currentCell(state).outline?.closed === true;
  const first = state.ui.frameIndex === 0;
  return (
    <div class="tool-strip-commands">
      <Command command={{ what: 'copy', step: -1 }} icon="copy" label={strip.copy} name={strip.copyLabel} title={strip.copyTitle} keys="Shift+D" disabled={first} />
      <Command command={{ what: 'snap' }} icon="magnet" label={strip.snap} name={strip.snapLabel} title={strip.snapTitle} keys="S" disabled={!closed} />
      <Command command={{ what: 'shape' }} icon="smooth" label={strip.shape} name={strip.shapeLabel} title={strip.shapeTitle} keys="Shift+S" disabled={!closed} opens={state.ui.popover === 'shape'} />
    </div>
  );
}

interface CommandProps {
  readonly command: TracingCommand;
  readonly label: string;
  /** For readers, where the label is short. */
  readonly name?: string;
  readonly title?: string;
  /** Of the keyboard, for readers. */
  readonly keys?: string;
  readonly icon?: IconName;
  readonly disabled: boolean;
  /** Is what it opens open? */
  readonly opens?: boolean;
}

function Command({ command, label, name, title, keys, icon, disabled, opens }: CommandProps) {
  const { actions } = useApp();
  const dialog = opens === undefined ? {} : { 'aria-haspopup': 'dialog' as const, 'aria-expanded': opens };
  return (
    <button type="button" class="button small" aria-label={name ?? label} aria-keyshortcuts={keys} title={title ?? label} disabled={disabled} {...dialog} onClick={() => actions.run({ name: 'tracing', command })}>
      {icon && <Icon name={icon} />}
      <span class={icon && 'word'}>{label}</span>
    </button>
  );
}

function Check({ label, shown, title, checked, onChange }: { label: string; shown?: string; title: string; checked: boolean; onChange: (on: boolean) => void }): ComponentChildren {
  return (
    <label class="check" title={title}>
      <input type="checkbox" checked={checked} onChange={(event) => onChange(event.currentTarget.checked)} aria-label={label} />
      {shown ?? label}
    </label>
  );
}
