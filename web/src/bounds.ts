import { readBendyBox } from './generated/bindings.js';
import type { Key } from './items.js';
import type { Model } from './model.js';
import type { Joint, Vector3 } from './parts.js';
import type { Pose } from './pose.js';
import { Handle } from './runtime.js';

/** An axis-aligned box that includes both corners; empty if a minimum is above its maximum (infinity above -infinity). */
export interface Box {
  /** Metres. */
  minimum: Vector3;
  maximum: Vector3;
}

/**
 * Boxes that contain everything that linear skinning makes of a model in any pose, without skinning it: for culling, cameras,
 * picking. Making it takes time linear in the vertices.
 */
export class Bounds extends Handle {
  readonly model: Model;

  /** Throws OUT_OF_MEMORY. */
  constructor(model: Model) {
    const { runtime } = model;
    const { functions, error } = runtime;
    const handle = runtime.checkHandle(functions.bendy_bounds_new(model.handle, error));
    super(runtime, handle, () => functions.bendy_bounds_free(handle));
    this.own(model.useFile());
    this.model = model;
  }

  /** Computes the box of all vertices in a pose, in model space. Throws BAD_ARGUMENT for a pose of another model. */
  ofPose(pose: Pose): Box {
    const { runtime } = this;
    this.model.checkOwn(pose, 'pose');
    runtime.check(runtime.functions.bendy_bounds_of_pose(this.handle, pose.handle, runtime.scratch, runtime.error));
    return readBendyBox(runtime, runtime.scratch);
  }

  /**
   * Computes the box of all vertices that a joint moves, as if that joint alone moved them: in a pose, in model space, or, without
   * one, in joint space. Throws NOT_FOUND; BAD_ARGUMENT for a joint or a pose of another model.
   */
  ofJoint(joint: Key<Joint>, pose?: Pose): Box {
    const { runtime } = this;
    const { scratch, error } = runtime;
    const number = this.model.joints.number(joint);
    if (pose !== undefined) this.model.checkOwn(pose, 'pose');
    runtime.check(runtime.functions.bendy_bounds_of_joint(this.handle, pose?.handle ?? 0, number, scratch, error));
    return readBendyBox(runtime, scratch);
  }
}
