import { useEffect, useRef, useState } from 'preact/hooks';
import { currentCell, type State } from '../document/store';
import type { LandscapeFacts } from '../workers/protocol/by_hand';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { cellAt, paintLandscape } from './landscape_picture';
import { degreesOf, goesAround, type LandscapeCell, summary } from '../results/landscape';
import { grouped } from '../texts/numbers';

/** The score of every view of the library for the outline on view: how sure the match is, and what else might fit. */
export function Landscape({ state }: { state: State }) {
  const { landscapes } = useApp();
  const { outline, result } = currentCell(state);
  const scored = landscapes.of(outline);
  const words = texts.seeing.landscape;
  const facts = scored && 'facts' in scored ? scored.facts : null;
  const refusal = scored && 'refusal' in scored ? scored.refusal : null;
  const byHand = result?.kind === 'posed' && result.from !== 'outline';
  return (
    <section class="card landscape" aria-label={words.region}>
      {facts ? <Chart facts={facts} takable={!byHand} /> : outline?.closed && <div class="landscape-empty" />}
      <p class="card-note">{refusal ?? (facts ? (byHand ? words.byHand : summary(facts)) : outline?.closed ? words.working : words.none)}</p>
    </section>
  );
}

/** A picture to be pointed at, and walked through with arrows. */
function Chart({ facts, takable }: { facts: LandscapeFacts; takable: boolean }) {
  const { hand } = useApp();
  const canvas = useRef<HTMLCanvasElement>(null);
  const [cursor, setCursor] = useState<LandscapeCell>(() => bestCell(facts));
  useEffect(() => setCursor(bestCell(facts)), [facts]);
  useEffect(() => {
    const context = canvas.current?.getContext('2d');
    if (context) paintLandscape(context, facts, cursor);
  }, [facts, cursor]);
  const score = facts.scores[cursor.y * facts.x.count + cursor.x] ?? 0;
  const [x, y] = [degreesOf(facts.x, cursor.x), degreesOf(facts.y, cursor.y)];
  const side = sideOf(facts);
  const words = texts.seeing.landscape;
  const said = words.view(x, y, grouped(score));
  const take = (cell: LandscapeCell) => takable && void hand.takeView(facts, cell);
  const pointed = (event: MouseEvent) => canvas.current && cellAt(facts, canvas.current, event);
  return (
    <>
      <canvas
        ref={canvas}
        class="landscape-canvas"
        width={side * facts.y.count}
        height={side * facts.x.count}
        style={{ aspectRatio: `${facts.y.count} / ${facts.x.count}` }}
        tabIndex={0}
        role="application"
        data-arrows
        aria-label={`${words.grid}. ${said}`}
        title={words.take}
        onPointerMove={(event) => setCursor((now) => pointed(event) ?? now)}
        onPointerLeave={() => setCursor(bestCell(facts))}
        onClick={(event) => {
          const cell = pointed(event);
          if (cell) take(cell);
        }}
        onKeyDown={(event) => {
          const step = ARROWS[event.key];
          if (step) setCursor((now) => walked(facts, now, step));
          else if (event.key === 'Enter') take(cursor);
          else return;
          event.preventDefault();
          event.stopPropagation();
        }}
      />
      <p class="landscape-said" aria-live="polite">
        {said}
      </p>
    </>
  );
}

/** Canvas pixels of a view: fewer where there are many. */
function sideOf({ y }: LandscapeFacts): number {
  return y.count > MANY ? 2 : 8;
}
const MANY = 90;

const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [0, -1],
  ArrowRight: [0, 1],
  ArrowUp: [-1, 0],
  ArrowDown: [1, 0],
};

function walked({ x, y }: LandscapeFacts, cell: LandscapeCell, [dx, dy]: readonly [number, number]): LandscapeCell {
  const within = (value: number, count: number) => Math.min(count - 1, Math.max(0, value));
  const across = cell.y + dy;
  return { x: within(cell.x + dx, x.count), y: goesAround(y) ? (across + y.count) % y.count : within(across, y.count) };
}

function bestCell({ scores, x }: LandscapeFacts): LandscapeCell {
  const best = scores.indexOf(Math.min(...scores));
  return { x: best % x.count, y: Math.floor(best / x.count) };
}
