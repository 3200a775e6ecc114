/** How the joint's curves are shown. */

/** By whose convention translations are meant; the rotations of both are the same. */
export const CONVENTIONS = ['field', 'grood-suntay'] as const;
export type Convention = (typeof CONVENTIONS)[number];

/** What curves run over. */
export const OVERS = ['frame', 'time', 'flexion'] as const;
export type Over = (typeof OVERS)[number];

export const CURVE_NAMES = ['flexion', 'abduction', 'internal', 'anterior', 'superior', 'medial', 'gsAnterior', 'gsDistraction', 'gsLateral', 'lowest', 'liftOff'] as const;
export type CurveName = (typeof CURVE_NAMES)[number];

export interface JointView {
  readonly open: boolean;
  readonly convention: Convention;
  readonly over: Over;
  /** The one curve that is shown large; null: all of them. */
  readonly alone: CurveName | null;
  /** Height of the dock as a part of the window's. */
  readonly height: number;
}

/** Heights of the dock, parts of the window's. */
export const DOCK = { least: 0.2, usual: 0.4, large: 0.64, step: 0.04 } as const;

export const DEFAULT_JOINT: JointView = { open: false, convention: 'field', over: 'frame', alone: null, height: DOCK.usual };
