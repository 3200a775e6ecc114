import { useEffect, useMemo, useState } from 'preact/hooks';
import { asBefore } from '../document/laid_by';
import { setOutline } from '../document/outlines';
import { currentCell, currentPlace, type State } from '../document/store';
import type { Outline } from '../document/types';
import type { Reshape } from '../tracing/pixels';
import { reshaped, type Shaping } from '../tracing/shaping';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { Range } from '../controls/range';

/** Simplifies or smooths the outline: what it would become lies on the frame, with how far the shape moves. */
export function ShapeSheet({ state }: { state: State }) {
  const { tracingTools, services } = useApp();
  const { store } = services;
  const [shaping, setShaping] = useState<Shaping>({ smooth: 0, simplify: 0.5 });
  const { outline } = currentCell(state);
  const closed = outline?.closed ? outline : null;
  const shape = useMemo(() => closed && reshaped(closed, shaping), [closed, shaping]);
  useEffect(() => {
    tracingTools.showShape(shape?.points ?? []);
    return () => tracingTools.showShape([]);
  }, [tracingTools, shape]);
  const { none, smooth, simplify, use, smoothed, simplified } = texts.tracing.shape;
  if (!closed || !shape) return <p class="sheet-body">{none}</p>;
  const take = () => {
    const place = currentPlace(store.state);
    if (!place) return;
    const { points, unknownSides } = shape;
    store.perform(setOutline(place, shaping.smooth > 0 ? smoothed : simplified, { points, closed: true, unknownSides, ...asBefore(closed) }));
    store.show({ popover: null, selectedPoint: null });
  };
  return (
    <form
      class="sheet-body shape-body"
      onSubmit={(event) => {
        event.preventDefault();
        take();
      }}
    >
      <Range label={smooth} value={shaping.smooth} text={`${shaping.smooth.toFixed(1)} px`} min={0} max={20} step={0.5} onInput={(value) => setShaping({ ...shaping, smooth: value })} />
      <Range label={simplify} value={shaping.simplify} text={`${shaping.simplify.toFixed(2)} px`} min={0} max={5} step={0.05} onInput={(value) => setShaping({ ...shaping, simplify: value })} />
      <ShapeError outline={closed} shape={shape} />
      <button type="submit" class="button primary" disabled={shape.points.length === 0 || same(closed, shape)}>
        {use}
      </button>
    </form>
  );
}

function ShapeError({ outline, shape }: { outline: Outline; shape: Reshape }) {
  const { points, error, same: unchanged, gone } = texts.tracing.shape;
  if (shape.points.length === 0) return <p class="sheet-text">{gone}</p>;
  if (same(outline, shape)) return <p class="sheet-text">{unchanged}</p>;
  return (
    <p class="sheet-text" aria-live="polite">
      {points(outline.points.length, shape.points.length)} {error(shape.greatest.toFixed(2), shape.rms.toFixed(2))}
    </p>
  );
}

function same(outline: Outline, shape: Reshape): boolean {
  return shape.greatest === 0 && shape.points.length === outline.points.length;
}
