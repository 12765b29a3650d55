import { type BendyRetargeted, type BendyRetargetOptions, retargetOptionsNames } from './generated/bindings.js';
import { MadeRetarget, MadeRetargetState } from './generated/classes.js';
import type { Model } from './model.js';
import { checkOptions, optionNames } from './options.js';
import type { Pose } from './pose.js';
import type { Runtime } from './runtime.js';

/** Options of a Retarget. */
export interface RetargetOptions extends BendyRetargetOptions {}

const retargetNames = optionNames<RetargetOptions>(retargetOptionsNames);

/** What had to give way in a frame: the result of `Retarget.apply`. */
export interface Retargeted extends BendyRetargeted {}

/** What a character remembers from one frame to the next: where its feet stand and its hands lie, and how its joints were turned. */
export class RetargetState extends MadeRetargetState {
  /** Throws OUT_OF_MEMORY. */
  constructor(runtime: Runtime) {
    super(runtime, runtime.calls.bendy_retarget_state_new(), runtime.functions.bendy_retarget_state_free);
  }
}

/**
 * How poses of one model become poses of another of different build: what corresponds is known from `Joint.role`, not from names; the
 * rest poses may differ (arms out or down), face other ways and have other sizes. Joints with a role turn as those of the source do.
 * Joints and morph targets with equal names and no role come along, such as props and faces; all others keep their rest relative to
 * their parent. Both models must be of one runtime. Only making it allocates.
 */
export class Retarget extends MadeRetarget {
  /** The model whose poses are taken; `model` is the other one. */
  readonly source: Model;

  /**
   * Both models are humans, animals on four legs, or animals on two. A human needs the roles of hips, head, upper and lower arms and
   * legs, hands and feet; an animal those of hips, and of three joints or more of each leg. Throws BAD_ARGUMENT, with a message that
   * says what is missing; OUT_OF_MEMORY.
   */
  constructor(source: Model, target: Model, options: RetargetOptions = {}) {
    checkOptions('Retarget', options, retargetNames);
    const { calls, functions } = target.runtime;
    super(target, calls.bendy_retarget_new(source, target, options), functions.bendy_retarget_free);
    this.own(source.useFile());
    this.source = source;
  }

  /**
   * Sets a pose of `model` to a pose of `source`. Where neither a constraint nor a contact acts, limbs have the directions of the
   * source's. Feet and hands on the ground are brought to their places by IK, and the body of who sits, lies or kneels to its height.
   * `state` is the character's own. `contacts` says how firmly left heel, left toes, right heel and right toes stand, then the same of an
   * animal's front feet, of a human's left and right hand, and its body, from 0 in the air to 1, then whether its hands are near each
   * other, as on one sword, and whether left and right hand touch its own body; if not given, they are found by heights above the ground
   * and by the skin. `seconds` since the last call with this state, 0 to 1: joints that would jump where the source does not turn
   * quickly, but do not jump; 0: they may. Throws BAD_ARGUMENT, and for numbers that are not finite the pose is then at rest.
   */
  apply(pose: Pose, source: Pose, state: RetargetState, contacts?: ArrayLike<number>, seconds = 0): Retargeted {
    return this.runtime.calls.bendy_retarget_pose(pose, this, source, state, contacts, seconds);
  }

  /** For each joint of `model`, the source's joint that turns it, or -1. */
  get joints(): Int32Array<ArrayBuffer> {
    return this.runtime.copyIndices(this.runtime.calls.bendy_retarget_joints(this), this.model.joints.length);
  }

  /** For each morph target of `model`, the source's, or -1. */
  get morphTargets(): Int32Array<ArrayBuffer> {
    return this.runtime.copyIndices(this.runtime.calls.bendy_retarget_morph_targets(this), this.model.morphTargets.length);
  }
}
