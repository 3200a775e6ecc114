import { currentCell, currentFrame, currentPlace, type Store } from '../document/store';
import type { Outline } from '../document/types';
import type { ComponentName } from '../terms/component';
import { Aborted, type Bridge } from '../workers/bridge';
import type { LandscapeFacts } from '../workers/protocol/by_hand';
import { cameraOf, poseKey } from '../results/keys';
import { Pause } from './pause';
import { flatten } from './poser';
import type { PoseProtocol } from '../workers/protocol/pose';
import type { MatchInput } from '../workers/protocol/match';
import { sentenceOf } from './services';

export type Scored = { readonly key: string; readonly facts: LandscapeFacts } | { readonly key: string; readonly refusal: string };

/** So many are kept, of the outlines that were scored last. */
const KEPT = 16;

/** How long an outline has to be at rest before all views are scored, ms. */
const REST = 200;

/** Scores every view for the outline on view, while somebody looks at that. */
export class Landscapes {
  readonly #store: Store;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  readonly #scored = new Map<Outline, Scored>();
  readonly #pause = new Pause();
  #busy = false;

  constructor(store: Store, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#store = store;
    this.#worker = worker;
    store.subscribe(() => this.#consider());
  }

  /** Null while it is on its way, or nothing can be scored. */
  of(outline: Outline | null): Scored | null {
    return (outline && this.#scored.get(outline)) ?? null;
  }

  /** The pose of one view for the outline on view. Throws where there is none to ask for. */
  async pose(view: number): Promise<PoseProtocol['viewPose']['output'] | null> {
    const asked = this.#asked();
    return asked && this.#worker.call('viewPose', { ...asked.input, view });
  }

  #consider(): void {
    this.#pause.end();
    const asked = this.#asked();
    if (this.#busy || !asked || this.#store.ui.seeing.picture !== 'landscape') return;
    if (this.#scored.get(asked.outline)?.key === asked.key) return;
    this.#pause.before(REST, () => void this.#score(asked));
  }

  #asked(): { outline: Outline; component: ComponentName; key: string; input: MatchInput } | null {
    const { state, doc } = this.#store;
    const { outline } = currentCell(state);
    const place = currentPlace(state);
    const frame = currentFrame(state);
    const camera = cameraOf(doc, frame);
    if (!outline?.closed || !place || !frame || !camera) return null;
    const { component } = place;
    const key = poseKey(doc, component, frame);
    if (!key || state.ui.libraries[component].state !== 'ready') return null;
    return { outline, component, key, input: { component, ...flatten(outline), camera } };
  }

  async #score({ outline, key, input }: { outline: Outline; key: string; input: MatchInput }): Promise<void> {
    this.#busy = true;
    try {
      this.#scored.set(outline, { key, facts: await this.#worker.call('landscape', input) });
    } catch (error) {
      if (!(error instanceof Aborted)) this.#scored.set(outline, { key, refusal: sentenceOf(error) });
    } finally {
      this.#busy = false;
      for (const oldest of [...this.#scored.keys()].slice(0, -KEPT)) this.#scored.delete(oldest);
      // No part of the state: the views are notified all the same.
      this.#store.show({});
    }
  }
}
