import { type Model, type Pose, Retarget, RetargetState } from '../index.js';

/** @internal Another character whose poses become those of one that borrows its clips. Owns that character's model. */
export class Borrowed {
  readonly model: Model;
  /** The other character's. */
  readonly pose: Pose;
  readonly #retarget: Retarget;
  readonly #state: RetargetState;

  /** Throws BAD_ARGUMENT if one of the two lacks roles. */
  constructor(source: Model, target: Model) {
    this.#retarget = new Retarget(source, target);
    this.#state = new RetargetState(target.runtime);
    this.pose = source.pose();
    this.model = source;
  }

  /** Sets the pose of the one that borrows, so many seconds after the last call. */
  apply(target: Pose, seconds: number): void {
    this.#retarget.apply(target, this.pose, this.#state, undefined, Math.min(seconds, 1));
  }

  /** Forgets the last frame: for a motion that jumps. */
  reset(): void {
    this.#state.reset();
  }

  dispose(): void {
    for (const one of [this.#retarget, this.#state, this.pose, this.model]) one.dispose();
  }
}
