import { referencePose } from '../document/reference';
import { currentFrame, currentPlace, type State } from '../document/store';
import { cellOf, chosenCandidate, type Doc, type FrameEntry } from '../document/types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { ComponentName } from '../terms/component';
import type { ModelMesh } from '../workers/protocol/decode';
import type { CameraInput } from '../workers/protocol/camera';
import { cameraOf } from '../results/keys';
import type { Studio } from '../films/studio';
import { middleOf } from '../geometry/mesh_middle';
import type { Pinhole, Vector } from '../geometry/pose_motion';
import type { HandSituation } from '../interaction/hand_situation';

/** What a hand on the selected model works with; null where model, calibration or frame is missing. */
export function handSituationOf(state: State, studio: Studio): HandSituation | null {
  const { present: doc } = state.history;
  const { component, hand } = state.ui;
  const frame = currentFrame(state);
  const mesh = meshOf(doc, component, studio);
  const camera = frame && pinholeOf(studio, cameraOf(doc, frame));
  if (!frame || !mesh || !camera) return null;
  const middle = middleOf(mesh);
  const own = chosenCandidate(cellOf(doc, frame.id, component))?.pose ?? null;
  const pose = own ?? placedPose(state, studio)?.pose;
  if (!pose) return null;
  return { pose, absent: own === null, middle, camera, locks: hand.locks, fine: hand.grain === 'fine' };
}

export function meshOf(doc: Doc, component: ComponentName, studio: Studio): ModelMesh | null {
  const { model } = doc.components[component];
  return model && studio.meshOf(model.sha256);
}

/** Where a model without a pose would be placed: as in the nearest frame that has one, else in the middle of the frame. */
export function placedPose(state: State, studio: Studio): { readonly pose: PoseNumbers; readonly frame: number | null } | null {
  const { present: doc } = state.history;
  const { component, frameIndex } = state.ui;
  const compared = referencePose(doc, currentPlace(state));
  if (compared) return { pose: compared, frame: null };
  const near = nearestPosed(doc.frames, frameIndex, (frame) => chosenCandidate(cellOf(doc, frame.id, component))?.pose ?? null);
  if (near) return near;
  const frame = currentFrame(state);
  const mesh = meshOf(doc, component, studio);
  const camera = frame && cameraOf(doc, frame);
  const pinhole = pinholeOf(studio, camera);
  if (!frame || !mesh || !pinhole || !camera) return null;
  const { librarySpec } = doc.components[component];
  const { principal } = studio.calibrationFacts(camera.text, camera);
  const depth = librarySpec.distance ?? (principal ? USUAL_FRACTION * principal.distance : USUAL_DISTANCE);
  const { nominalX = 0, nominalY = 0 } = librarySpec.views === 'window' ? librarySpec : {};
  return { pose: inTheMiddle(frame, pinhole, depth, { nominalX, nominalY }, middleOf(mesh)), frame: null };
}

/** Knees stand at this fraction of the principal distance, as libraries are built for; mm where that is not known. */
const USUAL_FRACTION = 0.9;
const USUAL_DISTANCE = 1000;

function nearestPosed(
  frames: readonly FrameEntry[],
  from: number,
  poseOf: (frame: FrameEntry) => PoseNumbers | null,
): { pose: PoseNumbers; frame: number } | null {
  for (let away = 1; away < frames.length; away++) {
    for (const index of [from - away, from + away]) {
      const frame = frames[index];
      const pose = frame && poseOf(frame);
      if (pose) return { pose, frame: index + 1 };
    }
  }
  return null;
}

function inTheMiddle(
  frame: FrameEntry,
  { fx, fy, cx, cy }: Pinhole,
  depth: number,
  { nominalX, nominalY }: { nominalX: number; nominalY: number },
  middle: Vector,
): PoseNumbers {
  const x = ((frame.width / 2 - cx) / fx) * depth;
  const y = ((cy - frame.height / 2) / fy) * depth;
  // Without rotation the middle would be beside the origin by its own coordinates.
  return { x: x - middle[0], y: y - middle[1], z: -depth - middle[2], zRot: 0, xRot: nominalX, yRot: nominalY };
}

const pinholes = new WeakMap<Studio, { key: string; pinhole: Pinhole | null }>();

/** The camera of a frame as four numbers; null where the calibration does not fit it. Asked with every move of the mouse. */
export function pinholeOf(studio: Studio, camera: CameraInput | null): Pinhole | null {
  if (!camera) return null;
  const key = `${camera.width}x${camera.height} ${camera.text}`;
  const kept = pinholes.get(studio);
  if (kept?.key === key) return kept.pinhole;
  const pinhole = calibrated(studio, camera);
  pinholes.set(studio, { key, pinhole });
  return pinhole;
}

function calibrated(studio: Studio, camera: CameraInput): Pinhole | null {
  try {
    return studio.calibrationFacts(camera.text, camera).camera;
  } catch {
    // The calibration's own sheet says what is wrong with it.
    return null;
  }
}
