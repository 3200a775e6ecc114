import { useEffect, useState } from 'preact/hooks';
import type { State } from '../../document/store';
import { openKept, startAnew } from '../../keep/restore';
import type { KeptWork } from '../../keep/shelf';
import { sentenceOf } from '../../jobs/services';
import { texts } from '../../texts/texts';
import { useApp } from '../../commands/app';

/** What else this browser keeps, to be opened or deleted. `isAlone`: nothing is open; then it is there only where there is some. */
export function EarlierWork({ state, isAlone = false }: { state: State; isAlone?: boolean }) {
  const { services, keeper } = useApp();
  const { store } = services;
  const [works, setWorks] = useState<readonly KeptWork[] | null>(null);
  const { work: current } = state.history.present;
  const look = async () => setWorks(await (await keeper.shelf()).works());
  const trying = (job: () => Promise<void>) => void job().catch((error: unknown) => store.say('error', sentenceOf(error)));
  useEffect(() => trying(look), [current]);
  const others = works?.filter(({ id }) => id !== current) ?? [];
  const remove = async ({ id, name }: KeptWork) => {
    await keeper.discard(id);
    await look();
    store.say('info', texts.keep.deleted(name));
  };
  if (isAlone && others.length === 0) return null;
  return (
    <section class="earlier" aria-label={texts.keep.earlier}>
      <h3>{texts.keep.earlier}</h3>
      {others.length === 0 && <p class="sheet-text quiet">{texts.keep.noEarlier}</p>}
      {others.map((work) => (
        <Row key={work.id} work={work} onOpen={() => trying(() => openKept(services, keeper, work.id))} onDelete={() => trying(() => remove(work))} />
      ))}
      {!isAlone && (
        <div class="sheet-buttons">
          <button type="button" class="button" title={texts.withKey(texts.keep.startAnew, 'Shift+Alt+N')} disabled={current === ''} onClick={() => startAnew(services)}>
            {texts.keep.startAnew}
          </button>
          <PersistButton />
        </div>
      )}
    </section>
  );
}

interface RowProps {
  readonly work: KeptWork;
  readonly onOpen: () => void;
  readonly onDelete: () => void;
}

/** Deleting asks twice: it is the one thing here that cannot be taken back. */
function Row({ work, onOpen, onDelete }: RowProps) {
  const [sure, setSure] = useState(false);
  const { name, frames, savedAt } = work;
  const { keep } = texts;
  return (
    <div class="earlier-row">
      <span>{keep.row(name, frames, new Date(savedAt).toLocaleString())}</span>
      <button type="button" class="button small" aria-label={keep.openRowLabel(name)} onClick={onOpen}>
        {keep.openRow}
      </button>
      <button
        type="button"
        class="button small"
        aria-label={sure ? keep.reallyDeleteLabel(name) : keep.deleteRowLabel(name)}
        onBlur={() => setSure(false)}
        onClick={() => (sure ? onDelete() : setSure(true))}
      >
        {sure ? keep.reallyDelete : keep.deleteRow}
      </button>
    </div>
  );
}

/** Browsers clear what a page keeps when the disk fills up, unless the person asked them not to. */
function PersistButton() {
  const { store } = useApp().services;
  const [persisted, setPersisted] = useState(true);
  useEffect(() => void navigator.storage?.persisted?.().then(setPersisted), []);
  if (persisted) return null;
  const ask = async () => {
    const granted = await navigator.storage.persist();
    setPersisted(granted);
    store.say('info', granted ? texts.keep.persisted : texts.keep.notPersisted);
  };
  return (
    <button type="button" class="button" onClick={() => void ask()}>
      {texts.keep.persist}
    </button>
  );
}
