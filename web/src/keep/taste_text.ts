import { flag, missingAs, number, object, oneOf, type Reader } from '../document/reader';
import { NO_LOCKS } from '../geometry/pose_numbers';
import { PREPROCESSINGS, OVERLAY_STYLES, PICTURES, type HandSettings, type Seeing, type Steps } from '../terms/seeing';

/** What the browser remembers, as a text. */
export interface Taste {
  readonly seeing: Seeing;
  readonly hand: HandSettings;
}

export function writeTaste({ seeing, hand }: Taste): string {
  const { comparing: _, ...shown } = seeing;
  const { locks: __, ...steps } = hand;
  return JSON.stringify({ seeing: shown, hand: steps });
}

const positive: Reader<number> = (value, path) => Math.max(1e-4, number(value, path));
const readSteps = object<Steps>({ plane: positive, depth: positive, turn: positive });

const readTasteObject = object<Taste>({
  seeing: object<Seeing>({
    preprocessing: oneOf(...PREPROCESSINGS),
    overlay: oneOf(...OVERLAY_STYLES),
    magnifier: flag,
    scaleBar: flag,
    ghosts: flag,
    picture: oneOf(...PICTURES),
    comparing: missingAs(false, flag),
  }),
  hand: object<HandSettings>({
    grain: oneOf('fine', 'coarse'),
    fine: readSteps,
    coarse: readSteps,
    locks: () => NO_LOCKS,
  }),
});

/** Null for a text that an older page wrote, or somebody else: then the usual things are shown. */
export function readTaste(text: string | null): Taste | null {
  if (text === null) return null;
  try {
    return readTasteObject(JSON.parse(text), 'taste');
  } catch {
    return null;
  }
}
