import { en } from './en';

/**
 * Everything the page says to a person, in one file for each language. What has a number or a name in it is a
 * function, so that a translation can put it where its grammar wants it. Another language is another value of this
 * type: the compiler tells what it lacks.
 *
 * Not here: the core's own sentences, which come from Rust, and the names of keys.
 */
export type Texts = typeof en;

export const texts: Texts = en;
