import { writeCoco } from '../exchange/coco';
import { writeOutlines } from '../exchange/outline_file';
import { cellOf, type Outline } from '../document/types';
import { COMPONENT_NAMES } from '../terms/component';
import { PROGRAM } from '../terms/program';
import { sentenceOf, type Services } from '../jobs/services';
import { texts } from '../texts/texts';
import { Aborted } from '../workers/bridge';
import { download, fileStem } from '../exchange/browser_files';

/** Outlines on their way out, in three forms. */
export class ExchangeActions {
  readonly #services: Services;

  constructor(services: Services) {
    this.#services = services;
  }

  saveOutlines(): void {
    const { doc } = this.#services.store;
    download([writeOutlines(doc, PROGRAM)], `${fileStem(doc.name)}.outlines.json`, 'application/json');
    this.#tell(this.#outlines(), 0, 0);
  }

  saveCoco(): void {
    const { doc } = this.#services.store;
    download([writeCoco(doc, PROGRAM)], `${fileStem(doc.name)}.coco.json`, 'application/json');
    this.#tellClosed();
  }

  async saveMasks(): Promise<void> {
    const { store } = this.#services;
    try {
      const { exportMasks } = await import('../exchange/exporter');
      const zip = await exportMasks(this.#services);
      if (!zip) return store.say('info', texts.exchange.noneClosed);
      download([zip], `${fileStem(store.doc.name)}_masks.zip`, 'application/zip');
      this.#tellClosed();
    } catch (error) {
      if (!(error instanceof Aborted)) store.say('error', sentenceOf(error));
    }
  }

  hasOutlines(): boolean {
    return this.#outlines().length > 0;
  }

  #outlines(): Outline[] {
    const { doc } = this.#services.store;
    const all = doc.frames.flatMap(({ id }) => COMPONENT_NAMES.map((component) => cellOf(doc, id, component).outline));
    return all.filter((outline) => outline !== null);
  }

  #tellClosed(): void {
    const outlines = this.#outlines();
    const closed = outlines.filter((outline) => outline.closed);
    this.#tell(closed, outlines.length - closed.length, closed.filter(({ unknownSides }) => unknownSides.length > 0).length);
  }

  #tell(saved: readonly Outline[], drafts: number, unknown: number): void {
    this.#services.store.say('info', texts.exchange.saved(saved.length, drafts, unknown));
  }
}
