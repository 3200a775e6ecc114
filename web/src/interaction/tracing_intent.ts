import type { FramePoint } from '../geometry/points';

/**
 * What tools that work with the frame's pixels want done. The machines say it in frame coordinates; who holds the pixels
 * (`tracing/tracing_tools.ts`) answers with previews and commands.
 */
export type TracingIntent =
  /** The pointer is here: show what a press would do. */
  | { readonly tool: 'wire'; readonly to: 'aim' | 'fix' | 'close'; readonly at: FramePoint; readonly straight: boolean }
  | { readonly tool: 'threshold'; readonly to: 'aim' | 'take'; readonly at: FramePoint }
  /** The hand went so many CSS pixels down since it took hold. */
  | { readonly tool: 'threshold'; readonly to: 'drag'; readonly down: number }
  | { readonly tool: 'threshold'; readonly to: 'let-go' }
  /** All of the stroke so far. */
  | { readonly tool: 'brush'; readonly to: 'paint' | 'finish'; readonly stroke: readonly FramePoint[]; readonly erase: boolean }
  | { readonly tool: 'one-click'; readonly to: 'frame' | 'box'; readonly from: FramePoint; readonly at: FramePoint }
  | { readonly tool: 'one-click'; readonly to: 'point'; readonly at: FramePoint }
  /** Nothing is to be shown any more. */
  | { readonly tool: 'none' };
