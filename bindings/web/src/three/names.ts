/**
 * Returns a function that makes names unique as GLTFLoader does: Bone, Bone_1, Bone_2. A name that was given before gets the next
 * free number, because tracks find objects by their names.
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
