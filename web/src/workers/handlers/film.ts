import { type FilmFacts as RawFacts, FilmSquares, FilmStudy, statedFilm, statedFilmWords } from '../../pkg/core/fluoropose_wasm.js';
import type { FilmConstants } from '../../document/types';
import { COMPONENT_NAMES, type ComponentName } from '../../terms/component';
import { squareOf } from '../../document/film';
import type { FilmFacts, FilmProtocol, ReadProfiles, SquaresState } from '../protocol/film';
import { loadCore } from './core_module';
import { serve } from './serve';

/** Keeps the profiles of a study's frames and estimates its film from them, beside the worker that finds poses: nobody waits. */
const ready = loadCore();
let study: { readonly side: number; readonly film: FilmStudy } | null = null;
let squares: FilmSquares | null = null;

serve<FilmProtocol>({
  estimate: async ({ read, stated, side }) => {
    await ready;
    if (stated.constants) return asStated(stated.constants);
    const kept = takeAll(read, side);
    const found = told(kept.estimate(stated.display ?? undefined, stated.blur ?? undefined), COMPONENT_NAMES);
    const clipped = found === null && kept.clipped();
    return clipped ? { clipped } : found;
  },
  learntAgain: async ({ followed, stated }) => {
    await ready;
    const asked = FilmStudy.inSquares(squareOf(followed[0]?.known ?? null));
    // Of these frames alone, by the places of their components here.
    followed.forEach(({ known, read }, place) => {
      asked.know(Float64Array.from(known));
      for (const { frame, profiles } of read) asked.take(place, frame, profiles);
    });
    const facts = asked.learntAgain(stated.display ?? undefined, stated.blur ?? undefined);
    asked.free();
    return told(facts, followed.map(({ component }) => component));
  },
  beginSquares: async ({ stated }) => {
    await ready;
    squares?.free();
    squares = new FilmSquares(stated.constants?.blur ?? stated.blur ?? undefined);
    return stateOf(squares, squares.wanted === undefined);
  },
  takeSquares: async ({ read, stated }) => {
    await ready;
    if (!squares) throw new Error('no squares are looked for');
    const tried = FilmStudy.inSquares(squares.wanted ?? squares.side);
    for (const { component, frame, profiles } of read) tried.take(COMPONENT_NAMES.indexOf(component), frame, profiles);
    const facts = tried.estimate(stated.display ?? undefined, undefined);
    squares.take(facts);
    tried.free();
    return stateOf(squares, facts !== undefined);
  },
  take: async ({ read, side }) => {
    await ready;
    takeAll(read, side);
    return null;
  },
});

function stateOf({ wanted, side }: FilmSquares, isTold: boolean): SquaresState {
  return { wanted: wanted ?? null, side, isTold };
}

function takeAll(read: readonly ReadProfiles[], side: number): FilmStudy {
  if (study?.side !== side) {
    study?.film.free();
    study = { side, film: FilmStudy.inSquares(side) };
  }
  const { film } = study;
  for (const { component, frame, profiles } of read) film.take(COMPONENT_NAMES.indexOf(component), frame, profiles);
  return film;
}

/** `components`: by their numbers in what was estimated. */
function told(facts: RawFacts | undefined, components: readonly ComponentName[]): FilmFacts | null {
  if (!facts) return null;
  const { words, blur, curved, profiles } = facts;
  const model = (component: ComponentName) => known(Array.from(facts.model(components.indexOf(component)) ?? []));
  const models = { femur: model('femur'), tibia: model('tibia') };
  facts.free();
  return { words, blur, curved, profiles, models };
}

function asStated({ curvature, blur, attenuation }: FilmConstants): FilmFacts {
  const of = (component: ComponentName) => {
    const own = attenuation[component];
    return own === null ? null : Array.from(statedFilm(curvature, blur, own));
  };
  return { words: statedFilmWords(curvature, blur), blur, curved: 0, profiles: 0, models: { femur: of('femur'), tibia: of('tibia') } };
}

function known(numbers: readonly number[] | undefined): readonly number[] | null {
  return numbers?.length ? numbers : null;
}
