import { useEffect, useRef, useState } from 'preact/hooks';
import { sentenceOf } from '../jobs/services';
import { texts } from '../texts/texts';
import { loadSpace, NoWebgl } from '../stage/three/load';
import type { PlacedModel } from '../stage/three/models';
import type { SpaceView } from '../stage/three/space';

/** The view in space of a canvas once the 3-D library is there, or why there is none. */
export function useSpaceView() {
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

/** Changes when something else is to be drawn. */
export function drawingKey(models: readonly PlacedModel[]): string {
  return JSON.stringify(models.map(({ component, pose, arrows }) => [component, pose, arrows ?? []]));
}

const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-10, 0],
  ArrowRight: [10, 0],
  ArrowUp: [0, 10],
  ArrowDown: [0, -10],
};

export function turnByKey(view: SpaceView, event: KeyboardEvent): void {
  const turn = ARROWS[event.key];
  if (!turn || event.ctrlKey || event.altKey) return;
  event.preventDefault();
  event.stopPropagation();
  view.turn(...turn);
}
