import type { BendyBox } from './generated/bindings.js';
import type { Key } from './items.js';
import type { Model } from './model.js';
import type { Joint } from './parts.js';
import type { Pose } from './pose.js';
import { OfModel } from './runtime.js';

/** An axis-aligned box that includes both corners; empty if a minimum is above its maximum (infinity above -infinity). */
export interface Box extends BendyBox {}

/**
 * Boxes that contain everything that linear skinning makes of a model in any pose, without skinning it: for culling, cameras,
 * picking. Making it takes time linear in the vertices.
 */
export class Bounds extends OfModel {
  /** Throws OUT_OF_MEMORY. */
  constructor(model: Model) {
    const { calls, functions } = model.runtime;
    super(model, calls.bendy_bounds_new(model), functions.bendy_bounds_free);
  }

  /** Computes the box of all vertices in a pose, in model space. Throws BAD_ARGUMENT for a pose of another model. */
  ofPose(pose: Pose): Box {
    return this.runtime.calls.bendy_bounds_of_pose(this, pose);
  }

  /**
   * Computes the box of all vertices that a joint moves, as if that joint alone moved them: in a pose, in model space, or, without
   * one, in joint space. Throws NOT_FOUND; BAD_ARGUMENT for a joint or a pose of another model.
   */
  ofJoint(joint: Key<Joint>, pose?: Pose): Box {
    const number = this.model.joints.number(joint);
    return this.runtime.calls.bendy_bounds_of_joint(this, pose, number);
  }
}
