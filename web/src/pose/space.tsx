import { useEffect, useRef, useState } from 'preact/hooks';
import { currentFrame, type State } from '../document/store';
import { sentenceOf } from '../jobs/services';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { middleOf } from '../commands/model_in_hand';
import { placedModels } from '../stage/shading';
import { loadSpace, NoWebgl } from '../stage/three/load';
import type { PlacedModel } from '../stage/three/models';
import type { Side, SpaceView } from '../stage/three/space';

/** The models of the frame in space, seen from anywhere. */
export function Space({ state }: { state: State }) {
  const { services } = useApp();
  const frame = currentFrame(state);
  const models = frame ? placedModels(state, services.studio, frame) : [];
  const { canvas, view, trouble } = useSpaceView();
  const { component } = state.ui;
  const selected = models.find((model) => model.component === component) ?? models[0];
  const poses = models.map(({ pose }) => pose);
  useEffect(() => {
    if (view && selected) view.show(models, component, middleOf(selected.mesh));
  }, [view, component, ...padded(poses)]);
  const words = texts.seeing.space;
  const note = trouble ?? (selected ? (view ? '' : words.loading) : words.none);
  return (
    <section class="card space" aria-label={words.region}>
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
          {(['camera', 'side', 'above'] as const satisfies readonly Side[]).map((side) => (
            <button key={side} type="button" class="button small" disabled={!view || !selected} onClick={() => view?.look(side)}>
              {words.views[side]}
            </button>
          ))}
        </div>
        <p class="card-note" role="note">
          {note}
        </p>
      </div>
    </section>
  );
}

function useSpaceView() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [view, setView] = useState<SpaceView | null>(null);
  const [trouble, setTrouble] = useState<string | null>(null);
  useEffect(() => {
    let made: SpaceView | null = null;
    let gone = false;
    loadSpace().then(
      (Space) => {
        if (gone || !canvas.current) return;
        made = new Space(canvas.current);
        setView(made);
      },
      (error: unknown) => {
        const why = error instanceof NoWebgl ? texts.seeing.space.noWebgl : sentenceOf(error);
        if (!gone) setTrouble(texts.seeing.space.failed(why));
      },
    );
    return () => {
      gone = true;
      made?.dispose();
    };
  }, []);
  return { canvas, view, trouble };
}

/** Effects want as many things to watch each time. */
function padded<T>(values: readonly T[]): (T | null)[] {
  return [values[0] ?? null, values[1] ?? null];
}

function namesOf(models: readonly PlacedModel[]): string {
  return models.length === 0 ? texts.seeing.space.region : texts.listed(models.map(({ component }) => texts.componentTitle[component]));
}

const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-10, 0],
  ArrowRight: [10, 0],
  ArrowUp: [0, 10],
  ArrowDown: [0, -10],
};

function turnByKey(view: SpaceView, event: KeyboardEvent): void {
  const turn = ARROWS[event.key];
  if (!turn || event.ctrlKey || event.altKey) return;
  event.preventDefault();
  event.stopPropagation();
  view.turn(...turn);
}
