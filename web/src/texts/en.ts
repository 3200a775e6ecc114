import type { ComponentName } from '../document/types';

/** English, as the page speaks it. Grouped as the page is. */
export const en = {
  program: 'fluoropose',
  failedToStart: (why: string) => `The page could not start: ${why}. It needs a current browser with WebAssembly.`,
  /** Alone, as a heading or a label. */
  componentTitle: { femur: 'Femur', tibia: 'Tibia' } satisfies Record<ComponentName, string>,
  /** Inside a sentence, after "the". */
  component: { femur: 'femur', tibia: 'tibia' } satisfies Record<ComponentName, string>,
  cancel: 'Cancel',
  close: (what: string) => `Close ${what}`,
  closeTitle: 'Close (Esc)',
  withKey: (what: string, key: string) => `${what} (${key})`,
  /** Several things in a row: "a, b and c". */
  listed: (items: readonly string[]) =>
    items.length <= 1 ? (items[0] ?? '') : `${items.slice(0, -1).join(', ')} and ${items.at(-1)}`,

  empty: {
    region: 'Begin',
    title: 'Trace an implant on an X-ray; see its pose in space.',
    text: 'Drop frames, models, a calibration, poses, a library or a session anywhere on this page. Nothing leaves this computer.',
    demonstration: 'Open the demonstration',
    files: 'Open files',
  },

  top: {
    region: 'Study',
    undo: (label: string | null) => (label === null ? 'Undo' : `Undo: ${label}`),
    redo: (label: string | null) => (label === null ? 'Redo' : `Redo: ${label}`),
    open: 'Open files',
    openTitle: 'Open files (Ctrl+O)',
    save: 'Save',
    saveLabel: 'Save session',
    saveTitle: 'Save the session (Ctrl+S)',
    keys: 'Keys and mouse',
    keysTitle: 'Keys and mouse (?)',
    keysSign: '?',
    studyName: 'Name of the study',
    side: 'Side of the body',
    sides: { unknown: 'side?', left: 'left', right: 'right' },
    calibration: 'Calibration',
    noCalibration: 'none',
    noModel: 'no model',
    building: 'building',
    noLibrary: 'no library',
    chip: (label: string, text: string) => `${label}: ${text}`,
    notSaved: 'not saved',
    savedAt: (time: string) => `saved ${time}`,
    update: 'Update',
    updateTitle: 'A newer version is here. It takes over when the page is next opened; this button does it now, and asks first if work is not saved.',
    updateSaid: 'A newer version of the page is ready. Nothing changes until the page is opened again, or Update is pressed.',
  },

  status: {
    region: 'Status',
    log: 'Log',
    begin: 'Open frames, or the demonstration, to begin.',
    count: (done: number, total: number, unit: string) => `${done} of ${total} ${unit}`,
    preparing: 'preparing',
    job: (title: string, count: string, seconds: string) => `${title}: ${count}, ${seconds} s`,
    cancelJob: (title: string) => `Cancel: ${title}`,
    pointer: (column: string, row: string, grey: number | null) => `${column}, ${row} px${grey === null ? '' : ` · ${grey}`}`,
  },

  sheets: {
    calibration: 'Calibration',
    keys: 'Keys and mouse',
    log: 'Log',
    session: 'Save',
    convergence: 'Convergence',
  },

  log: { empty: 'Nothing has been said yet.' },

  calibration: {
    none: 'No calibration yet. Drop a JT_INTCALIB or MayaCam file, or type the numbers.',
    nameOnly: (name: string) => `${name}.`,
    facts: (name: string, focal: string, column: string, row: string) =>
      `${name}: focal length ${focal} px, principal point at ${column}, ${row} px.`,
    distance: 'Principal distance',
    pitch: 'Pixel pitch',
    pointX: 'Principal point x',
    pointY: 'Principal point y',
    meaning: "Distance from the X-ray focus to the detector; principal point from the frame's middle, x to the right, y up.",
    frameSize: (width: number, height: number) => `The frame has ${width} x ${height} px.`,
    typedName: 'typed',
    use: 'Use these numbers',
    open: 'Open a calibration file',
  },

  library: {
    model: (name: string) => `Model ${name}.`,
    noModel: 'No model yet.',
    needs: 'A library needs the model, a calibration and a frame; it is built as soon as they are here.',
    building: 'Its library is being built.',
    stopped: (reason: string) => `No library: ${reason}.`,
    builtIn: (seconds: string) => `built in ${seconds} s`,
    ready: (views: number, megabytes: string, origin: string) => `Library: ${views} views, ${megabytes} MB, ${origin}.`,
    open: 'Open a model, library or poses',
    fromModel: 'Build from the model instead',
    build: 'Build the library',
    views: 'Views of the library',
    nominal: (axis: 'x' | 'y') => `Nominal ${axis}`,
    from: (axis: 'x' | 'y') => `${axis} from`,
    to: (axis: 'x' | 'y') => `${axis} to`,
    step: (axis: 'x' | 'y') => `${axis} step`,
    distance: 'Distance',
    automatic: 'auto',
    area: 'Canonical area',
    use: 'Use these views',
    count: (views: number) => `${views} views`,
  },

  session: {
    meaning:
      'A session holds frames, calibration, models, outlines, poses, window and level: everything, in one file. A table holds poses with their standard deviations and the reason of each choice.',
    include: 'Include images and models (otherwise named by their SHA-256)',
    save: 'Save session file',
    poses: (component: string) => `${component} poses (.jts)`,
    table: (component: string) => `${component} table (.csv)`,
    tableTitle: 'With standard deviations and the reason of the choice, a row a frame',
  },

  convergence: {
    none: 'A refined pose has one; there is none here.',
    following: 'Following it ...',
    refining: 'Refining it once more ...',
    refused: (why: string) => `Not to be followed: ${why}`,
    noStep: 'Not a step was needed.',
    summary: (poses: number, renders: number) =>
      `${poses} poses, the model drawn ${renders} times. Each stage looks less far round the outline and trusts what is far off less.`,
    region: 'Steps of refinement',
    table: 'Poses on the way',
    columns: ['Stage', 'Drawn', 'Residual px', 'x mm', 'y mm', 'z mm', 'z rot °', 'x rot °', 'y rot °'],
    chart: (first: string, last: string, most: number) => `Residual from ${first} to ${last} px over ${most} drawings`,
    pixels: (value: number) => `${value} px`,
    drawings: (count: number) => `${count} drawings`,
  },

  hints: {
    hand: 'Drag to move the film, wheel to zoom at the cursor, 0 to see all of it.',
    window: 'Drag sideways for contrast, up and down for brightness; R goes back to what the film suggests.',
    noOutline: (component: string) => `No outline of the ${component} here: press P and click round it.`,
    onPoint: (point: number) => `Point ${point}: drag to move it; Alt-click or Delete removes it.`,
    onSide: 'Click to insert a point here; U marks this side unknown, or known again.',
    open: 'The outline is open: press P to go on tracing, Enter to close it.',
    closed: 'Drag a point to move it, click an edge to insert one, Alt-click a point to delete it.',
    first: (component: string) => `Click on the edge of the ${component} to begin its outline.`,
    closeHere: 'Click to close the outline here.',
    tooFew: (points: number) => `${counted(points)}. Click the next one along the edge; Backspace takes the last one back.`,
    goOn: (points: number) => `${counted(points)}. Go on along the edge; close with a click on the first point, a double click, or Enter.`,
  },
};

function counted(points: number): string {
  return points === 1 ? '1 point' : `${points} points`;
}
