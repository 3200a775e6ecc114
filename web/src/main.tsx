import { render } from 'preact';
import './styles/theme.css';
import './styles/layout.css';
import './styles/controls.css';
import './styles/panels.css';
import './styles/aids.css';
import './styles/seeing.css';
import './styles/calibrate.css';
import './styles/working.css';
import { Assets } from './document/assets';
import { Store } from './document/store';
import { Aids } from './engine/aids/aids';
import { Calibrator } from './engine/calibrator';
import { Chooser } from './engine/chooser';
import { Convergence } from './engine/convergence';
import { FromHere } from './engine/from_here';
import { Landscapes } from './engine/landscape';
import { Librarian } from './engine/librarian';
import { Keeper } from './engine/keep/keeper';
import { restoreWork, workToRestore } from './engine/keep/restore';
import { keepForOffline } from './engine/offline';
import { Poser } from './engine/poser';
import type { Services } from './engine/services';
import { Studio } from './engine/studio';
import { Videos } from './engine/videos';
import { decodeWorker, poseWorker } from './engine/workers';
import { texts } from './texts';
import { Actions } from './view/actions';
import { AppContext, type App } from './view/app';
import { guardAgainstLoss } from './view/guard';
import { HandActions } from './view/hand_actions';
import { Page } from './view/page';
import { rememberTheme } from './view/theme';
import { SeeingActions } from './view/seeing_actions';
import { rememberTaste } from './view/taste';

async function start(root: HTMLElement): Promise<void> {
  const services: Services = {
    store: new Store(),
    studio: await Studio.open(),
    assets: new Assets(),
    decoder: decodeWorker(),
  };
  // Before anybody looks at films: it sees to it that they are straight where the document says so.
  const calibrator = new Calibrator(services);
  const keeper = new Keeper(services);
  const kept = await workToRestore(keeper).catch(() => null);
  const matcher = poseWorker();
  const poser = new Poser(services.store, matcher);
  new Chooser(services.store, matcher);
  const aids = new Aids(services, matcher);
  const landscapes = new Landscapes(services.store, matcher);
  const hand = new HandActions(services, new FromHere(services, matcher), landscapes);
  rememberTaste(services.store);
  const actions = new Actions(services, aids);
  const videos = new Videos(services, (files) => actions.open(files));
  actions.videos = videos;
  const app: App = {
    services,
    librarian: new Librarian(services, matcher),
    poser,
    convergence: new Convergence(services.store, poser, matcher),
    keeper,
    aids,
    hand,
    seeing: new SeeingActions(services.store, hand),
    landscapes,
    actions,
    calibrator,
    videos,
  };
  guardAgainstLoss(services.store, keeper);
  keepForOffline(services.store);
  rememberTheme(services.store, document.documentElement);
  render(
    <AppContext.Provider value={app}>
      <Page />
    </AppContext.Provider>,
    root,
  );
  if (kept) await restoreWork(services, keeper, kept);
}

const root = document.getElementById('page');
if (!root) throw new Error('index.html has no element "page"');
start(root).catch((error: unknown) => {
  root.textContent = texts.failedToStart(error instanceof Error ? error.message : String(error));
});
