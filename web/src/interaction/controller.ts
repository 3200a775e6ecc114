import { edit, type EditState } from './edit';
import type { Effect, Input, Scene } from './machine';
import { drag, gestureOf, hand, windowing, type DragState } from './navigate';
import { trace, type TraceState } from './trace';
import type { ToolName } from './tools';

/**
 * Sends each input to whoever has the pointer: a navigation gesture that began before, or the tool. Holds the states
 * and nothing else.
 */
export class Controller {
  #navigation: { kind: 'panning' | 'windowing'; state: DragState } | null = null;
  #edit: EditState = edit.start;
  #trace: TraceState = trace.start;
  #drag: DragState = hand.start;

  handle(tool: ToolName, input: Input, scene: Scene, spaceHeld: boolean): readonly Effect[] {
    const navigation = this.#navigation ?? this.#beginNavigation(input, spaceHeld);
    if (navigation) return this.#navigate(navigation, input, scene);
    return this.#toTool(tool, input, scene);
  }

  /** Is a gesture under way? Then keys do not change tools under it. */
  get busy(): boolean {
    const tracing = this.#trace.name === 'adding' || this.#trace.edit.name !== 'idle';
    return this.#navigation !== null || tracing || this.#edit.name !== 'idle' || this.#drag.name !== 'idle';
  }

  #beginNavigation(input: Input, spaceHeld: boolean) {
    const kind = this.busy ? null : gestureOf(input, spaceHeld);
    return kind && { kind, state: hand.start };
  }

  #navigate(
    navigation: { kind: 'panning' | 'windowing'; state: DragState },
    input: Input,
    scene: Scene,
  ): readonly Effect[] {
    const { state, effects } = drag(navigation.state, input, scene, navigation.kind);
    this.#navigation = state.name === 'idle' ? null : { kind: navigation.kind, state };
    return effects;
  }

  #toTool(tool: ToolName, input: Input, scene: Scene): readonly Effect[] {
    switch (tool) {
      case 'edit':
        return keep(edit.next(this.#edit, input, scene), (state) => (this.#edit = state));
      case 'trace':
        return keep(trace.next(this.#trace, input, scene), (state) => (this.#trace = state));
      case 'hand':
        return keep(hand.next(this.#drag, input, scene), (state) => (this.#drag = state));
      case 'window':
        return keep(windowing.next(this.#drag, input, scene), (state) => (this.#drag = state));
    }
  }
}

function keep<State>(result: { state: State; effects: readonly Effect[] }, store: (state: State) => void) {
  store(result.state);
  return result.effects;
}
