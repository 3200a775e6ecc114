import * as commands from '../document/commands';
import { hasUnsavedWork, nextRedo, nextUndo } from '../document/history';
import type { Popover, State } from '../document/store';
import { COMPONENT_NAMES, titleOf, type ComponentName, type Side } from '../document/types';
import { useApp } from './app';
import { Icon } from './icons';

export function TopBar({ state }: { state: State }) {
  const { actions, services } = useApp();
  const undoStep = nextUndo(state.history);
  const redoStep = nextRedo(state.history);
  return (
    <header class="top-bar" aria-label="Study">
      <h1 class="for-readers">fluoropose</h1>
      <StudyName state={state} />
      <div class="chips">
        <CalibrationChip state={state} />
        {COMPONENT_NAMES.map((component) => (
          <ComponentChip key={component} state={state} component={component} />
        ))}
      </div>
      <div class="bar-buttons">
        <IconButton icon="undo" label={undoStep ? `Undo: ${undoStep.label}` : 'Undo'} keys="Ctrl+Z" disabled={!undoStep} onClick={() => services.store.undo()} />
        <IconButton icon="redo" label={redoStep ? `Redo: ${redoStep.label}` : 'Redo'} keys="Ctrl+Y" disabled={!redoStep} onClick={() => services.store.redo()} />
        <button type="button" class={state.history.present.frames.length > 0 ? 'button' : 'button unseen'} title="Open files (Ctrl+O)" onClick={() => void actions.openPicked()}>
          <Icon name="open" /> Open files
        </button>
        <button
          type="button"
          class="button"
          aria-label="Save session"
          title="Save the session (Ctrl+S)"
          aria-haspopup="dialog"
          aria-expanded={state.ui.popover === 'session'}
          onClick={() => toggle(services.store, 'session')}
        >
          <Icon name="save" /> Save
        </button>
        <SavedState state={state} />
        <button
          type="button"
          class="button round"
          aria-label="Keys and mouse"
          title="Keys and mouse (?)"
          aria-haspopup="dialog"
          aria-expanded={state.ui.popover === 'keys'}
          onClick={() => toggle(services.store, 'keys')}
        >
          ?
        </button>
      </div>
    </header>
  );
}

function StudyName({ state }: { state: State }) {
  const { store } = useApp().services;
  const { name, side } = state.history.present;
  return (
    <div class="study">
      <input
        class="study-name"
        aria-label="Name of the study"
        placeholder="fluoropose"
        value={name}
        onInput={(event) => store.perform(commands.rename(event.currentTarget.value))}
      />
      <select
        class="side"
        aria-label="Side of the body"
        value={side}
        onChange={(event) => store.perform(commands.setSide(event.currentTarget.value as Side))}
      >
        <option value="unknown">side?</option>
        <option value="left">left</option>
        <option value="right">right</option>
      </select>
    </div>
  );
}

function CalibrationChip({ state }: { state: State }) {
  const { calibration } = state.history.present;
  const text = calibration ? calibration.name : 'none';
  return <Chip state={state} popover="calibration" label="Calibration" text={text} missing={!calibration} />;
}

function ComponentChip({ state, component }: { state: State; component: ComponentName }) {
  const { model, libraryFile } = state.history.present.components[component];
  const library = state.ui.libraries[component];
  const text = model?.name ?? libraryFile?.name ?? 'no model';
  const suffix = library.state === 'building' ? ' · building' : library.state === 'stopped' ? ' · no library' : '';
  return <Chip state={state} popover={component} label={titleOf(component)} text={text + suffix} missing={!model && !libraryFile} tint={component} />;
}

interface ChipProps {
  readonly state: State;
  readonly popover: Popover;
  readonly label: string;
  readonly text: string;
  readonly missing: boolean;
  readonly tint?: ComponentName;
}

function Chip({ state, popover, label, text, missing, tint }: ChipProps) {
  const { store } = useApp().services;
  return (
    <button
      type="button"
      class={`chip${missing ? ' missing' : ''}${tint ? ` ${tint}` : ''}`}
      aria-haspopup="dialog"
      aria-expanded={state.ui.popover === popover}
      title={`${label}: ${text}`}
      onClick={() => toggle(store, popover)}
    >
      <span class="chip-label">{label}:</span>{' '}
      <span class="chip-text">{text}</span>
    </button>
  );
}

function SavedState({ state }: { state: State }) {
  const unsaved = hasUnsavedWork(state.history);
  const { savedAt } = state.ui;
  const time = savedAt && new Date(savedAt).toLocaleTimeString([], { hour: '2-digit', minute: '2-digit' });
  const text = unsaved ? 'not saved' : time ? `saved ${time}` : '';
  return <span class="saved">{text}</span>;
}

interface IconButtonProps {
  readonly icon: 'undo' | 'redo';
  readonly label: string;
  readonly keys: string;
  readonly disabled: boolean;
  readonly onClick: () => void;
}

function IconButton({ icon, label, keys, disabled, onClick }: IconButtonProps) {
  return (
    <button type="button" class="button square" aria-label={label} title={`${label} (${keys})`} disabled={disabled} onClick={onClick}>
      <Icon name={icon} />
    </button>
  );
}

function toggle(store: { ui: { popover: Popover | null }; show(change: { popover: Popover | null }): void }, popover: Popover): void {
  store.show({ popover: store.ui.popover === popover ? null : popover });
}
