import { useEffect, useRef, useState } from 'preact/hooks';
import { currentFrame, type State } from '../document/store';
import type { Doc } from '../document/types';
import { viewpointOf, type ViewName } from '../geometry/axes';
import { rotationOf } from '../geometry/pose_motion';
import { axesInWords, namedArrows } from '../results/axes_words';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { Icon } from '../controls/icons';
import { placedModels } from '../stage/shading';
import type { PlacedModel } from '../stage/three/models';
import { useBesideFrame } from './beside';
import { drawingKey, turnByKey, useSpaceView } from './space_view';

const VIEWS: readonly ViewName[] = ['camera', 'front', 'side', 'above'];

/** The models of the frame in space with their anatomical axes, seen from anywhere. */
export function Space({ state }: { state: State }) {
  const { services } = useApp();
  const frame = currentFrame(state);
  const doc = state.history.present;
  const { component } = state.ui;
  const placed = frame ? placedModels(state, services.studio, frame) : [];
  const models = placed.map((model) => withArrows(model, doc, model.component === component));
  const { canvas, view, trouble } = useSpaceView();
  const host = useRef<HTMLElement>(null);
  const [large, setLarge] = useState(false);
  useBesideFrame(host, large);
  const selected = models.find((model) => model.component === component) ?? models[0];
  const axes = selected ? doc.components[selected.component].axes : null;
  useEffect(() => {
    view?.show(models);
  }, [view, selected?.mesh, drawingKey(models)]);
  const words = texts.seeing.space;
  const look = (name: ViewName) => selected && view?.look(viewpointOf(name, rotationOf(selected.pose), axes?.told === 'all' ? axes.directions : null, doc.side));
  const told = axes?.told === 'all' ? axesInWords(axes.directions, doc.side) : '';
  const note = trouble ?? (selected ? (view ? told : words.loading) : words.none);
  return (
    <section ref={host} class={large ? 'card space large' : 'card space'} aria-label={words.region}>
      <canvas
        ref={canvas}
        class="space-canvas"
        tabIndex={0}
        role="application"
        data-arrows
        aria-label={words.canvas(namesOf(models))}
        onKeyDown={(event) => view && turnByKey(view, event)}
      />
      <div class="space-foot">
        <div class="space-sides" role="group" aria-label={words.looking}>
          {VIEWS.map((name) => (
            <button key={name} type="button" class="button small" disabled={!view || !selected || (name === 'front' && axes?.told !== 'all')} onClick={() => look(name)}>
              {words.views[name]}
            </button>
          ))}
          <button type="button" class="button square small" aria-label={words.large} title={words.large} aria-pressed={large} onClick={() => setLarge(!large)}>
            <Icon name="fit" />
          </button>
        </div>
        <p class="card-note" role="note">
          {note}
        </p>
      </div>
    </section>
  );
}

/** Arrows of both, names of the selected one: two sets of names would lie on each other. */
function withArrows(model: PlacedModel, doc: Doc, named: boolean): PlacedModel {
  const { axes } = doc.components[model.component];
  const arrows = axes ? namedArrows(axes, doc.side) : [];
  return { ...model, arrows: arrows.map(({ name, direction }) => ({ direction, name: named ? name : null })) };
}

function namesOf(models: readonly PlacedModel[]): string {
  return models.length === 0 ? texts.seeing.space.region : texts.listed(models.map(({ component }) => texts.componentTitle[component]));
}
