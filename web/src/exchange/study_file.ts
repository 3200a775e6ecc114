import { parse } from 'smol-toml';
import { list, number, object, oneOf, optional, ReadError, text } from '../document/reader';
import { componentNamed } from '../document/proposal';
import type { Study, StudyPart } from '../document/study';
import type { Axes } from '../document/types';
import { directionsFromWords } from '../geometry/axes';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';

const readStudyText = object({
  name: optional(text),
  side: optional(oneOf('left', 'right')),
  frames_per_s: optional(number),
  component: list(
    object({
      name: text,
      role: optional(oneOf('femur', 'tibia')),
      model: optional(text),
      reference: optional(text),
      axes: optional(text),
      nominal: optional(list(number)),
      distance_mm: optional(number),
    }),
  ),
});

/** Throws a sentence that names the place. Parts that are neither femur nor tibia are left to the laboratory. */
export function readStudy(content: string): Study {
  const { name, side, frames_per_s: rate, component: parts } = readStudyText(parsed(content), texts.study.place);
  return { name: name ?? '', side, rate, parts: parts.flatMap(readPart) };
}

function readPart({ name, role, model, reference, axes, nominal, distance_mm: distance }: ReturnType<typeof readStudyText>['component'][number]): StudyPart[] {
  const component = role ?? componentNamed(name);
  if (!component) return [];
  const [x, y] = nominal ?? [];
  return [
    {
      component,
      model: model && fileName(model),
      reference: reference && fileName(reference),
      axes: axes === null ? null : readStudyAxes(axes, component),
      nominal: x === undefined || y === undefined ? null : [x, y],
      distance,
    },
  ];
}

function readStudyAxes(words: string, component: ComponentName): Axes {
  const directions = directionsFromWords(words);
  if (!directions) throw new ReadError(texts.study.wrongAxes(texts.component[component], words));
  return { directions, from: 'study', told: 'all' };
}

function parsed(content: string): unknown {
  try {
    return parse(content);
  } catch (error) {
    const [first = ''] = (error as Error).message.split('\n');
    throw new ReadError(texts.study.notRead(first));
  }
}

function fileName(path: string): string {
  return path.split(/[\\/]/).at(-1) ?? path;
}
