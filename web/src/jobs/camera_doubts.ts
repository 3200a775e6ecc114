import { cameraOf } from '../results/keys';
import { texts } from '../texts/texts';
import type { Services } from './services';

/** What is unusual of the calibration for the film's first frame, in the core's words: most often it is wrong then. */
export async function cameraDoubts({ store, studio, doubtsOf }: Services): Promise<readonly string[]> {
  const first = store.doc.frames[0] ?? null;
  const camera = cameraOf(store.doc, first);
  const stated = first && studio.statedGeometry(first.id);
  return camera ? (await doubtsOf({ ...camera, stated })).map(texts.said.cameraDoubt) : [];
}

/** The same where the camera is another than it was; `before`: its `cameraKey` then. */
export async function newCameraDoubts(services: Services, before: string): Promise<readonly string[]> {
  return cameraKey(services) === before ? [] : cameraDoubts(services);
}

/** What those doubts depend on. */
export function cameraKey({ store: { doc } }: Services): string {
  const { width, height } = doc.frames[0] ?? {};
  return `${width} ${height} ${doc.calibration?.text}`;
}
