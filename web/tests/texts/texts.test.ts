import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseSync, type ESTree } from 'vite';
import { describe, expect, it } from 'vitest';
import { filesBelow } from '../../build/files.ts';
import { en } from '../../src/texts/en';
import { later } from '../../src/texts/later';

const VIEWS = new URL('../../src', import.meta.url).pathname;

/** Attributes that people read or hear. */
const SPOKEN = new Set(['aria-label', 'aria-valuetext', 'aria-description', 'title', 'placeholder', 'label', 'alt', 'shown', 'unit']);

/** Units, signs and the names of keys are the same in every language. */
const SAME_EVERYWHERE = /^([A-Z]|Enter|Esc|(mm|px|deg|°|±|kV|x|y|z|%|ms|s|\W|\d|\s)*)$/;

describe('texts', () => {
  it('are none of them in a view', () => {
    const found = filesBelow(VIEWS)
      .filter((name) => name.endsWith('.tsx'))
      .flatMap((name) => literalsOf(name, readFileSync(join(VIEWS, name), 'utf8')));
    expect(found).toEqual([]);
  });

  it('would be found in a view', () => {
    const view = 'const a = <p title="Close it">Say {b ? "yes" : `no ${c}`} <Field label={d ? "Width" : x} class="wide" unit="mm" /></p>;';
    expect(literalsOf('view.tsx', view)).toEqual(['view.tsx: Close it', 'view.tsx: Say', 'view.tsx: yes', 'view.tsx: no', 'view.tsx: Width']);
  });

  it('say something, wherever a language has a place for it', () => {
    const empty = [...leavesOf(en), ...leavesOf(later)].filter(([, value]) => typeof value === 'string' && value.trim() === '');
    expect(empty).toEqual([]);
  });
});

/** Words in a view that a person would see or hear: text between tags, and literals in attributes for people. */
function literalsOf(name: string, source: string): string[] {
  const { program, errors } = parseSync(name, source);
  expect(errors).toEqual([]);
  const found: string[] = [];
  const note = (text: string) => {
    const words = text.trim().replace(/\s+/g, ' ');
    if (!SAME_EVERYWHERE.test(words)) found.push(`${name}: ${words}`);
  };
  const visit = (node: Node): void => {
    if (node.type === 'JSXText') note(node.value);
    else if (node.type === 'JSXAttribute' && !SPOKEN.has(nameOf(node.name))) visitElements(node);
    else if (node.type === 'JSXExpressionContainer' || node.type === 'JSXAttribute') notes(node);
    else childrenOf(node).forEach(visit);
  };
  /** Literals that may become the value, and elements within. */
  const notes = (node: Node): void => {
    if (node.type === 'Literal') return typeof node.value === 'string' ? note(node.value) : undefined;
    if (node.type === 'TemplateLiteral') return note(node.quasis.map(({ value }) => value.cooked).join(' '));
    if (node.type === 'ConditionalExpression') return [node.consequent, node.alternate].forEach(notes);
    if (node.type === 'BinaryExpression' && COMPARISON.test(node.operator)) return;
    if (WITH_VALUES.has(node.type)) return childrenOf(node).forEach(notes);
    if (ELEMENTS.has(node.type)) return visit(node);
    visitElements(node);
  };
  const visitElements = (node: Node): void => childrenOf(node).forEach((child) => (ELEMENTS.has(child.type) ? visit(child) : visitElements(child)));
  visit(program);
  return found;
}

const COMPARISON = /^[!=]==?$/;
const ELEMENTS = new Set(['JSXElement', 'JSXFragment']);
/** One of their parts may become the value. */
const WITH_VALUES = new Set(['LogicalExpression', 'BinaryExpression', 'AssignmentExpression', 'ParenthesizedExpression', 'JSXExpressionContainer', 'JSXAttribute']);

type Node = ESTree.Node;

function childrenOf(node: Node): Node[] {
  return Object.values(node).flat().filter(isNode);
}

function isNode(value: unknown): value is Node {
  return typeof value === 'object' && value !== null && 'type' in value;
}

function nameOf(name: ESTree.JSXAttributeName): string {
  return name.type === 'JSXIdentifier' ? name.name : `${name.namespace.name}:${name.name.name}`;
}

function leavesOf(value: unknown, path = ''): [string, unknown][] {
  if (typeof value !== 'object' || value === null) return [[path, value]];
  return Object.entries(value).flatMap(([key, inner]) => leavesOf(inner, `${path}.${key}`));
}
