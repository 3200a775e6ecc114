import { currentCell, type State } from '../document/store';
import { TOOLS } from '../interaction/tools';
import type { ToolName } from '../terms/tool';
import { useApp } from '../commands/app';
import { Icon, type IconName } from '../controls/icons';
import { texts } from '../texts/texts';

const ICONS: Readonly<Record<ToolName, IconName>> = {
  edit: 'pointer',
  trace: 'polygon',
  wire: 'wire',
  threshold: 'threshold',
  'one-click': 'wand',
  brush: 'brush',
  transform: 'transform',
  stretch: 'stretch',
  pose: 'pose',
  hand: 'hand',
  window: 'contrast',
};

export function Rail({ state }: { state: State }) {
  const { actions } = useApp();
  return (
    <nav class="rail" aria-label={texts.panel.rail.region}>
      {TOOLS.map(({ name, key, title }) => (
        <button
          key={name}
          type="button"
          class="tool"
          aria-label={title}
          aria-pressed={state.ui.tool === name}
          aria-keyshortcuts={key}
          title={texts.withKey(title, key.toUpperCase())}
          onClick={() => actions.run({ name: 'tool', tool: name })}
        >
          <Icon name={ICONS[name]} />
          <KeyHint shown={key.toUpperCase()} />
        </button>
      ))}
      <button
        type="button"
        class="tool"
        aria-label={texts.panel.rail.markSide}
        aria-keyshortcuts="u"
        title={texts.panel.rail.markSideTitle}
        disabled={!currentCell(state).outline?.closed}
        onClick={() => actions.toggleUnknownSide()}
      >
        <Icon name="dashed" />
        <KeyHint shown="U" />
      </button>
      <span class="rail-gap" />
      <button type="button" class="tool" aria-label={texts.panel.rail.fit} aria-keyshortcuts="0" title={texts.panel.rail.fitTitle} onClick={() => actions.run({ name: 'fit' })}>
        <Icon name="fit" />
        <KeyHint shown="0" />
      </button>
    </nav>
  );
}

/** Drawn by the style sheet: the key is no part of the button's name, voice control would take it for one. */
function KeyHint({ shown }: { shown: string }) {
  return <kbd aria-hidden="true" data-shown={shown} />;
}
