import type { FramePoint } from '../geometry/points';

/**
 * What tools that work with the film's pixels want done. The machines say it in frame coordinates; who holds the pixels
 * (`engine/aids.ts`) answers with previews and commands.
 */
export type AidIntent =
  /** The pointer is here: show what a press would do. */
  | { readonly aid: 'wire'; readonly to: 'aim' | 'fix' | 'close'; readonly at: FramePoint; readonly straight: boolean }
  | { readonly aid: 'threshold'; readonly to: 'aim' | 'take'; readonly at: FramePoint }
  /** The hand went so many CSS pixels down since it took hold. */
  | { readonly aid: 'threshold'; readonly to: 'drag'; readonly down: number }
  | { readonly aid: 'threshold'; readonly to: 'let-go' }
  /** All of the stroke so far. */
  | { readonly aid: 'brush'; readonly to: 'paint' | 'finish'; readonly stroke: readonly FramePoint[]; readonly erase: boolean }
  | { readonly aid: 'one-click'; readonly to: 'frame' | 'box'; readonly from: FramePoint; readonly at: FramePoint }
  | { readonly aid: 'one-click'; readonly to: 'point'; readonly at: FramePoint }
  /** Nothing is to be shown any more. */
  | { readonly aid: 'none' };

/** How the tools work; set in the strip above the film, kept while the page is open. */
export interface AidOptions {
  /** Metal is brighter than what surrounds it. */
  readonly bright: boolean;
  /** Of the brush, frame pixels. */
  readonly radius: number;
  readonly erase: boolean;
  /** Grey value of the threshold; null: what suits the place that is pointed at. */
  readonly level: number | null;
  /** The threshold cuts bridges up to twice this thick, px. */
  readonly bridge: number;
  /** The live-wire fixes what has stayed the same for a while. */
  readonly cooling: boolean;
  /** How far snapping looks for an edge, px. */
  readonly reach: number;
}

export const USUAL_OPTIONS: AidOptions = {
  bright: false,
  radius: 8,
  erase: false,
  level: null,
  bridge: 2,
  cooling: true,
  reach: 6,
};

export const RADIUS = { least: 1, most: 60 } as const;
