import { FilmLook as Derived, type Film } from '../pkg/page/fluoropose_wasm.js';
import type { FilmLook } from '../terms/seeing';
import type { GreyWindow } from '../document/types';

export type Look = FilmLook;

/**
 * Paints a frame as it is to be seen. A picture made from it has grey values of its own: window and level work on it as
 * they do on the film, with the window that the film suggests showing all of it.
 */
export function paintLook(film: Film, suggested: GreyWindow, context: CanvasRenderingContext2D, window: GreyWindow, look: Look): void {
  switch (look) {
    case 'original':
      return film.paint(context, window.centre, window.width);
    case 'inverted':
      return film.paintInverted(context, window.centre, window.width);
    case 'edges':
    case 'equalised': {
      const { centre, width } = derivedWindow(suggested, window);
      return film.paintDerived(context, look === 'edges' ? Derived.Edges : Derived.Equalised, centre, width);
    }
  }
}

/** The window over a picture of 0 to 255 that differs from all of it as `window` differs from what the film suggests. */
export function derivedWindow(suggested: GreyWindow, window: GreyWindow): GreyWindow {
  const unit = 255 / Math.max(1, suggested.width);
  return { centre: 127.5 + (window.centre - suggested.centre) * unit, width: Math.max(1, window.width * unit) };
}
