import type { Preprocessing, OverlayStyle, PictureName } from '../terms/seeing';

/** English of how things are shown. */
export const seeing = {
  sheet: 'View',
  open: 'View',
  openTitle: 'How frame and model are shown, and what else is (9)',
  preprocessing: 'Frame',
  preprocessings: {
    original: 'Original',
    inverted: 'Inverted',
    edges: 'Edges',
    equalised: 'Equalised',
  } satisfies Record<Preprocessing, string>,
  overlay: 'Model',
  overlays: { outline: 'Outline', fill: 'Fill', shaded: 'Shaded' } satisfies Record<OverlayStyle, string>,
  besides: 'Also shown',
  magnifier: 'Magnifier',
  scaleBar: 'Scale bar',
  ghosts: 'Neighbouring outlines',
  compare: 'Compare with the other set',
  remembered: 'This browser remembers these choices.',
  scale: (length: string, component: string) => `Scale bar: ${length} at the ${component}`,
  pictures: 'Picture',
  picture: { unmatched: 'Fit', landscape: 'Landscape', space: '3-D' } satisfies Record<PictureName, string>,
  landscape: {
    region: 'Score landscape',
    grid: 'Scores of the library’s views',
    view: (x: string, y: string, unmatched: string) => `x ${x}, y ${y}: ${unmatched} px unmatched`,
    take: 'Click a view, or go there with the arrows and press Enter, to take its pose.',
    taken: (x: string, y: string) => `Took the view x ${x}, y ${y} as a candidate; X goes on to the others.`,
    best: (x: string, y: string) => `best at x ${x}, y ${y}`,
    rivals: (count: number) => (count === 1 ? '1 rival' : `${count} rivals`),
    axes: { across: 'y rotation', down: 'x rotation' },
    scale: (least: string, most: string) => `${least} to ${most} px unmatched, bright to dark`,
    working: 'Scoring ...',
    none: 'How well each view fits, as a map: click the implant (O), or trace it (P), and it comes here.',
    byHand: 'The pose was set by hand: go back to the page’s pose to take a view.',
  },
  edges: {
    region: 'Edges along the outline',
    picture: (times: number) => `The model’s outline, and the frame’s edges beside it, ${times} times as far off as they lie; red where there are none`,
    met: ({ met, known, residual }: { met: number; known: number; residual: number }, times: number) =>
      known === 0
        ? 'Nothing is seen along the outline.'
        : `${Math.round(100 * met)} % of ${seen(known)} lies on edges, ${residual.toFixed(2)} px off. They are drawn ${times} times as far.`,
    reading: 'Reading the frame’s edges ...',
    none: 'The edges of a pose show here once there is one.',
  },
  space: {
    region: 'Models in space',
    canvas: (names: string) => `${names} in space; drag or use the arrows to look from elsewhere`,
    loading: 'Loading the 3-D view ...',
    none: 'A model with a pose is shown here.',
    failed: (why: string) => `The 3-D view cannot be shown: ${why}`,
    noWebgl: 'this browser draws no 3-D pictures (WebGL is off or missing)',
    views: { camera: 'Camera', front: 'Front', side: 'Side', above: 'Above' },
    looking: 'Look from',
    large: 'Beside the frame',
  },
};

/** What nothing hides. */
function seen(known: number): string {
  return known > 0.95 ? 'the outline' : `the ${Math.round(100 * known)} % of the outline that can be seen`;
}
