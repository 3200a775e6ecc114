import { work } from '../workers/activity';
import type { ComponentName } from '../terms/component';
import type { Beside } from './film_beside';
import type { ReadProfiles } from '../workers/protocol/film';
import type { FilmReader } from './film_reader';
import type { Services } from './services';

type Bridges = ConstructorParameters<typeof FilmReader> extends [Services, infer Poses, infer Films] ? readonly [Poses, Films] : never;

/** The reader of the film, loaded with the first frames: an empty page has none to read. */
export class FilmLater {
  readonly #services: Services;
  readonly #bridges: Bridges;
  #reader: Promise<FilmReader> | null = null;

  constructor(services: Services, ...bridges: Bridges) {
    this.#services = services;
    this.#bridges = bridges;
    services.store.subscribe(() => void this.#load()?.catch(() => undefined));
  }

  /** When all that is there to be known is known. */
  async ready(): Promise<void> {
    await (await this.#load())?.ready();
  }

  async knowsBeside(component: ComponentName): Promise<boolean> {
    return (await this.#load())?.knowsBeside(component) ?? false;
  }

  async chooseSquares(read: (side: number) => Promise<readonly ReadProfiles[]>): Promise<number> {
    return (await (await this.#load())?.chooseSquares(read)) ?? 1;
  }

  async takeBeside(component: ComponentName, beside: Beside): Promise<void> {
    (await this.#load())?.takeBeside(component, beside);
  }

  async learnAgain(asked: ReadonlyMap<ComponentName, Beside>, signal: AbortSignal): Promise<boolean> {
    return (await (await this.#load())?.learnAgain(asked, signal)) ?? false;
  }

  #load(): Promise<FilmReader> | null {
    if (this.#services.store.doc.frames.length === 0) return this.#reader;
    return (this.#reader ??= this.#begin());
  }

  async #begin(): Promise<FilmReader> {
    const over = work.begin();
    try {
      const { FilmReader } = await import('./film_reader');
      return new FilmReader(this.#services, ...this.#bridges);
    } finally {
      over();
    }
  }
}
