import { parse } from 'smol-toml';
import { above0, list, number, object, oneOf, optional, pair, ReadError, text } from '../document/reader';
import { isBlur, isCurvature } from '../document/film';
import { componentNamed } from '../document/proposal';
import type { Study, StudyPart } from '../document/study';
import { type Axes, DISPLAYS, NOTHING_STATED, type StatedFilm } from '../document/types';
import { directionsFromWords } from '../geometry/axes';
import type { ComponentName } from '../terms/component';
import { LENGTH_UNITS } from '../terms/length_unit';
import { later } from '../texts/later';
import { texts } from '../texts/texts';

const readStudyText = object({
  name: optional(text),
  side: optional(oneOf('left', 'right')),
  frames_per_s: optional(above0),
  frames: optional(text),
  calibration: optional(text),
  film: optional(object({ curvature: optional(number), blur_px: optional(number), display: optional(oneOf(...DISPLAYS)) })),
  component: list(
    object({
      name: text,
      role: optional(oneOf('femur', 'tibia')),
      model: optional(text),
      unit: optional(oneOf(...LENGTH_UNITS)),
      reference: optional(text),
      axes: optional(text),
      nominal: optional(pair),
      distance_mm: optional(above0),
      attenuation: optional(above0),
    }),
  ),
});

/** Throws a sentence that names the place. Parts that are neither femur nor tibia are left to the laboratory. */
export function readStudy(content: string): Study {
  const { name, side, frames_per_s: rate, frames, calibration, film, component: parts } = readStudyText(parsed(content), later.study.place);
  const files = { ...(frames !== null && { frames }), ...(calibration !== null && { calibration }) };
  return { name: name ?? '', side, rate, film: film && statedBy(film, parts), parts: parts.flatMap(readPart), ...files };
}

type StudyText = ReturnType<typeof readStudyText>;

/** As the command line takes it: with curvature and blur nothing is estimated, otherwise what is left out is. */
function statedBy({ curvature, blur_px: blur, display }: NonNullable<StudyText['film']>, parts: StudyText['component']): StatedFilm {
  if ((curvature !== null && (blur === null || display !== null || !isCurvature(curvature))) || (blur !== null && !isBlur(blur))) {
    throw new ReadError(later.study.wrongFilm);
  }
  if (curvature === null || blur === null) return { ...NOTHING_STATED, display, blur };
  const of = (component: ComponentName) => parts.find((part) => roleOf(part) === component)?.attenuation ?? null;
  return { ...NOTHING_STATED, constants: { curvature, blur, attenuation: { femur: of('femur'), tibia: of('tibia') } } };
}

function roleOf({ role, name }: Pick<StudyText['component'][number], 'role' | 'name'>): ComponentName | null {
  return role ?? componentNamed(name);
}

function readPart({ model, unit, reference, axes, nominal, distance_mm: distance, ...named }: StudyText['component'][number]): StudyPart[] {
  const component = roleOf(named);
  if (!component) return [];
  return [
    {
      component,
      model,
      unit,
      reference,
      axes: axes === null ? null : readStudyAxes(axes, component),
      nominal,
      distance,
    },
  ];
}

function readStudyAxes(words: string, component: ComponentName): Axes {
  const directions = directionsFromWords(words);
  if (!directions) throw new ReadError(later.study.wrongAxes(texts.component[component], words));
  return { directions, from: 'study', told: 'all' };
}

function parsed(content: string): unknown {
  try {
    return parse(content);
  } catch (error) {
    const [first = ''] = (error as Error).message.split('\n');
    throw new ReadError(later.study.notRead(first));
  }
}
