import { type BendyRootAxes, type BendyRootMotion, rootAxesNames } from './generated/bindings.js';
import { MadeRootPath } from './generated/classes.js';
import type { Key } from './items.js';
import { loadedRuntime } from './load.js';
import type { Model } from './model.js';
import { checkOptions, optionNames } from './options.js';
import type { Joint } from './parts.js';
import type { CrossFade, Playback } from './play.js';

/** A rotation followed by a translation, in double precision. */
export interface RootMotion extends BendyRootMotion {}

/** Which parts of the root's movement move the character; the rest stays in the pose. */
export interface RootAxes extends BendyRootAxes {}

const axesNames = optionNames<RootAxes>(rootAxesNames);

/** Applies `motion`, given in the axes of `before`, after it. Each frame: `place = composeMotions(place, motion)`. */
export function composeMotions(before: RootMotion, motion: RootMotion): RootMotion {
  return loadedRuntime().calls.bendy_root_motion_compose(before, motion);
}

/** Interpolates between two motions along the shorter arc; weight 0 to 1. */
export function blendMotions(motion: RootMotion, other: RootMotion, weight: number): RootMotion {
  return loadedRuntime().calls.bendy_root_motion_blend(motion, other, weight);
}

/** Returns the matrix of a motion: 16 numbers, column by column. */
export function motionMatrix(motion: RootMotion): Float64Array {
  return loadedRuntime().calls.bendy_root_motion_matrix(motion);
}

/** The root motion of the joint that carries a character over the ground: a root joint, or the hips. */
export class RootPath extends MadeRootPath {
  /** Throws NOT_FOUND, BAD_ARGUMENT, OUT_OF_MEMORY. */
  constructor(model: Model, joint: Key<Joint>, axes: RootAxes = {}) {
    checkOptions('RootPath', axes, axesNames);
    const { calls, functions } = model.runtime;
    super(model, calls.bendy_root_path_new(model, model.joints.number(joint), axes), functions.bendy_root_path_free);
  }

  /**
   * Computes the motion that the last `advance` of a clock or a cross-fade has played, across the ends of clips.
   * Throws BAD_ARGUMENT for one of another model.
   */
  over(played: Playback | CrossFade): RootMotion {
    this.model.checkOwn(played, 'clip that was played');
    if ('clip' in played) return this.#over(played.clip.number, played.played);
    let motion: RootMotion = { translation: [0, 0, 0], rotation: [0, 0, 0, 1] };
    for (const [number, { clip, weight }] of played.playing.entries()) {
      const next = this.#over(clip.number, played.played(number));
      motion = number === 0 ? next : blendMotions(motion, next, weight);
    }
    return motion;
  }

  #over(clip: number, played: number): RootMotion {
    return this.runtime.calls.bendy_root_path_over(this, clip, played);
  }
}
