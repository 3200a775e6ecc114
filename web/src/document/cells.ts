import { COMPONENT_NAMES, type ComponentName } from '../terms/component';

/** The cells of a frame. */
type Row<Cell> = Readonly<Record<ComponentName, Cell | null>>;
/** Some frames with their rows, by frame. */
type Page<Cell> = ReadonlyMap<string, Row<Cell>>;

export interface CellEntry<Cell> {
  readonly frameId: string;
  readonly component: ComponentName;
  readonly cell: Cell;
}

/** One that differs between two documents; null where there is none. */
export interface CellDifference<Cell> {
  readonly frameId: string;
  readonly component: ComponentName;
  readonly before: Cell | null;
  readonly after: Cell | null;
}

/** Frames of a page. */
const PAGE = 64;
const EMPTY_PAGE: Page<never> = new Map();
const EMPTY_ROW: Row<never> = { femur: null, tibia: null };

const numbers = new Map<string, number>();

/** Frames are numbered as they come, so that those of a film share pages. */
function pageOf(frameId: string): number {
  let number = numbers.get(frameId);
  if (number === undefined) numbers.set(frameId, (number = numbers.size));
  return Math.floor(number / PAGE);
}

/**
 * The cells of a document, immutable. A copy with one cell changed shares all but one page with the original: a step back holds
 * little, and what differs between two documents is found by looking at the pages that they do not share.
 */
export class Cells<Cell> {
  static readonly NONE = new Cells<never>([]);

  /** Public so that two that hold the same cells are equal to whoever compares them. */
  readonly pages: readonly Page<Cell>[];

  private constructor(pages: readonly Page<Cell>[]) {
    this.pages = pages;
  }

  /** By `cellKey`. */
  static from<Cell>(entries: Iterable<readonly [string, Cell]>): Cells<Cell> {
    let cells: Cells<Cell> = Cells.NONE;
    for (const [key, cell] of entries) cells = cells.with(...partsOf(key), cell);
    return cells;
  }

  at(frameId: string, component: ComponentName): Cell | null {
    return this.pages[pageOf(frameId)]?.get(frameId)?.[component] ?? null;
  }

  with(frameId: string, component: ComponentName, cell: Cell): Cells<Cell> {
    const number = pageOf(frameId);
    const page = new Map<string, Row<Cell>>(this.pages[number]);
    page.set(frameId, { ...(page.get(frameId) ?? EMPTY_ROW), [component]: cell });
    const pages = Array.from({ length: Math.max(this.pages.length, number + 1) }, (_, at) => this.pages[at] ?? EMPTY_PAGE);
    pages[number] = page;
    return new Cells(pages);
  }

  get isEmpty(): boolean {
    return this.pages.every((page) => page.size === 0);
  }

  entries(): readonly CellEntry<Cell>[] {
    return this.pages.flatMap((page) => entriesOf(page));
  }

  /** Each cell changed; pages in which all stay the same are the same. */
  map(change: (cell: Cell, frameId: string, component: ComponentName) => Cell): Cells<Cell> {
    let isSame = true;
    const pages = this.pages.map((page) => {
      const changed = mapped(page, change);
      isSame &&= changed === page;
      return changed;
    });
    return isSame ? this : new Cells(pages);
  }

  /** What differs in `after`. */
  differences(after: Cells<Cell>): readonly CellDifference<Cell>[] {
    if (this === after) return [];
    const found: CellDifference<Cell>[] = [];
    for (let at = 0; at < Math.max(this.pages.length, after.pages.length); at++) {
      const [old, now] = [this.pages[at] ?? EMPTY_PAGE, after.pages[at] ?? EMPTY_PAGE];
      if (old !== now) found.push(...differencesOf(old, now));
    }
    return found;
  }
}

/** Of a `cellKey`. */
export function partsOf(key: string): readonly [frameId: string, component: ComponentName] {
  const at = key.lastIndexOf('/');
  return [key.slice(0, at), key.slice(at + 1) as ComponentName];
}

function entriesOf<Cell>(page: Page<Cell>): readonly CellEntry<Cell>[] {
  const found: CellEntry<Cell>[] = [];
  for (const [frameId, row] of page) {
    for (const component of COMPONENT_NAMES) {
      const cell = row[component];
      if (cell !== null) found.push({ frameId, component, cell });
    }
  }
  return found;
}

function mapped<Cell>(page: Page<Cell>, change: (cell: Cell, frameId: string, component: ComponentName) => Cell): Page<Cell> {
  let result = page;
  for (const { frameId, component, cell } of entriesOf(page)) {
    const changed = change(cell, frameId, component);
    if (changed === cell) continue;
    const copy: Map<string, Row<Cell>> = result === page ? new Map(page) : (result as Map<string, Row<Cell>>);
    result = copy.set(frameId, { ...copy.get(frameId)!, [component]: changed });
  }
  return result;
}

function differencesOf<Cell>(old: Page<Cell>, now: Page<Cell>): readonly CellDifference<Cell>[] {
  const found: CellDifference<Cell>[] = [];
  for (const frameId of new Set([...old.keys(), ...now.keys()])) {
    const [then, later] = [old.get(frameId) ?? EMPTY_ROW, now.get(frameId) ?? EMPTY_ROW];
    if (then === later) continue;
    for (const component of COMPONENT_NAMES) {
      const [before, after] = [then[component], later[component]];
      if (before !== after) found.push({ frameId, component, before, after });
    }
  }
  return found;
}

/**
 * Finds the cells that pass a test, again and again while they change: a page is looked at anew only when it is another one, or when
 * what the test depends on besides the cell is.
 */
export class CellIndex<Cell> {
  readonly #test: (entry: CellEntry<Cell>) => boolean;
  #found = new WeakMap<Page<Cell>, readonly CellEntry<Cell>[]>();
  #inputs: readonly unknown[] = [];

  constructor(test: (entry: CellEntry<Cell>) => boolean) {
    this.#test = test;
  }

  /** `inputs`: what else the test depends on, compared by identity. */
  in(cells: Cells<Cell>, ...inputs: readonly unknown[]): readonly CellEntry<Cell>[] {
    if (inputs.some((input, at) => input !== this.#inputs[at])) {
      this.#found = new WeakMap();
      this.#inputs = inputs;
    }
    return cells.pages.flatMap((page) => this.#of(page));
  }

  #of(page: Page<Cell>): readonly CellEntry<Cell>[] {
    const known = this.#found.get(page);
    if (known) return known;
    const found = entriesOf(page).filter(this.#test);
    this.#found.set(page, found);
    return found;
  }
}
