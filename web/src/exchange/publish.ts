import { knownAxes } from '../document/axes';
import { digestOf } from '../document/digest';
import { checkState, markOf } from '../document/marks';
import { filesOf } from '../document/named_files';
import { methodOf } from '../document/session/table';
import { type Cell, cellOf, type Doc, type Mark } from '../document/types';
import type { JointNumbers } from '../results/joint_curves';
import { faultsOf, inRuns, type PoseFaults } from '../results/joint_faults';
import { doubtOf } from '../results/motion';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import type { PublishedFilm, PublishedFrame } from '../workers/protocol/joint';

/**
 * All that files, figure and report of a joint tell. Its words are the same for whoever reads them with whatever program, so they
 * are in no other language than English.
 */
export async function publishedFilm(doc: Doc, numbers: JointNumbers): Promise<PublishedFilm> {
  return {
    name: doc.name,
    rate: doc.rate ?? NaN,
    frames: doc.frames.map(({ id }) => frameOf(doc, id, numbers)),
    inputs: await inputsOf(doc),
    settings: settingsOf(doc),
    remarks: remarksOf(doc),
  };
}

function frameOf(doc: Doc, frameId: string, numbers: JointNumbers): PublishedFrame {
  const cells = COMPONENT_NAMES.map((component) => ({ component, cell: cellOf(doc, frameId, component), mark: markOf(doc, { frameId, component }) }));
  const row = numbers.of.get(frameId);
  const doubts = cells.flatMap(({ component, cell, mark }) => doubtIn(component, cell, mark));
  const accepted = cells.flatMap(({ component, cell, mark }) => acceptedIn(component, cell, mark));
  return {
    // A copy: what goes to a worker is not seen here again.
    numbers: row ? Float64Array.from(row) : null,
    checked: cells.every(({ cell, mark }) => checkState(cell, mark) === 'yes'),
    doubt: doubts.length > 0 ? doubts.join('; ') : null,
    accepted: accepted.length > 0 ? accepted.join('; ') : null,
  };
}

/** They count, and whoever reads of them is to know. */
function acceptedIn(component: ComponentName, cell: Cell, mark: Mark): string[] {
  const doubt = checkState(cell, mark) === 'yes' ? doubtOf(cell) : null;
  return doubt === null ? [] : [`${component}: ${doubt}`];
}

/** In the words of the command line's table of states. What a person has accepted counts. */
function doubtIn(component: ComponentName, cell: Cell, mark: Mark): string[] {
  if (cell.result?.kind === 'failed') return [`${component} no pose: ${cell.result.sentence}`];
  const doubt = checkState(cell, mark) === 'yes' ? null : doubtOf(cell);
  return doubt === null ? [] : [`${component} doubtful: ${doubt}`];
}

async function inputsOf(doc: Doc): Promise<PublishedFilm['inputs']> {
  const inputs: { what: string; name: string; sha256: string }[] = [];
  if (doc.calibration) {
    const { name, text } = doc.calibration;
    inputs.push({ what: 'calibration', name, sha256: await digestOf(new TextEncoder().encode(text)) });
  }
  for (const component of COMPONENT_NAMES) {
    const { model } = doc.components[component];
    if (model) inputs.push({ what: `${component === 'femur' ? 'femoral' : 'tibial'} model`, ...model });
  }
  return [...inputs, ...(await framesAmong(doc))];
}

/** More files of frames than this are named together: by the digest of their digests, in the film's order. */
const FEW_FILES = 6;

async function framesAmong(doc: Doc): Promise<PublishedFilm['inputs']> {
  const sources = new Set(doc.frames.map(({ source }) => source));
  const files = filesOf(doc).filter(({ sha256 }) => sources.has(sha256));
  if (files.length <= FEW_FILES) return files.map((file) => ({ what: 'frames', ...file }));
  const digests = files.map(({ sha256 }) => `${sha256}\n`).join('');
  const name = `${files.length} files, ${files[0]?.name} to ${files.at(-1)?.name}; the digest is that of their digests, a line each`;
  return [{ what: 'frames', name, sha256: await digestOf(new TextEncoder().encode(digests)) }];
}

function settingsOf(doc: Doc): PublishedFilm['settings'] {
  const poses = COMPONENT_NAMES.map((component): readonly [string, string] => [`poses of the ${component}`, methodsOf(doc, component)]);
  const { known } = doc.film;
  return [...poses, ['constants of the film', known ? known.words : 'not known'], ['distortion', distortionOf(doc)]];
}

function distortionOf({ distortion }: Doc): string {
  return distortion ? `corrected, of ${distortion.appliesTo}` : 'not corrected';
}

/** How the poses of a component were found, the most frequent first. */
function methodsOf(doc: Doc, component: ComponentName): string {
  const counts = new Map<string, number>();
  for (const { id } of doc.frames) {
    const { result } = cellOf(doc, id, component);
    const method = result?.kind === 'posed' ? methodOf(result) : 'none';
    counts.set(method, (counts.get(method) ?? 0) + 1);
  }
  const sorted = [...counts].sort(([, a], [, b]) => b - a);
  return sorted.map(([method, count]) => `${method}: ${count} of ${doc.frames.length}`).join('; ');
}

const SAID: Readonly<Record<Exclude<keyof PoseFaults, 'missing' | 'doubtful'>, string>> = {
  unrefined: 'Frames with a pose that was not refined',
  unknown: 'Frames with a pose from a file, which does not say how it was found',
  outdated: 'Frames with a pose that was found with another model, calibration or library',
  unchecked: 'Frames of which no person has checked both poses',
};

/** What people wrote at frames, in their order. */
function notesOf(doc: Doc): string[] {
  return doc.frames.flatMap(({ id }, index) =>
    COMPONENT_NAMES.flatMap((component) => {
      const note = markOf(doc, { frameId: id, component }).note.replace(/\s+/g, ' ').trim();
      return note === '' ? [] : [`Note on the ${component} in frame ${index + 1}: ${note}`];
    }),
  );
}

/** What the report's own lists do not have. */
function remarksOf(doc: Doc): string[] {
  const faults = faultsOf(doc);
  const remarks = (['unrefined', 'unknown', 'outdated', 'unchecked'] as const).flatMap((fault) => {
    const frames = faults[fault];
    return frames.length > 0 ? [`${SAID[fault]}: ${inRuns(frames, Infinity)} (${frames.length} of ${doc.frames.length}).`] : [];
  });
  const assumed = COMPONENT_NAMES.filter((component) => !doc.components[component].axes && knownAxes(doc.components[component]));
  if (doc.unread.length > 0) remarks.unshift(`Frames that could not be read: ${doc.unread.join(', ')}. They are not counted, neither in numbers of frames nor in times.`);
  return [...remarks, ...notesOf(doc), ...assumed.map((component) => `The axes of the ${component} are taken to be those of its file: there is no model of it.`)];
}
