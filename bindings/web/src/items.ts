import { BendyError, described } from './errors.js';

/** One of several items of a model. Read-only. */
export interface Item {
  /** May be empty, and need not be unique. */
  readonly name: string;
  /** Its index in the list. */
  readonly number: number;
}

/**
 * Refers to an item: by its name (the first of that name), its number or itself. In texts, `#3` is the
 * number 3, `=3` the name "3", and `3` either of them: an error if that is the name of one item and the number of another.
 */
export type Key<T extends Item> = string | number | T;

/** Returns an index of one of `count` things. Throws BAD_ARGUMENT for any other number. */
export function checkIndex(index: number, count: number, kind: string): number {
  if (Number.isInteger(index) && index >= 0 && index < count) return index;
  throw new BendyError('bad_argument', `${kind} ${index} does not exist: there are ${count}`);
}

/** Returns the index of an item in its list. Throws BAD_ARGUMENT for an item of another model, and for copies. */
export function indexOwn<T extends { readonly number: number }>(list: readonly T[], item: T, kind: string): number {
  const index = item != null && list[item.number] === item ? item.number : list.indexOf(item);
  if (index >= 0) return index;
  if (Object(item) !== item || item instanceof Promise) {
    throw new BendyError('bad_argument', `a ${kind} is a name, a number or one of the model's own, not ${described(item)}`);
  }
  throw new BendyError('bad_argument', `the ${kind} belongs to another model`);
}

/** Reads a text that refers to an item, as all tools do: see `Key`. */
function readKey(text: string): { name?: string; number?: number } {
  if (text.startsWith('=')) return { name: text.slice(1) };
  const digits = /^(#?)([0-9]+)$/.exec(text);
  if (digits === null) return { name: text };
  const number = Number(digits[2]);
  return digits[1] === '#' ? { number } : { name: text, number };
}

/** A list of named items: an array with look-up by name. */
export class Items<T extends Item> extends Array<T> {
  #kind = '';
  #numbers = new Map<string, number>();

  /** Methods such as `map` return ordinary arrays. */
  static override get [Symbol.species](): ArrayConstructor {
    return Array;
  }

  /** @internal */
  static make<T extends Item>(kind: string, count: number, read: (number: number) => T): Items<T> {
    const items = new Items<T>();
    items.#kind = kind;
    for (let number = 0; number < count; ++number) {
      const item = read(number);
      items.push(item);
      if (!items.#numbers.has(item.name)) items.#numbers.set(item.name, number);
    }
    return items;
  }

  /** The names in order. */
  get names(): string[] {
    return this.map((item) => item.name);
  }

  /** Returns whether there is an item with exactly that name. */
  has(name: string): boolean {
    return this.#numbers.has(name);
  }

  /**
   * Returns the item with that name or number. Throws NOT_FOUND with the names that exist; BAD_ARGUMENT for a text that is the name of
   * one item and the number of another, and for an item of another list.
   */
  get(key: Key<T>): T {
    return this[this.number(key)]!;
  }

  /** Returns the index of the item with that name or number. Throws as `get`. */
  number(key: Key<T>): number {
    if (typeof key === 'string') {
      const { name, number } = readKey(key);
      const named = name === undefined ? undefined : this.#numbers.get(name);
      const numbered = number !== undefined && number < this.length ? number : undefined;
      if (named !== undefined && numbered !== undefined && named !== numbered) {
        const kind = this.#kind;
        throw new BendyError(
          'bad_argument',
          `${kind} ${JSON.stringify(key)} is ambiguous: =${key} is the ${kind} with this name, #${key} the ${kind} with this number`,
        );
      }
      const found = named ?? numbered;
      if (found !== undefined) return found;
      const names = this.names.slice(0, 20).map((name) => JSON.stringify(name));
      if (this.length > names.length) names.push(`${this.length - names.length} more`);
      const lower = name?.toLowerCase();
      const meant =
        lower && (this.find((item) => item.name.toLowerCase() === lower) ?? this.find((item) => item.name.toLowerCase().startsWith(lower)));
      const hint = meant ? `; did you mean ${JSON.stringify(meant.name)}? There` : '; there';
      const advice = this.#kind === 'chain' ? '; convert() with { autoRig: true } proposes some' : '';
      const list = names.length > 0 ? `are: ${names.join(', ')}` : `are none${advice}`;
      throw new BendyError('not_found', `there is no ${this.#kind} ${JSON.stringify(key)}${hint} ${list}`);
    }
    if (typeof key === 'number') return checkIndex(key, this.length, this.#kind);
    return indexOwn(this, key, this.#kind);
  }
}
