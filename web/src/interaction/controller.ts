import type { Place } from '../document/command';
import { adjust } from './adjust';
import { brush } from './brush';
import { edit } from './edit';
import type { Effect, Input, Machine, Situation } from './machine';
import { drag, gestureOf, hand, windowing, type DragState } from './navigate';
import { oneClick } from './one_click';
import { ruler } from './ruler';
import { stretch } from './stretch';
import { threshold } from './threshold';
import type { ToolName } from '../terms/tool';
import { trace } from './trace';
import { transform } from './transform';
import { wire, wireBusy } from './wire';

/**
 * Sends each input to whoever has the pointer: a navigation gesture that began before, or the tool. Holds the states
 * and nothing else.
 */
export class Controller {
  /** Of the gesture under way: where the film goes on under the hand, or another component is chosen, it is given up. */
  #place: Place | null = null;
  #navigation: { kind: 'panning' | 'windowing'; state: DragState } | null = null;
  readonly #tools: Readonly<Record<ToolName | 'ruler', Running>> = {
    edit: new Held(edit),
    trace: new Held(trace, (state) => state.name === 'adding' || state.edit.name !== 'idle'),
    wire: new Held(wire, wireBusy),
    threshold: new Held(threshold),
    'one-click': new Held(oneClick),
    brush: new Held(brush),
    transform: new Held(transform),
    stretch: new Held(stretch),
    pose: new Held(adjust),
    hand: new Held(hand),
    window: new Held(windowing),
    ruler: new Held(ruler),
  };

  handle(tool: ToolName | 'ruler', input: Input, situation: Situation, spaceHeld: boolean): readonly Effect[] {
    const navigation = this.#navigation ?? this.#beginNavigation(input, spaceHeld);
    if (navigation) return this.#navigate(navigation, input, situation);
    const isOfAnother = this.busy && !isSame(this.#place, situation.place);
    const effects = this.#tools[tool].handle(isOfAnother ? { ...input, type: 'cancel' } : input, situation);
    this.#place = situation.place;
    return effects;
  }

  /** Is a gesture under way? Then keys do not change tools under it. */
  get busy(): boolean {
    return this.#navigation !== null || Object.values(this.#tools).some((tool) => tool.busy);
  }

  #beginNavigation(input: Input, spaceHeld: boolean) {
    const kind = this.busy ? null : gestureOf(input, spaceHeld);
    return kind && { kind, state: hand.start };
  }

  #navigate(
    navigation: { kind: 'panning' | 'windowing'; state: DragState },
    input: Input,
    situation: Situation,
  ): readonly Effect[] {
    const { state, effects } = drag(navigation.state, input, situation, navigation.kind);
    this.#navigation = state.name === 'idle' ? null : { kind: navigation.kind, state };
    return effects;
  }
}

function isSame(one: Place | null, other: Place): boolean {
  return one?.frameId === other.frameId && one.component === other.component;
}

interface Running {
  handle(input: Input, situation: Situation): readonly Effect[];
  readonly busy: boolean;
}

/** A tool's machine and the state that it is in. */
class Held<State extends { readonly name: string }> implements Running {
  readonly #machine: Machine<State>;
  readonly #isBusy: (state: State) => boolean;
  #state: State;

  constructor(machine: Machine<State>, isBusy: (state: State) => boolean = (state) => state.name !== 'idle') {
    this.#machine = machine;
    this.#isBusy = isBusy;
    this.#state = machine.start;
  }

  get busy(): boolean {
    return this.#isBusy(this.#state);
  }

  handle(input: Input, situation: Situation): readonly Effect[] {
    const { state, effects } = this.#machine.next(this.#state, input, situation);
    this.#state = state;
    return effects;
  }
}
