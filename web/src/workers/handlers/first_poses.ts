import { type FrameImage, FrameSearch, searchDistances, SearchPlan, shapeAxes } from '../../pkg/core/fluoropose_wasm.js';
import { directionsFrom, numbersOf } from '../../geometry/axes';
import { middleOf } from '../../geometry/mesh_middle';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import type { ClickOutcome, Discovery, FindInput, FirstPosesProtocol, Known, Member, PlanState, SearchInput, StepAnswer } from '../protocol/first_poses';
import { poseArray, poseFrom } from '../protocol/pose_array';
import { withImage } from './frame_pixels';
import type { Context, Handlers } from './serve';

const NONE = new Float64Array();
const WAYS = [0, 1];

/** Looks for one component in frames, where nobody pointed at it or where it was lost. */
export class Searcher {
  #search: FrameSearch | null = null;
  /** What frames are searched with: opened with the first one, because most films need none, and it takes as long as some frames. */
  #open: (() => FrameSearch) | null = null;
  #film: Float64Array = NONE;

  /** Whether there is anything to search with. */
  get isOpen(): boolean {
    return this.#search !== null || this.#open !== null;
  }

  get pose(): Float64Array | undefined {
    return this.#search?.pose;
  }

  open(input: SearchInput): void {
    this.#search?.free();
    this.#search = null;
    this.#film = NONE;
    this.#open = () => opened(input);
  }

  knowFilm(film: Float64Array): void {
    this.#film = film;
    this.#search?.knowFilm(film);
  }

  /** Searches a frame in steps of some tens of milliseconds, so that it can be called off between them. */
  async find(
    image: FrameImage,
    { beside, places }: Pick<FindInput, 'beside' | 'places'>,
    { report, breathe }: Context<{ readonly fraction: number }>,
  ): Promise<Discovery | null> {
    const search = this.own();
    search.beside(beside ? numbers(beside.pose) : NONE, beside?.inJoint ?? false);
    search.lookAt(places);
    for (let more = search.step(image, true); more; more = search.step(image, false)) {
      report({ fraction: search.progress });
      await breathe();
    }
    const { place, pose, score = 0 } = search;
    return place && pose ? { place: [place[0] ?? 0, place[1] ?? 0], pose: poseFrom(pose), score } : null;
  }

  own(): FrameSearch {
    if (this.#search) return this.#search;
    if (!this.#open) throw new Error('nothing is looked for');
    this.#search = this.#open();
    this.#open = null;
    this.#search.knowFilm(this.#film);
    return this.#search;
  }
}

export function firstPoses(ready: Promise<unknown>, searcher: Searcher): Handlers<FirstPosesProtocol> {
  const planner = new Planner();
  return {
    plan: async (input) => {
      await ready;
      return planner.begin(input);
    },
    planned: (answer) => planner.take(answer),
    distances: async ({ camera: { text, width, height }, told, depth }) => {
      await ready;
      return [...searchDistances(text, width, height, told ?? undefined, depth ?? undefined)];
    },
    openSearch: async (input) => {
      await ready;
      searcher.open(input);
      return null;
    },
    addLibrary: ({ library }) => {
      searcher.own().addLibrary(library);
      return null;
    },
    isBright: ({ pose, ...pixels }) => withImage(pixels, async (image) => searcher.own().isBright(image, numbers(pose))),
    find: ({ beside, bright, library, places, ...pixels }, context) =>
      withImage(pixels, (image) => {
        searcher.own().showBright(bright);
        searcher.own().useLibrary(library);
        return searcher.find(image, { beside, places }, context);
      }),
    beginWalk: ({ frame, pose, frames, bright, goal }) => {
      const search = searcher.own();
      search.showBright(bright);
      if (goal === null) search.beginWalk(frame, numbers(pose), frames);
      else search.beginWalkTo(goal, frame, numbers(pose));
      return search.walkWanted() ?? null;
    },
    walk: (pixels) =>
      withImage(pixels, async (image) => {
        const search = searcher.own();
        search.walkTake(image);
        return { next: search.walkWanted() ?? null, ends: search.walkEnds() as Float64Array<ArrayBuffer> };
      }),
    isBrightNear: ({ place, ...pixels }) => withImage(pixels, async (image) => searcher.own().isBrightNear(image, ...place)),
    clickStands: ({ pose, bright, ...pixels }) =>
      withImage(pixels, async (image) => {
        const search = searcher.own();
        search.showBright(bright);
        const standing = search.clickStands(image, numbers(pose));
        const { score, convinces } = standing;
        standing.free();
        return { score, convinces };
      }),
    clickOutcome: ({ frame, pose, place, ...pixels }) =>
      withImage(pixels, async (image) => searcher.own().clickOutcome(image, frame, numbers(pose), ...place) as ClickOutcome),
  };
}

/** The order of work, which the core has. */
class Planner {
  #plan: SearchPlan | null = null;
  #count = 0;

  begin({ frames, told, parts }: FirstPosesProtocol['plan']['input']): PlanState {
    this.#plan?.free();
    const plan = (this.#plan = new SearchPlan(frames, told));
    this.#count = parts.length;
    for (const part of parts) {
      plan.add(part.component === 'femur', limbOf(part) !== null, ...middleOf(part.mesh));
      for (const { frame, pose } of part.known) plan.know(frame, numbers(pose));
    }
    return this.#state(plan);
  }

  take(answer: StepAnswer): PlanState {
    const plan = this.#plan;
    if (!plan) throw new Error('nothing is looked for');
    if ('ends' in answer) plan.followed(answer.ends);
    else plan.found(answer.found ? numbers(answer.found.pose) : undefined, answer.found?.score ?? 0);
    return this.#state(plan);
  }

  #state(plan: SearchPlan): PlanState {
    const step = plan.wanted();
    const known = (way: number, part: number): Known | null => {
      const all = plan.known(way, part);
      return all ? { frame: all[0]!, pose: poseFrom(all.subarray(1)) } : null;
    };
    const state = {
      step: step
        ? { way: step.way, part: step.part, frame: step.frame, search: step.search as 'whole', places: step.places as 'all', depth: step.depth ?? null, known: step.known ? poseFrom(step.known) : null }
        : null,
      known: WAYS.map((way) => Array.from({ length: this.#count }, (_, part) => known(way, part))),
      way: plan.way ?? null,
    };
    step?.free();
    return state;
  }
}

function opened({ mesh, camera: { text, width, height }, library, bright, other, ...own }: SearchInput): FrameSearch {
  const search = new FrameSearch(library, mesh.vertices, mesh.triangles, text, width, height);
  search.showBright(bright);
  const limb = limbOf({ mesh, ...own });
  if (limb) search.knowLimb(own.component === 'femur', limb.axes, limb.front);
  const beside = other && limbOf(other);
  if (other) search.knowOther(other.mesh.vertices, other.mesh.triangles, beside?.axes ?? NONE, beside?.front ?? false);
  return search;
}

/** Axes with their signs, without which a joint does not tell where its other component is; null where they are not known. */
function limbOf({ component, mesh, axes }: Member): { readonly axes: Float64Array; readonly front: boolean } | null {
  const known = axes ?? shapeOf(component, mesh);
  const isTold = known.told === 'all' || known.told === 'not the front';
  return isTold ? { axes: numbersOf(known.directions), front: known.told === 'all' } : null;
}

function shapeOf(component: string, mesh: Member['mesh']): Pick<NonNullable<Member['axes']>, 'directions' | 'told'> {
  const found = shapeAxes(mesh.vertices, mesh.triangles, component === 'femur');
  const axes = { directions: directionsFrom(found.directions), told: found.told as 'all' };
  found.free();
  return axes;
}

function numbers(pose: PoseNumbers): Float64Array {
  return Float64Array.from(poseArray(pose));
}
