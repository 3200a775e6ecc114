import { Derived, type FrameImage } from '../pkg/page/fluoropose_page.js';
import type { Preprocessing } from '../terms/seeing';
import type { GreyWindow } from '../document/types';

/**
 * Paints a frame as it is to be seen. A picture made from it has grey values of its own: window and level work on it as
 * they do on the frame, with the window that the frame suggests showing all of it.
 */
export function paintPreprocessed(image: FrameImage, suggested: GreyWindow, context: CanvasRenderingContext2D, window: GreyWindow, preprocessing: Preprocessing): void {
  switch (preprocessing) {
    case 'original':
      return image.paint(context, window.centre, window.width);
    case 'inverted':
      return image.paintInverted(context, window.centre, window.width);
    case 'edges':
    case 'equalised': {
      const { centre, width } = derivedWindow(suggested, window);
      return image.paintDerived(context, preprocessing === 'edges' ? Derived.Edges : Derived.Equalised, centre, width);
    }
  }
}

/** The window over a picture of 0 to 255 that differs from all of it as `window` differs from what the frame suggests. */
export function derivedWindow(suggested: GreyWindow, window: GreyWindow): GreyWindow {
  const unit = 255 / Math.max(1, suggested.width);
  return { centre: 127.5 + (window.centre - suggested.centre) * unit, width: Math.max(1, window.width * unit) };
}
