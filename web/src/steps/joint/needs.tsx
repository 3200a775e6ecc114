import { useApp } from '../../commands/app';
import * as commands from '../../document/commands';
import type { MotionNeeds } from '../../results/motion';
import { later } from '../../texts/later';
import { texts } from '../../texts/texts';

/** What the curves wait for, and where to say it. */
export function Needs({ needs }: { needs: MotionNeeds }) {
  const { services: { store }, sideTeller: { told } } = useApp();
  const words = later.curves.needs;
  switch (needs.what) {
    case 'poses':
      return <p class="joint-needs">{words.poses}</p>;
    case 'side':
      return (
        <p class="joint-needs">
          {words.side} {told && `${words.told[told]} `}
          {(['left', 'right'] as const).map((side) => (
            <button key={side} type="button" class="button small" onClick={() => store.perform(commands.setSide(side))}>
              {words.sides[side]}
            </button>
          ))}
        </p>
      );
    case 'finding':
      return <p class="joint-needs">{words.finding(texts.component[needs.component])}</p>;
    default:
      return (
        <p class="joint-needs">
          {words[needs.what](texts.component[needs.component])}{' '}
          <button type="button" class="button small" aria-haspopup="dialog" onClick={() => store.show({ component: needs.component, popover: needs.component })}>
            {later.axes.look}
          </button>
        </p>
      );
  }
}
