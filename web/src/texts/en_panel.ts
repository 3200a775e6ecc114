import { ended } from './sentences';

/** The rail on the left and the panel on the right: the pose, how far to trust it, how the frame is shown. */
export const panel = {
  region: 'Pose',
  component: 'Component',
  switchTitle: (component: string) => `${component} (C switches)`,
  savePoses: (component: string) => `Save ${component} poses…`,
  savePosesTitle: 'As .jts, a table or others',
  deleteOutline: 'Delete outline',
  deleteOutlineTitle: 'Shift+Delete',

  rail: {
    region: 'Tools',
    markSide: 'Mark a side unknown or known',
    markSideTitle: 'Mark the side after the selected point unknown, or known again (U)',
    fit: 'Fit the frame to the window',
    fitTitle: 'Fit the frame to the window (0)',
  },

  pose: {
    region: 'Pose numbers',
    outdated: (needs: string) => `Found with another model, calibration or library. ${needs}`,
    fromFile: (name: string) => `From ${name}.`,
    refined: (residual: string, sure: boolean) =>
      `refined, ${residual} px; ${sure ? '± is one standard deviation' : 'the outline does not determine how sure'}`,
    laidBy: { tool: 'a tool', mixed: 'a tool and a hand', mask: 'a mask' },
    onEdges: (residual: string, who: string) =>
      `refined, ${residual} px, on an outline that ${who} laid on the frame's edges: ± is wide until the film is known`,
    byFilm: (residual: string, who: string) =>
      `refined on the frame by its film, ${residual} px, from an outline that ${who} laid; ± is one standard deviation`,
    follows: (residual: string) => `following the outline, ${residual} px; refined when it is at rest`,
    library: 'library',
    notRefined: (why: string) => `library. Not refined: ${why}`,
    needs: (what: string) => `For a pose: ${what}.`,
    verdict: 'Verdict',
    verdicts: { good: 'Good', doubtful: 'Doubtful', accepted: 'Checked', none: 'No pose' },
    accepted: (because: string) => `. It was doubtful: ${ended(because)}`,
    reason: (because: string) => `: ${because.charAt(0).toLowerCase()}${because.slice(1)}`,
    finding: 'Finding it ...',
    remedies: 'What to do',
    traceAgain: 'Trace it again',
    traceAgainTitle: 'Deletes the outline; Ctrl+Z brings it back',
    give: (component: string) => `It is the ${component}`,
    giveTitle: (component: string) => `Gives this outline to the ${component}, and looks there`,
    number: (name: string, value: string, unit: string) => `${name} ${value} ${unit}`,
    deviation: (name: string, value: string, unit: string) => `${name} plus or minus ${value} ${unit}`,
    deviationTitle: 'One standard deviation; the truth lies within two of them 95 times in 100',
    copyTitle: 'Click to copy with all its decimals',
    copied: (name: string, value: number) => `${name} copied: ${value}`,
    notCopied: 'The browser did not let the page copy to the clipboard.',
    convergence: 'Convergence',
    convergenceTitle: 'How refinement came to this pose, step by step',
  },

  candidates: {
    region: 'Score and candidates',
    unmatched: 'Unmatched',
    refined: 'Unmatched pixels, pose refined',
    ofLibrary: 'Unmatched pixels, pose of the library',
    beingRefined: 'Unmatched pixels, pose of the library, being refined',
    follows: 'Unmatched pixels, pose following the outline, being refined',
    of: (area: string | null) => (area === null ? 'px' : `px of ${area}`),
    list: 'Candidate poses',
    /** Best first. */
    names: ['Best', 'Rival', 'Third', 'Fourth'],
    candidate: (name: string) => `${name} candidate`,
    rivalTitle: 'Another pose that explains the outline nearly as well (X switches)',
    bestTitle: 'The pose that was chosen; the reason stands below (X switches)',
    rotations: (x: string, y: string) => `x ${x}, y ${y}`,
    pixels: (count: string) => `${count} px`,
    drawn: (count: string) => `${count} px differ`,
    atBorder:
      'The best view lies at the border of the library: the true rotation may lie beyond it. Choose all directions under the component above.',
    byHand: 'Chosen by hand; X goes back to the best.',
    compares: (reason: string) => `${reason} X takes the other.`,
    alone: 'No other view comes near: the choice is clear.',
    clear: (drawn: boolean, ratio: string) => `${rival(drawn)} misses ${ratio} times as many pixels: the choice is clear.`,
    close: (drawn: boolean, ratio: string) => `${rival(drawn)} misses only ${ratio} times as many pixels: compare both overlays with X.`,
    even: (drawn: boolean) => `${rival(drawn)} misses just as many pixels: compare both overlays with X.`,
  },

  joint: {
    region: 'Joint angles in this frame',
    angles: { flexion: 'Flexion', abduction: 'Abduction', internal_rotation: 'Internal' },
    /** Of the components whose poses are: one, or both. */
    doubt: (components: readonly string[]) => (components.length === 1 ? `The pose of the ${components[0]} is doubtful.` : 'Both poses are doubtful.'),
  },

  unmatched: {
    region: 'Unmatched pixels in the canonical frame',
    picture: 'Outline and library view in canonical form, black where they differ',
    working: 'No picture of the match yet',
    differs: 'outline and model differ',
    partial: 'from a part of the outline',
    clipped: 'cut by the picture',
    found: (milliseconds: string) => `found in ${milliseconds} ms`,
  },

  display: {
    region: 'Display',
    opacity: 'Overlay opacity',
    opacityShown: 'Overlay',
    percent: (value: number) => `${value} %`,
    width: 'Window width',
    level: 'Window level',
    reset: 'Reset window and level',
    resetTitle: 'R',
  },
};

function rival(drawn: boolean): string {
  return drawn ? 'Drawn at its pose, the rival' : 'The rival';
}
