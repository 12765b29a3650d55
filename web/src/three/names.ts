/**
 * Gives each name once, as GLTFLoader numbers them: Bone, Bone_1, Bone_2. A name that is taken, even if it is in the file, gets the
 * next free number: tracks find objects by their names.
 */
export function nameGiver(): (name: string) => string {
  const taken = new Set<string>();
  const numbers = new Map<string, number>();
  return (name) => {
    let number = numbers.get(name) ?? 0;
    let given = number === 0 ? name : `${name}_${number}`;
    while (taken.has(given)) given = `${name}_${++number}`;
    numbers.set(name, number);
    taken.add(given);
    return given;
  };
}
