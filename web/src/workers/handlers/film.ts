import { FilmStudy, statedFilmWords } from '../../pkg/core/fluoropose_wasm.js';
import type { FilmConstants } from '../../document/types';
import { COMPONENT_NAMES, type ComponentName } from '../../terms/component';
import type { FilmFacts, FilmProtocol } from '../protocol/film';
import { loadCore } from './core_module';
import { serve } from './serve';

/** Keeps the profiles of a study's frames and estimates its film from them, beside the worker that finds poses: nobody waits. */
const ready = loadCore();
let study: FilmStudy | null = null;

serve<FilmProtocol>({
  estimate: async ({ read, stated }) => {
    await ready;
    if (stated.constants) return asStated(stated.constants);
    study ??= new FilmStudy();
    for (const { component, frame, profiles } of read) study.take(COMPONENT_NAMES.indexOf(component), frame, profiles);
    const facts = study.estimate(stated.display ?? undefined, stated.blur ?? undefined);
    if (!facts) return null;
    const { words, blur, curved, profiles } = facts;
    const [femur, tibia] = [0, 1].map((component) => Array.from(facts.model(component) ?? []));
    facts.free();
    return { words, blur, curved, profiles, models: { femur: known(femur), tibia: known(tibia) } };
  },
});

function asStated({ curvature, blur, attenuation }: FilmConstants): FilmFacts {
  const of = (component: ComponentName) => {
    const own = attenuation[component];
    return own === null ? null : [curvature, blur, own];
  };
  return { words: statedFilmWords(curvature, blur), blur, curved: 0, profiles: 0, models: { femur: of('femur'), tibia: of('tibia') } };
}

function known(numbers: readonly number[] | undefined): readonly number[] | null {
  return numbers?.length ? numbers : null;
}
