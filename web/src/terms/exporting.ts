import type { ComponentName } from './component';

/** What leaves the page as a file. */
export const EXPORTS = ['session', 'results', 'poses', 'joint', 'figure', 'report', 'film', 'outlines'] as const;
export type ExportKind = (typeof EXPORTS)[number];

/** Forms of each, the usual one first. */
export const FORMS = {
  session: ['whole', 'without files', 'study'],
  results: ['zip'],
  poses: ['jts', 'csv', 'jtak', 'jtap', 'tra', 'folder'],
  joint: ['csv', 'mot', 'cycle'],
  figure: ['svg', 'pdf', 'png'],
  report: ['html'],
  film: ['video', 'pictures'],
  outlines: ['outlines', 'coco', 'masks'],
} as const satisfies Record<ExportKind, readonly string[]>;
export type FormOf<K extends ExportKind> = (typeof FORMS)[K][number];

/** One file has the poses of both components. */
export function isOfBoth(form: FormOf<'poses'>): boolean {
  return form === 'tra' || form === 'folder';
}

/** What the export sheet shows, and would write. */
export interface Exporting {
  readonly kind: ExportKind;
  readonly forms: { readonly [K in ExportKind]: FormOf<K> };
  /** Whose poses, in a file of one component. */
  readonly component: ComponentName;
  /** Which number at 101 points, by the core's name. */
  readonly column: string;
}

export const DEFAULT_EXPORTING: Exporting = {
  kind: 'session',
  forms: { session: 'whole', results: 'zip', poses: 'jts', joint: 'csv', figure: 'svg', report: 'html', film: 'video', outlines: 'outlines' },
  component: 'femur',
  column: 'flexion_deg',
};
