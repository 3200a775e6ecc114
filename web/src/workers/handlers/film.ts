import { FilmStudy } from '../../pkg/core/fluoropose_wasm.js';
import { COMPONENT_NAMES } from '../../terms/component';
import type { FilmProtocol } from '../protocol/film';
import { loadCore } from './core_module';
import { serve } from './serve';

/** Keeps the profiles of a study's frames and estimates its film from them, beside the worker that finds poses: nobody waits. */
const ready = loadCore();
let study: FilmStudy | null = null;

serve<FilmProtocol>({
  estimate: async ({ read, stated }) => {
    await ready;
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

function known(numbers: readonly number[] | undefined): readonly number[] | null {
  return numbers?.length ? numbers : null;
}
