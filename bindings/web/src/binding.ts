import { type BendyBindingOptions, bindingOptionsNames } from './generated/bindings.js';
import type { Key } from './items.js';
import type { MorphTarget } from './mesh.js';
import type { Model } from './model.js';
import { checkOptions, optionNames } from './options.js';
import type { Joint } from './parts.js';
import { Handle } from './runtime.js';

/** Options of a Binding. */
export interface BindingOptions extends Omit<BendyBindingOptions, 'translations' | 'root'> {
  /** Only the root takes translations, so that limbs keep the posed model's lengths. */
  rootOnly?: boolean;
  /** With `rootOnly`: this joint of the posed model and its ancestors take translations; usually the hips. */
  root?: Key<Joint>;
  /** With `rootOnly`: the factor of these translations; 1 if not given. */
  rootScale?: number;
}

const { translations: _, ...others } = bindingOptionsNames;
const bindingNames = optionNames<BindingOptions>({ ...others, rootOnly: true });

/**
 * Maps the clips of one model to another by the names of joints and morph targets: for files that hold only a skeleton and clips,
 * shared by many characters. The rest poses should be the same. Both models must be of one runtime.
 */
export class Binding extends Handle {
  /** The model that owns the clips. */
  readonly animated: Model;
  /** The model of the poses. */
  readonly posed: Model;

  /** Throws NOT_FOUND, BAD_ARGUMENT, OUT_OF_MEMORY. */
  constructor(animated: Model, posed: Model, options: BindingOptions = {}) {
    checkOptions('Binding', options, bindingNames);
    const { runtime } = animated;
    const { rootOnly, root, ...others } = options;
    const handle = runtime.calls.bendy_binding_new(animated, posed, {
      ...others,
      translations: rootOnly ? 'root_only' : 'all',
      root: root === undefined ? null : posed.joints.number(root),
    });
    super(runtime, handle, runtime.functions.bendy_binding_free);
    this.own(animated.useFile());
    this.own(posed.useFile());
    this.animated = animated;
    this.posed = posed;
  }

  /** For each joint of the animated model the posed model's, or -1. */
  get joints(): Int32Array {
    const at = this.runtime.calls.bendy_binding_joints(this);
    return this.runtime.copyIndices(at, this.animated.joints.length);
  }

  /** For each morph target of the animated model the posed model's, or -1. */
  get targets(): Int32Array {
    const at = this.runtime.calls.bendy_binding_targets(this);
    return this.runtime.copyIndices(at, this.animated.morphTargets.length);
  }

  /** The joints of the animated model that some clip animates but that have no match. */
  get unmatchedJoints(): Joint[] {
    const joints = this.runtime.calls.bendy_binding_unmatched_joints(this);
    return Array.from(joints, (joint) => this.animated.joints[joint]!);
  }

  /** The morph targets of the animated model that some clip animates but that have no match. */
  get unmatchedTargets(): MorphTarget[] {
    const targets = this.runtime.calls.bendy_binding_unmatched_targets(this);
    return Array.from(targets, (target) => this.animated.morphTargets[target]!);
  }
}
