import { PREPROCESSINGS, OVERLAY_STYLES } from '../terms/seeing';
import type { State } from '../document/store';
import { seeingKey, type SeeingAction } from '../commands/seeing_bindings';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { Segments, Toggle } from '../controls/segments';

/** All of how things are shown, each with its key. */
export function ViewSheet({ state }: { state: State }) {
  const { seeing: actions } = useApp();
  const { seeing } = state.ui;
  const words = texts.seeing;
  const preprocessings = PREPROCESSINGS.map((value) => ({ value, title: words.preprocessings[value], key: seeingKey({ name: 'preprocessing', preprocessing: value }) }));
  const overlays = OVERLAY_STYLES.map((value) => ({ value, title: words.overlays[value], key: seeingKey({ name: 'overlay', style: value }) }));
  const toggle = (action: SeeingAction, label: string, on: boolean, disabled = false) => (
    <Toggle label={label} keyShown={seeingKey(action)} on={on} disabled={disabled} onToggle={() => actions.run(action)} />
  );
  return (
    <div class="sheet-body">
      <Segments label={words.preprocessing} shown options={preprocessings} value={seeing.preprocessing} onChoose={(preprocessing) => actions.run({ name: 'preprocessing', preprocessing })} />
      <Segments label={words.overlay} shown options={overlays} value={seeing.overlay} onChoose={(style) => actions.run({ name: 'overlay', style })} />
      <div class="toggles" role="group" aria-label={words.besides}>
        {toggle({ name: 'magnifier' }, words.magnifier, seeing.magnifier)}
        {toggle({ name: 'scale-bar' }, words.scaleBar, seeing.scaleBar)}
        {toggle({ name: 'ghosts' }, words.ghosts, seeing.ghosts)}
        {toggle({ name: 'compare' }, words.compare, seeing.comparing, !state.history.present.reference)}
      </div>
      <p class="sheet-text quiet">{words.remembered}</p>
    </div>
  );
}
