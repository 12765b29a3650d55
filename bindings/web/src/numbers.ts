// Numbers as callers give them: alone, in arrays, or in objects such as three.js's vectors.
import { BendyError, described } from './errors.js';

/** A point or a direction: `[x, y, z]`, or an object with x, y and z, such as three.js's Vector3. */
export type PointLike = ArrayLike<number> | { readonly x: number; readonly y: number; readonly z: number };
/** A unit quaternion: `[x, y, z, w]`, or an object with x, y, z and w, such as three.js's Quaternion. */
export type RotationLike = ArrayLike<number> | { readonly x: number; readonly y: number; readonly z: number; readonly w: number };
/** @internal */
export type Numbers = PointLike | RotationLike;

const axes = ['x', 'y', 'z', 'w'] as const;

function notANumber(given: unknown, name: string): BendyError {
  const what = given === undefined ? 'is missing: a number is expected' : `is ${described(given)}, not a number`;
  return new BendyError('bad_argument', `${name} ${what}`);
}

/** @internal Returns a number. Throws BAD_ARGUMENT for anything else; whether it is finite is for the caller to check. */
export function checkNumber(given: number, name: string): number {
  if (typeof given !== 'number') throw notANumber(given, name);
  return given;
}

/** @internal Returns an array without a change. Throws BAD_ARGUMENT if it has anything but numbers. */
export function checkNumbers<T extends ArrayLike<number>>(numbers: T, name: string): T {
  if (!ArrayBuffer.isView(numbers)) for (let i = 0; i < numbers.length; ++i) checkNumber(numbers[i]!, `${name}[${i}]`);
  return numbers;
}

/** @internal One of `count` numbers that are an array or, if three or four, an object. Throws BAD_ARGUMENT unless all are there. */
export function component(numbers: Numbers, i: number, count: number, name: string): number {
  const list = numbers as ArrayLike<number> & { readonly x: number; readonly y: number; readonly z: number; readonly w: number };
  const isObject = typeof list === 'object' && list !== null;
  // The `length` of three.js's vectors is a method.
  if (isObject && list.length === count) return typeof list[i] === 'number' ? list[i] : checkNumber(list[i]!, `${name}[${i}]`);
  const axis = axes[i]!;
  if (isObject && count <= axes.length && typeof list.length !== 'number' && typeof list[axis] === 'number') return list[axis];
  throw refusal(list, count, name);
}

function refusal(given: unknown, count: number, name: string): BendyError {
  const members = axes.slice(0, count).join(', ');
  const wanted = count > axes.length ? `an array of ${count} numbers` : `[${members}] or an object with ${members}`;
  const object = typeof given === 'object' ? (given as { length?: unknown; position?: unknown } | null) : null;
  const found = typeof object?.length === 'number' ? `has ${object.length} numbers` : given === undefined ? 'is missing' : `is ${described(given)}`;
  const hint = object?.position === undefined ? '' : '; did you mean its position?';
  return new BendyError('bad_argument', `${name} ${found}, not ${wanted}${hint}`);
}
