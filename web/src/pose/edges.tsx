import { useEffect, useRef } from 'preact/hooks';
import { useApp } from '../commands/app';
import { currentCell, type State } from '../document/store';
import { chosenCandidate } from '../document/types';
import { texts } from '../texts/texts';
import { paintEdges, TIMES } from './edges_picture';

/** As the style sheet has it, twice as fine. */
const [WIDTH, HEIGHT] = [600, 300];

/** Where the frame's edges lie beside the outline of the model on view: what a pose that no outline led to rests on. */
export function Edges({ state }: { state: State }) {
  const { edges } = useApp();
  const canvas = useRef<HTMLCanvasElement>(null);
  const candidate = chosenCandidate(currentCell(state));
  const facts = edges.of(candidate);
  const { component } = state.ui;
  const words = texts.seeing.edges;
  useEffect(() => {
    const context = canvas.current?.getContext('2d');
    if (context && facts) paintEdges(context, facts, component);
  }, [facts, component]);
  return (
    <section class="card edges" aria-label={words.region}>
      {facts && <canvas ref={canvas} width={WIDTH} height={HEIGHT} role="img" aria-label={words.picture(TIMES)} />}
      <p class="card-note">{facts ? words.met(facts, TIMES) : candidate ? words.reading : words.none}</p>
    </section>
  );
}
