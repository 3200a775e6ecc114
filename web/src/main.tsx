import { render } from 'preact';
import './styles/theme.css';
import './styles/layout.css';
import './styles/controls.css';
import './styles/panels.css';
import { Assets } from './document/assets';
import { Store } from './document/store';
import { Chooser } from './engine/chooser';
import { Convergence } from './engine/convergence';
import { Librarian } from './engine/librarian';
import { Keeper } from './engine/keep/keeper';
import { restoreWork, workToRestore } from './engine/keep/restore';
import { keepForOffline } from './engine/offline';
import { Poser } from './engine/poser';
import type { Services } from './engine/services';
import { Studio } from './engine/studio';
import { decodeWorker, poseWorker } from './engine/workers';
import { texts } from './texts';
import { Actions } from './view/actions';
import { AppContext, type App } from './view/app';
import { guardAgainstLoss } from './view/guard';
import { Page } from './view/page';

async function start(root: HTMLElement): Promise<void> {
  const services: Services = {
    store: new Store(),
    studio: await Studio.open(),
    assets: new Assets(),
    decoder: decodeWorker(),
  };
  const keeper = new Keeper(services);
  const kept = await workToRestore(keeper).catch(() => null);
  const matcher = poseWorker();
  const poser = new Poser(services.store, matcher);
  new Chooser(services.store, matcher);
  const app: App = {
    services,
    librarian: new Librarian(services, matcher),
    poser,
    convergence: new Convergence(services.store, poser, matcher),
    keeper,
    actions: new Actions(services),
  };
  guardAgainstLoss(services.store, keeper);
  keepForOffline(services.store);
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
