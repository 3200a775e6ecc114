import { exporting } from './en_exporting';
import { curves } from './en_joint_curves';

/** What is said by views that come when they are opened: apart from the rest, so that the first load does not have it. */
export const later: { readonly exporting: typeof exporting; readonly curves: typeof curves } = { exporting, curves };
