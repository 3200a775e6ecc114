import { describe, expect, it } from 'vitest';
import { en } from '../../src/texts/en';
import { later } from '../../src/texts/later';
import { asSentence, ended } from '../../src/texts/sentences';

describe('sentences', () => {
  it('begin with a capital and end once', () => {
    expect(asSentence('the surface has holes')).toBe('The surface has holes.');
    expect(asSentence('is the file in metres?')).toBe('Is the file in metres?');
    expect(asSentence('')).toBe('');
    expect(ended('is it?')).toBe('is it?');
  });

  it('of a doubt that asks end in its question mark', () => {
    expect(en.tracing.said.oneClickFound('Tibia', 'Doubtful', 'does it lie on other edges?')).toBe('Tibia: Doubtful, does it lie on other edges?');
    expect(en.panel.pose.accepted('does it lie on other edges?')).toBe('. It was doubtful: does it lie on other edges?');
  });

  it('of a model are told apart', () => {
    expect(later.models.remarks('a.stl', ['one triangle was turned', 'the model is 0.1 across: is it in metres?'])).toBe(
      'a.stl: One triangle was turned. The model is 0.1 across: is it in metres?',
    );
  });

  it('of following say how many cells were left without a pose', () => {
    expect(en.first.steps.checkTitle(1, 2)).toBe('1 pose is doubtful, 2 are missing: go through them, the worst first (N)');
    expect(en.first.steps.checkTitle(0, 1)).toBe('1 pose is missing: go through them, the worst first (N)');
    expect(en.follow.done(14, 'some', 8, false)).toContain('8 are missing');
    expect(en.follow.done(14, 'none', 0, false)).toBe('14 poses found.');
  });
});
