import { type ComponentName, otherThan } from '../terms/component';
import { texts } from '../texts/texts';
import type { Report } from './services';

/** A frame was looked at, for a component. */
export type Looked = (component: ComponentName, frame: number) => void;

/**
 * How far following is: frame by frame first, and then one cannot say how many looks there will be at those that may lie otherwise,
 * so that the one that was looked at last is named in place of a count.
 */
export class Progress {
  readonly #report: Report;
  readonly #title: string;
  readonly #total: number;
  #followed = 0;
  #deciding: string = texts.follow.deciding;

  constructor(report: Report, total: number, title: string = texts.follow.job) {
    this.#report = report;
    this.#total = total;
    this.#title = title;
  }

  readonly followed: Looked = () => {
    this.#followed++;
    this.#tell();
  };

  readonly another: Looked = (component, frame) => {
    this.#deciding = texts.follow.decidingIn(texts.component[component], frame + 1);
    this.#tell();
  };

  /** It was looked for there, beside the other component. */
  readonly beside: Looked = (component, frame) => {
    this.#deciding = texts.follow.looking(texts.component[component], frame + 1, texts.component[otherThan(component)]);
    this.#tell();
  };

  #tell(): void {
    if (this.#followed < this.#total) this.#report(this.#followed, this.#total, { title: this.#title });
    else this.#report(0, 0, { title: this.#deciding, unit: '' });
  }
}
