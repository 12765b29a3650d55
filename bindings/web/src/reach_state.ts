import { MadeReachState } from './generated/classes.js';
import type { Model } from './model.js';

/**
 * What the chains of one character did last. With it (`state` of `Pose.reach`), chains that reach in frame after frame do not jump: where
 * two poses are about equally good, a chain keeps the one that it has; where another one has been better for a tenth of a second, it goes
 * there at a limited speed. Each chain reaches once a frame.
 */
export class ReachState extends MadeReachState {
  /** Throws OUT_OF_MEMORY, DISPOSED. */
  constructor(model: Model) {
    const { calls, functions } = model.runtime;
    super(model, calls.bendy_reach_state_new(model), functions.bendy_reach_state_free);
  }
}
