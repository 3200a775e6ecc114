import { describe, expect, it } from 'vitest';
import { Progress } from '../../src/jobs/follow_progress';

describe('how far following is', () => {
  it('is a count while the film is followed, and then the frame that is looked at once more, for nobody knows how many there will be', () => {
    const said: string[] = [];
    const progress = new Progress((done, total, now) => said.push(`${now?.title ?? ''} ${done} of ${total}${now?.unit === '' ? ' without a unit' : ''}`.trim()), 2);
    progress.followed('femur', 0);
    progress.another('femur', 5);
    progress.followed('tibia', 0);
    progress.another('tibia', 6);
    progress.beside('tibia', 7);
    expect(said).toEqual([
      'Following the film 1 of 2',
      'Following the film 1 of 2',
      'Looking at other poses of the femur in frame 6 0 of 0 without a unit',
      'Looking at other poses of the tibia in frame 7 0 of 0 without a unit',
      'Looking for the tibia beside the femur in frame 8 0 of 0 without a unit',
    ]);
  });
});
