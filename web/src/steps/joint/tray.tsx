import { useMemo, useRef } from 'preact/hooks';
import type { Doc } from '../../document/types';
import type { JointNumbers } from '../../results/joint_curves';
import { trayOf, type TrayLine } from '../../results/joint_tray';
import { later } from '../../texts/later';
import { InWords } from './curve_panel';

interface TrayProps {
  readonly doc: Doc;
  readonly numbers: JointNumbers;
  /** The frame whose line is drawn in full. */
  readonly shown: number;
  readonly onPick: (index: number) => void;
}

/** The tray from above, anterior up: the line between the lowest points in the frame at hand, and those of the film faintly behind it. */
export function Tray({ doc, numbers, shown, onPick }: TrayProps) {
  const { tray: words } = later.curves;
  const tray = useMemo(() => trayOf(doc, numbers), [doc.frames, doc.side, numbers]);
  if (!tray) return null;
  const { border, lines, middle, reach } = tray;
  const here = lines.find(({ index }) => index === shown);
  const [low, high] = [middle[0] - reach[0], middle[1] - reach[1]];
  return (
    <section class="joint-panel joint-tray" aria-label={words.title}>
      <div class="joint-panel-head">
        <h2>
          <InWords full={words.title} short={words.short} /> <span class="unit">mm</span>
        </h2>
      </div>
      <div class="tray-words" aria-hidden="true">
        <SideWord side={tray.medialSide > 0 ? 'lateral' : 'medial'} />
        <span>{words.anterior}</span>
        <SideWord side={tray.medialSide > 0 ? 'medial' : 'lateral'} />
      </div>
      <svg preserveAspectRatio="xMidYMin" viewBox={`${low} ${high} ${2 * reach[0]} ${2 * reach[1]}`} role="img" aria-label={here ? words.here(shown + 1) : words.none(shown + 1)}>
        <polygon class="tray-border" points={border.map((point) => point.join()).join(' ')} />
        <Fan lines={lines} onPick={onPick} />
        {here && (
          <>
            <line class="tray-here" {...endsOf(here)} />
            <circle class="tray-medial" cx={here.medial[0]} cy={here.medial[1]} r="1.6" />
            <rect class="tray-lateral" x={here.lateral[0] - 1.4} y={here.lateral[1] - 1.4} width="2.8" height="2.8" />
          </>
        )}
      </svg>
    </section>
  );
}

function SideWord({ side }: { side: 'medial' | 'lateral' }) {
  const { of, ofShort } = later.curves;
  return (
    <span>
      <InWords full={of[side]} short={ofShort[side]} />
    </span>
  );
}

/** More lines than these would be one surface. */
const MOST = 60;

/** Drawn when lines change alone, not with every frame that is looked at. */
function Fan({ lines, onPick }: { lines: readonly TrayLine[]; onPick: (index: number) => void }) {
  const pick = useRef(onPick);
  pick.current = onPick;
  return useMemo(() => {
    const every = Math.ceil(lines.length / MOST);
    const some = lines.filter((_, at) => at % every === 0);
    return (
      <g>
        {some.map((line) => (
          <line key={line.index} class={line.doubtful ? 'tray-line doubtful' : 'tray-line'} {...endsOf(line)} onClick={() => pick.current(line.index)} />
        ))}
      </g>
    );
  }, [lines]);
}

function endsOf({ medial, lateral }: TrayLine) {
  return { x1: medial[0], y1: medial[1], x2: lateral[0], y2: lateral[1] };
}
