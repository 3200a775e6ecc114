import { checkSources, checkStated } from './asked.js';
import { type FilmFacts, FilmSquares, FilmStudy, statedFilm } from './pkg/core/fluoropose_wasm.js';
import type { FilmConstants, Grey, Hints, Pose, StatedFilm } from './types.js';

/** Who reads profiles across the outline of its model: an `Implant`. */
export interface Reader {
  profiles(image: Grey, pose: Pose, squarePx?: number): Float32Array;
}

/** A frame in which an implant has a pose, which need only be near. */
export interface FilmSource {
  readonly implant: Reader;
  readonly image: Grey;
  readonly pose: Pose;
}

/** The core tells so many implants apart. */
const MOST = 2;

/**
 * What the frames of a study tell of their film: all of one film, one or two implants. Null where they do not tell. One implant
 * alone does not tell a logarithmic display from a sharpened picture: the film is then taken to be in the middle, and depth is
 * shown as that uncertain.
 */
export function estimateFilm(sources: readonly FilmSource[], stated: StatedFilm = {}): FilmConstants | null {
  checkSources(sources);
  checkStated(stated);
  const implants = [...new Set(sources.map(({ implant }) => implant))];
  if (implants.length > MOST) throw new Error(`A film is estimated from one or two implants, not from ${implants.length}`);
  const facts = factsOf(sources, implants, squareOf(sources, implants, stated), stated);
  if (!facts) return null;
  const { words, blur, profiles } = facts;
  const models = implants.flatMap((implant, number) => {
    const model = facts.model(number);
    return model ? [[implant, Array.from(model)] as const] : [];
  });
  facts.free();
  return { words, blur, profiles, models: new Map(models) };
}

/** The side of the squares of pixels that the film is read in: 1 unless it is much finer than its blur. */
function squareOf(sources: readonly FilmSource[], implants: readonly Reader[], stated: StatedFilm): number {
  const squares = new FilmSquares(stated.blur);
  const first = implants.flatMap((implant) => sources.filter((source) => source.implant === implant).slice(0, squares.frames));
  try {
    for (let side = squares.wanted; side !== undefined; side = squares.wanted) squares.take(factsOf(first, implants, side, stated));
    return squares.side;
  } finally {
    squares.free();
  }
}

function factsOf(sources: readonly FilmSource[], implants: readonly Reader[], side: number, { display, blur }: StatedFilm): FilmFacts | undefined {
  const study = FilmStudy.inSquares(side);
  try {
    sources.forEach(({ implant, image, pose }, frame) => study.take(implants.indexOf(implant), frame, implant.profiles(image, pose, side)));
    return study.estimate(display, blur);
  } finally {
    study.free();
  }
}

/** The numbers of a film for an implant, as WebAssembly takes them; none where nothing is known. */
export function filmNumbers(film: Hints['film'], implant: object): Float64Array {
  if (!film) return new Float64Array();
  if ('models' in film) return Float64Array.from(film.models.get(implant) ?? []);
  return statedFilm(film.curvature, film.blur, film.attenuation);
}
