/** What a page holds in memory: its own heap, those of its workers, and what WebAssembly has. Chromium only. */
import assert from 'node:assert/strict';
import { PATIENCE } from './browser.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('playwright-core').CDPSession} Session */
/** @typedef {{ heap: number, wasm: number, buffers: number }} Held bytes; `buffers`: of typed arrays, WebAssembly's memories aside */
/** @typedef {{ page: number, workers: number, wasm: number, buffers: number, count: number, nodes: number, listeners: number, parts: Record<string, Held> }} Memory bytes; how many workers, nodes of the document and listeners there are; and the page and each worker by its name */

/** Asks the debugger of a page or of a worker. @typedef {(method: string, params?: object) => Promise<any>} Ask */

export class MemoryOf {
  /** @type {Map<string, { name: string, ask: Ask }>} */
  #workers = new Map();
  /** @type {Map<string, (message: any) => void>} answers that are waited for */
  #waiting = new Map();
  #last = 0;

  /** @param {Session} session */
  constructor(session) {
    /** @type {Ask} */
    this.page = (method, params) => session.send(/** @type {any} */ (method), /** @type {any} */ (params));
    session.on('Target.attachedToTarget', ({ sessionId, targetInfo }) => this.#workers.set(sessionId, { name: nameOf(targetInfo.url), ask: this.#asking(session, sessionId) }));
    session.on('Target.detachedFromTarget', ({ sessionId }) => this.#ended(sessionId));
    session.on('Target.receivedMessageFromTarget', ({ sessionId, message }) => {
      const answer = JSON.parse(message);
      this.#waiting.get(`${sessionId} ${answer.id}`)?.(answer);
    });
  }

  /** @param {Page} page */
  static async of(page) {
    const session = await page.context().newCDPSession(page);
    const memory = new MemoryOf(session);
    await session.send('Target.setAutoAttach', { autoAttach: true, waitForDebuggerOnStart: false, flatten: false });
    return memory;
  }

  /** After everything that nobody holds has been let go. @returns {Promise<Memory>} */
  async now() {
    const page = await heldBy(this.page);
    const { nodes, jsEventListeners } = await this.page('Memory.getDOMCounters');
    const asked = [...this.#workers.values()].map(async ({ name, ask }) => /** @type {const} */ ([name, await heldBy(ask).catch(() => null)]));
    const workers = (await Promise.all(asked)).flatMap(([name, held]) => (held ? [/** @type {const} */ ([name, held])] : []));
    const sum = (/** @type {'heap' | 'wasm' | 'buffers'} */ part) => workers.reduce((total, [, held]) => total + held[part], 0);
    // There may be two of a name.
    const parts = Object.fromEntries([['page', page], ...workers.map(([name, held], at) => [`${name} ${at + 1}`, held])]);
    return { page: page.heap, workers: sum('heap'), wasm: page.wasm + sum('wasm'), buffers: page.buffers + sum('buffers'), count: workers.length, nodes, listeners: jsEventListeners, parts };
  }

  /** One that ends answers no more. @param {string} sessionId */
  #ended(sessionId) {
    this.#workers.delete(sessionId);
    for (const [key, answer] of [...this.#waiting]) if (key.startsWith(`${sessionId} `)) answer({ error: { message: 'it has ended' } });
  }

  /** @param {Session} session @param {string} sessionId @returns {Ask} */
  #asking(session, sessionId) {
    return (method, params = {}) => {
      const id = ++this.#last;
      const answered = new Promise((resolve, reject) => {
        const late = setTimeout(() => reject(new Error(`${method} is not answered`)), PATIENCE);
        this.#waiting.set(`${sessionId} ${id}`, ({ result, error }) => {
          clearTimeout(late);
          this.#waiting.delete(`${sessionId} ${id}`);
          if (error) reject(new Error(`${method}: ${error.message}`));
          else resolve(result);
        });
      });
      session.send('Target.sendMessageToTarget', { sessionId, message: JSON.stringify({ id, method, params }) }).catch(() => undefined);
      return answered;
    };
  }
}

/** Of the script that a worker was started with, without the digest of what is in it. @param {string} url */
function nameOf(url) {
  return /([\w]+)(-[\w-]+)?\.js$/.exec(url)?.[1] ?? url;
}

/** @param {Ask} ask @returns {Promise<Held>} */
async function heldBy(ask) {
  await ask('HeapProfiler.enable');
  await ask('HeapProfiler.collectGarbage');
  const { usedSize, backingStorageSize } = await ask('Runtime.getHeapUsage');
  const group = { objectGroup: 'memory' };
  const { result } = await ask('Runtime.evaluate', { expression: 'WebAssembly.Memory.prototype', ...group });
  const { objects } = await ask('Runtime.queryObjects', { prototypeObjectId: result.objectId, ...group });
  const sum = 'function () { return this.reduce((sum, memory) => sum + memory.buffer.byteLength, 0); }';
  const summed = await ask('Runtime.callFunctionOn', { objectId: objects.objectId, functionDeclaration: sum, returnByValue: true });
  await ask('Runtime.releaseObjectGroup', group);
  assert(typeof summed.result.value === 'number', 'the debugger tells what WebAssembly has');
  return { heap: usedSize, wasm: summed.result.value, buffers: backingStorageSize ?? 0 };
}
