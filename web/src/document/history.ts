import type { Doc } from './types';
import { Amended } from './amended';
import { carryResult } from './commands';
import type { Command, Place } from './command';

/**
 * Undo and redo over immutable documents. A command is one undo unit; a gesture previews as often as it likes and
 * becomes one unit when it ends; what the machine works out (a pose) amends the present and is no unit at all: undo and redo keep it.
 */
export interface History {
  readonly past: readonly Step[];
  readonly present: Doc;
  readonly future: readonly Step[];
  /** The document before a gesture that is under way. */
  readonly gestureStart: Doc | null;
  /** The document that was last written to a file or opened from one. */
  readonly saved: Doc;
  /** What the machine made of cells of all these documents. */
  readonly amended: Amended;
}

interface Step {
  readonly label: string;
  readonly place: Place | null;
  readonly mergeKey: string | null;
  /** The document on the step's other side: before it in `past`, after it in `future`. */
  readonly doc: Doc;
}

const DEPTH = 2000;

/** Undo goes back into so many works, the present one among them; the empty page between two is one more. Others are in the browser's storage. */
const WORKS = 4;

export function startHistory(doc: Doc): History {
  return { past: [], present: doc, future: [], gestureStart: null, saved: doc, amended: new Amended() };
}

/** A gesture under way goes on from it: what comes while a hand drags, as the answer to a click, is done to the document before the gesture. */
export function perform(history: History, command: Command): History {
  const { gestureStart, present } = history;
  const before = gestureStart ?? present;
  const after = command.apply(before);
  if (after === before) return history;
  const shown = gestureStart === null ? { present: after } : { gestureStart: after, present: command.apply(present) };
  return { ...history, ...shown, past: pushed(history.past, command, before), future: [] };
}

/** Shows a gesture's effect without making it an undo unit; always applied to the document before the gesture. */
export function preview(history: History, command: Command): History {
  const start = history.gestureStart ?? history.present;
  const changed = command.apply(start);
  const present = command.place ? carryResult(history.present, changed, command.place) : changed;
  return { ...history, gestureStart: start, present };
}

/** Ends a gesture: what is on view becomes one undo unit. */
export function commitPreview(history: History, command: Omit<Command, 'apply'>): History {
  const start = history.gestureStart;
  if (start === null) return history;
  const shown = history.present;
  return perform({ ...history, present: start, gestureStart: null }, { ...command, apply: () => shown });
}

export function cancelPreview(history: History): History {
  return history.gestureStart === null ? history : { ...history, present: history.gestureStart, gestureStart: null };
}

/**
 * Takes in what the machine worked out. No undo unit, and no unsaved work by itself. A gesture under way goes on from
 * it, too.
 */
export function amend(history: History, change: (doc: Doc) => Doc): History {
  const present = change(history.present);
  const gestureStart = history.gestureStart && change(history.gestureStart);
  if (present === history.present && gestureStart === history.gestureStart) return history;
  history.amended.note(history.present, present);
  if (history.gestureStart && gestureStart) history.amended.note(history.gestureStart, gestureStart);
  const amended = (doc: Doc) =>
    doc === history.present ? present : doc === history.gestureStart && gestureStart ? gestureStart : doc;
  return { ...history, present, gestureStart, saved: amended(history.saved) };
}

export function undo(history: History): History {
  const quiet = cancelPreview(history);
  const step = quiet.past.at(-1);
  if (!step) return quiet;
  return {
    ...quiet,
    ...shownOf(quiet, step),
    past: quiet.past.slice(0, -1),
    future: [...quiet.future, { ...step, mergeKey: null, doc: quiet.present }],
  };
}

export function redo(history: History): History {
  const quiet = cancelPreview(history);
  const step = quiet.future.at(-1);
  if (!step) return quiet;
  return {
    ...quiet,
    ...shownOf(quiet, step),
    past: [...quiet.past, { ...step, doc: quiet.present }],
    future: quiet.future.slice(0, -1),
  };
}

/** A step's document with all that was worked out since, which is no work of a person that would have to be saved. */
function shownOf({ amended, saved }: History, { doc }: Step): Pick<History, 'present' | 'saved'> {
  const present = amended.latest(doc);
  return { present, saved: saved === doc ? present : saved };
}

/** What undo and redo would touch, for their buttons and so that the page can show that place. */
export function nextUndo(history: History): Pick<Step, 'label' | 'place'> | null {
  return history.past.at(-1) ?? null;
}

export function nextRedo(history: History): Pick<Step, 'label' | 'place'> | null {
  return history.future.at(-1) ?? null;
}

export function markSaved(history: History, doc: Doc): History {
  return { ...history, saved: doc };
}

export function hasUnsavedWork(history: History): boolean {
  return history.present !== history.saved;
}

function pushed(past: readonly Step[], command: Omit<Command, 'apply'>, before: Doc): readonly Step[] {
  const last = past.at(-1);
  const mergeKey = command.mergeKey ?? null;
  if (last && mergeKey !== null && last.mergeKey === mergeKey) return past;
  const step: Step = { label: command.label, place: command.place ?? null, mergeKey, doc: before };
  return ofLatestWorks([...past.slice(-(DEPTH - 1)), step]);
}

function ofLatestWorks(steps: readonly Step[]): readonly Step[] {
  const works = new Set(['']);
  return steps.slice(1 + steps.findLastIndex(({ doc }) => works.add(doc.work).size > 1 + WORKS));
}
