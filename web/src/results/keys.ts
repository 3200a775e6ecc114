import { distortionKey, fits, numbersOf, type Distortion } from '../document/distortion';
import type { Place } from '../document/command';
import { indexOfFrame } from '../document/frame_index';
import { interned } from '../document/interned';
import type { Doc, FrameEntry, LibrarySpec } from '../document/types';
import type { ComponentName } from '../terms/component';
import type { DistortionInput, CameraInput } from '../workers/protocol/camera';

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
  return `model ${model.sha256} views ${viewsText(librarySpec)} frame ${width}x${height} camera ${JSON.stringify(text)}`;
}

/** Of a window as in sessions that knew nothing else: what was found then is still found so. */
function viewsText({ views, ...settings }: LibrarySpec): string {
  return `${views === 'window' ? '' : `${views} `}${JSON.stringify(settings)}`;
}

/** What a pose in this frame is found with. */
export function poseKey(doc: Doc, component: ComponentName, frame: FrameEntry): string | null {
  return poseKeys(doc)(component, frame);
}

/** The same of a cell; null for one of a frame that is not there. */
export function poseKeyAt(doc: Doc, { frameId, component }: Place): string | null {
  const frame = doc.frames[indexOfFrame(doc, frameId)];
  return frame ? poseKey(doc, component, frame) : null;
}

function keyFor(doc: Doc, component: ComponentName, frame: FrameEntry): string | null {
  const library = libraryKey(doc, component);
  const camera = cameraOf(doc, frame);
  if (!library || !camera) return null;
  const straightened = fits(doc.distortion, frame) ? ` straightened ${distortionKey(doc.distortion)}` : '';
  return interned(`${library}; frame ${camera.width}x${camera.height} camera ${JSON.stringify(camera.text)}${straightened}`);
}

type KeyOf = (component: ComponentName, frame: FrameEntry) => string | null;

const keysOf = new WeakMap<Doc, KeyOf>();

/** The same for many cells of one document: keys are long texts, and frames of a sequence share them. */
export function poseKeys(doc: Doc): KeyOf {
  let keyOf = keysOf.get(doc);
  if (!keyOf) keysOf.set(doc, (keyOf = keysFor(doc)));
  return keyOf;
}

function keysFor(doc: Doc): KeyOf {
  const known = new Map<string, string | null>();
  return (component, frame) => {
    const kind = `${component} ${frame.width} ${frame.height}`;
    let key = known.get(kind);
    if (key === undefined) known.set(kind, (key = keyFor(doc, component, frame)));
    return key;
  };
}

export function cameraOf(doc: Doc, frame: FrameEntry | null): CameraInput | null {
  if (!doc.calibration || !frame) return null;
  const camera = { text: doc.calibration.text, width: frame.width, height: frame.height };
  const distortion = distortionInputOf(doc.distortion);
  return distortion && fits(doc.distortion, frame) ? { ...camera, distortion } : camera;
}

const inputs = new WeakMap<Distortion, DistortionInput>();

/** Null where frames themselves are undistorted, or nothing is. */
function distortionInputOf(distortion: Distortion | null): DistortionInput | null {
  if (distortion?.appliesTo !== 'outlines') return null;
  const known = inputs.get(distortion);
  if (known) return known;
  const input = { key: distortionKey(distortion), numbers: numbersOf(distortion) };
  inputs.set(distortion, input);
  return input;
}
