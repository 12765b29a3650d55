import {
  Bone,
  BufferAttribute,
  type BufferGeometry,
  DynamicDrawUsage,
  Matrix4,
  type Object3D,
  Quaternion,
  Skeleton,
  SkinnedMesh,
  Vector3,
} from 'three';
import {
  BendyError,
  type Chain,
  type Clip,
  CrossFade,
  type Items,
  type Key,
  type Model,
  type PointLike,
  type Pose,
  type ReachOptions,
  type ReachResult,
  ReachState,
  type RotationLike,
  type SkinOptions,
} from '../index.js';
import { described } from '../errors.js';
import { type ClipOptions, startClip } from '../engines/player.js';
import { reachOptionsNames } from '../generated/bindings.js';
import { checkNumber, component } from '../numbers.js';
import { checkOptions, optionNames } from '../options.js';
import { Borrowed } from './borrowed.js';
import type { BendyCharacter } from './character.js';
import { Palettes } from './palettes.js';
import { withIndex } from './parts.js';

/** Options of a BendyAnimator. */
export interface AnimatorOptions {
  /**
   * Who skins the vertices. `gpu`, if not given: three.js, by the bones. `wasm`: the runtime, into attributes of the geometries;
   * the bones move as well.
   */
  skin?: 'gpu' | 'wasm';
  /** With `wasm`: the skinning method. */
  method?: NonNullable<SkinOptions['method']>;
  /**
   * Which objects of joints move. `all`, if not given: each. `needed`: those that carry something, such as a sword that you attached, with
   * the joints above them. The skinned meshes then take the runtime's palettes, which is faster; what else reads joints, such as
   * raycasts and SkeletonHelper, needs `updateJoints` before. With `wasm`, all joints move.
   */
  joints?: 'all' | 'needed';
}

/** Options of `BendyAnimator.play`. */
export interface AnimatorPlayOptions extends ClipOptions {}

/** Options of `BendyAnimator.reach`. */
export interface AnimatorReachOptions extends Omit<ReachOptions, 'rotation' | 'pole'> {
  /** The desired orientation of the tip. */
  rotation?: RotationLike;
  /** A point to bend towards: two-bone and aim. */
  pole?: PointLike;
  /** The space of target, rotation and pole: three.js's world, if not given, or the model's own space, that of `scene`. */
  space?: 'world' | 'model';
}

const animatorNames = optionNames<AnimatorOptions>({ skin: true, method: true, joints: true });
const reachNames = optionNames<AnimatorReachOptions>({ ...reachOptionsNames, rotation: true, space: true });

/** A skinned object whose vertices the runtime computes, and its original state. */
interface Skinned {
  readonly object: SkinnedMesh;
  readonly geometry: BufferGeometry;
  readonly skeleton: Skeleton;
  readonly wasCulled: boolean;
}

/** The attributes that the parts of a mesh share. */
interface Attributes {
  readonly position: BufferAttribute;
  readonly normal: BufferAttribute | null;
  readonly tangent: BufferAttribute | null;
}

const toModel = new Matrix4();
const point = new Vector3();
const turn = new Quaternion();

/**
 * Animates a character by Bendy's runtime: plays and blends clips, and reaches within the joints' limits.
 *
 *     const animator = new BendyAnimator(character).play('Walk');
 *     // each frame
 *     animator.update(seconds, () => animator.reach('LeftArm', target));
 *
 * Its methods change `pose`; `update` and `apply` write it to the joints, the morph targets and, with `skin: 'wasm'`, the vertices.
 */
export class BendyAnimator {
  readonly character: BendyCharacter;
  /** The current pose, for anything that the methods here do not offer. */
  readonly pose: Pose;
  #fade: CrossFade; // of the model whose clips play
  #borrowed: Borrowed | null = null;
  readonly #other: Pose;
  readonly #reached: ReachState;
  #seconds: number | null = null; // of the update that runs
  readonly #method: NonNullable<SkinOptions['method']>;
  readonly #skinned: Skinned[] = [];
  readonly #attributes = new Map<number, Attributes>();
  readonly #palettes: Palettes | null;

  /** Throws OUT_OF_MEMORY, DISPOSED. */
  constructor(character: BendyCharacter, options: AnimatorOptions = {}) {
    const model = character?.model as BendyCharacter['model'] | undefined;
    if (model === undefined) {
      throw new BendyError('bad_argument', `expected the result of BendyLoader, with scene and model, found ${described(character)}`);
    }
    checkOptions('BendyAnimator', options, animatorNames);
    this.character = character;
    this.pose = model.pose();
    this.#other = model.pose();
    this.#reached = new ReachState(model);
    this.#fade = new CrossFade(model);
    this.#method = options.method ?? 'linear';
    this.#palettes = options.joints === 'needed' && options.skin !== 'wasm' ? new Palettes(character) : null;
    if (options.skin === 'wasm') this.#skinByRuntime();
    else if (this.#palettes !== null) this.apply();
  }

  /** Sets the pose to a clip at a time on its time line, in seconds. Throws NOT_FOUND, BAD_ARGUMENT. */
  sample(clip: Key<Clip>, seconds: number): this {
    this.#check();
    this.pose.sample(clip, seconds);
    return this;
  }

  /** Blends the pose towards a clip at a time: weight 0 to 1, `mask` scales it per joint. Throws NOT_FOUND, BAD_ARGUMENT. */
  blend(clip: Key<Clip>, seconds: number, weight: number, mask?: ArrayLike<number>): this {
    this.#check();
    this.pose.blend(this.#other.sample(clip, seconds), weight, mask);
    return this;
  }

  /** Starts a clip, which `update` plays and which fades in over what plays now. Throws NOT_FOUND, BAD_ARGUMENT. */
  play(clip: Key<Clip>, options: AnimatorPlayOptions = {}): this {
    this.#check();
    startClip(this.#fade, clip, options);
    return this;
  }

  /** The clips that `play` starts: those of the character, or those that it borrows. */
  get clips(): Items<Clip> {
    return this.#fade.model.clips;
  }

  /**
   * From now on, `play` starts the clips of another model, which the character plays whatever its build, as `Retarget` does it; null: its
   * own again. What plays ends. The animator owns `source` and disposes of it with the next one, or at the end; if it throws, nothing
   * has changed and `source` is the caller's. Throws BAD_ARGUMENT if a joint lacks its role.
   */
  borrow(source: Model | null): this {
    this.#check();
    if (source !== null && source === this.#borrowed?.model) return this;
    const borrowed = source === null ? null : new Borrowed(source, this.character.model);
    const fade = new CrossFade(source ?? this.character.model);
    this.#endPlaying();
    [this.#fade, this.#borrowed] = [fade, borrowed];
    return this;
  }

  /** Ends what plays, and sets the pose to rest. */
  stop(): this {
    this.#check();
    const { model } = this.#fade;
    this.#fade.dispose();
    this.#fade = new CrossFade(model);
    this.#reached.reset();
    this.pose.reset();
    return this;
  }

  /** As `play`, with a fade of this many seconds. */
  crossFade(clip: Key<Clip>, seconds: number, options: Omit<AnimatorPlayOptions, 'fade'> = {}): this {
    return this.play(clip, { ...options, fade: seconds });
  }

  /**
   * Moves an IK chain so that its tip reaches a target, within the joints' limits, starting from the current pose. Called by
   * `adjust` of `update`, it remembers what the chain did in the last update, so that the chain does not jump. Lengths in options and
   * result are metres of the model. Throws NOT_FOUND, BAD_ARGUMENT.
   */
  reach(chain: Key<Chain>, target: PointLike, options: AnimatorReachOptions = {}): ReachResult {
    this.#check();
    checkOptions('reach', options, reachNames);
    const { rotation, pole, space, ...rest } = options;
    const isWorld = space !== 'model';
    if (isWorld) {
      this.character.scene.updateWorldMatrix(true, false);
      toModel.copy(this.character.scene.matrixWorld).invert();
    }
    const place = (p: PointLike, name: string): number[] => {
      point.set(component(p, 0, 3, name), component(p, 1, 3, name), component(p, 2, 3, name));
      return (isWorld ? point.applyMatrix4(toModel) : point).toArray();
    };
    const given: ReachOptions = this.#seconds === null ? rest : { state: this.#reached, seconds: this.#seconds, ...rest };
    if (pole !== undefined) given.pole = place(pole, 'pole');
    if (rotation !== undefined) {
      const part = (i: number): number => component(rotation, i, 4, 'rotation');
      turn.set(part(0), part(1), part(2), part(3));
      if (isWorld) turn.premultiply(this.character.scene.getWorldQuaternion(new Quaternion()).invert());
      given.rotation = turn.normalize().toArray();
    }
    return this.pose.reach(chain, place(target, 'target'), given);
  }

  /**
   * Advances what plays by seconds, sets the pose to it and writes it. `adjust` is called in between: it may blend and reach. If
   * nothing plays, the pose stays, and is written.
   */
  update(seconds: number, adjust?: (animator: this) => void): this {
    this.#check();
    checkNumber(seconds, 'seconds');
    if (this.#fade.isPlaying) {
      this.#fade.advance(seconds).sample(this.#borrowed?.pose ?? this.pose);
      this.#borrowed?.apply(this.pose, seconds);
    }
    this.#seconds = Math.min(Math.max(seconds, 0), 1);
    try {
      adjust?.(this);
    } finally {
      this.#seconds = null;
    }
    return this.apply();
  }

  /** Writes the pose. */
  apply(): this {
    this.#check();
    const { parts, model } = this.character;
    const { moved } = this.#palettes ?? { moved: null };
    if (moved === null || moved.length > 0) this.#moveJoints(moved);
    this.#palettes?.take(this.pose);
    if (model.morphTargets.length > 0) {
      const weights = this.pose.morphWeights;
      for (const { object, mesh } of parts) {
        if (object.morphTargetInfluences === undefined) continue;
        const first = model.meshes[mesh]!.morphTargets[0]?.number ?? 0;
        for (let k = 0; k < object.morphTargetInfluences.length; ++k) object.morphTargetInfluences[k] = weights[first + k]!;
      }
    }
    for (const [mesh, { position, normal, tangent }] of this.#attributes) {
      const options = { mesh, normals: normal !== null, tangents: tangent !== null, method: this.#method };
      const skinned = this.pose.skin(options);
      write(position, skinned.positions);
      if (normal !== null) write(normal, skinned.normals);
      if (tangent !== null) write(tangent, skinned.tangents);
    }
    return this;
  }

  #moveJoints(moved: readonly number[] | null): void {
    const { joints } = this.character;
    const { locals } = this.pose;
    const move = (k: number): void => {
      const { quaternion, position, scale } = joints[k]!;
      const at = 10 * k;
      // three.js computes Euler angles whenever a quaternion is set.
      const { x, y, z, w } = quaternion;
      if (x !== locals[at] || y !== locals[at + 1] || z !== locals[at + 2] || w !== locals[at + 3]) quaternion.fromArray(locals, at);
      position.fromArray(locals, at + 4);
      scale.fromArray(locals, at + 7);
    };
    if (moved === null) for (let k = 0; k < joints.length; ++k) move(k);
    else for (const k of moved) move(k);
  }

  /** With `joints: 'needed'`: moves the objects of all joints to the pose, and computes the scene's world matrices. */
  updateJoints(): this {
    this.#moveJoints(null);
    this.#palettes?.wake();
    this.character.scene.updateWorldMatrix(true, false);
    this.character.scene.updateMatrixWorld(true);
    this.#palettes?.rest();
    return this;
  }

  /** Releases the animator's memory. Vertices that the runtime has skinned are skinned by three.js again. */
  dispose(): void {
    if (this.#palettes !== null && !this.pose.disposed) this.#moveJoints(null); // the pose stays
    this.#palettes?.dispose();
    for (const { object, geometry, skeleton, wasCulled } of this.#skinned) {
      const { drawRange } = object.geometry;
      geometry.setDrawRange(drawRange.start, drawRange.count);
      object.geometry.dispose();
      object.skeleton.dispose();
      object.geometry = geometry;
      object.frustumCulled = wasCulled;
      object.bind(skeleton, object.bindMatrix);
    }
    this.#skinned.length = 0;
    this.#attributes.clear();
    this.#endPlaying();
    this.#other.dispose();
    this.#reached.dispose();
    this.pose.dispose();
  }

  #check(): void {
    if (this.pose.disposed) throw new BendyError('disposed', 'this BendyAnimator has been disposed');
  }

  #endPlaying(): void {
    this.#fade.dispose();
    this.#borrowed?.dispose();
  }

  /**
   * Gives the skinned objects geometries whose vertices are in model space, without morph targets, and one bone that carries model
   * space to the world.
   */
  #skinByRuntime(): void {
    const { scene, parts, model } = this.character;
    for (const { object, mesh: number } of parts) {
      if (!(object instanceof SkinnedMesh)) continue;
      const before = object.geometry as BufferGeometry;
      const mesh = model.meshes[number]!;
      let attributes = this.#attributes.get(number);
      if (attributes === undefined) {
        const copy = (name: string): BufferAttribute =>
          (before.getAttribute(name) as BufferAttribute).clone().setUsage(DynamicDrawUsage);
        attributes = {
          position: copy('position'),
          normal: mesh.hasNormals ? copy('normal') : null,
          tangent: mesh.hasTangents ? copy('tangent') : null,
        };
        this.#attributes.set(number, attributes);
      }
      const after = withIndex(before, before.index);
      after.morphAttributes = {};
      for (const [name, attribute] of Object.entries(attributes)) {
        if (attribute !== null) after.setAttribute(name, attribute as BufferAttribute);
      }
      const first = new Float32Array(4 * mesh.vertexCount).map((_, k) => (k % 4 === 0 ? 1 : 0));
      after.setAttribute('skinIndex', new BufferAttribute(new Uint8Array(4 * mesh.vertexCount), 4));
      after.setAttribute('skinWeight', new BufferAttribute(first, 4));
      this.#skinned.push({ object, geometry: before, skeleton: object.skeleton, wasCulled: object.frustumCulled });
      object.geometry = after;
      object.frustumCulled = false; // the bounds of the vertices change from frame to frame
      object.bind(new Skeleton([scene as Object3D as Bone], [new Matrix4()]), object.bindMatrix);
    }
    this.apply();
  }
}

function write(attribute: BufferAttribute, numbers: Float32Array): void {
  attribute.array.set(numbers);
  attribute.needsUpdate = true;
}
