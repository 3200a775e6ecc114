import { describe, expect, it } from 'vitest';
import { addFrames } from '../../src/document/commands';
import { setPoseByHand } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { cellOf, chosenCandidate } from '../../src/document/types';
import { canvasPoint } from '../../src/geometry/points';
import { NO_LOCKS } from '../../src/geometry/pose_numbers';
import { Controller } from '../../src/interaction/controller';
import { act, situationOf } from '../../src/stage/stage_input';

const poseOf = (x: number) => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });

/** The film plays (`PlayButton`), or frames that were opened are there (`addToDocument`), while a hand drags the model. */
describe('a drag of the model while another frame comes on view', () => {
  it('leaves the poses of other frames alone', () => {
    const store = new Store();
    store.perform(addFrames([0, 1].map((k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 100, height: 100 }))));
    store.perform(setPoseByHand({ frameId: 'f0', component: 'femur' }, poseOf(0)));
    store.perform(setPoseByHand({ frameId: 'f1', component: 'femur' }, poseOf(500)));
    store.show({ tool: 'pose' });
    store.goTo(0);
    const camera = { fx: 1000, fy: 1000, cx: 50, cy: 50 };
    const view = {
      viewport: () => ({ scale: 1, x: 0, y: 0, left: 0, top: 0 }),
      window: () => ({ centre: 0, width: 1 }),
      hand: () => ({ pose: chosenCandidate(cellOf(store.doc, store.doc.frames[store.ui.frameIndex]!.id, 'femur'))!.pose, absent: false, middle: [0, 0, 0], camera, locks: NO_LOCKS, fine: false }),
    };
    const controller = new Controller();
    const send = (type: 'down' | 'move' | 'up', x: number) =>
      act({ services: { store } } as never, controller, { type, at: canvasPoint(x, 10), button: 'primary', alt: false }, situationOf(store, view as never)!);
    send('down', 10);
    send('move', 20);
    store.goTo(1);
    send('move', 30);
    send('up', 30);
    // Frame 2 has its own pose still.
    expect(chosenCandidate(cellOf(store.doc, 'f1', 'femur'))?.pose.x).toBe(500);
  });
});
