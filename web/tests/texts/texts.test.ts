import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import ts from 'typescript';
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
  const file = ts.createSourceFile(name, source, ts.ScriptTarget.ESNext, true, ts.ScriptKind.TSX);
  const found: string[] = [];
  const note = (text: string) => {
    const words = text.trim().replace(/\s+/g, ' ');
    if (!SAME_EVERYWHERE.test(words)) found.push(`${name}: ${words}`);
  };
  const visit = (node: ts.Node): void => {
    if (ts.isJsxText(node)) note(node.text);
    else if (ts.isJsxAttribute(node) && !SPOKEN.has(node.name.getText())) return visitElements(node);
    else if (ts.isJsxExpression(node) || ts.isJsxAttribute(node)) return notes(node);
    ts.forEachChild(node, visit);
  };
  /** Literals that may become the value, and elements within. */
  const notes = (node: ts.Node): void => {
    if (ts.isStringLiteral(node) || ts.isNoSubstitutionTemplateLiteral(node)) note(node.text);
    else if (ts.isTemplateExpression(node)) note([node.head.text, ...node.templateSpans.map(({ literal }) => literal.text)].join(' '));
    else if (ts.isConditionalExpression(node)) [node.whenTrue, node.whenFalse].forEach(notes);
    else if (ts.isBinaryExpression(node)) [node.left, node.right].filter((side) => !isComparison(node) || side === node.right).forEach((side) => isComparison(node) || notes(side));
    else if (ts.isJsxElement(node) || ts.isJsxSelfClosingElement(node) || ts.isJsxFragment(node)) visit(node);
    else if (ts.isParenthesizedExpression(node) || ts.isJsxExpression(node) || ts.isJsxAttribute(node)) ts.forEachChild(node, notes);
    else visitElements(node);
  };
  const visitElements = (node: ts.Node): void =>
    ts.forEachChild(node, (child) =>
      ts.isJsxElement(child) || ts.isJsxSelfClosingElement(child) || ts.isJsxFragment(child) ? visit(child) : visitElements(child),
    );
  visit(file);
  return found;
}

function isComparison({ operatorToken }: ts.BinaryExpression): boolean {
  return /^[!=]==?$/.test(operatorToken.getText());
}

function leavesOf(value: unknown, path = ''): [string, unknown][] {
  if (typeof value !== 'object' || value === null) return [[path, value]];
  return Object.entries(value).flatMap(([key, inner]) => leavesOf(inner, `${path}.${key}`));
}
