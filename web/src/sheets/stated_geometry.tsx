import { currentFrame, type State } from '../document/store';
import type { StatedGeometry as Stated } from '../workers/protocol/decode';
import { later } from '../texts/later';
import { useApp } from '../commands/app';

const said = later.calibrate.stated;

interface Offer {
  readonly sentence: string;
  /** Null for what is stated but not offered. */
  readonly fill: (() => void) | null;
  readonly what: string;
}

interface Takers {
  readonly onDistance: (value: number) => void;
  readonly onPitch: (value: number) => void;
}

/** Sizes and distances that the file of the frame states, each with where it holds. Nothing is taken by itself. */
export function StatedGeometry({ state, ...takers }: { state: State } & Takers) {
  return <Offers offers={offersOf(useStated(state), takers)} />;
}

/** The same where only the distance to the detector has a field. */
export function StatedDistances({ state, onDistance }: { state: State; onDistance: Takers['onDistance'] }) {
  const stated = useStated(state);
  return <Offers offers={stated ? distances(stated, onDistance) : []} />;
}

function useStated(state: State): Stated | null {
  const { studio } = useApp().services;
  const frame = currentFrame(state);
  return frame && studio.statedGeometry(frame.id);
}

function Offers({ offers }: { offers: readonly Offer[] }) {
  if (offers.length === 0) return null;
  return (
    <section class="stated" aria-label={said.title}>
      <h3>{said.title}</h3>
      <p class="sheet-text quiet">{said.meaning}</p>
      <ul>
        {offers.map(({ sentence, fill, what }) => (
          <li key={sentence}>
            <span>{sentence}</span>
            {fill && (
              <button type="button" class="button small" aria-label={said.fillLabel(what)} onClick={fill}>
                {said.fill}
              </button>
            )}
          </li>
        ))}
      </ul>
    </section>
  );
}

function offersOf(stated: Stated | null, { onDistance, onPitch }: Takers): Offer[] {
  if (!stated) return [];
  const { detectorSpacing, pixelSpacing, pixelSpacingCalibration, scannedSpacing } = stated;
  const only = (sentence: string): Offer => ({ sentence, fill: null, what: '' });
  return [
    ...spacing(detectorSpacing, said.detectorSpacing, later.calibration.pitch, onPitch),
    ...spacing(scannedSpacing, said.scannedSpacing, later.calibration.pitch, onPitch),
    ...(pixelSpacing ? [only(said.pixelSpacing[pixelSpacingCalibration ?? 'plain'](shown(pixelSpacing)))] : []),
    ...distances(stated, onDistance),
  ];
}

function distances({ sourceToDetector, sourceToPatient, sourceToIsocentre, magnification }: Stated, onDistance: Takers['onDistance']): Offer[] {
  const offers: Offer[] = [];
  const tell = (value: number | null, sentence: (value: string) => string) => {
    if (value !== null) offers.push({ sentence: sentence(String(value)), fill: null, what: '' });
  };
  if (sourceToDetector !== null) {
    const what = later.calibration.distance;
    offers.push({ sentence: said.sourceToDetector(String(sourceToDetector)), fill: () => onDistance(sourceToDetector), what });
  }
  tell(sourceToPatient, said.sourceToPatient);
  tell(sourceToIsocentre, said.sourceToIsocentre);
  tell(magnification, said.magnification);
  return offers;
}

/** Pixels whose sides differ by more than this part are not square. */
const SQUARE = 1e-3;

function spacing(pair: readonly [number, number] | null, sentence: (value: string) => string, what: string, onPitch: Takers['onPitch']): Offer[] {
  if (!pair) return [];
  const [across, along] = pair;
  const isSquare = Math.abs(across - along) <= SQUARE * across;
  if (isSquare) return [{ sentence: sentence(shown(pair)), fill: () => onPitch((across + along) / 2), what }];
  return [{ sentence: `${sentence(shown(pair))} ${said.oblong(String(across), String(along))}`, fill: null, what }];
}

function shown([across, along]: readonly [number, number]): string {
  return across === along ? String(across) : `${across} x ${along}`;
}
