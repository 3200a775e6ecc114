import { NO_LOCKS, type Locks } from '../geometry/pose_numbers';

/** How things are shown, and how far a key moves a model: taste, not work. Remembered by the browser, not undone. */

export const PREPROCESSINGS = ['original', 'inverted', 'edges', 'equalised'] as const;
export type Preprocessing = (typeof PREPROCESSINGS)[number];

export const OVERLAY_STYLES = ['outline', 'fill', 'shaded'] as const;
export type OverlayStyle = (typeof OVERLAY_STYLES)[number];

/** The picture in the panel: unmatched pixels, the scores of all views, or the models in space. */
export const PICTURES = ['unmatched', 'landscape', 'space'] as const;
export type PictureName = (typeof PICTURES)[number];

export interface Seeing {
  readonly preprocessing: Preprocessing;
  readonly overlay: OverlayStyle;
  readonly magnifier: boolean;
  readonly scaleBar: boolean;
  /** Outlines of the frames before and after. */
  readonly ghosts: boolean;
  readonly picture: PictureName;
  /** The poses to compare with are on view too, and differences take the place of deviations. Not remembered. */
  readonly comparing: boolean;
}

/** How far one press of a key moves a model. */
export interface Steps {
  /** In the image plane, mm. */
  readonly plane: number;
  /** Along the view, mm: a silhouette shows it ten times less. */
  readonly depth: number;
  /** Degrees. */
  readonly turn: number;
}

export type Grain = 'fine' | 'coarse';

export interface HandSettings {
  readonly grain: Grain;
  readonly fine: Steps;
  readonly coarse: Steps;
  /** Numbers that neither keys nor the mouse nor refinement change. Not remembered: a forgotten lock is a trap. */
  readonly locks: Locks;
}

export const DEFAULT_SEEING: Seeing = {
  preprocessing: 'original',
  overlay: 'fill',
  magnifier: false,
  scaleBar: true,
  ghosts: false,
  picture: 'unmatched',
  comparing: false,
};

export const DEFAULT_HAND: HandSettings = {
  grain: 'coarse',
  fine: { plane: 0.1, depth: 1, turn: 0.1 },
  coarse: { plane: 1, depth: 10, turn: 1 },
  locks: NO_LOCKS,
};
