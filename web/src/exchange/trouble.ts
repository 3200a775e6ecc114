import { sentenceOf } from '../jobs/services';
import { texts } from '../texts/texts';

/** What is amiss with a file, by its name, with which some sentences begin already. */
export function troubleOf(name: string, error: unknown): string {
  const sentence = sentenceOf(error);
  return sentence.startsWith(name) ? sentence : texts.said.of(name, sentence);
}
