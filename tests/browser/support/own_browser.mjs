/** A browser of its own on a profile, as a person starts it, to be killed. */
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after } from 'node:test';
import { chromium } from 'playwright-core';
import { ADDRESS, ARGUMENTS, PATIENCE, setting, until } from './browser.mjs';

/** @type {(() => Promise<void>)[]} */
const running = [];
after(() => Promise.all(running.map((kill) => kill())));

/** @param {string} profile a folder */
export async function startBrowser(profile) {
  const address = [...ARGUMENTS, '--headless=new', '--remote-debugging-port=0', `--user-data-dir=${profile}`, 'about:blank'];
  const child = spawn(setting('FLUOROPOSE_CHROMIUM'), address, { detached: true, stdio: 'ignore' });
  const gone = new Promise((resolve) => child.once('exit', resolve));
  // The whole group: a crash spares nobody.
  const kill = async () => {
    if (child.exitCode === null && child.signalCode === null && child.pid) process.kill(-child.pid, 'SIGKILL');
    await gone;
  };
  running.push(kill);
  const port = await until(() => portOf(profile, child.pid), (found) => found !== null, 'the browser to listen');
  const connected = await chromium.connectOverCDP(`http://127.0.0.1:${port}`);
  const page = async () => {
    const context = connected.contexts()[0];
    const tab = await context.newPage();
    await tab.setViewportSize({ width: 1440, height: 900 });
    tab.setDefaultTimeout(PATIENCE);
    await tab.goto(ADDRESS);
    return tab;
  };
  return { page, kill };
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
