import { readFile } from 'node:fs/promises';
import { readWith } from './read.js';

readWith(async (address) => new Uint8Array(await readFile(address)));

export * from './index.js';
