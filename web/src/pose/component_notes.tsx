import { isAssumed } from '../document/axes';
import { swapModels } from '../document/commands';
import type { State } from '../document/store';
import { cellOf, chosenCandidate, type Component } from '../document/types';
import { takeInMillimetres } from '../exchange/model_unit';
import { sentenceOf } from '../jobs/services';
import type { ComponentName } from '../terms/component';
import { misplacedModels } from '../results/misplaced';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { Icon } from '../controls/icons';

/** What a person should know of the selected component's model, and what only a person can tell of it. */
export function ComponentNotes({ state }: { state: State }) {
  const { component } = state.ui;
  return (
    <>
      <MisplacedCard state={state} />
      <RemarksCard state={state} component={component} />
      <AxesCard state={state} component={component} />
    </>
  );
}

/** A model that was taken by its name for what it is not, whichever component is on view. */
function MisplacedCard({ state }: { state: State }) {
  const { studio, store } = useApp().services;
  const doc = state.history.present;
  const { components, canSwap } = misplacedModels(doc, (sha256) => studio.shapeOf(sha256));
  const key = `shape ${components.map((component) => doc.components[component].model?.sha256).join(' ')}`;
  if (components.length === 0 || state.ui.dismissed.includes(key)) return null;
  const words = later.models;
  const said = components.map((component) => words.misplaced(doc.components[component].model?.name ?? '', words.shape[component], texts.component[component]));
  return (
    <section class="card note" aria-label={words.card}>
      <p class="card-note">{[...said, ...(components.length > 1 ? [words.swapped] : [])].join(' ')}</p>
      {canSwap && (
        <button type="button" class="button small primary" title={words.swapTitle} onClick={() => store.perform(swapModels())}>
          {words.swap}
        </button>
      )}
      <button type="button" class="button square small" aria-label={words.dismiss} onClick={() => store.show({ dismissed: [...state.ui.dismissed, key] })}>
        <Icon name="close" />
      </button>
    </section>
  );
}

function RemarksCard({ state, component }: { state: State; component: ComponentName }) {
  const { studio, store } = useApp().services;
  const { model } = state.history.present.components[component];
  const remarks = model ? studio.remarksOn(model.sha256) : [];
  if (!model || remarks.length === 0 || state.ui.dismissed.includes(model.sha256)) return null;
  const words = later.models;
  return (
    <section class="card note" aria-label={words.card}>
      <p class="card-note">{words.remarks(model.name, remarks)}</p>
      <UnitButtons component={component} sha256={model.sha256} />
      <button
        type="button"
        class="button square small"
        aria-label={words.dismiss}
        title={words.dismissTitle}
        onClick={() => store.show({ dismissed: [...state.ui.dismissed, model.sha256] })}
      >
        <Icon name="close" />
      </button>
    </section>
  );
}

/** Where a model's size speaks for another unit than millimetres, a person says which: two of them look alike. */
export function UnitButtons({ component, sha256 }: { component: ComponentName; sha256: string }) {
  const { services } = useApp();
  const units = services.studio.suspectedUnitsOf(sha256);
  if (units.length === 0) return null;
  const take = (mm: number) => takeInMillimetres(services, component, mm).catch((error) => services.store.say('error', sentenceOf(error)));
  return (
    <div class="card-buttons">
      {units.map((mm) => (
        <button key={mm} type="button" class="button small primary" title={later.models.isInTitle(mm)} onClick={() => void take(mm)}>
          {later.models.isIn(mm)}
        </button>
      ))}
    </div>
  );
}

/** Poses of a component without a model are taken in their own axes, and that is said. */
function questionOf(about: Component, isPosed: boolean): ((component: string) => string) | null {
  const { cardText } = later.axes;
  if (isAssumed(about)) return isPosed ? cardText.assumed : null;
  if (!about.axes || about.axes.told === 'all') return null;
  return about.axes.told === 'not the front' ? cardText.front : cardText.axes;
}

/** Asked where the shape does not tell; nothing waits for the answer but what speaks of front and back. */
function AxesCard({ state, component }: { state: State; component: ComponentName }) {
  const { store } = useApp().services;
  const doc = state.history.present;
  const about = doc.components[component];
  const words = later.axes;
  const say = questionOf(about, doc.frames.some(({ id }) => chosenCandidate(cellOf(doc, id, component)) !== null));
  if (!say) return null;
  return (
    <section class="card note" aria-label={words.card}>
      <p class="card-note">{say(texts.component[component])}</p>
      <button type="button" class="button small" aria-haspopup="dialog" aria-expanded={state.ui.popover === component} onClick={() => store.show({ popover: component })}>
        {words.look}
      </button>
    </section>
  );
}
