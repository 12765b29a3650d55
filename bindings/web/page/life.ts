// Small signs of life of the first character: it smiles, and blinks from time to time.
import type { Character } from './character.js';

const smile = 0.45;
const blinkSeconds = 0.18;
const between = [2.5, 5.5]; // seconds, from one blink to the next
const lids = 0.12; // of the blink, while the eyes are open

export class Life {
  #blink: number | undefined;
  #smile: number | undefined;
  #until = 1.5;

  constructor(readonly character: Character) {
    const find = (wanted: string): number | undefined => character.morphTargets.find(({ name }) => name === wanted)?.number;
    [this.#blink, this.#smile] = [find('Blink'), find('Smile')];
    if (this.#smile !== undefined) character.weights.set(this.#smile, smile);
    if (this.#blink !== undefined) character.weights.set(this.#blink, lids);
  }

  /** A morph target that the user moves is left alone. */
  leave(target: number): void {
    if (target === this.#blink) this.#blink = undefined;
    if (target === this.#smile) this.#smile = undefined;
  }

  advance(seconds: number): void {
    if (this.#blink === undefined) return;
    this.#until -= seconds;
    const share = Math.max(0, -this.#until / blinkSeconds);
    this.character.weights.set(this.#blink, lids + (1 - lids) * Math.sin(Math.PI * Math.min(share, 1)));
    if (share >= 1) this.#until = between[0]! + Math.random() * (between[1]! - between[0]!);
  }
}
