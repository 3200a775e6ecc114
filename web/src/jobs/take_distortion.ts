import { type Distortion, fits } from '../document/distortion';
import { setDistortion } from '../document/set_distortion';
import { texts } from '../texts/texts';
import type { Services } from './services';
import { distorting, checkDistortion, undistorting } from '../films/undistorted';

const said = texts.calibrate;

/** Takes a correction into the document, or takes it away; throws the core's sentence for one that is none. */
export function takeDistortion({ store }: Services, distortion: Distortion | null): void {
  if (distortion) checkDistortion(distortion);
  const before = store.doc.distortion;
  const fromShown = before?.appliesTo === 'frames' ? distorting(before) : null;
  const toShown = distortion?.appliesTo === 'frames' ? undistorting(distortion) : null;
  store.perform(setDistortion(distortion, fromShown, toShown));
  store.say('info', distortion ? sentenceOn(distortion, store.doc.frames) : said.removed);
}

function sentenceOn(distortion: Distortion, frames: readonly { readonly width: number; readonly height: number }[]): string {
  const others = frames.filter((frame) => !fits(distortion, frame)).length;
  const rest = others === 0 ? '' : ` ${said.otherSizes(others, distortion.width, distortion.height)}`;
  return said.applied[distortion.appliesTo] + rest;
}
