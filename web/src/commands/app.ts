import { createContext } from 'preact';
import { useCallback, useContext } from 'preact/hooks';
import type { State } from '../document/store';
import type { TracingTools } from '../tracing/tracing_tools';
import type { Calibrator } from '../jobs/calibrator';
import type { Convergence } from '../jobs/convergence';
import type { Keeper } from '../keep/keeper';
import type { Librarian } from '../jobs/librarian';
import type { Poser } from '../jobs/poser';
import type { Services } from '../jobs/services';
import type { JointReader } from '../jobs/joint_reader';
import type { SideTeller } from '../jobs/side_teller';
import type { EdgeWatch } from '../jobs/edge_watch';
import type { Landscapes } from '../jobs/landscape';
import type { Videos } from '../exchange/videos';
import type { Actions } from './actions';
import type { HandActions } from './hand_actions';
import { useAtReadingPace } from '../controls/pace';
import type { SeeingActions } from './seeing_actions';

/** What every view may use. Views read the state and call actions; they hold nothing that matters. */
export interface App {
  readonly services: Services;
  readonly librarian: Librarian;
  readonly poser: Poser;
  readonly convergence: Convergence;
  readonly tracingTools: TracingTools;
  readonly keeper: Keeper;
  readonly actions: Actions;
  readonly calibrator: Calibrator;
  readonly videos: Videos;
  readonly hand: HandActions;
  readonly seeing: SeeingActions;
  readonly landscapes: Landscapes;
  readonly edges: EdgeWatch;
  readonly joint: JointReader;
  readonly sideTeller: SideTeller;
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
