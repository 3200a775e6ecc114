import type { FramePoint } from '../geometry/points';

/** What a tool would do, shown before it does it. Apart from the document: it changes with every move of the hand. */
export type Preview =
  | { readonly kind: 'nothing' }
  /** Where a first click would begin. */
  | { readonly kind: 'spot'; readonly at: FramePoint }
  /** An open path that a click would fix. */
  | { readonly kind: 'path'; readonly points: readonly FramePoint[] }
  /** An outline that a click would take. */
  | { readonly kind: 'ring'; readonly points: readonly FramePoint[] }
  | { readonly kind: 'box'; readonly from: FramePoint; readonly to: FramePoint };

export const NO_PREVIEW: Preview = { kind: 'nothing' };

/** The points between which a preview is drawn. */
export function pointsOfPreview(preview: Preview): readonly FramePoint[] {
  switch (preview.kind) {
    case 'nothing':
      return [];
    case 'spot':
      return [preview.at];
    case 'box':
      return [preview.from, preview.to];
    case 'path':
    case 'ring':
      return preview.points;
  }
}
