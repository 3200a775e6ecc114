import { useLater } from '../../commands/later';
import { useApp } from '../../commands/app';
import type { State } from '../../document/store';
import { motionNeeds } from '../../results/motion';
import { hasBothComponents, standingOf } from '../../results/steps';
import { texts } from '../../texts/texts';

const load = () => import('./curves');

/** How the joint moves: one line until somebody opens it, then curves. */
export function JointDock({ state }: { state: State }) {
  const { services } = useApp();
  const { popover, exporting } = state.ui;
  const { open, height, over } = state.ui.joint;
  const doc = state.history.present;
  const loaded = useLater(open, load);
  // There is a place for it as soon as a joint can come about: the frame must not jump when the first pose does.
  if (!hasBothComponents(doc)) return null;
  const words = texts.joint;
  // One line that says what is missing needs no more room than that.
  const isDrawn = open && motionNeeds(doc) === null && (over !== 'time' || doc.rate !== null);
  return (
    <section class="joint" aria-label={words.region} style={isDrawn ? { height: `${100 * height}vh` } : undefined}>
      <div class="joint-head">
        <button
          type="button"
          class="joint-toggle"
          aria-expanded={open}
          aria-keyshortcuts="Shift+K"
          title={texts.withKey(open ? words.close : words.open, 'Shift + K')}
          onClick={() => services.store.setJoint({ open: !open })}
        >
          <span class="joint-sign" aria-hidden="true" /> {words.title}
        </button>
        {open && loaded && <loaded.JointTools state={state} />}
        <button
          type="button"
          class={open && standingOf(doc).step === 'joint' ? 'button small primary' : 'button small'}
          title={words.saveTitle}
          aria-haspopup="dialog"
          aria-expanded={popover === 'export'}
          onClick={() => services.store.show({ popover: popover === 'export' ? null : 'export', exporting: { ...exporting, kind: 'joint' } })}
        >
          {words.save}
        </button>
      </div>
      {open && loaded && <loaded.Curves state={state} />}
    </section>
  );
}
