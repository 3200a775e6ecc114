import { texts } from '../texts/texts';
import type { ComponentName } from '../terms/component';
import type { LengthUnit } from '../terms/length_unit';
import { withStatedAxes } from './axes';
import type { Command } from './command';
import { type Axes, DEFAULT_WINDOW, type Doc, type LibrarySpec, type StatedFilm } from './types';

/** What a `study.toml` tells a page: which file is what, and what is known of the models. Methods and masks are the laboratory's. */
export interface Study {
  readonly name: string;
  readonly side: 'left' | 'right' | null;
  /** Frames a second. */
  readonly rate: number | null;
  /** Null where it says nothing of the film. */
  readonly film: StatedFilm | null;
  /** The folder of the frames, as it is written; missing where none is named. */
  readonly frames?: string;
  /** Likewise. */
  readonly calibration?: string;
  readonly parts: readonly StudyPart[];
}

export interface StudyPart {
  readonly component: ComponentName;
  /** Paths of files, as they are written. */
  readonly model: string | null;
  /** Of the model's file; missing where that is in millimetres. */
  readonly unit?: LengthUnit | null;
  readonly reference: string | null;
  readonly axes: Axes | null;
  readonly nominal: readonly [number, number] | null;
  readonly distance: number | null;
}

/** Everything that the study tells of the document, one step back. */
export function takeStudy(study: Study, fileName: string): Command {
  return {
    label: texts.steps.readStudy(fileName),
    apply: (doc) => {
      const { name, side, rate, film, parts } = study;
      const known = { ...doc, name: name || doc.name, side: side ?? doc.side, rate: rate ?? doc.rate };
      return parts.reduce(withPart, film ? { ...known, film: { ...doc.film, stated: film } } : known);
    },
  };
}

function withPart(doc: Doc, { component, axes, nominal, distance }: StudyPart): Doc {
  const known = axes ? withStatedAxes(doc, component, axes) : doc;
  if (!nominal && distance === null) return known;
  const librarySpec = specOf(known.components[component].librarySpec, nominal, distance);
  return { ...known, components: { ...known.components, [component]: { ...known.components[component], librarySpec } } };
}

function specOf(spec: LibrarySpec, nominal: readonly [number, number] | null, distance: number | null): LibrarySpec {
  const known = { ...spec, distance: distance ?? spec.distance };
  return nominal ? { ...DEFAULT_WINDOW, nominalX: nominal[0], nominalY: nominal[1], distance: known.distance } : known;
}
