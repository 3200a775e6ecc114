import type { ComponentName, Doc, FrameEntry } from '../document/types';
import type { CameraInput } from './protocol';

/**
 * A key names the inputs of a result; two results with the same key are the same. It is a readable text, kept with
 * each pose, so that a session tells what made it.
 */
export function libraryKey(doc: Doc, component: ComponentName): string | null {
  const { model, libraryFile, librarySpec } = doc.components[component];
  if (libraryFile) return `library ${libraryFile.sha256}${model ? ` model ${model.sha256}` : ''}`;
  const camera = cameraOf(doc, doc.frames[0] ?? null);
  if (!model || !camera) return null;
  const { width, height, text } = camera;
  return `model ${model.sha256} views ${JSON.stringify(librarySpec)} frame ${width}x${height} camera ${JSON.stringify(text)}`;
}

/** What a pose in this frame is found with. */
export function poseKey(doc: Doc, component: ComponentName, frame: FrameEntry): string | null {
  const library = libraryKey(doc, component);
  const camera = cameraOf(doc, frame);
  return library && camera && `${library}; frame ${camera.width}x${camera.height} camera ${JSON.stringify(camera.text)}`;
}

export function cameraOf(doc: Doc, frame: FrameEntry | null): CameraInput | null {
  return doc.calibration && frame && { text: doc.calibration.text, width: frame.width, height: frame.height };
}
