/** Keys of going through the work: what is next, what was checked, flags and notes. */
export type WorkCommand =
  | 'next-unfinished'
  | 'previous-unfinished'
  | 'toggle-checked'
  | 'toggle-flagged'
  | 'write-note'
  | 'follow-film'
  | 'joint-curves'
  | 'work-list'
  | 'start-anew';

export interface WorkKey {
  /** As on the sheet. */
  readonly shown: string;
  readonly key: string;
  readonly shift: boolean;
  readonly alt?: boolean;
  readonly command: WorkCommand;
}

export const WORK_KEYS: readonly WorkKey[] = [
  { shown: 'N', key: 'n', shift: false, command: 'next-unfinished' },
  { shown: 'Shift + N', key: 'n', shift: true, command: 'previous-unfinished' },
  { shown: 'Y', key: 'y', shift: false, command: 'toggle-checked' },
  { shown: 'Shift + Y', key: 'y', shift: true, command: 'toggle-flagged' },
  { shown: 'Shift + J', key: 'j', shift: true, command: 'write-note' },
  { shown: 'Shift + G', key: 'g', shift: true, command: 'follow-film' },
  { shown: 'Shift + K', key: 'k', shift: true, command: 'joint-curves' },
  { shown: 'J', key: 'j', shift: false, command: 'work-list' },
  { shown: 'Shift + Alt + N', key: 'n', shift: true, alt: true, command: 'start-anew' },
];
