import type { LibrarySpec } from '../../document/types';
import type { CameraInput } from './camera';
import type { ModelMesh } from './decode';

export interface LibraryFacts {
  readonly views: number;
  readonly bytes: number;
}

/** What a library is built from. */
export interface LibraryPlan {
  readonly mesh: ModelMesh;
  readonly camera: CameraInput;
  readonly spec: LibrarySpec;
}

export interface LibraryProtocol {
  /** Forgets the plan before; gives the number of views. */
  plan: { input: LibraryPlan; output: number; progress: never };
  /** Some views, drawn and packed. */
  pack: { input: { first: number; count: number }; output: Uint8Array<ArrayBuffer>; progress: never };
  /** The library of all views, packed by workers of the same plan, in their order. */
  assemble: { input: { parts: readonly Uint8Array<ArrayBuffer>[] }; output: Uint8Array<ArrayBuffer>; progress: never };
}
