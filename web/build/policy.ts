import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import type { Plugin } from 'vite';

/** The same file gives the header of `cargo xtask serve`. */
const FILE = new URL('../content_security_policy.txt', import.meta.url);

/** The policy's directives, each with its sources. */
export type Policy = ReadonlyMap<string, string>;

export function readPolicy(): Policy {
  const lines = readFileSync(FILE, 'utf8').split('\n').filter((line) => line !== '');
  return new Map(lines.map((line) => split(line)));
}

function split(line: string): [string, string] {
  const space = line.indexOf(' ');
  return [line.slice(0, space), line.slice(space + 1)];
}

/** The element that sets the policy for a page of any host; it must come before whatever it is to govern. */
export function policyElement(policy: Policy): string {
  const text = [...policy].map(([directive, sources]) => `${directive} ${sources}`).join('; ');
  return `<meta http-equiv="Content-Security-Policy" content="${text}" />`;
}

/** The source that allows exactly this inline script or style. */
export function hashSource(text: string): string {
  return `'sha256-${createHash('sha256').update(text).digest('base64')}'`;
}

/** Puts the policy into the built page. While developing, the bundler's own inline code has to run. */
export function contentPolicy(): Plugin {
  return {
    name: 'content-security-policy',
    apply: 'build',
    transformIndexHtml: {
      order: 'post',
      handler: (html) => html.replace(/(<meta charset=[^>]*>)/, `$1\n    ${policyElement(readPolicy())}`),
    },
  };
}
