import { useEffect, useState } from 'preact/hooks';
import { setAxes, withFront } from '../document/axes';
import type { State } from '../document/store';
import type { Axes } from '../document/types';
import { AXIS_WORDS, type AxisWord, directionsOf, fromTheRight, viewpointOf, wordOf } from '../geometry/axes';
import { rotationOf } from '../geometry/pose_motion';
import { axesSentence, namedArrows } from '../results/axes_words';
import { facingByFilm, type Facing } from '../results/facing';
import { type ComponentName, titleOf } from '../terms/component';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { meshOf } from '../commands/model_in_hand';
import { middleOf } from '../geometry/mesh_middle';
import { drawingKey, turnByKey, useSpaceView } from '../pose/space_view';
import type { PlacedModel } from '../stage/three/models';

/** Which way the component lies in its file: what its shape tells, shown on the model, and a person's word instead. */
export function AxesSection({ state, component }: { state: State; component: ComponentName }) {
  const { store, studio } = useApp().services;
  const doc = state.history.present;
  const { axes, model } = doc.components[component];
  const mesh = meshOf(doc, component, studio);
  const words = later.axes;
  const sentence = axesSentence(axes, component, doc.side, model !== null);
  const say = (axes: Axes | null) => store.perform(setAxes(component, axes));
  return (
    <section class="axes" aria-label={words.heading}>
      <h3>{words.heading}</h3>
      <p class="sheet-text">{sentence}</p>
      {mesh && axes && <AxesPicture component={component} axes={axes} mesh={mesh} side={doc.side} sentence={sentence} />}
      {axes?.told === 'not the front' && <FrontQuestion facing={facingByFilm(doc, component)} other={OTHER[component]} onAnswer={(front) => say(withFront(axes, front))} />}
      <StatedAxes key={JSON.stringify(axes)} axes={axes} onSay={say} canReset={model !== null && axes !== null && axes.from !== 'shape'} />
    </section>
  );
}

const OTHER = { femur: 'tibia', tibia: 'femur' } as const satisfies Record<ComponentName, ComponentName>;

interface FrontQuestionProps {
  readonly facing: Facing | null;
  readonly other: ComponentName;
  readonly onAnswer: (front: Facing['front']) => void;
}

/** Asked of a person; where the film knows an answer, that is said, and not taken by itself. */
function FrontQuestion({ facing, other, onAnswer }: FrontQuestionProps) {
  const words = later.axes;
  return (
    <div class="sheet-buttons" role="group" aria-label={words.question}>
      <span class="sheet-text">{words.question}</span>
      {(['as shown', 'the other way'] as const).map((front) => (
        <button key={front} type="button" class={facing?.front === front ? 'button primary' : 'button'} onClick={() => onAnswer(front)}>
          {words.fronts[front]}
        </button>
      ))}
      {facing && <p class="sheet-text quiet">{words.film(facing.front, facing.frames, texts.component[other])}</p>}
    </div>
  );
}

/** How far from the camera the model stands for its picture, mm: any distance will do. */
const AWAY = 1000;

interface AxesPictureProps {
  readonly component: ComponentName;
  readonly axes: Axes;
  readonly mesh: PlacedModel['mesh'];
  readonly side: State['history']['present']['side'];
  readonly sentence: string;
}

/** From its right side: anterior to the right, superior up, if the axes are right. */
function AxesPicture({ component, axes, mesh, side, sentence }: AxesPictureProps) {
  const { canvas, view, trouble } = useSpaceView();
  const middle = middleOf(mesh);
  const placed: PlacedModel = { component, mesh, pose: fromTheRight(axes.directions, middle, AWAY), arrows: namedArrows(axes, side) };
  useEffect(() => {
    if (!view) return;
    view.show([placed]);
    view.look(viewpointOf('camera', rotationOf(placed.pose), null, side));
    // A little from above and from the front, so that all three are seen.
    view.turn(-25, 20);
  }, [view, mesh, drawingKey([placed])]);
  const words = later.axes;
  return (
    <>
      <canvas
        ref={canvas}
        class="axes-canvas"
        tabIndex={0}
        role="application"
        data-arrows
        aria-label={words.canvas(titleOf(component), sentence.replace(/\.$/, ''))}
        onKeyDown={(event) => view && turnByKey(view, event)}
      />
      {trouble && <p class="sheet-text quiet">{trouble}</p>}
    </>
  );
}

interface StatedAxesProps {
  readonly axes: Axes | null;
  readonly onSay: (axes: Axes | null) => void;
  readonly canReset: boolean;
}

/** Two of the file's axes tell the third: what is said is a right-handed frame. */
function StatedAxes({ axes, onSay, canReset }: StatedAxesProps) {
  const known = axes && axes.told !== 'nothing' ? axes.directions : null;
  // Axes that lie between those of the file are none of the choices, and nothing is proposed in their place.
  const [anterior, setAnterior] = useState<AxisWord | null>(known && wordOf(known[0]));
  const [superior, setSuperior] = useState<AxisWord | null>(known && wordOf(known[1]));
  const directions = anterior && superior && directionsOf(anterior, superior);
  const words = later.axes;
  const same = axes?.told === 'all' && JSON.stringify(axes.directions) === JSON.stringify(directions);
  return (
    <form
      class="stated-axes"
      onSubmit={(event) => {
        event.preventDefault();
        if (directions) onSay({ directions, from: 'person', told: 'all' });
      }}
    >
      <AxisChoice label={words.anterior} value={anterior} onChoose={setAnterior} />
      <AxisChoice label={words.superior} value={superior} onChoose={setSuperior} />
      <output class="sheet-text quiet">{directions ? words.third(shown(wordOf(directions[2]) ?? 'z')) : anterior && superior ? words.skew : words.choose}</output>
      <div class="sheet-buttons">
        <button type="submit" class="button" disabled={!directions || same}>
          {words.use}
        </button>
        {canReset && (
          <button type="button" class="button" onClick={() => onSay(null)}>
            {words.reset}
          </button>
        )}
      </div>
    </form>
  );
}

function AxisChoice({ label, value, onChoose }: { label: string; value: AxisWord | null; onChoose: (word: AxisWord) => void }) {
  return (
    <label class="axis-choice">
      <span>{label}</span>
      <select aria-label={label} value={value ?? ''} onChange={(event) => onChoose(event.currentTarget.value as AxisWord)}>
        {value === null && <option value="">–</option>}
        {AXIS_WORDS.map((word) => (
          <option key={word} value={word}>
            {shown(word)}
          </option>
        ))}
      </select>
    </label>
  );
}

function shown(word: AxisWord): string {
  return word.replace('-', '\u2212');
}
