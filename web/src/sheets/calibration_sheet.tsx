import { useEffect, useState } from 'preact/hooks';
import * as commands from '../document/commands';
import { droppedIn } from '../document/found_anew';
import { currentFrame, type State } from '../document/store';
import type { CalibrationFacts } from '../workers/protocol/camera';
import { cameraDoubts, cameraKey } from '../jobs/camera_doubts';
import { sentenceOf } from '../jobs/services';
import { useApp } from '../commands/app';
import { NumberField } from '../controls/number_field';
import { StatedGeometry } from './stated_geometry';
import { asSentence } from '../texts/sentences';
import { later } from '../texts/later';
import { texts } from '../texts/texts';

/** Calibration from a file, or typed: the four numbers of `JT_INTCALIB`. The frame size comes from the frame. */
export function CalibrationSheet({ state }: { state: State }) {
  // What another file says takes the place of what stands in the fields.
  return <Typed key={state.history.present.calibration?.text} state={state} />;
}

function Typed({ state }: { state: State }) {
  const { actions, services } = useApp();
  const { store, studio } = services;
  const frame = currentFrame(state);
  const facts = factsOf(state, studio.calibrationFacts.bind(studio));
  const [typed, setTyped] = useState({
    distance: facts?.principal?.distance ?? NaN,
    pitch: facts?.principal?.pitch ?? NaN,
    offsetX: facts?.principal?.offsetX ?? 0,
    offsetY: facts?.principal?.offsetY ?? 0,
  });
  const [trouble, setTrouble] = useState('');
  const set = (field: keyof typeof typed) => (value: number) => setTyped({ ...typed, [field]: value });
  const use = () => {
    try {
      const size = frame ?? { width: 1024, height: 1024 };
      const text = studio.calibrationText(typed.distance, typed.offsetX, typed.offsetY, typed.pitch, size);
      const before = store.doc;
      store.perform(commands.setCalibration({ name: later.calibration.typedName, text }));
      const dropped = droppedIn(before, store.doc);
      if (dropped > 0) store.say('info', asSentence(later.opening.dropped(dropped)));
      setTrouble('');
      store.show({ popover: null });
      void cameraDoubts(services).then((doubts) => doubts.forEach((doubt) => store.say('error', doubt)));
    } catch (error) {
      setTrouble(sentenceOf(error));
    }
  };
  return (
    <form
      class="sheet-body"
      onSubmit={(event) => {
        event.preventDefault();
        use();
      }}
    >
      <p class="sheet-text">{describe(state, facts)}</p>
      <Doubts key={cameraKey(services)} />
      <div class="fields">
        <NumberField label={later.calibration.distance} unit="mm" value={typed.distance} onChange={set('distance')} />
        <NumberField label={later.calibration.pitch} unit="mm" value={typed.pitch} onChange={set('pitch')} />
        <NumberField label={later.calibration.pointX} unit="mm" value={typed.offsetX} onChange={set('offsetX')} />
        <NumberField label={later.calibration.pointY} unit="mm" value={typed.offsetY} onChange={set('offsetY')} />
      </div>
      <p class="sheet-text quiet">
        {later.calibration.meaning} {frame ? later.calibration.frameSize(frame.width, frame.height) : ''}
      </p>
      <StatedGeometry state={state} onDistance={set('distance')} onPitch={set('pitch')} />
      <p class="sheet-trouble" role="alert">
        {trouble}
      </p>
      <div class="sheet-buttons">
        <button type="submit" class="button primary">
          {later.calibration.use}
        </button>
        <button type="button" class="button" onClick={() => void actions.openPicked()}>
          {later.calibration.open}
        </button>
        <button type="button" class="button" onClick={() => store.show({ popover: 'calibrate' })}>
          {texts.calibrate.open}
        </button>
      </div>
    </form>
  );
}

/** What is unusual of the camera in use. */
function Doubts() {
  const { services } = useApp();
  const [doubts, setDoubts] = useState<readonly string[]>([]);
  useEffect(() => void cameraDoubts(services).then(setDoubts), []);
  return (
    <>
      {doubts.map((doubt) => (
        <p key={doubt} class="sheet-trouble">
          {doubt}
        </p>
      ))}
    </>
  );
}

function factsOf(state: State, read: (text: string, frame: ReturnType<typeof currentFrame>) => CalibrationFacts) {
  const { calibration } = state.history.present;
  if (!calibration) return null;
  try {
    return read(calibration.text, currentFrame(state));
  } catch {
    // A calibration for frames of another size: its chip and the pose say so; the form stays usable.
    return read(calibration.text, null);
  }
}

function describe(state: State, facts: CalibrationFacts | null): string {
  const { calibration } = state.history.present;
  if (!calibration || !facts) return later.calibration.none;
  if (!facts.camera) return later.calibration.nameOnly(calibration.name);
  const { fx, fy, cx, cy } = facts.camera;
  const focal = fx === fy ? fx.toFixed(1) : `${fx.toFixed(1)} x ${fy.toFixed(1)}`;
  return later.calibration.facts(calibration.name, focal, cx.toFixed(1), cy.toFixed(1));
}
