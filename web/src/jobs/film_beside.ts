import { type Doc, cellOf, chosenCandidate } from '../document/types';
import type { Vector } from '../geometry/pose_motion';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { isSamePlace } from '../results/film';
import type { ComponentName } from '../terms/component';
import type { ReadProfiles } from '../workers/protocol/film';

/** What was read of the film around poses of a component, and in the frames beside them. */
export interface Beside {
  /** SHA-256 of the model. */
  readonly model: string;
  readonly anchors: readonly { readonly frameId: string; readonly pose: PoseNumbers }[];
  readonly read: readonly ReadProfiles[];
}

/**
 * Profiles beside poses, between the follower that reads them and the worker that estimates the film from them. They stay when a pose
 * is corrected, so that the film does not depend on how often that was done; they go with the poses or the model.
 */
export class ReadBeside {
  readonly #known = new Map<ComponentName, { readonly beside: Beside; isTaken: boolean }>();
  /** The worker has them, and must not. */
  #gone: readonly ReadProfiles[] = [];

  get isEmpty(): boolean {
    return this.#known.size === 0;
  }

  /** Is there anything that the worker does not know? */
  get isNews(): boolean {
    return this.#gone.length > 0 || [...this.#known.values()].some(({ isTaken }) => !isTaken);
  }

  has(component: ComponentName): boolean {
    return this.#known.has(component);
  }

  set(component: ComponentName, beside: Beside): void {
    this.#drop(component);
    this.#known.set(component, { beside, isTaken: false });
  }

  /** Drops what was read of another model, or around poses that are there no more. `middleOf`: of a component's model. */
  keepTo(doc: Doc, middleOf: (component: ComponentName) => Vector): void {
    for (const [component, { beside }] of this.#known) {
      const isThere = beside.anchors.every(({ frameId, pose }) => {
        const now = doc.frames.some(({ id }) => id === frameId) ? chosenCandidate(cellOf(doc, frameId, component))?.pose : undefined;
        return now !== undefined && isSamePlace(now, pose, middleOf(component));
      });
      if (!isThere || doc.components[component].model?.sha256 !== beside.model) this.#drop(component);
    }
  }

  /** What the worker is to take or to forget, in this order, but for frames in which a pose itself is read. Afterwards it knows them. */
  handOver(isReadItself: (component: ComponentName, frame: number) => boolean): readonly ReadProfiles[] {
    const handed = [...this.#gone];
    this.#gone = [];
    for (const entry of this.#known.values()) {
      if (!entry.isTaken) handed.push(...entry.beside.read);
      entry.isTaken = true;
    }
    return handed.filter(({ component, frame }) => !isReadItself(component, frame));
  }

  /** The profiles of a frame in which a pose itself is read no more. */
  inPlaceOf(component: ComponentName, frame: number): ReadProfiles {
    const read = this.#known.get(component)?.beside.read.find((one) => one.frame === frame);
    return read ?? { component, frame, profiles: new Float32Array() };
  }

  /** What was read in other squares is of no use. */
  clear(): void {
    this.#known.clear();
    this.#gone = [];
  }

  /** What the worker knew may be gone with it. */
  forgotten(): void {
    for (const entry of this.#known.values()) entry.isTaken = false;
  }

  #drop(component: ComponentName): void {
    const known = this.#known.get(component);
    this.#known.delete(component);
    if (known?.isTaken) this.#gone = [...this.#gone, ...known.beside.read.map(({ frame }) => ({ component, frame, profiles: new Float32Array() }))];
  }
}
