import { withCell } from '../document/commands';
import type { Place } from '../document/command';
import { CONSTANTS, filmNumbers, squareOf, withKnownFilm } from '../document/film';
import { isSilhouette } from '../document/laid_by';
import { itsOutline, setItsOutline } from '../document/own_outlines';
import { type Candidate, cellOf, type FilmModel, type FrameEntry, type KnownFilm, type Posed, UNMET } from '../document/types';
import { middleOf } from '../geometry/mesh_middle';
import { pointsFrom } from '../geometry/points';
import type { Vector } from '../geometry/pose_motion';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { indexOfFrame } from '../document/frame_index';
import { corrected, foundOnFrames, isNear, isNews, meetsFrames, misfitsBeside, needsCorrection, settled, type Witness, witnesses } from '../results/film';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import type { ToolName } from '../terms/tool';
import { asSentence } from '../texts/sentences';
import { Aborted, type Bridge } from '../workers/bridge';
import type { Corrected, FilmFacts, FilmProtocol, FollowedProfiles, ReadProfiles } from '../workers/protocol/film';
import type { PoseProtocol } from '../workers/protocol/pose';
import { type Beside, ReadBeside } from './film_beside';
import { onFrameInput } from './from_here';
import { MasksTold } from './masks_told';
import { Pause } from './pause';
import { sentenceOf, type Services } from './services';

/** No pose is near it. */
const ELSEWHERE: PoseNumbers = { x: Infinity, y: 0, z: 0, zRot: 0, xRot: 0, yRot: 0 };

/** How long the document rests before its frames are asked, ms: while a hand moves nothing is worth reading. */
export const FILM_REST = 40;

/** A pose at which profiles were read, or are when they are wanted: those of an opened session were told before. */
interface Entry {
  readonly witness: Witness;
  readonly isRead: boolean;
}

/**
 * Keeps what is known of the study's film up to date: profiles across the outlines of posed components are read in the pose
 * worker, the constants are estimated from all of them in a worker of their own, and poses that were found on a frame before are
 * corrected when the constants change what is known. What a person set or checked never changes.
 */
export class FilmReader {
  readonly #services: Services;
  readonly #poses: Pick<Bridge<PoseProtocol>, 'call'>;
  readonly #films: Pick<Bridge<FilmProtocol>, 'call'>;
  readonly #entries = new Map<string, Entry>();
  /** The worker has profiles of them, of a work that is shown no more. */
  readonly #left = new Map<string, Witness>();
  readonly #beside = new ReadBeside();
  /** Of the squares that profiles are read in, pixels; chosen before anything is estimated, and anew where a film is followed. */
  #side = 1;
  #isSideChosen = false;
  /** What the page worked out itself, or adopted. */
  readonly #taken = new WeakSet<KnownFilm>();
  /** They cannot be corrected. */
  readonly #refused = new WeakSet<Posed>();
  #last: KnownFilm | null = null;
  /** The poses that were there when nothing was left to be asked or corrected. */
  readonly #rested = new WeakMap<KnownFilm, readonly Witness[]>();
  /** How often these very poses were asked. */
  #turns = 0;
  #asked: string | null = null;
  /** Constants that somebody stated, while they are not taken. */
  #tried: string | null = null;
  readonly #masks: MasksTold;
  readonly #pause = new Pause();
  #busy = false;
  #waiting: (() => void)[] = [];

  constructor(services: Services, poses: Pick<Bridge<PoseProtocol>, 'call'>, films: Pick<Bridge<FilmProtocol>, 'call'>) {
    this.#services = services;
    this.#poses = poses;
    this.#films = films;
    this.#masks = new MasksTold(services.store);
    services.store.subscribe(() => this.#consider());
    this.#consider();
  }

  /** When all that is there to be known is known: for who asks once and for good. */
  ready(): Promise<void> {
    if (!this.#busy && !this.#task()) return Promise.resolve();
    return new Promise((go) => this.#waiting.push(go));
  }

  /** Was the film read beside poses of the component, as they are? */
  knowsBeside(component: ComponentName): boolean {
    this.#beside.keepTo(this.#services.store.doc, (component) => this.#middleOf(component));
    return this.#beside.has(component);
  }

  /** The side of the squares of pixels that the film is read in from now on, by what `read` reads in those that are tried. */
  async chooseSquares(read: (side: number) => Promise<readonly ReadProfiles[]>): Promise<number> {
    const { stated } = this.#services.store.doc.film;
    let { wanted, side, isTold } = await this.#films.call('beginSquares', { stated });
    while (wanted !== null) {
      const found = await this.#films.call('takeSquares', { read: await read(wanted), stated });
      isTold ||= found.isTold;
      ({ wanted, side } = found);
    }
    // Wrong poses tell nothing: others are asked as they come.
    this.#isSideChosen = isTold;
    if (side !== this.#side) this.#readAnew(side);
    return side;
  }

  #inSquaresOf({ models: { femur, tibia } }: KnownFilm): void {
    const side = squareOf((femur ?? tibia)?.numbers ?? null);
    this.#isSideChosen = true;
    if (side !== this.#side) this.#readAnew(side);
  }

  /** What was read in other squares is of no use. */
  #readAnew(side: number): void {
    this.#side = side;
    this.#asked = null;
    this.#left.clear();
    this.#beside.clear();
    for (const [key, { witness }] of this.#entries) this.#entries.set(key, { witness, isRead: false });
  }

  takeBeside(component: ComponentName, beside: Beside): void {
    this.#beside.set(component, beside);
    this.#consider();
  }

  /**
   * Compares what is known of the film with frames in which followed components are good, and takes what these tell, and the profiles in place of those
   * from beside poses that the components were followed from, where it does not stand; whether it did not.
   */
  async learnAgain(asked: ReadonlyMap<ComponentName, Beside>, signal: AbortSignal): Promise<boolean> {
    await this.ready();
    this.#busy = true;
    this.#pause.end();
    try {
      const { stated } = this.#services.store.doc.film;
      const followed = this.#followed(asked);
      const facts = followed && (await this.#films.call('learntAgain', { followed, stated }));
      if (!facts || signal.aborted) return false;
      for (const [component, beside] of asked) this.#beside.set(component, beside);
      await this.#films.call('take', { read: this.#beside.handOver((...at) => this.#isReadItself(...at)), side: this.#side });
      const known = this.#knownFrom(facts);
      this.#taken.add(known);
      this.#last = known;
      // Poses that this corrects are read anew.
      this.#turns = 0;
      this.#services.store.amend((doc) => withKnownFilm(doc, known));
      return true;
    } finally {
      this.#busy = false;
      queueMicrotask(() => this.#consider());
    }
  }

  /** Null where of one of them nothing is known to be compared. */
  #followed(asked: ReadonlyMap<ComponentName, Beside>): readonly FollowedProfiles[] | null {
    const { doc } = this.#services.store;
    const followed = [...asked].flatMap(([component, { read }]) => {
      const known = filmNumbers(doc, component);
      return known ? [{ component, known, read }] : [];
    });
    return followed.length === asked.size ? followed : null;
  }

  #isReadItself(component: ComponentName, frame: number): boolean {
    return [...this.#entries.values()].some(({ witness, isRead }) => isRead && witness.component === component && witness.frame === frame);
  }

  #consider(): void {
    this.#pause.end();
    this.#beside.keepTo(this.#services.store.doc, (component) => this.#middleOf(component));
    if (this.#busy || this.#adopt()) return;
    const task = this.#task();
    if (!task) {
      const { known } = this.#services.store.doc.film;
      if (known && known === this.#last) this.#rested.set(known, this.#witnesses(() => true));
      this.#masks.rested();
      return void this.#waiting.splice(0).forEach((go) => go());
    }
    this.#pause.before(FILM_REST, () => void this.#run());
  }

  /** A film from a session, or from before a step back, was told by the poses that are there with it. */
  #adopt(): boolean {
    const { store } = this.#services;
    const { known, stated } = store.doc.film;
    if (known && !this.#taken.has(known)) {
      this.#taken.add(known);
      this.#inSquaresOf(known);
      this.#last = known;
      this.#asked = JSON.stringify(known.stated);
      this.#leave();
      // Its frames and libraries may be on their way yet.
      for (const witness of this.#witnesses(() => true)) this.#entries.set(witness.key, { witness, isRead: false });
      return false;
    }
    if (known && this.#isBack(known)) {
      this.#inSquaresOf(known);
      this.#last = known;
      this.#asked = JSON.stringify(known.stated);
      this.#backTo(this.#witnesses(() => true));
      return false;
    }
    const isBehind = stated.constants === null && known !== this.#last && JSON.stringify(stated) === this.#asked && !this.#isOpen(this.#witnesses());
    if (isBehind) store.amend((doc) => withKnownFilm(doc, this.#last));
    return isBehind;
  }

  /** A step back, or on again, brought a film with the poses that it was told by: it holds, though the worker would tell another by now. */
  #isBack(known: KnownFilm): boolean {
    const then = known === this.#last ? undefined : this.#rested.get(known);
    if (!then) return false;
    const here = this.#witnesses(() => true);
    if (then.length !== here.length || JSON.stringify(known.stated) !== JSON.stringify(this.#services.store.doc.film.stated)) return false;
    const poses = new Map(then.map(({ key, pose }) => [key, pose]));
    return here.every(({ key, component, pose }) => isNear(poses.get(key) ?? ELSEWHERE, pose, this.#middleOf(component)));
  }

  /** What was read elsewhere is read anew where it is wanted. */
  #backTo(here: readonly Witness[]): void {
    const before = new Map(this.#entries);
    this.#entries.clear();
    for (const witness of here) {
      const entry = before.get(witness.key);
      const stands = entry && isNear(entry.witness.pose, witness.pose, this.#middleOf(witness.component));
      this.#entries.set(witness.key, stands ? entry : { witness, isRead: false });
      if (stands) before.delete(witness.key);
    }
    for (const { witness, isRead } of before.values()) if (isRead) this.#left.set(witness.key, witness);
  }

  /** Profiles of another work tell nothing of this one. */
  #leave(): void {
    for (const { witness, isRead } of this.#entries.values()) if (isRead) this.#left.set(witness.key, witness);
    this.#entries.clear();
  }

  #task(): (() => Promise<void>) | null {
    const { doc } = this.#services.store;
    if (!this.#isWanted()) return null;
    const here = this.#witnesses();
    if (doc.film.stated.constants) return this.#isTaken() ? this.#correction() : this.#taking();
    const tells = here.length > 0 || !this.#beside.isEmpty || doc.film.known !== null;
    const isStated = JSON.stringify(doc.film.stated) !== this.#asked && tells;
    if (this.#isOpen(here) || this.#beside.isNews || isStated) return () => this.#estimate(here);
    return this.#correction();
  }

  /** Are the constants that somebody stated known, of the models as they are? */
  #isTaken(): boolean {
    const { film, components } = this.#services.store.doc;
    const { known, stated } = film;
    const isOfModel = (component: ComponentName) => {
      const attenuation = stated.constants?.attenuation[component] ?? null;
      const sha256 = components[component].model?.sha256;
      return attenuation === null || sha256 === undefined || known?.models[component]?.of === sha256;
    };
    return known !== null && JSON.stringify(known.stated) === JSON.stringify(stated) && COMPONENT_NAMES.every(isOfModel);
  }

  /** What fails is not tried again. */
  #taking(): (() => Promise<void>) | null {
    const { film, components } = this.#services.store.doc;
    const tried = JSON.stringify([film.stated, COMPONENT_NAMES.map((component) => components[component].model?.sha256)]);
    if (tried === this.#tried) return null;
    return async () => {
      this.#tried = tried;
      await this.#estimate([]);
      this.#tried = null;
    };
  }

  /**
   * The next pose that is to be corrected. One that never was comes first: what it leaves is held against what others left before
   * it had its say on the film, or a tray on its inner rim would bend the film until that is usual.
   */
  #correction(): (() => Promise<void>) | null {
    const { doc } = this.#services.store;
    const open = foundOnFrames(doc).flatMap(({ frameId, component }) => {
      const frame = doc.frames[indexOfFrame(doc, frameId)]!;
      const cell = needsCorrection(doc, component, frame);
      const isPossible = cell && !this.#refused.has(cell.result) && this.#isReady(component, frame);
      return isPossible ? [{ place: { component, frameId }, result: cell.result }] : [];
    });
    const next = open.find(({ result }) => result.onFrame?.film === null) ?? open[0];
    return next ? () => this.#correctOnce(next.place, next.result) : null;
  }

  /** Traced outlines do without it: it is asked once a pose meets a frame, or is about to. */
  #isWanted(): boolean {
    const { doc, ui } = this.#services.store;
    return !this.#beside.isEmpty || this.#beside.isNews || MEETING_FRAMES.includes(ui.tool) || doc.film.known !== null || doc.film.stated.constants !== null || meetsFrames(doc);
  }

  #witnesses(isReady = (component: ComponentName, frame: FrameEntry) => this.#isReady(component, frame)): readonly Witness[] {
    return witnesses(this.#services.store.doc, isReady, (key) => this.#entries.has(key));
  }

  /** Of the model; its origin while it is not at hand, when nothing can be read anyway. */
  #middleOf(component: ComponentName): Vector {
    const { store, studio } = this.#services;
    const mesh = studio.meshOf(store.doc.components[component].model?.sha256 ?? '');
    return mesh ? middleOf(mesh) : [0, 0, 0];
  }

  #isReady(component: ComponentName, frame: FrameEntry): boolean {
    const { store, studio } = this.#services;
    const { model } = store.doc.components[component];
    return model !== null && store.ui.libraries[component].state === 'ready' && studio.hasFrame(frame.id);
  }

  /** Are there poses enough that were not asked, one that lies elsewhere now, or was one asked that is gone? */
  #isOpen(here: readonly Witness[]): boolean {
    const entries = [...this.#entries.values()];
    const isMoved = ({ key, component, pose, hasLed }: Witness) => !hasLed && !isNear(this.#entries.get(key)?.witness.pose ?? pose, pose, this.#middleOf(component));
    const fresh = here.filter(({ key }) => !this.#entries.has(key));
    const isFirst = ({ component }: Witness) => !entries.some(({ witness }) => witness.component === component);
    const isEnough = fresh.length > 0 && fresh.length >= MORE * entries.length;
    return isEnough || fresh.some(isFirst) || (this.#turns < TURNS && here.some(isMoved)) || this.#gone(this.#witnesses(() => true)).length > 0;
  }

  #gone(here: readonly Witness[]): readonly Witness[] {
    const keys = new Set(here.map(({ key }) => key));
    return [...this.#entries.values()].flatMap(({ witness }) => (keys.has(witness.key) ? [] : [witness]));
  }

  async #run(): Promise<void> {
    const task = this.#task();
    if (!task) return;
    this.#busy = true;
    try {
      await task();
    } catch (error) {
      if (!(error instanceof Aborted)) this.#services.store.say('error', sentenceOf(error));
    } finally {
      this.#busy = false;
      queueMicrotask(() => this.#consider());
    }
  }

  /** By the first frames in which each component has a pose. */
  async #chooseSide(here: readonly Witness[]): Promise<void> {
    const first = COMPONENT_NAMES.flatMap((name) => here.filter(({ component }) => component === name).sort((a, b) => a.frame - b.frame).slice(0, FIRST));
    // Another work is another film.
    const isOfThese = !this.#beside.isEmpty || here.some(({ key }) => this.#entries.has(key));
    if ((this.#isSideChosen && isOfThese) || first.length === 0) return;
    const read = async (witness: Witness, side: number) => ({ ...namesOf(witness), profiles: await this.#profilesOf(witness, side) });
    await this.chooseSquares((side) => Promise.all(first.map((witness) => read(witness, side))));
  }

  async #estimate(here: readonly Witness[]): Promise<void> {
    const { store } = this.#services;
    const { stated } = store.doc.film;
    await this.#chooseSide(here);
    this.#asked = JSON.stringify(stated);
    const read: ReadProfiles[] = [];
    const gone = stated.constants ? [] : this.#gone(here);
    this.#turns = gone.length > 0 || here.some(({ key }) => !this.#entries.has(key)) ? 1 : this.#turns + 1;
    for (const { key } of gone) this.#entries.delete(key);
    for (const { component, frame } of [...this.#left.values(), ...gone]) read.push(this.#beside.inPlaceOf(component, frame));
    this.#left.clear();
    if (!stated.constants) {
      const own = new Set(here.map(({ component, frame }) => `${component} ${frame}`));
      read.push(...this.#beside.handOver((component, frame) => own.has(`${component} ${frame}`)));
    }
    for (const witness of here) {
      const entry = this.#entries.get(witness.key);
      if (entry?.isRead && (witness.hasLed || isNear(entry.witness.pose, witness.pose, this.#middleOf(witness.component)))) continue;
      this.#entries.set(witness.key, { witness, isRead: true });
      read.push({ ...namesOf(witness), profiles: await this.#profilesOf(witness) });
    }
    try {
      const facts = await this.#films.call('estimate', { read, stated, side: this.#side });
      const isClipped = facts !== null && 'clipped' in facts;
      this.#sayClipped(isClipped ? facts.clipped : null);
      this.#take(facts && !isClipped ? this.#knownFrom(facts) : null);
    } catch (error) {
      // What the worker knew may be gone with it.
      for (const [key, { witness }] of this.#entries) this.#entries.set(key, { witness, isRead: false });
      this.#beside.forgotten();
      throw error;
    }
  }

  /** That grey values are cut off is said when it is seen first, whatever part of the outlines that is of later. */
  #sayClipped(clipped: string | null): void {
    const { store } = this.#services;
    const isNew = clipped !== null && store.ui.clipped === null;
    if (clipped !== store.ui.clipped) store.show({ clipped });
    if (isNew) store.say('info', asSentence(clipped), undefined, 'film');
  }

  /** None where the frame cannot be held against the pose. */
  async #profilesOf({ component, frameId, pose }: Witness, side = this.#side): Promise<Float32Array<ArrayBuffer>> {
    try {
      const input = await onFrameInput(this.#services, { component, frameId });
      return await this.#poses.call('filmProfiles', { ...input, pose, side }, { lane: 'film', transfer: [input.frame.pixels.buffer] });
    } catch (error) {
      if (error instanceof Aborted) throw error;
      return new Float32Array();
    }
  }

  #knownFrom({ words, blur, curved, profiles, models }: FilmFacts): KnownFilm {
    const { doc } = this.#services.store;
    const model = (component: ComponentName): FilmModel | null => {
      const of = doc.components[component].model?.sha256;
      const numbers = models[component];
      return of !== undefined && numbers ? { of, numbers } : null;
    };
    return { words, stated: doc.film.stated, blur, curved, profiles, models: { femur: model('femur'), tibia: model('tibia') } };
  }

  #take(found: KnownFilm | null): void {
    const { store } = this.#services;
    const { known } = store.doc.film;
    const taken = isNews(known, found) ? found : known;
    if (taken) this.#taken.add(taken);
    this.#last = taken;
    store.amend((doc) => withKnownFilm(doc, taken));
  }

  /** What fails is not tried again. */
  async #correctOnce(place: Place, result: Posed): Promise<void> {
    try {
      await this.#correct(place, result);
    } catch (error) {
      this.#refused.add(result);
      throw error;
    }
  }

  /** The frame does not lead on from the pose at all. */
  #refuse(place: Place, result: Posed): void {
    const after: Posed = { ...result, verdict: result.verdict?.word === 'doubtful' ? result.verdict : UNMET };
    for (const one of [result, after]) this.#refused.add(one);
    this.#services.store.amend((doc) => {
      const cell = cellOf(doc, place.frameId, place.component);
      return cell.result === result ? withCell(doc, place, { ...cell, result: after }) : doc;
    });
  }

  async #correct(place: Place, result: Posed): Promise<void> {
    this.#masks.corrected(place.component);
    const input = await onFrameInput(this.#services, place);
    const misfits = misfitsBeside(this.#services.store.doc, place);
    const { chosen } = result;
    const candidates = result.candidates.map(({ pose, support = null }) => ({ pose, support }));
    const answers = await this.#poses.call('correct', { ...input, candidates, chosen, misfits }, { lane: 'film', transfer: [input.frame.pixels.buffer] });
    if (!input.film) return void this.#refused.add(result);
    if (!answers.some(({ from }) => from === chosen)) return this.#refuse(place, result);
    const film = input.film.slice(0, CONSTANTS);
    this.#services.store.amend((doc) => {
      const cell = cellOf(doc, place.frameId, place.component);
      if (cell.result !== result || cell.resultOf !== cell.outline) return doc;
      const left = { ...result, ...correctedOf(result, answers) };
      const more = answers.filter(({ from }) => from === null).map(another);
      const after = { ...left, ...settled(left, left.candidates, more), onFrame: { ...result.onFrame, film } };
      // What somebody traced stays; the silhouette that a click found goes along.
      const outline = isSilhouette(cell.outline) ? (itsOutline(after.candidates[after.chosen]) ?? cell.outline) : cell.outline;
      return withCell(doc, place, { outline, result: after, resultOf: outline });
    });
  }
}

const MEETING_FRAMES: readonly ToolName[] = ['one-click', 'pose'];

/** Corrected poses tell a little more, and that corrects them a little more: it settles after two or three turns. */
const TURNS = 5;

/** So many poses of each component tell the squares that a film is read in. */
const FIRST = 3;

/** So many more poses, of those that were asked, are worth asking: while a film is followed there is a new one every moment. */
const MORE = 0.4;

function namesOf({ component, frame }: Witness): Pick<ReadProfiles, 'component' | 'frame'> {
  return { component, frame };
}

/** The candidates with their new numbers, and the outlines that they draw. Those that came to one pose are one, and what cannot be corrected is none. */
function correctedOf({ candidates, chosen }: Posed, answers: readonly Corrected[]): Pick<Posed, 'candidates' | 'chosen'> {
  const answerOf = (at: number) => answers.find(({ from }) => from === at);
  const left = candidates.flatMap((candidate, at) => {
    const answer = answerOf(at);
    return answer ? [outlined(corrected(candidate, answer), answer)] : [];
  });
  return { candidates: left, chosen: candidates.filter((_, at) => at < chosen && answerOf(at)).length };
}

/** A pose that nobody had looked at. */
function another(answer: Corrected): Candidate {
  const { pose, residual, deviations, judged, support } = answer;
  return outlined({ pose, unmatched: null, drawn: null, residual, deviations, judged, support }, answer);
}

function outlined(candidate: Candidate, { outline }: Corrected): Candidate {
  setItsOutline(candidate, { points: pointsFrom(outline), closed: true, unknownSides: [], laidBy: 'click' });
  return candidate;
}
