import { work } from '../workers/activity';
import type { Bridge } from '../workers/bridge';
import { followWorker } from '../workers/start';
import type { PoseProtocol } from '../workers/protocol/pose';
import type { Clicks } from './first_poses';
import type { FilmLater } from './film_later';
import type { Follower } from './follower';
import type { Services } from './services';

/** What follows films is loaded with the first one. */
export class FollowLater {
  readonly #make: () => Promise<Follower>;
  #made: Promise<Follower> | null = null;

  constructor(services: Services, poser: Pick<Bridge<PoseProtocol>, 'call'>, clicks: Clicks, film: Pick<FilmLater, 'ready' | 'chooseSquares' | 'knowsBeside' | 'takeBeside' | 'learnAgain'>) {
    this.#make = async () => {
      const [{ Follower }, { FirstPoses }, { SearchLibraries }] = await Promise.all([import('./follower'), import('./first_poses'), import('./search_libraries')]);
      const workers = { femur: followWorker(), tibia: followWorker() };
      return new Follower(services, workers, new FirstPoses(services, clicks, new SearchLibraries(services, poser)), film);
    };
  }

  async follow(): Promise<void> {
    const over = work.begin();
    try {
      await (await (this.#made ??= this.#make())).follow();
    } finally {
      over();
    }
  }
}
