import { currentFrame, type State } from '../document/store';
import { cellOf, chosenCandidate } from '../document/types';
import { cameraOf } from '../results/keys';
import { inCamera } from '../geometry/pose_motion';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { meshOf, pinholeOf } from '../commands/model_in_hand';
import { middleOf } from '../geometry/mesh_middle';
import { barLength } from './scale_length';

/** A length of so many millimetres where the selected component is: farther away it is shorter. */
export function ScaleBar({ state }: { state: State }) {
  const { actions, services } = useApp();
  const { component, seeing } = state.ui;
  const { present: doc } = state.history;
  const frame = currentFrame(state);
  if (!seeing.scaleBar || !frame || !actions.stage) return null;
  const mesh = meshOf(doc, component, services.studio);
  const camera = pinholeOf(services.studio, cameraOf(doc, frame));
  const pose = chosenCandidate(cellOf(doc, frame.id, component))?.pose;
  if (!mesh || !camera || !pose) return null;
  const depth = -inCamera(pose, middleOf(mesh))[2];
  const perMillimetre = (camera.fx / depth) * actions.stage.viewport().scale;
  const millimetres = barLength(perMillimetre);
  if (!(depth > 0) || millimetres === null) return null;
  const label = millimetres < 1 ? `${millimetres * 1000} µm` : `${millimetres} mm`;
  return (
    <div class="scale-bar" role="img" aria-label={texts.seeing.scale(label, texts.component[component])} style={{ width: `${millimetres * perMillimetre}px` }}>
      <span aria-hidden="true">{label}</span>
    </div>
  );
}
