import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';
import type { Command } from './command';
import { count, list, missingAs, nullable, number, object, oneOf, optional, text, type Reader } from './reader';
import { DISPLAYS, type Doc, type Film, type FilmConstants, type FilmModel, type KnownFilm, type StatedFilm, UNKNOWN_FILM } from './types';

/** Curvature, blur and attenuation: with what a pose was found. */
export const CONSTANTS = 3;

/** What may be stated of a film, as the commands take it. A core that is told of more blur takes it as this. */
const MOST_BLUR = 12;
const MOST_CURVATURE = 1;

/** Whether a film can be blurred so, px. */
export function isBlur(blur: number): boolean {
  return blur > 0 && blur <= MOST_BLUR;
}

/** Whether a display can be curved so, one divided by grey values. */
export function isCurvature(curvature: number): boolean {
  return curvature >= 0 && curvature <= MOST_CURVATURE;
}

/** Behind all other numbers of a film. */
const SQUARE = 16;

/** Side of the squares of pixels that what is known of a film was read in. */
export function squareOf(known: readonly number[] | null): number {
  return known?.[SQUARE] ?? 1;
}

/** What the film makes of a component as its model is now. */
export function filmNumbers({ film, components }: Doc, component: ComponentName): readonly number[] | null {
  const known = film.known?.models[component];
  return known && known.of === components[component].model?.sha256 ? known.numbers : null;
}

/** Two lists of constants are the same. */
export function sameFilm(a: readonly number[] | null, b: readonly number[] | null): boolean {
  return a === b || (a !== null && b !== null && a.slice(0, CONSTANTS).join() === b.slice(0, CONSTANTS).join());
}

/** What a person says of the film. Poses follow by themselves. */
export function stateFilm(stated: StatedFilm): Command {
  return { label: texts.steps.stateFilm, mergeKey: 'film', apply: (doc) => ({ ...doc, film: { ...doc.film, stated } }) };
}

/** What the frames tell; no unit of undo: nobody did anything. */
export function withKnownFilm(doc: Doc, known: KnownFilm | null): Doc {
  return doc.film.known === known ? doc : { ...doc, film: { ...doc.film, known } };
}

const readConstants = object<FilmConstants>({
  curvature: number,
  blur: number,
  attenuation: object({ femur: nullable(number), tibia: nullable(number) }),
});

const readStated = object<StatedFilm>({
  display: nullable(oneOf(...DISPLAYS)),
  blur: nullable(number),
  // Sessions from before all of a film could be stated do not.
  constants: optional(readConstants),
});

const readModel = nullable(object<FilmModel>({ of: text, numbers: list(number) }));

/** Sessions of versions 1 to 4 have none. */
export const readFilm: Reader<Film> = missingAs(
  UNKNOWN_FILM,
  object<Film>({
    stated: readStated,
    known: nullable(
      object<KnownFilm>({
        words: text,
        stated: readStated,
        blur: number,
        curved: number,
        profiles: count,
        models: object({ femur: readModel, tibia: readModel }),
      }),
    ),
  }),
);
