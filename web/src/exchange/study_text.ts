import { stringify } from 'smol-toml';
import type { Doc } from '../document/types';
import { wordsOf } from '../geometry/axes';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';

/**
 * The document as a `study.toml`: which file is what, and what a person stated. What was found is not in it: who reads it looks
 * for that anew. Files are named without their folders, and frames and masks, whose folders a page does not know, are left out.
 */
export function writeStudy(doc: Doc): string {
  const { name, side, calibration, rate } = doc;
  const study = {
    name,
    ...(side !== 'unknown' && { side }),
    ...(calibration && { calibration: calibration.name }),
    ...(rate !== null && { frames_per_s: rate }),
    ...filmOf(doc),
    component: COMPONENT_NAMES.flatMap((component) => partOf(doc, component)),
  };
  return stringify(study);
}

function filmOf({ film }: Doc): { film?: object } {
  const { display, blur, constants } = film.stated;
  if (constants) return { film: { curvature: constants.curvature, blur_px: constants.blur } };
  if (display === null && blur === null) return {};
  return { film: { ...(display !== null && { display }), ...(blur !== null && { blur_px: blur }) } };
}

function partOf({ components, film }: Doc, name: ComponentName): object[] {
  const { model, axes, librarySpec } = components[name];
  if (!model) return [];
  const words = axes && axes.from !== 'shape' ? wordsOf(axes.directions) : null;
  const attenuation = film.stated.constants?.attenuation[name] ?? null;
  const { distance } = librarySpec;
  return [
    {
      name,
      model: model.writtenFrom?.name ?? model.name,
      ...(model.writtenFrom && { unit: model.writtenFrom.unit }),
      ...(words && { axes: words.join(' ') }),
      ...(librarySpec.views === 'window' && { nominal: [librarySpec.nominalX, librarySpec.nominalY] }),
      ...(distance !== null && { distance_mm: distance }),
      ...(attenuation !== null && { attenuation }),
    },
  ];
}
