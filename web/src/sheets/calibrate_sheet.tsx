import { useState } from 'preact/hooks';
import { writeDistortionFile } from '../document/distortion';
import { NOTHING_MEASURED, type MeasuredGrid, type Measuring } from '../document/measuring';
import { currentFrame, type State } from '../document/store';
import { sentenceOf } from '../jobs/services';
import type { FramePoint } from '../geometry/points';
import { later } from '../texts/later';
import { plusMinus } from '../texts/numbers';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { DistortionFindings } from './distortion_findings';
import { download } from '../exchange/browser_files';
import { fileStem } from '../terms/file_name';
import { NumberField } from '../controls/number_field';
import { Segments } from '../controls/segments';
import { StatedDistances } from './stated_geometry';

const said = { ...texts.calibrate, ...later.calibrate };

interface Lengths {
  /** Between beads, or between the two marks, mm. */
  readonly known: number;
  readonly toDetector: number;
  readonly toObject: number;
}

const KINDS = (['grid', 'ruler'] as const).map((value) => ({ value, title: said.kinds[value] }));

/** Pixel pitch, principal point and distortion from a picture of a bead grid or a ruler. */
export function CalibrateSheet({ state }: { state: State }) {
  const { calibrator } = useApp();
  const measuring = state.ui.measuring ?? NOTHING_MEASURED;
  const [lengths, setLengths] = useState<Lengths>({ known: NaN, toDetector: NaN, toObject: NaN });
  const choose = (kind: Measuring['kind']) => calibrator.show({ kind });
  return (
    <div class="sheet-body">
      <Segments label={said.what} options={KINDS} value={measuring.kind} onChoose={choose} />
      {measuring.kind === 'grid' ? <Grid state={state} grid={measuring.grid} /> : <Ruler marks={measuring.marks} />}
      <h3>{said.camera}</h3>
      <LengthFields state={state} kind={measuring.kind} lengths={lengths} onChange={setLengths} />
      <Camera state={state} measuring={measuring} lengths={lengths} />
    </div>
  );
}

// --- What is looked at ------------------------------------------------------------------------------------------------

function Grid({ state, grid }: { state: State; grid: MeasuredGrid | null }) {
  const { calibrator } = useApp();
  const [radius, setRadius] = useState(NaN);
  const [bright, setBright] = useState(false);
  const searching = state.ui.jobs.some(({ title }) => title === said.searching);
  return (
    <>
      <p class="sheet-text quiet">{said.gridMeaning}</p>
      <div class="fields">
        <NumberField label={said.radius} unit="px" value={radius} placeholder={said.anyRadius} onChange={setRadius} />
      </div>
      <label class="check">
        <input type="checkbox" checked={bright} onChange={(event) => setBright(event.currentTarget.checked)} />
        {said.bright}
      </label>
      <div class="sheet-buttons">
        <button type="button" class="button primary" disabled={searching || !currentFrame(state)} onClick={() => void calibrator.find(Number.isNaN(radius) ? 0 : radius, bright)}>
          {said.find}
        </button>
      </div>
      {grid && <p class="sheet-text">{describe(grid)}</p>}
      <h3>{said.distortion}</h3>
      {grid && <DistortionFindings grid={grid} />}
      <DistortionInUse state={state} />
    </>
  );
}

function describe({ frameName, beads }: MeasuredGrid): string {
  const numbers = (offset: number) => Array.from({ length: beads.length / 4 }, (_, at) => beads[4 * at + offset] ?? 0);
  const span = (values: number[]) => Math.max(...values) - Math.min(...values) + 1;
  const [columns, rows] = [span(numbers(2)), span(numbers(3))];
  return said.gridOf(frameName, beads.length / 4, columns, rows, columns * rows - beads.length / 4);
}

function DistortionInUse({ state }: { state: State }) {
  const { actions, calibrator } = useApp();
  const { distortion, name } = state.history.present;
  const save = () => distortion && download([writeDistortionFile(distortion)], `${fileStem(name)}_distortion.json`, 'application/json');
  return (
    <>
      {distortion && <p class="sheet-text">{said.inUse[distortion.appliesTo](distortion.name, distortion.order, distortion.quality.after.toFixed(3))}</p>}
      <div class="sheet-buttons">
        <button type="button" class="button" disabled={!distortion} onClick={() => calibrator.use(null)}>
          {said.remove}
        </button>
        <button type="button" class="button" disabled={!distortion} onClick={save}>
          {said.saveFile}
        </button>
        <button type="button" class="button" onClick={() => void actions.openPicked()}>
          {said.openFile}
        </button>
      </div>
    </>
  );
}

/** Marks by click, or typed: the mouse alone must not be needed. */
function Ruler({ marks }: { marks: readonly FramePoint[] }) {
  const { calibrator } = useApp();
  return (
    <>
      <p class="sheet-text quiet">{said.rulerMeaning}</p>
      <div class="fields">
        {[0, 1].flatMap((index) => {
          const { column, row } = marks[index] ?? { column: NaN, row: NaN };
          return [
            <NumberField key={`${index} column`} label={said.mark(index + 1, 'column')} unit="px" value={rounded(column)} onChange={(column) => calibrator.type(index, { column })} />,
            <NumberField key={`${index} row`} label={said.mark(index + 1, 'row')} unit="px" value={rounded(row)} onChange={(row) => calibrator.type(index, { row })} />,
          ];
        })}
      </div>
      <div class="sheet-buttons">
        <button type="button" class="button" disabled={marks.length === 0} onClick={() => calibrator.show({ marks: [] })}>
          {said.clearMarks}
        </button>
      </div>
    </>
  );
}

function rounded(value: number): number {
  return Math.round(100 * value) / 100;
}

// --- The camera -------------------------------------------------------------------------------------------------------

function LengthFields({ state, kind, lengths, onChange }: { state: State; kind: Measuring['kind']; lengths: Lengths; onChange: (lengths: Lengths) => void }) {
  const set = (field: keyof Lengths) => (value: number) => onChange({ ...lengths, [field]: value });
  return (
    <>
      <div class="fields">
        <NumberField label={kind === 'grid' ? said.spacing : said.length} unit="mm" value={lengths.known} onChange={set('known')} />
        <NumberField label={said.toDetector} unit="mm" value={lengths.toDetector} onChange={set('toDetector')} />
        <NumberField label={said.toObject[kind]} unit="mm" value={lengths.toObject} onChange={set('toObject')} />
      </div>
      <StatedDistances state={state} onDistance={set('toDetector')} />
    </>
  );
}

interface CameraFound {
  readonly sentences: readonly string[];
  readonly pitch: number;
  readonly offset: readonly [number, number];
}

function Camera({ state, measuring, lengths }: { state: State; measuring: Measuring; lengths: Lengths }) {
  const app = useApp();
  const { calibrator } = app;
  const { studio } = app.services;
  const frame = currentFrame(state);
  const typed = Object.values(lengths).every((length) => !Number.isNaN(length));
  const ready = typed && (measuring.kind === 'grid' ? measuring.grid !== null : marksOf(measuring) !== null);
  if (!ready || !frame) return <p class="sheet-text quiet">{said.needs}</p>;
  let found: CameraFound;
  let text: string;
  try {
    found = measuring.kind === 'grid' ? ofPlate(app, state, measuring, lengths) : ofRuler(app, measuring, lengths);
    text = studio.calibrationText(lengths.toDetector, found.offset[0], found.offset[1], found.pitch, frame);
  } catch (error) {
    return (
      <p class="sheet-trouble" role="alert">
        {sentenceOf(error)}
      </p>
    );
  }
  const name = said.nameOf[measuring.kind]((measuring.kind === 'grid' && measuring.grid?.frameName) || frame.name);
  return (
    <>
      <div role="group" aria-label={said.camera}>
        {found.sentences.map((sentence) => (
          <p key={sentence} class="sheet-text">
            {sentence}
          </p>
        ))}
      </div>
      <div class="sheet-buttons">
        <button type="button" class="button primary" onClick={() => calibrator.useCamera(name, text)}>
          {said.use}
        </button>
      </div>
    </>
  );
}

function marksOf({ marks }: Measuring): readonly FramePoint[] | null {
  return marks.length === 2 && marks.every(({ column, row }) => !Number.isNaN(column) && !Number.isNaN(row)) ? marks : null;
}

type AppServices = ReturnType<typeof useApp>;

/** Places in what `plateCamera` gives: the tilt, degrees, and whether it is too much for a correction. */
const TILT = 7;
const IS_TILTED = 11;

function ofPlate({ calibrator, services }: AppServices, state: State, { grid }: Measuring, { known, toDetector, toObject }: Lengths): CameraFound {
  if (!grid) throw new Error(said.needs);
  const { present: doc } = state.history;
  const beads = calibrator.beadsForCamera(grid, doc);
  const camera = (places: Float64Array<ArrayBuffer>) => services.studio.plateCamera(places, known, toDetector, toObject, grid);
  const numbers = camera(beads);
  const [pitch = NaN, pitchDeviation = 0, x = 0, y = 0, dx = 0, dy = 0, isMeasured = 0, tilt = 0, residual = 0, used = 0, isDistorted = 0] = numbers;
  const sentences = [
    `${said.pitch(plusMinus(pitch, pitchDeviation, 5))}; ${
      isMeasured ? said.point(plusMinus(x, dx, 2), plusMinus(y, dy, 2)) : said.pointUnknown(tilt.toFixed(1))
    }`,
    said.residual(residual.toFixed(3), used),
    said.distancesMatter,
  ];
  if (!doc.distortion && isDistorted) sentences.push(said.distortedFirst(residual.toFixed(2)));
  // Straightened, a tilted plate looks level.
  const asTaken = beads === grid.beads ? null : camera(grid.beads);
  if (asTaken?.[IS_TILTED]) sentences.push(said.tiltedFirst(asTaken[TILT]!.toFixed(0)));
  return { sentences, pitch, offset: isMeasured ? [x, y] : [0, 0] };
}

function ofRuler({ services }: AppServices, measuring: Measuring, { known, toDetector, toObject }: Lengths): CameraFound {
  const marks = marksOf(measuring);
  if (!marks) throw new Error(said.needs);
  const [length = NaN, pitch = NaN, focal = NaN] = services.studio.rulerScale(marks, known, toDetector, toObject);
  const sentences = [said.pitchAlone(pitch.toFixed(5), focal.toFixed(1), length.toFixed(1)), said.pointOfRuler, said.distancesMatter];
  return { sentences, pitch, offset: [0, 0] };
}
