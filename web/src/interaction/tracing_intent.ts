import type { FramePoint } from '../geometry/points';

/**
 * What tools that work with the film's pixels want done. The machines say it in frame coordinates; who holds the pixels
 * (`tracing/tracing_tools.ts`) answers with previews and commands.
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
