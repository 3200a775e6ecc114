import { canBeChecked, checkState, markOf, setNote, toggleChecked, toggleFlagged } from '../document/marks';
import { type Doubt, doubtsOf, nextDoubt } from '../results/doubts';
import { nextTask } from '../results/progress';
import { hasBothComponents, standingOf } from '../results/steps';
import type { Place } from '../document/command';
import { currentPlace, type Store } from '../document/store';
import { cellOf, type Doc } from '../document/types';
import { poseKeys } from '../results/keys';
import { startAnew } from '../keep/restore';
import type { Follower } from '../jobs/follower';
import type { Services } from '../jobs/services';
import type { WorkCommand } from './work_keys';
import { texts } from '../texts/texts';

/** Going through the work: what is next, what was checked, flags and notes. */
export class WorkActions {
  readonly #services: Services;
  readonly #store: Store;
  /** Set by the timeline: the field for notes on the cell that is selected. */
  noteField: HTMLInputElement | null = null;
  /** Set when the page is put together. */
  follower: Pick<Follower, 'follow'> | null = null;

  constructor(services: Services) {
    this.#services = services;
    this.#store = services.store;
  }

  run(command: WorkCommand): boolean {
    const place = currentPlace(this.#store.state);
    switch (command) {
      case 'next-unfinished':
        return this.#goToNext(1);
      case 'previous-unfinished':
        return this.#goToNext(-1);
      case 'toggle-checked':
        return place !== null && this.toggleChecked(place);
      case 'toggle-flagged':
        return place !== null && this.toggleFlagged(place);
      case 'write-note':
        this.noteField?.focus();
        return this.noteField !== null;
      case 'follow-film':
        void this.follower?.follow();
        return this.follower !== null;
      case 'joint-curves':
        if (!hasBothComponents(this.#store.doc)) {
          this.#store.say('info', texts.joint.oneComponent);
          return true;
        }
        this.#store.setJoint({ open: !this.#store.ui.joint.open });
        return true;
      case 'work-list':
        this.#store.show({ popover: this.#store.ui.popover === 'work' ? null : 'work' });
        return true;
      case 'start-anew':
        startAnew(this.#services);
        return true;
    }
  }

  toggleChecked(place: Place): boolean {
    const { doc } = this.#store;
    const cell = cellOf(doc, place.frameId, place.component);
    if (!canBeChecked(cell) && checkState(cell, markOf(doc, place)) === 'no') {
      this.#store.say('info', texts.work.nothingToCheck);
      return true;
    }
    const { checking } = this.#store.ui;
    const next = checking ? nextDoubt(doc, place, 1) : null;
    this.#store.perform(toggleChecked(place));
    const now = checkState(cell, markOf(this.#store.doc, place)) === 'yes';
    const said = cell.result?.kind === 'failed' ? texts.work.saidAbsent : texts.work.saidChecked;
    const isLast = checking && now && doubtsOf(this.#store.doc).length === 0;
    this.#say(place, isLast ? texts.work.saidLast : now ? said : texts.work.saidUnchecked);
    // Who goes through what is doubtful goes on.
    if (now && next) this.goTo(stillDoubtful(this.#store.doc, next).place);
    if (doubtsOf(this.#store.doc).length === 0) this.#store.show({ checking: false });
    return true;
  }

  toggleFlagged(place: Place): boolean {
    this.#store.perform(toggleFlagged(place));
    this.#say(place, markOf(this.#store.doc, place).flagged ? texts.work.saidFlagged : texts.work.saidUnflagged);
    return true;
  }

  setNote(place: Place, note: string): void {
    this.#store.perform(setNote(place, note));
  }

  goTo({ frameId, component }: Place): void {
    this.#store.goTo(this.#store.doc.frames.findIndex(({ id }) => id === frameId));
    this.#store.selectComponent(component);
  }

  /** To the worst of what is doubtful or has no pose, or on from one of them. False where there is none. */
  check(step: 1 | -1 = 1): boolean {
    const { doc, state, ui } = this.#store;
    const next = nextDoubt(doc, ui.checking ? currentPlace(state) : null, step);
    this.#store.show({ checking: next !== null });
    if (!next) return false;
    this.goTo(next.place);
    const said = next.result.kind === 'failed' ? texts.work.nextLacking : texts.work.nextDoubtful;
    this.#store.say('info', said(next.index + 1, texts.component[next.place.component]));
    return true;
  }

  #goToNext(step: 1 | -1): boolean {
    const { doc, ui } = this.#store;
    if (doc.frames.length === 0) return false;
    if ((ui.checking || standingOf(doc).step === 'check') && this.check(step)) return true;
    const next = nextTask(doc, poseKeys(doc), { index: ui.frameIndex, component: ui.component }, step);
    if (!next) {
      this.#store.say('info', texts.work.allDone);
      return true;
    }
    const { place, index, progress } = next.entry;
    if (next.filter === 'doubtful' && this.check(step)) return true;
    this.goTo(place);
    const component = texts.component[place.component];
    const unfinished = texts.work.nextUnfinished(index + 1, component, texts.work.stages[progress.stage]);
    this.#store.say('info', next.filter === 'unfinished' ? unfinished : texts.work.nextUnchecked(index + 1, component));
    return true;
  }

  #say({ frameId, component }: Place, sentence: (frame: number, component: string) => string): void {
    const number = 1 + this.#store.doc.frames.findIndex(({ id }) => id === frameId);
    this.#store.say('info', sentence(number, texts.component[component]));
  }
}

/** The doubt that was the next, or the worst where a check has lifted that one; itself where none is left. */
function stillDoubtful(doc: Doc, next: Doubt): Doubt {
  const doubts = doubtsOf(doc);
  return doubts.find(({ index, place }) => index === next.index && place.component === next.place.component) ?? doubts[0] ?? next;
}
