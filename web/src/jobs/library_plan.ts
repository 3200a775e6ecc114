import { cameraOf } from '../results/keys';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';
import type { LibraryPlan } from '../workers/protocol/library';
import type { Services } from './services';

/** What the library that the document asks for is built from; throws where something of it is missing. */
export function libraryPlan({ store: { doc }, studio }: Pick<Services, 'store' | 'studio'>, component: ComponentName): LibraryPlan {
  const { model, librarySpec: spec } = doc.components[component];
  const mesh = model && studio.meshOf(model.sha256);
  const camera = cameraOf(doc, doc.frames[0] ?? null);
  if (!mesh || !camera) throw new Error(texts.said.library.noInputs);
  return { mesh, camera, spec };
}
