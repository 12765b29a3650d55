import type { BendyBox } from './generated/bindings.js';
import { MadeBounds } from './generated/classes.js';
import type { Model } from './model.js';

/** An axis-aligned box that includes both corners; empty if a minimum is above its maximum (infinity above -infinity). */
export interface Box extends BendyBox {}

/**
 * Boxes that contain everything that linear skinning makes of a model in any pose, without skinning it: for culling, cameras,
 * picking. Making it takes time linear in the vertices.
 */
export class Bounds extends MadeBounds {
  /** Throws OUT_OF_MEMORY. */
  constructor(model: Model) {
    const { calls, functions } = model.runtime;
    super(model, calls.bendy_bounds_new(model), functions.bendy_bounds_free);
  }
}
