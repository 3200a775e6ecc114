import { type FilmFacts as RawFacts, FilmStudy, statedFilmWords } from '../../pkg/core/fluoropose_wasm.js';
import type { FilmConstants } from '../../document/types';
import { COMPONENT_NAMES, type ComponentName } from '../../terms/component';
import type { FilmFacts, FilmProtocol, ReadProfiles } from '../protocol/film';
import { loadCore } from './core_module';
import { serve } from './serve';

/** Keeps the profiles of a study's frames and estimates its film from them, beside the worker that finds poses: nobody waits. */
const ready = loadCore();
let study: FilmStudy | null = null;

serve<FilmProtocol>({
  estimate: async ({ read, stated }) => {
    await ready;
    if (stated.constants) return asStated(stated.constants);
    const kept = takeAll(read);
    return told(kept.estimate(stated.display ?? undefined, stated.blur ?? undefined), COMPONENT_NAMES);
  },
  learntAgain: async ({ followed, stated }) => {
    await ready;
    const asked = new FilmStudy();
    // Of these frames alone, by the places of their components here.
    followed.forEach(({ known, read }, place) => {
      asked.know(Float64Array.from(known));
      for (const { frame, profiles } of read) asked.take(place, frame, profiles);
    });
    const facts = asked.learntAgain(stated.display ?? undefined, stated.blur ?? undefined);
    asked.free();
    return told(facts, followed.map(({ component }) => component));
  },
  take: async ({ read }) => {
    await ready;
    takeAll(read);
    return null;
  },
});

function takeAll(read: readonly ReadProfiles[]): FilmStudy {
  study ??= new FilmStudy();
  for (const { component, frame, profiles } of read) study.take(COMPONENT_NAMES.indexOf(component), frame, profiles);
  return study;
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
    return own === null ? null : [curvature, blur, own];
  };
  return { words: statedFilmWords(curvature, blur), blur, curved: 0, profiles: 0, models: { femur: of('femur'), tibia: of('tibia') } };
}

function known(numbers: readonly number[] | undefined): readonly number[] | null {
  return numbers?.length ? numbers : null;
}
