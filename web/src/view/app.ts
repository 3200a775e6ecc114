import { createContext } from 'preact';
import { useCallback, useContext } from 'preact/hooks';
import type { State } from '../document/store';
import type { Aids } from '../engine/aids/aids';
import type { Calibrator } from '../engine/calibrator';
import type { Convergence } from '../engine/convergence';
import type { Keeper } from '../engine/keep/keeper';
import type { Librarian } from '../engine/librarian';
import type { Poser } from '../engine/poser';
import type { Services } from '../engine/services';
import type { Landscapes } from '../engine/landscape';
import type { Videos } from '../engine/videos';
import type { Actions } from './actions';
import type { HandActions } from './hand_actions';
import { useAtReadingPace } from './pace';
import type { SeeingActions } from './seeing_actions';

/** What every view may use. Views read the state and call actions; they hold nothing that matters. */
export interface App {
  readonly services: Services;
  readonly librarian: Librarian;
  readonly poser: Poser;
  readonly convergence: Convergence;
  readonly aids: Aids;
  readonly keeper: Keeper;
  readonly actions: Actions;
  readonly calibrator: Calibrator;
  readonly videos: Videos;
  readonly hand: HandActions;
  readonly seeing: SeeingActions;
  readonly landscapes: Landscapes;
}

export const AppContext = createContext<App | null>(null);

export function useApp(): App {
  const app = useContext(AppContext);
  if (!app) throw new Error('a view outside the page');
  return app;
}

/** The state, for words and numbers. */
export function useAppState(): State {
  const { store } = useApp().services;
  const subscribe = useCallback((listener: () => void) => store.subscribe(listener), [store]);
  const read = useCallback(() => store.state, [store]);
  return useAtReadingPace(subscribe, read);
}
