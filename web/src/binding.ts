import { bindingOptionsLayout } from './generated/bindings.js';
import type { Key } from './items.js';
import type { Model } from './model.js';
import type { Joint } from './parts.js';
import { Handle, none } from './runtime.js';

/** Options of a Binding. */
export interface BindingOptions {
  /** Only the root takes translations, so that limbs keep the lengths of the posed model. */
  rootOnly?: boolean;
  /** With `rootOnly`: this joint of the posed model and its ancestors take translations; usually the hips. */
  root?: Key<Joint>;
  /** With `rootOnly`: the factor of these translations; 1 if not given. */
  rootScale?: number;
}

/**
 * Maps the clips of one model to another by the names of joints and morph targets: for files that hold only a skeleton and clips,
 * shared by many characters. The rest poses should be the same. Both models must be of one runtime.
 */
export class Binding extends Handle {
  /** The model that has the clips. */
  readonly animated: Model;
  /** The model of the poses. */
  readonly posed: Model;

  /** Throws NOT_FOUND, BAD_ARGUMENT, OUT_OF_MEMORY. */
  constructor(animated: Model, posed: Model, options: BindingOptions = {}) {
    const { runtime } = animated;
    animated.checkSameRuntime(posed);
    const { functions, error, view } = runtime;
    const root = options.root === undefined ? none : posed.joints.number(options.root);
    const at = runtime.struct(bindingOptionsLayout);
    view.setUint32(at + bindingOptionsLayout.translations, options.rootOnly ? 1 : 0, true);
    view.setUint32(at + bindingOptionsLayout.root, root, true);
    view.setFloat32(at + bindingOptionsLayout.rootScale, options.rootScale ?? 1, true);
    const handle = runtime.checkHandle(functions.bendy_binding_new(animated.handle, posed.handle, at, error));
    super(runtime, handle, () => functions.bendy_binding_free(handle));
    this.own(animated.useFile());
    this.own(posed.useFile());
    this.animated = animated;
    this.posed = posed;
  }

  /** For each joint of the animated model the posed model's, or -1. */
  get joints(): Int32Array {
    const at = this.runtime.functions.bendy_binding_joints(this.handle);
    return new Int32Array(this.runtime.copyIntegers(at, this.animated.joints.length).buffer);
  }

  /** The joints of the animated model that some clip animates but that have no match. */
  get unmatchedJoints(): Joint[] {
    const { runtime } = this;
    const at = runtime.functions.bendy_binding_unmatched_joints(this.handle, runtime.scratch, runtime.error);
    if (at === 0) return [];
    const count = runtime.view.getUint32(runtime.scratch, true);
    return Array.from(runtime.copyIntegers(at, count), (joint) => this.animated.joints[joint]!);
  }
}
