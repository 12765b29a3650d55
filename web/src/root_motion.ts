import type { Clip } from './clip.js';
import { readBendyRootMotion, rootAxesLayout, rootTurnWords } from './generated/bindings.js';
import type { Key } from './items.js';
import { loadedRuntime } from './load.js';
import type { Model } from './model.js';
import type { Joint, Quaternion, Vector3 } from './parts.js';
import type { CrossFade, Playback } from './play.js';
import { type Pose, word } from './pose.js';
import { Handle, type Runtime } from './runtime.js';

/** A rotation followed by a translation, in double precision. */
export interface RootMotion {
  /** Metres. */
  translation: Vector3;
  /** Unit quaternion x, y, z, w. */
  rotation: Quaternion;
}

/** Which parts of the root's movement move the character; the rest stays in the pose. */
export interface RootAxes {
  /** Translation along the model's axes; true, false, true if not given. */
  x?: boolean;
  y?: boolean;
  z?: boolean;
  /** Rotation about the model's y axis, all of it, or none; `yaw` if not given. */
  turn?: (typeof rootTurnWords)[number];
}

const numbers = 7;

function put(runtime: Runtime, at: number, { translation, rotation }: RootMotion): number {
  for (let k = 0; k < numbers; ++k) runtime.view.setFloat64(at + 8 * k, [...translation, ...rotation][k]!, true);
  return at;
}

function call(runtime: Runtime, make: (out: number) => number): RootMotion {
  runtime.check(make(runtime.scratch));
  return readBendyRootMotion(runtime, runtime.scratch);
}

/** Applies `motion`, given in the axes of `before`, after it. Each frame: `place = composeMotions(place, motion)`. */
export function composeMotions(before: RootMotion, motion: RootMotion): RootMotion {
  const runtime = loadedRuntime();
  const { scratch, functions, error } = runtime;
  const a = put(runtime, scratch + 64, before);
  const b = put(runtime, scratch + 128, motion);
  return call(runtime, (out) => functions.bendy_root_motion_compose(a, b, out, error));
}

/** Interpolates between two motions along the shorter arc; weight 0 to 1. */
export function blendMotions(motion: RootMotion, other: RootMotion, weight: number): RootMotion {
  const runtime = loadedRuntime();
  const { scratch, functions, error } = runtime;
  const a = put(runtime, scratch + 64, motion);
  const b = put(runtime, scratch + 128, other);
  return call(runtime, (out) => functions.bendy_root_motion_blend(a, b, weight, out, error));
}

/** Returns the matrix of a motion: 16 numbers, column by column. */
export function motionMatrix(motion: RootMotion): Float64Array {
  const runtime = loadedRuntime();
  const { scratch, functions, error } = runtime;
  const out = scratch + 64;
  runtime.check(functions.bendy_root_motion_matrix(put(runtime, scratch, motion), out, error));
  return Float64Array.from({ length: 16 }, (_, k) => runtime.view.getFloat64(out + 8 * k, true));
}

/** The root motion of the joint that carries a character over the ground: a root joint, or the hips. */
export class RootPath extends Handle {
  readonly model: Model;

  /** Throws NOT_FOUND, BAD_ARGUMENT, OUT_OF_MEMORY. */
  constructor(model: Model, joint: Key<Joint>, axes: RootAxes = {}) {
    const { runtime } = model;
    const { functions, error, view } = runtime;
    const number = model.joints.number(joint);
    const at = runtime.struct(rootAxesLayout);
    view.setUint32(at + rootAxesLayout.x, (axes.x ?? true) ? 1 : 0, true);
    view.setUint32(at + rootAxesLayout.y, (axes.y ?? false) ? 1 : 0, true);
    view.setUint32(at + rootAxesLayout.z, (axes.z ?? true) ? 1 : 0, true);
    view.setUint32(at + rootAxesLayout.turn, word(rootTurnWords, axes.turn ?? 'yaw', 'turn'), true);
    const handle = runtime.checkHandle(functions.bendy_root_path_new(model.handle, number, at, error));
    super(runtime, handle, () => functions.bendy_root_path_free(handle));
    this.own(model.useFile());
    this.model = model;
  }

  /** Computes the motion from the root's rest pose to its position in a clip at a time, in model space. Throws NOT_FOUND, BAD_ARGUMENT. */
  at(clip: Key<Clip>, seconds: number): RootMotion {
    const { functions, error } = this.runtime;
    const number = this.model.clips.number(clip);
    return call(this.runtime, (out) => functions.bendy_root_path_at(this.handle, number, seconds, out, error));
  }

  /** Computes the motion from one time to another, in the axes that the character has at `from`. */
  between(clip: Key<Clip>, from: number, to: number): RootMotion {
    const { functions, error } = this.runtime;
    const number = this.model.clips.number(clip);
    return call(this.runtime, (out) => functions.bendy_root_path_between(this.handle, number, from, to, out, error));
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
    const { functions, error } = this.runtime;
    return call(this.runtime, (out) => functions.bendy_root_path_over(this.handle, clip, played, out, error));
  }

  /**
   * Takes the motion out of a pose, and returns it: along the chosen axes the root is then at rest. Throws BAD_ARGUMENT for a pose
   * of another model.
   */
  extract(pose: Pose): RootMotion {
    const { functions, error } = this.runtime;
    this.model.checkOwn(pose, 'pose');
    return call(this.runtime, (out) => functions.bendy_root_path_extract(this.handle, pose.handle, out, error));
  }
}
