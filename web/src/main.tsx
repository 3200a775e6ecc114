import { render } from 'preact';
import './styles/theme.css';
import './styles/controls.css';
import './styles/shell.css';
import './styles/stage.css';
import './styles/strip.css';
import './styles/joint.css';
import './styles/pose.css';
import './styles/sheets.css';
import './styles/open.css';
import { Assets } from './document/assets';
import { Store } from './document/store';
import { OneClick } from './tracing/one_click';
import { TracingTools } from './tracing/tracing_tools';
import { Anatomist } from './jobs/anatomist';
import { Calibrator } from './jobs/calibrator';
import { Chooser } from './jobs/chooser';
import { Convergence } from './jobs/convergence';
import { FilmLater } from './jobs/film_later';
import { FollowLater } from './jobs/follow_later';
import { FromHere } from './jobs/from_here';
import { EdgeWatch } from './jobs/edge_watch';
import { HandJudge } from './jobs/hand_judge';
import { SideTeller } from './jobs/side_teller';
import { readJointHere } from './jobs/joint_here';
import { JointReader } from './jobs/joint_reader';
import { Landscapes } from './jobs/landscape';
import { keepLeads } from './jobs/leads';
import { Librarian } from './jobs/librarian';
import { attempt } from './keep/attempt';
import { Keeper } from './keep/keeper';
import { restoreWork, workToRestore } from './keep/restore';
import { tellLostJobs } from './keep/lost_jobs';
import { keepForOffline } from './keep/offline';
import { Poser } from './jobs/poser';
import { watchLater } from './jobs/watch_later';
import { sentenceOf, type Services } from './jobs/services';
import { frameDecoder } from './films/decoding';
import { Studio } from './films/studio';
import { FramesAhead } from './jobs/frames_ahead';
import { type Dropped, takeDrops } from './exchange/browser_files';
import { Videos } from './exchange/videos';
import { atRest, shown } from './workers/activity';
import { decodeWorker, filmWorker, poseWorker } from './workers/start';
import { texts } from './texts/texts';
import { Actions } from './commands/actions';
import { AppContext, type App } from './commands/app';
import { takeFirstTool } from './commands/first_tool';
import { guardAgainstLoss } from './keep/guard';
import { HandActions } from './commands/hand_actions';
import { Page } from './shell/page';
import { rememberTheme } from './keep/theme';
import { SeeingActions } from './commands/seeing_actions';
import { rememberTaste } from './keep/taste';

async function start(root: HTMLElement): Promise<void> {
  let begin: (open: (dropped: Dropped) => void) => void;
  takeDrops(new Promise((resolve) => (begin = resolve)));
  const assets = new Assets();
  const studio = await Studio.open(frameDecoder(assets, decodeWorker()));
  const matcher = poseWorker();
  const services: Services = {
    store: new Store(),
    studio,
    assets,
    decoder: decodeWorker(),
    shapeOf: (mesh) => matcher.call('shape', { mesh }).catch(() => ({ component: null, remarks: [] })),
    checkLibrary: (library) => matcher.call('check', { library }),
    ownCalibration: (text) => matcher.call('calibrationText', { text }),
    doubtsOf: (camera) => matcher.call('cameraDoubts', camera).catch(() => []),
  };
  // Before anybody looks at frames: it sees to it that they are undistorted where the document says so.
  const calibrator = new Calibrator(services);
  new FramesAhead(services);
  const keeper = new Keeper(services);
  const kept = await workToRestore(keeper).catch((error: unknown) => {
    services.store.say('error', texts.keep.notLookedAt(sentenceOf(error)));
    return null;
  });
  const poser = new Poser(services.store, matcher);
  new Anatomist(services, matcher);
  new Chooser(services, matcher);
  new HandJudge(services, matcher);
  const edges = new EdgeWatch(services, matcher);
  watchLater(services, matcher);
  const sideTeller = new SideTeller(services, matcher);
  keepLeads(services.store);
  const film = new FilmLater(services, matcher, filmWorker());
  const oneClick = new OneClick(services, matcher, film);
  const tracingTools = new TracingTools(services, oneClick);
  const landscapes = new Landscapes(services.store, matcher);
  const joint = new JointReader(services, matcher);
  readJointHere(services.store, joint);
  const hand = new HandActions(services, new FromHere(services, matcher, film), landscapes);
  rememberTaste(services.store);
  const actions = new Actions(services, tracingTools);
  actions.work.follower = new FollowLater(services, matcher, oneClick, film);
  const videos = new Videos(services, (files) => actions.open(files));
  actions.videos = videos;
  const app: App = {
    services,
    librarian: new Librarian(services, matcher),
    poser,
    convergence: new Convergence(services.store, poser, matcher),
    keeper,
    tracingTools,
    hand,
    seeing: new SeeingActions(services.store, hand),
    landscapes,
    edges,
    joint,
    sideTeller,
    actions,
    calibrator,
    videos,
  };
  takeFirstTool(services.store);
  guardAgainstLoss(services.store, keeper);
  keepForOffline(services.store);
  rememberTheme(services.store, document.documentElement);
  render(
    <AppContext.Provider value={app}>
      <Page />
    </AppContext.Provider>,
    root,
  );
  Object.assign(globalThis, { fluoropose: { atRest, shown } });
  if (kept) actions.restored = restoreWork(services, keeper, kept);
  begin!((dropped) => void actions.openDropped(dropped));
  await actions.restored;
  tellLostJobs(services.store, attempt(() => sessionStorage), () => actions.run({ name: 'work', command: 'follow-film' }));
}

const root = document.getElementById('page');
if (!root) throw new Error('index.html has no element "page"');
start(root).catch((error: unknown) => {
  root.textContent = texts.failedToStart(error instanceof Error ? error.message : String(error));
});
