/**
 * One browser for a test file and a fresh page for each test. The runner serves the page and names both:
 * `cargo xtask test --browser`.
 */
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { mkdir } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { after, test } from 'node:test';
import { chromium, firefox } from 'playwright-core';
import { keepLibraries } from './kept_libraries.mjs';

/**
 * After so long the page hangs. No test says how fast it is (`cargo xtask bench --browser` does): a step that takes ten seconds alone
 * takes a minute beside three others on a busy machine.
 */
export const PATIENCE = 240_000;

const WINDOW = { width: 1440, height: 900 };
/** Of Chromium. */
export const ARGUMENTS = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];
/** What Firefox's protocol has no words for is left out there. */
const CUSTOMARY = process.env.FLUOROPOSE_FIREFOX
  ? {}
  : /** @type {const} */ ({ reducedMotion: 'reduce', colorScheme: 'dark', permissions: ['clipboard-read', 'clipboard-write'] });
const WITH_SCREENSHOTS = process.env.FLUOROPOSE_SCREENSHOTS !== undefined;
const SCREENSHOTS = fileURLToPath(new URL('../../../target/screenshots/', import.meta.url));

/** Where the runner serves the page, with a slash at its end. */
export const ADDRESS = setting('FLUOROPOSE_URL');

/** @param {string} name */
export function setting(name) {
  const value = process.env[name];
  if (!value) throw new Error(`${name} is not set: run these tests with \`cargo xtask test --browser\``);
  return value;
}

/** Whether the runner wants Firefox. */
export const IN_FIREFOX = process.env.FLUOROPOSE_FIREFOX !== undefined;

/** @type {Promise<import('playwright-core').Browser> | undefined} */
let launched;

/** The browser under test, for pages with settings of their own. */
export function browser() {
  launched ??= IN_FIREFOX ? launchFirefox() : launchChromium();
  return launched;
}

function launchChromium() {
  return chromium.launch({ executablePath: setting('FLUOROPOSE_CHROMIUM'), args: ARGUMENTS, timeout: PATIENCE });
}

/** An ordinary Firefox, driven by the protocol that all browsers are to have in common. */
function launchFirefox() {
  return firefox.launch({ channel: 'moz-firefox', executablePath: setting('FLUOROPOSE_FIREFOX'), timeout: PATIENCE });
}

after(async () => (await launched)?.close());

/**
 * A test with a page of its own. Whatever the test does, the page must not throw, log an error, or ask another
 * computer for anything.
 *
 * @param {string} name
 * @param {(page: import('playwright-core').Page, t: import('node:test').TestContext) => Promise<void>} body
 * @param {{ refusals?: boolean, builds?: boolean }} [options] `refusals`: the test provokes errors that the browser logs; `builds`: its page draws the views of all its
 * libraries, as it does for a person, whatever another page has built before
 */
export function pageTest(name, body, { refusals = false, builds = false } = {}) {
  test(name, { timeout: 3 * PATIENCE }, async (t) => {
    const { page, troubles } = await freshPage(builds);
    try {
      await body(page, t);
    } catch (error) {
      await picture(page, `failed ${name}`).catch(() => undefined);
      throw error;
    } finally {
      await page.context().close();
    }
    if (!refusals) assert.deepEqual(troubles, [], 'the page threw, logged an error, or asked another computer');
  });
}

/**
 * A step of a test that shares its page with the steps before it.
 *
 * @param {import('playwright-core').Page} page
 * @param {import('node:test').TestContext} t
 * @param {string} name
 * @param {(t: import('node:test').TestContext) => Promise<void>} body
 */
export async function step(page, t, name, body) {
  await t.test(name, async (inner) => {
    try {
      await body(inner);
    } catch (error) {
      // A page that has crashed shows nothing; the error itself must not get lost over it.
      await picture(page, `failed ${name}`).catch(() => undefined);
      throw error;
    }
  });
}

/** An empty page, and the list of what goes wrong in it. @param {boolean} builds */
async function freshPage(builds) {
  const page = await openWindow({ serviceWorkers: 'block' });
  await keepLibraries(page.context(), { builds });
  const troubles = watch(page);
  await visit(page);
  return { page, troubles };
}

/**
 * An empty window of its own, with nothing kept from others.
 *
 * @param {import('playwright-core').BrowserContextOptions} [options]
 */
export async function openWindow(options = {}) {
  const context = await (await browser()).newContext({ viewport: WINDOW, ...CUSTOMARY, ...options });
  await prepare(context);
  return context.newPage();
}

/** All tabs of a window are patient, and remember what their status lines have said. @param {import('playwright-core').BrowserContext} context */
export async function prepare(context) {
  context.setDefaultTimeout(PATIENCE);
  await context.addInitScript(rememberWords);
}

/**
 * What goes wrong in a page from now on.
 *
 * @param {import('playwright-core').Page} page
 * @param {string} [address] of its host, where it is another than usual
 */
export function watch(page, address = ADDRESS) {
  /** @type {string[]} */
  const troubles = [];
  page.on('pageerror', (error) => isOfTheDriver(error) || troubles.push(`thrown: ${error.stack ?? error.message}`));
  page.on('console', (message) => message.type() === 'error' && troubles.push(`logged: ${message.text()}`));
  page.on('request', (request) => isOf(address, request.url()) || troubles.push(`asked: ${request.url()}`));
  return troubles;
}

/**
 * Before each screenshot in Firefox the driver puts an empty rule into the page to bring animations into step; the page's
 * policy refuses it, by the digest of exactly that text.
 *
 * @param {Error} error
 */
function isOfTheDriver({ message }) {
  return IN_FIREFOX && message.includes(`'sha256-${createHash('sha256').update('body {}').digest('base64')}'`);
}

/**
 * Opens the page anew with nothing kept from before, and waits until it listens.
 *
 * @param {import('playwright-core').Page} page
 * @param {string} [address] where else than usual
 */
export async function visit(page, address = ADDRESS) {
  if (page.url().startsWith(address)) await forget(page, address);
  await page.goto(address);
  await page.getByRole('button', { name: 'Open the demonstration' }).waitFor();
  await drawn(page);
}

/** Clears the browser's storage of the page, which keeps its work there. @param {import('playwright-core').Page} page @param {string} address */
async function forget(page, address) {
  // A document of the same origin that does nothing by itself and has nothing open.
  const nowhere = `${address}nothing`;
  const body = '<!doctype html><link rel="icon" href="data:,"><title>nothing</title>';
  await page.route(nowhere, (route) => route.fulfill({ contentType: 'text/html', body }));
  await page.goto(nowhere);
  await page.evaluate(
    () =>
      new Promise((resolve, reject) => {
        const request = indexedDB.deleteDatabase('fluoropose');
        request.onsuccess = () => resolve(null);
        request.onerror = () => reject(request.error);
      }),
  );
  await page.unroute(nowhere);
}

/** @param {string} host @param {string} url */
function isOf(host, url) {
  return url.startsWith(host) || url.startsWith('blob:') || url.startsWith('data:');
}

/**
 * Runs in the page before anything else. News pass after some seconds, jobs end, and others take their place: whoever looks from outside may come after them on a busy machine.
 * What was said before somebody did something is no answer to it.
 */
function rememberWords() {
  const most = 1000;
  /** @type {{ status: string[], jobs: string[] }} */
  const said = (globalThis.saidSoFar = { status: [], jobs: [] });
  const remember = (/** @type {string[]} */ words, /** @type {string | null | undefined} */ text) => {
    if (!text || words.includes(text, -10)) return;
    words.push(text);
    if (words.length > most) words.shift();
  };
  for (const deed of ['keydown', 'pointerdown', 'drop', 'change']) addEventListener(deed, () => [said.status, said.jobs].forEach((words) => words.splice(0)), { capture: true });
  const look = () => {
    remember(said.status, document.querySelector('footer [role=status]')?.textContent);
    for (const job of document.querySelectorAll('footer progress')) remember(said.jobs, `${job.ariaLabel}: ${job.parentElement?.textContent}`);
  };
  new MutationObserver(look).observe(document, { childList: true, characterData: true, subtree: true });
}

/** Without a style to hide the text cursor, which the page's policy would refuse. */
export const AS_IT_IS = /** @type {const} */ ({ caret: 'initial' });

/**
 * Writes what the page looks like to `target/screenshots`, where somebody wants to look at it (`FLUOROPOSE_SCREENSHOTS`): each takes 0.15 s of a processor.
 *
 * @param {import('playwright-core').Page} page
 * @param {string} name
 * @param {import('playwright-core').Locator} [part] of the page; the whole window without it
 */
export async function screenshot(page, name, part) {
  if (WITH_SCREENSHOTS) await picture(page, name, part);
}

/** What `screenshot` writes, asked for or not. @param {import('playwright-core').Page} page @param {string} name @param {import('playwright-core').Locator} [part] */
async function picture(page, name, part) {
  await mkdir(SCREENSHOTS, { recursive: true });
  const whole = IN_FIREFOX ? `firefox ${name}` : name;
  const file = `${whole.toLowerCase().replace(/[^a-z0-9]+/g, '-').slice(0, 80)}.png`;
  await (part ?? page).screenshot({ ...AS_IT_IS, path: SCREENSHOTS + file });
}

/**
 * Waits until a question about the page has the wanted answer, and gives that answer.
 *
 * @template T
 * @param {() => Promise<T>} ask
 * @param {(answer: T) => boolean} wanted
 * @param {string} what completes "waited in vain for ..."
 * @returns {Promise<T>}
 */
export async function until(ask, wanted, what) {
  const end = Date.now() + PATIENCE;
  for (;;) {
    const askedAt = performance.now();
    const answer = await ask();
    if (wanted(answer)) return answer;
    if (Date.now() > end) throw new Error(`waited in vain for ${what}; the last answer was ${JSON.stringify(answer)}`);
    // Asking keeps the page from what is waited for: most of the time it is left alone.
    const pause = Math.min(LONGEST_PAUSE, Math.max(SHORTEST_PAUSE, 3 * (performance.now() - askedAt)));
    await new Promise((resolve) => setTimeout(resolve, pause));
  }
}

/** Between two questions, ms. */
const [SHORTEST_PAUSE, LONGEST_PAUSE] = [50, 500];

/** What a part of the page says once that is what is wanted. @param {import('playwright-core').Locator} part @param {RegExp} pattern */
export function says(part, pattern) {
  return until(() => part.innerText(), (text) => pattern.test(text), `words like ${pattern}`);
}

/**
 * Until the page shows what it knew when this was called, whatever work goes on.
 *
 * @param {import('playwright-core').Page} page
 */
export async function drawn(page) {
  await whatThePageSays(page, 'shown');
}

/**
 * Until no work is under way in the page and it shows what came of it.
 *
 * @param {import('playwright-core').Page} page
 */
export async function atRest(page) {
  await whatThePageSays(page, 'atRest');
}

/** A page that was loaded anew says nothing before it has started. @param {import('playwright-core').Page} page @param {'shown' | 'atRest'} what */
async function whatThePageSays(page, what) {
  const answer = page.evaluate(async (what) => {
    while (!globalThis.fluoropose) await new Promise((resolve) => setTimeout(resolve, 10));
    await globalThis.fluoropose[what]();
  }, what);
  await inTime(answer, `the page to say "${what}"`);
}

/** @template T @param {Promise<T>} promise @param {string} what completes "waited in vain for ..." @returns {Promise<T>} */
async function inTime(promise, what) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`waited in vain for ${what}`)), PATIENCE);
  });
  try {
    return /** @type {T} */ (await Promise.race([promise, late]));
  } finally {
    clearTimeout(timer);
  }
}
