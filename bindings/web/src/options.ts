// Objects with options: a name that a function does not know is an error, not a choice without effect.
import { BendyError, described } from './errors.js';

/** The names of all options of a type. TypeScript refuses a list that lacks one. */
export function optionNames<T extends object>(names: Record<keyof T, true>): readonly string[] {
  return Object.keys(names);
}

/**
 * Throws BAD_ARGUMENT for an option that a function does not have, and for what is not an object. `advice`: by the name of an option that
 * does not exist, what to write instead. Does not allocate.
 */
export function checkOptions(caller: string, options: object, known: readonly string[], advice: Readonly<Record<string, string>> = noAdvice): void {
  if (typeof options !== 'object') throw new BendyError('bad_argument', `the options of ${caller} are ${described(options)}, not an object`);
  for (const name in options) if (!known.includes(name)) throw refusal(caller, name, known, advice);
}

const noAdvice = {};

function refusal(caller: string, name: string, known: readonly string[], advice: Readonly<Record<string, string>>): BendyError {
  const bare = (text: string): string => text.replace(/[-_]/g, '').toLowerCase();
  const given = bare(name);
  const meant =
    advice[name] ?? known.find((one) => bare(one) === given) ?? known.find((one) => bare(one).startsWith(given) || given.startsWith(bare(one)));
  const hint = meant === undefined ? `; it has ${known.join(', ')}` : `; did you mean ${meant}?`;
  return new BendyError('bad_argument', `${caller} has no option ${JSON.stringify(name)}${hint}`);
}
