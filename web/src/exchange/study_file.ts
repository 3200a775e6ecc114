import { parse } from 'smol-toml';
import { withStatedAxes } from '../document/axes';
import type { Command } from '../document/command';
import { list, number, object, oneOf, optional, ReadError, text } from '../document/reader';
import { componentNamed } from '../document/proposal';
import { type Axes, DEFAULT_WINDOW, type Doc, type LibrarySpec } from '../document/types';
import { directionsFromWords } from '../geometry/axes';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';

/** What a `study.toml` tells a page: which file is what, and what is known of the models. Methods and masks are the laboratory's. */
export interface Study {
  readonly name: string;
  readonly side: 'left' | 'right' | null;
  readonly parts: readonly StudyPart[];
}

interface StudyPart {
  readonly component: ComponentName;
  /** Names of files, without their folders. */
  readonly model: string | null;
  readonly reference: string | null;
  readonly axes: Axes | null;
  readonly nominal: readonly [number, number] | null;
  readonly distance: number | null;
}

const readStudyText = object({
  name: optional(text),
  side: optional(oneOf('left', 'right')),
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
  const { name, side, component: parts } = readStudyText(parsed(content), texts.study.place);
  return { name: name ?? '', side, parts: parts.flatMap(readPart) };
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

/** The component that the study means by a file; undefined where it names no such file. */
export function componentIn({ parts }: Study, kind: 'model' | 'reference', name: string): ComponentName | undefined {
  return parts.find((part) => part[kind] === name)?.component;
}

/** Everything that the study tells of the document, one step back. */
export function takeStudy(study: Study, fileName: string): Command {
  return {
    label: texts.steps.readStudy(fileName),
    apply: (doc) => study.parts.reduce(withPart, { ...doc, name: study.name || doc.name, side: study.side ?? doc.side }),
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
