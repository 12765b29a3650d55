// The exact character beside the compact one, whose colours show how far its points are off.
import * as THREE from 'three';
import type { Character } from './character.js';

const ramp = [0x30306e, 0x2678b2, 0x35b779, 0xf6d746, 0xd9381e].map((colour) => new THREE.Color(colour));
const mostCandidates = 8;

/** The ramp of colours, as a CSS gradient. */
export const rampGradient = `linear-gradient(90deg, ${ramp.map((colour) => `#${colour.getHexString()}`).join()})`;

/** For each point, the points of another set that are at most `distance` away: `mostCandidates` indices, -1 after the last. */
function neighbours(points: Float32Array, others: Float32Array, distance: number): Int32Array {
  const cells = new Map<string, number[]>();
  const cellOf = (list: Float32Array, at: number): number[] => [0, 1, 2].map((c) => Math.floor(list[at + c]! / distance));
  for (let k = 0; 3 * k < others.length; ++k) {
    const key = cellOf(others, 3 * k).join();
    const cell = cells.get(key);
    if (cell) cell.push(k);
    else cells.set(key, [k]);
  }
  const found = new Int32Array((points.length / 3) * mostCandidates).fill(-1);
  for (let k = 0; 3 * k < points.length; ++k) {
    const [x, y, z] = cellOf(points, 3 * k) as [number, number, number];
    let count = 0;
    for (let cell = 0; cell < 27 && count < mostCandidates; ++cell) {
      const key = [x + (cell % 3) - 1, y + (Math.floor(cell / 3) % 3) - 1, z + Math.floor(cell / 9) - 1].join();
      for (const other of cells.get(key) ?? []) {
        const apart = Math.hypot(...[0, 1, 2].map((c) => points[3 * k + c]! - others[3 * other + c]!));
        if (apart <= distance && count < mostCandidates) found[k * mostCandidates + count++] = other;
      }
    }
  }
  return found;
}

export class Comparison {
  /** The largest distance of the last pose, metres. */
  worst = 0;
  readonly #candidates: Int32Array;
  readonly #colours: Float32Array;

  /** @param bound - the largest distance that the compact file promises, metres */
  constructor(
    readonly exact: Character,
    readonly compact: Character,
    readonly bound: number,
  ) {
    compact.follow(exact);
    // The compact file has its vertices in another order: those that are at the same place at rest belong together.
    this.#candidates = neighbours(compact.vertices(true), exact.vertices(true), 1.5 * bound);
    this.#colours = compact.paint();
  }

  /** Colours each vertex by its distance to the one that it stands for, in the current poses. */
  update(): void {
    if (this.exact.isFading) return; // the exact character plays two clips for the moment
    const [given, made] = [this.exact.vertices(), this.compact.vertices()];
    const colour = new THREE.Color();
    this.worst = 0;
    for (let k = 0; 3 * k < made.length; ++k) {
      let nearest = Infinity;
      for (let at = k * mostCandidates; at < (k + 1) * mostCandidates && this.#candidates[at]! >= 0; ++at) {
        const other = 3 * this.#candidates[at]!;
        nearest = Math.min(nearest, Math.hypot(made[3 * k]! - given[other]!, made[3 * k + 1]! - given[other + 1]!, made[3 * k + 2]! - given[other + 2]!));
      }
      if (nearest === Infinity) nearest = 0; // of a vertex that nothing stands for
      this.worst = Math.max(this.worst, nearest);
      const place = Math.min(nearest / this.bound, 1) * (ramp.length - 1);
      const from = Math.min(Math.floor(place), ramp.length - 2);
      colour.lerpColors(ramp[from]!, ramp[from + 1]!, place - from).toArray(this.#colours, 3 * k);
    }
    this.compact.repaint();
  }
}
