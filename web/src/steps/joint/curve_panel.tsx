import type { ComponentChildren } from 'preact';
import { useMemo } from 'preact/hooks';
import type { Theme } from '../../document/store';
import type { Doc } from '../../document/types';
import { type Along, type CurvePoint, CURVES, type JointNumbers, pointAt, pointsOf, rangeOf } from '../../results/joint_curves';
import type { CurveName } from '../../terms/joint';
import { formatNumber, plusMinus } from '../../texts/numbers';
import { later } from '../../texts/later';
import { Icon } from '../../controls/icons';
import { type Line, Plot } from './plot';

interface CurvePanelProps {
  readonly name: CurveName;
  readonly doc: Doc;
  readonly numbers: JointNumbers;
  readonly along: Along;
  readonly theme: Theme;
  /** The frame whose numbers stand above the curve, and the one on view. */
  readonly shown: number;
  readonly current: number;
  readonly alone: boolean;
  readonly onAlone: () => void;
  readonly onHover: (index: number | null) => void;
  readonly onPick: (index: number) => void;
}

/** One curve with its name, its unit and what it is in one frame. */
export function CurvePanel({ name, doc, numbers, along, theme, shown, current, alone, onAlone, onHover, onPick }: CurvePanelProps) {
  const words = later.curves;
  const { title, short = title, sign } = words.curves[name];
  const { columns, unit } = CURVES[name];
  const { cells, marks, frames } = doc;
  const lines = useMemo(
    () => columns.map((column, at): Line => ({ points: pointsOf(doc, numbers, column, along), ink: columns.length === 1 ? 'only' : at === 0 ? 'medial' : 'lateral' })),
    [cells, marks, frames, numbers, along, columns],
  );
  const range = useMemo(() => rangeOf(lines.flatMap(({ points }) => points)), [lines]);
  // With every move of the mouse another frame is shown, and nothing else changes.
  const label = useMemo(() => chartLabel(name, lines, along), [name, lines, along]);
  return (
    <section class="joint-panel" aria-label={title}>
      <div class="joint-panel-head">
        <h2>
          <InWords full={title} short={short} /> <span class="unit">{unit}</span>
        </h2>
        <output class="joint-here" aria-label={words.here(title, shown + 1)}>
          {lines.map(({ points, ink }) => (
            <span key={ink} class={`joint-value ${ink}`}>
              {ink !== 'only' && (
                <>
                  <InWords full={words.of[ink]} short={words.ofShort[ink]} />{' '}
                </>
              )}
              {shownValue(pointAt(points, shown))}
            </span>
          ))}
          {name === 'liftOff' && <span>{beyond(doc, numbers, shown)}</span>}
        </output>
        <button type="button" class="button square small" aria-label={alone ? words.all : words.alone(title)} title={alone ? words.all : words.alone(title)} aria-pressed={alone} onClick={onAlone}>
          <Icon name="fit" />
        </button>
      </div>
      <Plot
        label={label}
        lines={lines}
        range={range}
        over={along.over}
        sign={sign}
        current={current}
        shown={shown}
        theme={theme}
        onHover={onHover}
        onPick={onPick}
      />
    </section>
  );
}

/** The one of them that there is room for. */
export function InWords({ full, short }: { full: string; short: string }) {
  return full === short ? (
    full
  ) : (
    <>
      <span class="in-full">{full}</span>
      <abbr class="in-short" title={full}>
        {short}
      </abbr>
    </>
  );
}

function chartLabel(name: CurveName, lines: readonly Line[], { over }: Along): string {
  const words = later.curves;
  const { title } = words.curves[name];
  const values = lines.flatMap(({ points }) => points.map(({ value }) => value));
  if (values.length === 0) return words.noChart(title);
  const { unit } = CURVES[name];
  const [least, most] = [Math.min(...values), Math.max(...values)].map((value) => `${formatNumber(value, 1)} ${unit}`) as [string, string];
  return words.chart(title, lines[0]!.points.length, least, most, words.overs[over].toLowerCase());
}

/** How probable a lift-off of more than a millimetre is. */
function beyond(doc: Doc, numbers: JointNumbers, shown: number): ComponentChildren {
  const row = numbers.of.get(doc.frames[shown]?.id ?? '');
  const probability = row?.[numbers.columns.indexOf('p_lift_off_over_1.0_mm')] ?? NaN;
  if (!Number.isFinite(probability)) return null;
  const percent = formatNumber(100 * probability, 0);
  return <InWords full={later.curves.beyond(percent)} short={later.curves.beyondShort(percent)} />;
}

function shownValue(point: CurvePoint | undefined): string {
  if (!point) return '–';
  return Number.isFinite(point.deviation) ? plusMinus(point.value, point.deviation, 2) : formatNumber(point.value, 2);
}
