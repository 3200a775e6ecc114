import * as commands from '../document/commands';
import { nextRedo, nextUndo } from '../document/history';
import type { Popover, State } from '../document/store';
import type { Side } from '../document/types';
import { COMPONENT_NAMES, type ComponentName, titleOf } from '../terms/component';
import { useApp } from '../commands/app';
import { CutName } from '../controls/cut_name';
import { Icon } from '../controls/icons';
import { SavedState } from './saved_state';
import { StepBar } from './step_bar';
import { hasBothComponents, standingOf, whatIsMissing } from '../results/steps';
import { texts } from '../texts/texts';

const SIDES: readonly Side[] = ['unknown', 'left', 'right'];

export function TopBar({ state }: { state: State }) {
  const { actions } = useApp();
  // Before there is a frame there is neither a way to go nor anything to save.
  const isEmpty = state.history.present.frames.length === 0;
  return (
    <header class="top-bar" aria-label={texts.top.region}>
      <h1 class="for-readers">{texts.program}</h1>
      <StudyName state={state} />
      <div class="chips">
        <CalibrationChip state={state} />
        {COMPONENT_NAMES.map((component) => (
          <ComponentChip key={component} state={state} component={component} />
        ))}
      </div>
      {!isEmpty && <StepBar state={state} />}
      <div class="bar-buttons">
        <WayOn state={state} />
        <UndoAndRedo state={state} />
        <button type="button" class={isEmpty ? 'button unseen' : 'button'} aria-label={texts.top.open} title={texts.top.openTitle} onClick={() => void actions.openPicked()}>
          <Icon name="open" /> <span class="word first-to-go">{texts.top.open}</span>
        </button>
        {!isEmpty && <SaveButton state={state} />}
        {!isEmpty && <SavedState state={state} />}
        {state.ui.update ? (
          <button type="button" class="button update" title={texts.top.updateTitle} onClick={state.ui.update}>
            {texts.top.update}
          </button>
        ) : null}
        <ThemeAndKeys state={state} />
      </div>
    </header>
  );
}

function SaveButton({ state }: { state: State }) {
  const { store } = useApp().services;
  return (
    <button
      type="button"
      class="button"
      aria-label={texts.top.saveLabel}
      title={texts.top.saveTitle}
      aria-haspopup="dialog"
      aria-expanded={state.ui.popover === 'export'}
      onClick={() => toggle(store, 'export')}
    >
      <Icon name="save" /> <span class="word">{texts.top.save}</span>
    </button>
  );
}

function ThemeAndKeys({ state }: { state: State }) {
  const { actions, services } = useApp();
  return (
    <>
      <button
        type="button"
        class="button square"
        aria-label={texts.top.theme}
        aria-pressed={state.ui.theme === 'light'}
        aria-keyshortcuts="Shift+L"
        title={texts.top.themeTitle}
        onClick={() => actions.run({ name: 'theme' })}
      >
        <Icon name="theme" />
      </button>
      <button
        type="button"
        class="button round"
        aria-label={texts.top.keys}
        title={texts.top.keysTitle}
        aria-haspopup="dialog"
        aria-expanded={state.ui.popover === 'keys'}
        onClick={() => toggle(services.store, 'keys')}
      >
        {texts.top.keysSign}
      </button>
    </>
  );
}

function UndoAndRedo({ state }: { state: State }) {
  const { actions } = useApp();
  const undoStep = nextUndo(state.history);
  const redoStep = nextRedo(state.history);
  return (
    <>
      <IconButton icon="undo" label={texts.top.undo(undoStep?.label ?? null)} keys="Ctrl+Z" disabled={!undoStep} onClick={() => actions.run({ name: 'undo' })} />
      <IconButton icon="redo" label={texts.top.redo(redoStep?.label ?? null)} keys="Ctrl+Y" disabled={!redoStep} onClick={() => actions.run({ name: 'redo' })} />
    </>
  );
}

/** The one button that leads on: asks for what is missing, follows the film, and once that is done goes through what is doubtful or has no pose. */
function WayOn({ state }: { state: State }) {
  const { actions } = useApp();
  const doc = state.history.present;
  const { following } = state.ui;
  const { step, doubtful, lacking } = standingOf(doc);
  if (step === 'check' && !following) {
    return (
      <button type="button" class="button primary" aria-keyshortcuts="n" title={texts.first.steps.checkTitle(doubtful, lacking)} onClick={() => actions.work.check()}>
        {texts.first.steps.check(doubtful + lacking)}
      </button>
    );
  }
  if (step === 'joint' && !state.ui.joint.open && hasBothComponents(doc)) {
    return (
      <button type="button" class="button primary" aria-keyshortcuts="Shift+K" title={texts.withKey(texts.joint.open, 'Shift + K')} onClick={() => actions.run({ name: 'work', command: 'joint-curves' })}>
        {texts.joint.title}
      </button>
    );
  }
  // Nothing can be followed before.
  const missing = whatIsMissing(doc);
  if (missing !== null && !following) return <GiveMissing missing={missing} />;
  if (doc.frames.length < 2 || step === 'joint') return null;
  return (
    <button
      type="button"
      class={following ? 'button' : 'button primary'}
      aria-keyshortcuts="Shift+G"
      title={following ? texts.follow.stopTitle : texts.follow.title}
      // The second click of a double click would stop what the first began.
      onClick={({ detail }) => detail < 2 && actions.run({ name: 'work', command: 'follow-film' })}
    >
      {following ? texts.follow.stop : texts.follow.button}
    </button>
  );
}

function GiveMissing({ missing }: { missing: 'calibration' | ComponentName }) {
  const { store } = useApp().services;
  const { give, giveTitles } = texts.first.steps;
  return (
    <button type="button" class="button primary" aria-haspopup="dialog" title={giveTitles[missing]} onClick={() => toggle(store, missing)}>
      {give[missing]}
    </button>
  );
}

function StudyName({ state }: { state: State }) {
  const { store } = useApp().services;
  const { name, side } = state.history.present;
  return (
    <div class="study">
      <input
        class="study-name"
        aria-label={texts.top.studyName}
        placeholder={texts.program}
        value={name}
        onInput={(event) => store.perform(commands.rename(event.currentTarget.value))}
      />
      <select
        class="side"
        aria-label={texts.top.side}
        value={side}
        onChange={(event) => store.perform(commands.setSide(event.currentTarget.value as Side))}
      >
        {SIDES.map((side) => (
          <option key={side} value={side}>
            {texts.top.sides[side]}
          </option>
        ))}
      </select>
    </div>
  );
}

function CalibrationChip({ state }: { state: State }) {
  const { calibration } = state.history.present;
  const text = calibration ? calibration.name : texts.top.noCalibration;
  return <Chip state={state} popover="calibration" label={texts.top.calibration} text={text} missing={!calibration} />;
}

function ComponentChip({ state, component }: { state: State; component: ComponentName }) {
  const { model, libraryFile } = state.history.present.components[component];
  const library = state.ui.libraries[component];
  const text = model?.name ?? libraryFile?.name ?? texts.top.noModel;
  const suffix = library.state === 'building' ? ` · ${texts.top.building}` : library.state === 'stopped' ? ` · ${texts.top.noLibrary}` : '';
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
      aria-label={texts.top.chip(label, text)}
      title={texts.top.chip(label, text)}
      onClick={() => toggle(store, popover)}
    >
      <span class="chip-label">
        {label}
        <span class="chip-colon">:</span>
      </span>{' '}
      <span class="chip-text">
        <CutName text={text} />
      </span>
    </button>
  );
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
    <button type="button" class="button square" aria-label={label} title={texts.withKey(label, keys)} disabled={disabled} onClick={onClick}>
      <Icon name={icon} />
    </button>
  );
}

function toggle(store: { ui: { popover: Popover | null }; show(change: { popover: Popover | null }): void }, popover: Popover): void {
  store.show({ popover: store.ui.popover === popover ? null : popover });
}
