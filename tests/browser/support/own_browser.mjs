/** A browser of its own on a profile, as a person starts it, to be killed. */
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { readdir, readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after } from 'node:test';
import { chromium, firefox } from 'playwright-core';
import { ADDRESS, ARGUMENTS, IN_FIREFOX, PATIENCE, prepare, setting, until } from './browser.mjs';

/** Part of what the driver starts its own browsers with: a busy machine is no reason to put a tab to sleep, and a container may have little shared memory. */
const AS_THE_DRIVER = ['--disable-background-timer-throttling', '--disable-backgrounding-occluded-windows', '--disable-renderer-backgrounding', '--disable-hang-monitor', '--disable-dev-shm-usage'];

/** @type {(() => Promise<void>)[]} */
const running = [];
after(() => Promise.all(running.map((kill) => kill())));

/** @param {string} profile a folder */
export async function startBrowser(profile) {
  if (IN_FIREFOX) return startFirefox(profile);
  const address = [...ARGUMENTS, ...AS_THE_DRIVER, '--headless=new', '--remote-debugging-port=0', `--user-data-dir=${profile}`, 'about:blank'];
  const child = spawn(setting('FLUOROPOSE_CHROMIUM'), address, { detached: true, stdio: 'ignore' });
  const gone = new Promise((resolve) => child.once('exit', resolve));
  // The whole group: a crash spares nobody.
  const kill = async () => {
    if (child.exitCode === null && child.signalCode === null && child.pid) process.kill(-child.pid, 'SIGKILL');
    await gone;
  };
  running.push(kill);
  const port = await until(() => portOf(profile, child.pid), (found) => found !== null, 'the browser to listen');
  const connected = await chromium.connectOverCDP(`http://127.0.0.1:${port}`, { timeout: PATIENCE });
  const [context] = connected.contexts();
  await prepare(context);
  const page = async () => {
    const tab = await context.newPage();
    await tab.setViewportSize({ width: 1440, height: 900 });
    await tab.goto(ADDRESS);
    return tab;
  };
  return { page, kill };
}

/** @param {string} profile a folder */
async function startFirefox(profile) {
  const options = { channel: 'moz-firefox', executablePath: setting('FLUOROPOSE_FIREFOX'), viewport: { width: 1440, height: 900 }, timeout: PATIENCE };
  const context = await firefox.launchPersistentContext(profile, options);
  await prepare(context);
  const pids = await processesOf(profile);
  assert(pids.length > 0, 'the browser has a process');
  const kill = async () => {
    for (const pid of pids.splice(0)) process.kill(pid, 'SIGKILL');
    await context.close().catch(() => undefined);
  };
  running.push(kill);
  const page = async () => {
    const tab = await context.newPage();
    await tab.goto(ADDRESS);
    return tab;
  };
  return { page, kill };
}

/** Those that were started with a folder. Only where the system tells (Linux). @param {string} profile */
async function processesOf(profile) {
  const numbers = (await readdir('/proc')).filter((name) => /^\d+$/.test(name));
  const words = await Promise.all(numbers.map((pid) => readFile(`/proc/${pid}/cmdline`, 'utf8').catch(() => '')));
  return numbers.filter((_, at) => words[at].split('\0').includes(profile)).map(Number);
}

/** Ports that a killed browser left behind are not taken for the new one's. @type {Map<string, string>} */
const seen = new Map();

/** @param {string} profile @param {number | undefined} pid */
async function portOf(profile, pid) {
  const text = await readFile(join(profile, 'DevToolsActivePort'), 'utf8').catch(() => null);
  if (!text || seen.get(profile) === text) return null;
  seen.set(profile, text);
  assert(pid);
  return Number(text.split('\n')[0]);
}
