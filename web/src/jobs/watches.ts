import type { Bridge } from '../workers/bridge';
import type { PoseProtocol } from '../workers/protocol/pose';
import { JointWatch } from './joint_watch';
import type { Services } from './services';
import { DetourWatch } from './detour_watch';

/** Begins to hold poses against each other. */
export function watchPoses(services: Services, worker: Pick<Bridge<PoseProtocol>, 'call'>): void {
  new JointWatch(services, worker);
  new DetourWatch(services.store, worker);
}
