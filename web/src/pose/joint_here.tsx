import { useApp } from '../commands/app';
import { currentFrame, type State } from '../document/store';
import { doubtfulIn, jointAskedIn } from '../results/motion';
import { asSentence } from '../texts/sentences';
import { formatNumber, plusMinus } from '../texts/numbers';
import { texts } from '../texts/texts';

const ANGLES = ['flexion', 'abduction', 'internal_rotation'] as const;

/** The joint's angles in the frame on view, or why no knee has them, and whether the pose of either component is doubtful. Their place is kept while they are worked out. */
export function JointHere({ state }: { state: State }) {
  const { joint } = useApp();
  const frame = currentFrame(state);
  if (!frame || !jointAskedIn(state.history.present, frame.id)) return null;
  const row = joint.rowOf(frame.id);
  const impossible = joint.impossibleIn(frame.id);
  const otherSide = joint.otherSideIn(frame.id);
  const words = texts.panel.joint;
  const doubtful = doubtfulIn(state.history.present, frame.id).map((component) => texts.component[component]);
  return (
    <div class="joint-angles" role="group" aria-label={words.region}>
      <dl>
        {ANGLES.map((name) => (
          <div key={name}>
            <dt>{words.angles[name]}</dt>
            <dd>{row ? inWords(row.get(`${name}_deg`), row.get(`sd_${name}_deg`)) : '–'}</dd>
          </div>
        ))}
      </dl>
      {impossible !== null && <p class="card-note">{asSentence(impossible)}</p>}
      {doubtful.length > 0 && <p class="card-note">{words.doubt(doubtful)}</p>}
      {otherSide !== null && <p class="card-note">{asSentence(otherSide)}</p>}
    </div>
  );
}

function inWords(value = NaN, deviation = NaN): string {
  if (!Number.isFinite(value)) return '–';
  return `${Number.isFinite(deviation) ? plusMinus(value, deviation, 2) : formatNumber(value, 2)}°`;
}
