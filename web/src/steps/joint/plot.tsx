import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type { Theme } from '../../document/store';
import { type CurvePoint, pointAt } from '../../results/joint_curves';
import type { Over } from '../../terms/joint';
import { formatNumber } from '../../texts/numbers';
import { later } from '../../texts/later';
import { drawLines, drawWords, FONT, type Inks, nearestPoint } from './plot_drawing';

export interface Line {
  readonly points: readonly CurvePoint[];
  readonly ink: keyof Inks['of'];
}

interface PlotProps {
  /** Spoken. */
  readonly label: string;
  readonly lines: readonly Line[];
  readonly range: readonly [number, number];
  readonly over: Over;
  readonly sign: string;
  readonly current: number;
  readonly shown: number;
  readonly theme: Theme;
  readonly onHover: (index: number | null) => void;
  readonly onPick: (index: number) => void;
}

/** Lines with axes; the mouse finds the frame that is nearest. */
export function Plot(props: PlotProps) {
  const host = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const now = useRef(props);
  now.current = props;
  const { label, lines, range, over, sign, current, shown, theme } = props;
  useEffect(() => {
    const element = host.current;
    if (!element) return undefined;
    const made = new uPlot(optionsOf(now, inksOf(element), sizeOf(element)), [[], []], element);
    plot.current = made;
    const watcher = new ResizeObserver(() => {
      made.setSize(sizeOf(element));
      // Room in pixels is another part of the range.
      made.setData(made.data, true);
    });
    watcher.observe(element);
    return () => {
      watcher.disconnect();
      made.destroy();
      plot.current = null;
    };
  }, [theme, over]);
  useEffect(() => {
    plot.current?.setData(dataOf(lines), true);
  }, [theme, lines, range, over, sign]);
  useEffect(() => {
    if (plot.current) placeMarks(plot.current, lines, current, shown);
  }, [theme, lines, range, over, current, shown]);
  return <div ref={host} class="joint-plot" role="img" aria-label={label} title={later.curves.chartTitle} />;
}

type Now = { readonly current: PlotProps };

function optionsOf(now: Now, inks: Inks, size: { width: number; height: number }): uPlot.Options {
  const axis = {
    stroke: inks.quiet,
    font: `11px ${FONT}`,
    grid: { stroke: inks.line, width: 1 },
    ticks: { stroke: inks.line, width: 1, size: 4 },
    values: (_: uPlot, ticks: number[]) => ticks.map((tick) => formatNumber(tick, decimalsOf(ticks))),
  };
  return {
    ...size,
    padding: [SIGN, 8, 0, 0],
    legend: { show: false },
    cursor: { points: { show: false }, drag: { x: false, y: false }, y: false },
    scales: { x: { time: false, range: () => acrossOf(now.current) }, y: { range: (plot) => withRoom(now.current.range, plot.height - SIGN - BELOW) } },
    series: [{}, { scale: 'y', paths: () => null, points: { show: false } }],
    axes: [
      { ...axis, size: BELOW, gap: 2, space: 42, incrs: now.current.over === 'frame' ? WHOLE : undefined } as uPlot.Axis,
      { ...axis, size: 44, gap: 2, space: (_, __, ___, ____, rows) => (rows < LOW ? 16 : 26), scale: 'y' },
    ],
    hooks: {
      draw: [
        (plot) => {
          const { lines, sign, over } = now.current;
          drawWords(plot, sign, later.curves.overUnits[over], inks.quiet);
          drawLines(plot, lines.map(({ points, ink }) => ({ points, colour: inks.of[ink] })), inks.ground);
          placeMarks(plot, lines, now.current.current, now.current.shown);
        },
      ],
      setCursor: [(plot) => now.current.onHover(underCursor(plot, now.current)?.index ?? null)],
      ready: [(plot) => plot.over.addEventListener('click', () => pick(plot, now.current))],
    },
  };
}

/** Frames are whole. */
const WHOLE = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];

/** Rows of a plot that has its ticks nearer to each other, px. */
const LOW = 90;

/** Room above a plot for what its positive numbers mean, px. */
const SIGN = 16;
/** Room below it for the numbers of its axis, px. */
const BELOW = 24;
/** As far from the middle of a point as it is drawn, px. */
const POINT = 5;

/** A range and as much beyond either end as keeps points whole, however low the plot is. */
function withRoom([least, most]: readonly [number, number], rows: number): [number, number] {
  const margin = rows > 4 * POINT ? ((most - least) * POINT) / (rows - 2 * POINT) : 0;
  return [least - margin, most + margin];
}

/** As many as tell the ticks apart, and no more. */
function decimalsOf(ticks: readonly number[]): number {
  return [0, 1, 2].find((decimals) => ticks.every((tick) => Math.abs(Number(tick.toFixed(decimals)) - tick) < 1e-6)) ?? 3;
}

/** What the library puts its axes round, by rising x. It is drawn from the points: flexion comes back, and frames are missing. */
function dataOf(lines: readonly Line[]): uPlot.AlignedData {
  const points = [...(lines[0]?.points ?? [])].sort((a, b) => a.x - b.x);
  return [points.map(({ x }) => x), points.map(({ value }) => value)];
}

function acrossOf({ lines, over }: PlotProps): [number, number] {
  const xs = lines[0]?.points.map(({ x }) => x) ?? [];
  const [least, most] = [xs.reduce((a, b) => Math.min(a, b), Infinity), xs.reduce((a, b) => Math.max(a, b), -Infinity)];
  if (least > most) return [0, 1];
  const margin = over === 'frame' ? 0.5 : Math.max(1e-3, 0.02 * (most - least));
  return [least - margin, most + margin];
}

function underCursor(plot: uPlot, { lines, over }: PlotProps): CurvePoint | null {
  const { left = -1, top = -1 } = plot.cursor;
  if (left < 0) return null;
  return nearestPoint(plot, lines.flatMap(({ points }) => points), left, top, over === 'flexion' ? 'both' : 'x alone');
}

function pick(plot: uPlot, props: PlotProps): void {
  const point = underCursor(plot, props);
  if (point) props.onPick(point.index);
}

/** Rings round the frame on view, and round the one that the mouse is at: no part of the canvas, which stays as it is. */
function placeMarks(plot: uPlot, lines: readonly Line[], current: number, shown: number): void {
  const old = [...plot.over.getElementsByClassName('joint-mark')] as HTMLElement[];
  for (const { points } of lines) {
    for (const index of new Set([current, shown])) {
      const point = pointAt(points, index);
      if (!point || point.impossible) continue;
      const mark = old.shift() ?? plot.over.appendChild(document.createElement('i'));
      mark.className = index === current ? 'joint-mark' : 'joint-mark hovered';
      mark.style.left = `${plot.valToPos(point.x, 'x')}px`;
      mark.style.top = `${plot.valToPos(point.value, 'y')}px`;
    }
  }
  for (const mark of old) mark.remove();
}

function sizeOf(element: HTMLElement): { width: number; height: number } {
  return { width: Math.max(60, element.clientWidth), height: Math.max(60, element.clientHeight) };
}

/** Colours of the style, which may depend on the theme, as values. */
function inksOf(element: HTMLElement): Inks {
  const probe = document.createElement('i');
  element.append(probe);
  const colour = (name: string) => {
    probe.style.color = `var(--${name})`;
    return getComputedStyle(probe).color;
  };
  const inks = {
    line: colour('line'),
    quiet: colour('text-quiet'),
    ground: colour('surface'),
    of: { only: colour('text'), medial: colour('medial'), lateral: colour('lateral') },
  };
  probe.remove();
  return inks;
}
