import { bare, dropHandPose, offerCandidate, setPoseByHand } from '../document/hand_poses';
import { forgetReference, keepReference, referencePose } from '../document/reference';
import type { Grain } from '../terms/seeing';
import { currentCell, currentPlace, type Store } from '../document/store';
import { isByHand } from '../document/types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { FromHere } from '../jobs/from_here';
import type { LandscapeFacts } from '../workers/protocol/by_hand';
import type { Landscapes } from '../jobs/landscape';
import { sentenceOf, type Services } from '../jobs/services';
import { inCamera, isTurn, nudged } from '../geometry/pose_motion';
import type { HandAction } from './hand_bindings';
import { texts } from '../texts/texts';
import { handSituationOf, placedPose } from './model_in_hand';
import { degreesOf, type LandscapeCell } from '../results/landscape';

/** Presses so far apart are steps of their own, ms. */
const PAUSE = 1000;

/** What keys and buttons do with a pose that is set by hand. */
export class HandActions {
  readonly #services: Services;
  readonly #store: Store;
  readonly #fromHere: FromHere;
  readonly #landscapes: Landscapes;
  /** Nudges of one key held down, or pressed again at once, are one step back. */
  #held = 0;
  #last: { readonly field: keyof PoseNumbers; readonly at: number } | null = null;

  constructor(services: Services, fromHere: FromHere, landscapes: Landscapes) {
    this.#services = services;
    this.#store = services.store;
    this.#fromHere = fromHere;
    this.#landscapes = landscapes;
  }

  /** `repeated`: the key is held down. */
  run(action: HandAction, repeated: boolean): boolean {
    switch (action.name) {
      case 'nudge':
        return this.#nudge(action.field, action.sign, repeated);
      case 'coarse':
      case 'fine':
        this.setGrain(action.name);
        return true;
      case 'refine-from-here':
        if (!repeated) this.refine();
        return true;
    }
  }

  begin(): void {
    this.#store.show({ tool: 'pose' });
  }

  end(): void {
    this.#store.show({ tool: 'edit' });
  }

  setGrain(grain: Grain): void {
    this.#store.setHand({ grain });
    const { plane, depth, turn } = this.#store.ui.hand[grain];
    this.#store.say('info', texts.hand.said.grain(texts.hand[grain], plane, depth, turn));
  }

  toggleLock(field: keyof PoseNumbers): void {
    const { locks } = this.#store.ui.hand;
    this.#store.setHand({ locks: { ...locks, [field]: !locks[field] } });
  }

  /** Refines the pose on view; where there is none, places the model. */
  refine(): void {
    const place = currentPlace(this.#store.state);
    if (!place) return;
    if (handSituationOf(this.#store.state, this.#services.studio)?.absent) this.place();
    else void this.#fromHere.refine(place);
  }

  place(): void {
    const { state } = this.#store;
    const place = currentPlace(state);
    const placed = placedPose(state, this.#services.studio);
    if (!place) return;
    if (!placed) return this.#store.say('info', texts.hand.said.noModel(texts.component[place.component]));
    this.#store.perform(setPoseByHand(place, placed.pose, texts.steps.placeModel));
    this.#store.show({ tool: 'pose' });
    this.#store.say('info', placed.frame === null ? texts.hand.said.placed : texts.hand.said.placedAs(placed.frame));
  }

  /** Gives the cell back to its outline. */
  drop(): void {
    const place = currentPlace(this.#store.state);
    if (place && isByHand(currentCell(this.#store.state).result)) this.#store.perform(dropHandPose(place));
  }

  /** A number that was typed. Turns keep the middle of the model in place, as keys do. False if it was not taken. */
  type(field: keyof PoseNumbers, value: number): boolean {
    const situation = handSituationOf(this.#store.state, this.#services.studio);
    const possible = Number.isFinite(value) && (field !== 'z' || value < 0);
    if (!possible) this.#store.say('error', Number.isNaN(value) ? texts.hand.said.notANumber(texts.hand.names[field]) : texts.hand.said.behind);
    return possible && situation !== null && this.#change(field, value - situation.pose[field], `type-${++this.#held}`);
  }

  /** Offers the pose of a view of the landscape as a candidate. */
  async takeView(facts: LandscapeFacts, { x, y }: LandscapeCell): Promise<void> {
    const place = currentPlace(this.#store.state);
    const { outline } = currentCell(this.#store.state);
    try {
      const found = await this.#landscapes.pose(y * facts.x.count + x);
      if (!found || !place || currentCell(this.#store.state).outline !== outline) return;
      const { pose, unmatched } = found;
      this.#store.perform(offerCandidate(place, { ...bare(pose), unmatched }));
      this.#store.say('info', texts.seeing.landscape.taken(degreesOf(facts.x, x), degreesOf(facts.y, y)));
    } catch (error) {
      this.#store.say('error', sentenceOf(error));
    }
  }

  // --- The set to compare with ---------------------------------------------------------------------------------------

  keepReference(): void {
    const time = new Date().toLocaleTimeString([], { hour: '2-digit', minute: '2-digit' });
    this.#store.perform(keepReference(texts.hand.compare.name(time)));
    this.#store.say('info', texts.hand.compare.kept(Object.keys(this.#store.doc.reference?.poses ?? {}).length));
  }

  forgetReference(): void {
    this.#store.perform(forgetReference());
    this.#store.see({ comparing: false });
  }

  toggleCompare(): void {
    const { doc, ui, state } = this.#store;
    if (!doc.reference) return this.#store.say('info', texts.hand.compare.none);
    const comparing = !ui.seeing.comparing;
    this.#store.see({ comparing });
    const { name } = doc.reference;
    const there = referencePose(doc, currentPlace(state)) !== null;
    if (comparing) this.#store.say('info', there ? texts.hand.compare.said(name) : texts.hand.compare.nothingHere(name));
  }

  // --- Parts -----------------------------------------------------------------------------------------------------------

  #nudge(field: keyof PoseNumbers, sign: 1 | -1, repeated: boolean): boolean {
    const { hand } = this.#store.ui;
    if (hand.locks[field]) {
      this.#store.say('info', texts.hand.said.locked(texts.hand.names[field]));
      return true;
    }
    const steps = hand[hand.grain];
    const by = isTurn(field) ? steps.turn : field === 'z' ? steps.depth : steps.plane;
    const at = performance.now();
    const again = this.#last?.field === field && at - this.#last.at < PAUSE;
    if (!repeated && !again) this.#held++;
    this.#last = { field, at };
    return this.#change(field, sign * by, `nudge-${field}-${this.#held}`);
  }

  #change(field: keyof PoseNumbers, by: number, mergeKey: string): boolean {
    const { state } = this.#store;
    const place = currentPlace(state);
    const situation = handSituationOf(state, this.#services.studio);
    if (!place || !situation) return false;
    if (situation.absent) {
      this.place();
      return true;
    }
    const pose = nudged(situation.pose, field, by, situation.middle, situation.locks);
    // In front of the camera it stays.
    if (inCamera(pose, situation.middle)[2] < 0 && by !== 0) this.#store.perform(setPoseByHand(place, pose, texts.steps.adjustPose, `${place.frameId} ${place.component} ${mergeKey}`));
    return true;
  }
}
