import { useApp } from '../../commands/app';
import type { State } from '../../document/store';
import { texts } from '../../texts/texts';
import { EarlierWork } from './earlier_work';

/** Before there is a frame: what to bring, and what was left here earlier. */
export function EmptyState({ state }: { state: State }) {
  const { actions } = useApp();
  return (
    <section class="empty" aria-label={texts.empty.region}>
      <p class="empty-title">{texts.empty.title}</p>
      <p class="empty-text">{texts.empty.text}</p>
      <div class="empty-buttons">
        <button type="button" class="button primary" onClick={() => void actions.openDemonstration()}>
          {texts.empty.demonstration}
        </button>
        <button type="button" class="button" onClick={() => void actions.openPicked()}>
          {texts.empty.files}
        </button>
        <button type="button" class="button" title={texts.files.folderTitle} onClick={() => void actions.openFolder()}>
          {texts.files.folder}
        </button>
      </div>
      <EarlierWork state={state} isAlone />
    </section>
  );
}
