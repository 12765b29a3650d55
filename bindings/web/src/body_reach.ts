import {
  type BendyBodyReached,
  type BendyBodyReachOptions,
  type BendyEffector,
  type BendyEffectorTarget,
  bodyReachOptionsNames,
  effectorNames,
  effectorTargetNames,
} from './generated/bindings.js';
import { MadeBodyReach } from './generated/classes.js';
import type { Key } from './items.js';
import type { Model } from './model.js';
import type { PointLike } from './numbers.js';
import { checkOptions, optionNames } from './options.js';
import type { Joint } from './parts.js';

/** A point of a joint that is to reach for a target. */
export interface Effector extends Omit<BendyEffector, 'joint'> {
  joint: Key<Joint>;
}

/** Where an effector is to be. */
export interface EffectorTarget extends BendyEffectorTarget {
  /** x, y, z in metres, model space. */
  position: PointLike;
}

/** Options of a BodyReach. */
export interface BodyReachOptions extends Omit<BendyBodyReachOptions, 'root'> {
  /** The topmost joint that moves, at or above all effectors' joints; the nearest such joint if not given. */
  root?: Key<Joint>;
}

/** How near the effectors came to their targets: the result of `Pose.reachBody`. */
export interface BodyReached extends Omit<BendyBodyReached, 'isReached'> {
  /** Whether every effector is at its target, within the tolerance. */
  readonly reached: boolean;
}

/** @internal */
export const targetNames = optionNames<EffectorTarget>(effectorTargetNames);
const namesOfEffector = optionNames<Effector>(effectorNames);
const bodyNames = optionNames<BodyReachOptions>(bodyReachOptionsNames);

/** The joints between a root and several effectors, such as hands, feet and head, for `Pose.reachBody`. Only making it allocates. */
export class BodyReach extends MadeBodyReach {
  /** `effectors`: 1 to 32. Throws NOT_FOUND, BAD_ARGUMENT, OUT_OF_MEMORY. */
  constructor(model: Model, effectors: readonly Effector[], options: BodyReachOptions = {}) {
    const { calls, functions } = model.runtime;
    checkOptions('BodyReach', options, bodyNames);
    const numbered = effectors.map((one) => {
      checkOptions('an effector', one, namesOfEffector);
      return { ...one, joint: model.joints.number(one.joint) };
    });
    const root = options.root === undefined ? null : model.joints.number(options.root);
    super(model, calls.bendy_body_reach_new(model, numbered, { ...options, root }), functions.bendy_body_reach_free);
  }
}
