import type { ComponentName } from '../terms/component';
import type { Doc } from './types';

/** A change to the document that undo takes back as one. */
export interface Command {
  /** Completes "Undo ...". */
  readonly label: string;
  /** Where it happened, so that undo can show it. */
  readonly place?: Place | null;
  /** Commands that follow each other with the same key are one undo unit. */
  readonly mergeKey?: string;
  readonly apply: (doc: Doc) => Doc;
}

export interface Place {
  readonly frameId: string;
  readonly component: ComponentName;
}
