/** A static host that knows nothing of the page: no headers but the type, any sub-folder, and it can go away. */
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';
import { after } from 'node:test';

/** @type {Record<string, string>} */
const TYPES = {
  '.css': 'text/css',
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.mjs': 'text/javascript',
  '.json': 'application/json',
  '.png': 'image/png',
  '.svg': 'image/svg+xml',
  '.wasm': 'application/wasm',
  '.webmanifest': 'application/manifest+json',
};

/** @type {Host[]} */
const hosts = [];
after(() => Promise.all(hosts.map((host) => host.end())));

export class Host {
  /** @param {string} folder what is served @param {string} path under which, with slashes at both ends */
  constructor(folder, path) {
    this.folder = folder;
    this.path = path;
    this.port = 0;
    /** Paths that were asked for. @type {string[]} */
    this.asked = [];
    this.isThere = false;
    /** @type {import('node:http').Server | null} */
    this.server = null;
    hosts.push(this);
  }

  get address() {
    return `http://127.0.0.1:${this.port}${this.path}`;
  }

  /** Begins, again at the same address. */
  async start() {
    this.isThere = true;
    if (this.server) return this;
    const server = createServer((request, response) => void this.#answer(request.url ?? '', response));
    server.on('connection', (socket) => this.isThere || socket.destroy());
    await new Promise((resolve) => server.listen(this.port, '127.0.0.1', () => resolve(undefined)));
    this.port = /** @type {import('node:net').AddressInfo} */ (server.address()).port;
    this.server = server;
    return this;
  }

  /** As a network cable pulled: nobody is answered. The port stays taken, or others would take it meanwhile. */
  stop() {
    this.isThere = false;
    this.server?.closeAllConnections();
  }

  /** For good. */
  async end() {
    this.stop();
    await new Promise((resolve) => (this.server ? this.server.close(resolve) : resolve(undefined)));
  }

  /** @param {string} url @param {import('node:http').ServerResponse} response */
  async #answer(url, response) {
    const path = decodeURI(url.replace(/[?#].*$/, ''));
    this.asked.push(path);
    try {
      if (!path.startsWith(this.path)) throw new Error('outside');
      const file = path.slice(this.path.length) || 'index.html';
      const bytes = await readFile(join(this.folder, file));
      response.setHeader('content-type', TYPES[extname(file)] ?? 'application/octet-stream');
      response.end(bytes);
    } catch {
      response.statusCode = 404;
      response.end('not here');
    }
  }
}
