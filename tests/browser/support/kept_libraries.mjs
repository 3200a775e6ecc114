/**
 * Libraries that pages have built in this run. Most tests want a pose of the demonstration's implants, and not to see twenty thousand views drawn once more: their pages
 * are given what another page has built from the same model, camera and views. Tests that ask for it (`builds`) build theirs, and what comes of that has to be the same
 * to the last bit.
 */
import assert from 'node:assert/strict';
import { readFile, rename, writeFile } from 'node:fs/promises';
import { join } from 'node:path';

/** Of this run; a page builds all that it needs where the runner names none. */
const FOLDER = process.env.FLUOROPOSE_LIBRARIES;

/** In all pages of a window. @param {import('playwright-core').BrowserContext} context @param {{ builds: boolean }} options */
export async function keepLibraries(context, { builds }) {
  if (!FOLDER) return;
  const file = (/** @type {string} */ key) => join(FOLDER, key);
  const kept = (/** @type {string} */ key) => readFile(file(key), 'base64').catch(() => null);
  await context.exposeFunction('keptLibrary', kept);
  await context.exposeFunction('keepLibrary', async (/** @type {string} */ key, /** @type {string} */ text) => {
    assert.match(key, /^[0-9a-f]{64}$/);
    // Others read meanwhile: it is there as a whole or not at all.
    const beside = `${file(key)}.${process.pid}`;
    await writeFile(beside, text, 'base64');
    await rename(beside, file(key));
  });
  await context.addInitScript(standIn, builds);
}

/** Runs in the page before anything else: what is asked of a worker that draws libraries is answered with what was kept, if there is something. @param {boolean} builds */
function standIn(builds) {
  const Own = globalThis.Worker;
  /** @param {any} plan */
  const keyOf = async ({ mesh: { vertices, triangles }, camera, spec }) => {
    const rest = JSON.stringify([vertices.length, triangles.length, camera, spec]);
    const bytes = await new Blob([vertices, triangles, rest]).arrayBuffer();
    const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
    return Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
  };
  const bytesOf = (/** @type {string} */ text) => {
    const letters = atob(text);
    const bytes = new Uint8Array(letters.length);
    for (let at = 0; at < bytes.length; at++) bytes[at] = letters.charCodeAt(at);
    return bytes;
  };
  // All workers ask for the same.
  /** @type {Map<string, Promise<string | null>>} */
  const asked = new Map();
  const keptOf = (/** @type {string} */ key) => {
    const kept = asked.get(key) ?? globalThis.keptLibrary(key);
    asked.set(key, kept);
    return kept;
  };
  const textOf = (/** @type {Uint8Array<ArrayBuffer>} */ bytes) =>
    new Promise((resolve, reject) => {
      const reader = new FileReader();
      reader.onload = () => resolve(String(reader.result).split(',')[1]);
      reader.onerror = () => reject(reader.error);
      reader.readAsDataURL(new Blob([bytes]));
    });

  /** @param {{ key: string, kept: string | null }} planned @param {Uint8Array<ArrayBuffer>} built */
  const keep = async ({ key, kept }, built) => {
    const text = await textOf(built);
    if (kept === null) await globalThis.keepLibrary(key, text);
    // Which a test does not suffer.
    else if (kept !== text) console.error('the library that was built is not the one that was kept');
  };

  /** In place of a worker. */
  class Librarian {
    /** @type {((event: { data: any }) => void) | null} */
    onmessage = null;
    /** @type {((event: ErrorEvent) => void) | null} */
    onerror = null;
    /** @type {Worker | null} */
    #own = null;
    /** What the last plan was, and what is kept of it. */
    #planned = { key: '', kept: /** @type {string | null} */ (null) };
    /** The call whose answer is a whole library, and of which plan: the next one may be asked for before that is compared. */
    #assembling = { id: 0, of: this.#planned };
    #hasEnded = false;
    #start;

    /** @param {() => Worker} start */
    constructor(start) {
      this.#start = start;
    }

    /** @param {any} message @param {Transferable[]} transfer */
    postMessage(message, transfer) {
      if (message.method === 'plan') return void this.#plan(message, transfer);
      if (message.method === 'assemble') {
        const { kept } = this.#planned;
        if (!builds && kept !== null) return this.#answer(message, bytesOf(kept));
        this.#assembling = { id: message.id, of: this.#planned };
      }
      this.#own?.postMessage(message, transfer);
    }

    terminate() {
      this.#hasEnded = true;
      this.#own?.terminate();
    }

    /** @param {any} message @param {Transferable[]} transfer */
    async #plan(message, transfer) {
      const key = await keyOf(message.input);
      const kept = await keptOf(key);
      if (this.#hasEnded) return;
      this.#planned = { key, kept };
      // No view is left to be drawn.
      if (!builds && kept !== null) return this.#answer(message, 0);
      this.#own ??= this.#hired();
      this.#own.postMessage(message, transfer);
    }

    /** @param {{ id: number }} call @param {unknown} output */
    #answer({ id }, output) {
      setTimeout(() => this.onmessage?.({ data: { type: 'done', id, output } }));
    }

    #hired() {
      const worker = this.#start();
      worker.onmessage = ({ data }) => {
        const { id, of } = this.#assembling;
        if (data.type === 'done' && data.id === id) void keep(of, data.output.slice());
        this.onmessage?.({ data });
      };
      worker.onerror = (event) => this.onerror?.(event);
      return worker;
    }
  }
  globalThis.Worker = new Proxy(Own, {
    construct: (_, [url, options]) => {
      const start = () => new Own(url, options);
      return options?.name === 'library' ? new Librarian(start) : start();
    },
  });
}
