import { BendyError } from './errors.js';

/** Something that a model has several of. Read-only. */
export interface Item {
  /** May be empty, and need not be unique. */
  readonly name: string;
  /** Its place in the list. */
  readonly number: number;
}

/** How a function is told which item is meant: by its name (the first of that name), its number or itself. */
export type Key<T extends Item> = string | number | T;

/** A list of named things: an array that also finds by name. */
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

  /** Returns whether there is an item of that name. */
  has(name: string): boolean {
    return this.#numbers.has(name);
  }

  /** Returns the item with that name or number. Throws NOT_FOUND with the names that exist, BAD_ARGUMENT. */
  get(key: Key<T>): T {
    return this[this.number(key)]!;
  }

  /** Returns the number of the item with that name or number. Throws NOT_FOUND with the names that exist, BAD_ARGUMENT. */
  number(key: Key<T>): number {
    if (typeof key === 'string') {
      const number = this.#numbers.get(key);
      if (number !== undefined) return number;
      const names = this.names.slice(0, 20).map((name) => JSON.stringify(name));
      if (this.length > names.length) names.push(`${this.length - names.length} more`);
      throw new BendyError('not_found', `there is no ${this.#kind} ${JSON.stringify(key)}; there are: ${names.join(', ') || 'none'}`);
    }
    const number = typeof key === 'number' ? key : key.number;
    if (Number.isInteger(number) && number >= 0 && number < this.length) return number;
    throw new BendyError('bad_argument', `${this.#kind} ${number} does not exist: there are ${this.length}`);
  }
}
