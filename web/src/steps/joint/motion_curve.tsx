import { useMemo, useState } from 'preact/hooks';
import { jointMotion, motionNeeds, QUANTITIES, runsOf, type JointPoint, type Quantity } from '../../results/motion';
import type { State } from '../../document/store';
import { cellOf, chosenCandidate, type Doc } from '../../document/types';
import { COMPONENT_NAMES } from '../../terms/component';
import { texts } from '../../texts/texts';
import { useApp } from '../../commands/app';

/** Of the drawing, px. */
const HEIGHT = 40;
const MARGIN = 6;
/** Less than this is drawn flat: what is left is noise, mm or degrees. */
const LEAST_SPAN = 2;

/** Room for the curve is kept as soon as a joint can come about: the frame must not jump when the first one does. */
export function hasBothComponents(doc: Doc): boolean {
  return COMPONENT_NAMES.every((component) => {
    const { model, libraryFile } = doc.components[component];
    return model !== null || libraryFile !== null || doc.frames.some(({ id }) => chosenCandidate(cellOf(doc, id, component)));
  });
}

/** The joint's motion over the frames; a click goes to the frame. */
export function MotionCurve({ state }: { state: State }) {
  const { services } = useApp();
  const [quantity, setQuantity] = useState<Quantity>('flexion');
  const doc = state.history.present;
  const { cells, components, frames, side } = doc;
  const points = useMemo(() => jointMotion(doc, (...poses) => services.studio.motionOf(...poses)), [cells, components, frames, side]);
  const here = points.find(({ index }) => index === state.ui.frameIndex);
  const { motion } = texts;
  return (
    <div class="motion">
      <div class="motion-head">
        <select class="motion-quantity" aria-label={motion.choose} value={quantity} onChange={(event) => setQuantity(event.currentTarget.value as Quantity)}>
          {QUANTITIES.map((name) => (
            <option key={name} value={name}>
              {motion.quantities[name]}
            </option>
          ))}
        </select>
        <output class="motion-here">{here ? shown(here, quantity) : motion.none}</output>
      </div>
      {points.length > 0 ? (
        <Curve points={points} quantity={quantity} count={frames.length} current={state.ui.frameIndex} onPick={(index) => services.store.goTo(index)} />
      ) : (
        <MotionNeeds state={state} />
      )}
    </div>
  );
}

/** What the curve waits for, and where to say it. */
function MotionNeeds({ state }: { state: State }) {
  const { store } = useApp().services;
  const needs = motionNeeds(state.history.present);
  if (needs.component === undefined) return <p class="motion-empty">{needs.what === 'side' ? texts.motion.needsSide : texts.motion.needsBoth}</p>;
  const { what, component } = needs;
  return (
    <p class="motion-empty">
      {texts.axes.motion[what](texts.component[component])}{' '}
      <button type="button" class="button small" aria-haspopup="dialog" onClick={() => store.show({ component, popover: component })}>
        {texts.axes.look}
      </button>
    </p>
  );
}

interface CurveProps {
  readonly points: readonly JointPoint[];
  readonly quantity: Quantity;
  readonly count: number;
  readonly current: number;
  readonly onPick: (index: number) => void;
}

/** Drawn in units of a frame across, so that it stands under the cells at any width. */
function Curve({ points, quantity, count, current, onPick }: CurveProps) {
  const values = points.map(({ motion }) => motion[quantity]);
  const [least, most] = [Math.min(...values), Math.max(...values)];
  const y = scale(least, most);
  const at = (event: MouseEvent & { currentTarget: Element }) => {
    const { left, width } = event.currentTarget.getBoundingClientRect();
    return Math.floor(((event.clientX - left) / width) * count);
  };
  const label = texts.motion.chart(texts.motion.quantities[quantity], points.length, shownValue(least, quantity), shownValue(most, quantity));
  return (
    <div class="motion-chart" role="img" aria-label={label} title={texts.motion.title} onClick={(event) => onPick(at(event))}>
      <svg class="motion-line" viewBox={`0 0 ${count} ${HEIGHT}`} preserveAspectRatio="none" aria-hidden="true">
        <line class="motion-now" x1={current + 0.5} x2={current + 0.5} y1={0} y2={HEIGHT} />
        {runsOf(points).map((run) => (
          <polyline key={run[0]!.index} points={run.map(({ index, motion }) => `${index + 0.5},${y(motion[quantity])}`).join(' ')} />
        ))}
      </svg>
      {points.map(({ index, motion, sure }) => (
        <i
          key={index}
          class={sure ? 'motion-point' : 'motion-point unsure'}
          style={{ left: `${(100 * (index + 0.5)) / count}%`, top: `${y(motion[quantity])}px` }}
        />
      ))}
    </div>
  );
}

function scale(least: number, most: number): (value: number) => number {
  const span = Math.max(LEAST_SPAN, most - least);
  const middle = (least + most) / 2;
  return (value) => HEIGHT / 2 - ((value - middle) / span) * (HEIGHT - 2 * MARGIN);
}

function shown({ motion }: JointPoint, quantity: Quantity): string {
  return shownValue(motion[quantity], quantity);
}

function shownValue(value: number, quantity: Quantity): string {
  const isAngle = quantity === 'flexion' || quantity === 'abduction' || quantity === 'internal';
  const { degrees, millimetres } = texts.motion.units;
  return `${value.toFixed(1).replace('-', '\u2212')}${isAngle ? degrees : millimetres}`;
}
