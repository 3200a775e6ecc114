/**
 * Reads untrusted JSON: each reader takes a value and the path to it and either returns a typed value or throws
 * a sentence that names the place.
 */
export class ReadError extends Error {}

export type Reader<T> = (value: unknown, path: string) => T;

export const text: Reader<string> = (value, path) => {
  if (typeof value !== 'string') throw wrong(path, 'a text', value);
  return value;
};

export const number: Reader<number> = (value, path) => {
  if (typeof value !== 'number' || !Number.isFinite(value)) throw wrong(path, 'a finite number', value);
  return value;
};

export const count: Reader<number> = (value, path) => {
  const n = number(value, path);
  if (!Number.isInteger(n) || n < 0) throw wrong(path, 'a whole number, zero or more', value);
  return n;
};

export const above0: Reader<number> = (value, path) => {
  const n = number(value, path);
  if (n <= 0) throw wrong(path, 'a number above 0', value);
  return n;
};

export const flag: Reader<boolean> = (value, path) => {
  if (typeof value !== 'boolean') throw wrong(path, 'true or false', value);
  return value;
};

export function oneOf<T extends string>(...choices: readonly T[]): Reader<T> {
  return (value, path) => {
    if (!choices.includes(value as T)) throw wrong(path, choices.map((choice) => `"${choice}"`).join(' or '), value);
    return value as T;
  };
}

export function nullable<T>(reader: Reader<T>): Reader<T | null> {
  return (value, path) => (value === null ? null : reader(value, path));
}

/** Missing is read as null. */
export function optional<T>(reader: Reader<T>): Reader<T | null> {
  return (value, path) => (value === undefined ? null : nullable(reader)(value, path));
}

/** Missing is read as `value`: files from before there was one. */
export function missingAs<T>(value: T, reader: Reader<T>): Reader<T> {
  return (given, path) => (given === undefined ? value : reader(given, path));
}

export function list<T>(reader: Reader<T>): Reader<readonly T[]> {
  return (value, path) => {
    if (!Array.isArray(value)) throw wrong(path, 'a list', value);
    return value.map((item, index) => reader(item, `${path}[${index}]`));
  };
}

export const pair: Reader<readonly [number, number]> = (value, path) => {
  const [first, second, ...more] = list(number)(value, path);
  if (first === undefined || second === undefined || more.length > 0) throw wrong(path, 'two numbers', value);
  return [first, second];
};

export function dictionary<T>(reader: Reader<T>): Reader<Record<string, T>> {
  return (value, path) =>
    Object.fromEntries(Object.entries(fields(value, path)).map(([key, item]) => [key, reader(item, `${path}.${key}`)]));
}

type Readers<T> = { readonly [K in keyof T]: Reader<T[K]> };

export function object<T>(readers: Readers<T>): Reader<T> {
  return (value, path) => {
    const given = fields(value, path);
    const entries = Object.entries(readers) as [string, Reader<unknown>][];
    return Object.fromEntries(entries.map(([key, reader]) => [key, reader(given[key], `${path}.${key}`)])) as T;
  };
}

function fields(value: unknown, path: string): Record<string, unknown> {
  if (typeof value !== 'object' || value === null || Array.isArray(value)) throw wrong(path, 'an object', value);
  return value as Record<string, unknown>;
}

function wrong(path: string, wanted: string, value: unknown): ReadError {
  const found = value === undefined ? 'is missing' : `is ${shorten(JSON.stringify(value) ?? String(value))}`;
  return new ReadError(`${path} should be ${wanted} but ${found}`);
}

function shorten(shown: string): string {
  return shown.length <= 40 ? shown : `${shown.slice(0, 37)}...`;
}
