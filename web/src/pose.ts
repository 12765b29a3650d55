import type { Binding } from './binding.js';
import type { Clip } from './clip.js';
import { BendyError } from './errors.js';
import {
  reachOptionsLayout,
  reachResultLayout,
  reachStatusWords,
  readBendyReachResult,
  skinMethodWords,
  skinOptionsLayout,
  socketLayout,
  solverWords,
  verticesLayout,
} from './generated/bindings.js';
import type { Key } from './items.js';
import type { LevelOfDetail } from './lod.js';
import type { Mesh } from './mesh.js';
import type { Model } from './model.js';
import type { Chain, Joint, Quaternion, Solver, Transform, Vector3 } from './parts.js';
import { type FloatBuffer, Handle, none } from './runtime.js';

/** Options of `Pose.reach`. What is not given is as the chain says. */
export interface ReachOptions {
  /** The desired orientation of the tip: unit quaternion x, y, z, w, model space. */
  rotation?: ArrayLike<number>;
  solver?: Solver;
  /** The largest number of iterations. */
  iterations?: number;
  /** Metres; 0.0001 of the chain's length if neither it nor the chain says. */
  tolerance?: number;
  /** 0 to 1: how far the solution is blended into the pose; 1 if not given. */
  influence?: number;
  /** A point in model space to bend towards, in metres: two-bone and aim. */
  pole?: ArrayLike<number>;
  /** False: joints may turn beyond their limits. */
  obeyConstraints?: boolean;
  /** True: afterwards, the joint that the chain follows is moved to the tip. */
  carryTarget?: boolean;
  /** Two-bone, 0 to 1: the fraction of its length over which the chain slows near full reach. */
  softness?: number;
  /** Pull: radians per chain length of distance; 1 if not given. */
  gain?: number;
  /** Pull: radians per joint and call; 0.2 if not given. */
  stepLimit?: number;
  /** Least squares: how many other starting points to try when it is stuck; 8 if not given. */
  restarts?: number;
}

/** What `Pose.reach` has done. */
export interface ReachResult {
  /** `out_of_reach`: the target is farther away than the chain is long; `aimed`: only aim, the tip points at the target. */
  readonly status: (typeof reachStatusWords)[number];
  /** Whether the tip is at the target, within the tolerance, or points at it. */
  readonly reached: boolean;
  /** Metres between tip and target. */
  readonly distance: number;
  /** Radians between the tip's orientation and the target's, if it has one; aim: to the line to the target. */
  readonly angle: number;
  readonly iterations: number;
}

/** Options of `Pose.skin`. */
export interface SkinOptions {
  /** One mesh; all if not given. */
  mesh?: Key<Mesh>;
  /** Whether to compute normals, too. */
  normals?: boolean;
  /** Whether to compute tangents, too. */
  tangents?: boolean;
  /** `dual_quaternion` preserves the volume of limbs that twist or bend; `linear` if not given. */
  method?: (typeof skinMethodWords)[number];
  /** Computes only the vertices in use at that level; the others keep their values. */
  lod?: LevelOfDetail;
}

/** Options of `Pose.socket`. */
export interface SocketOptions {
  /** 16 floats: from socket space to joint space; the identity if not given. */
  offset?: ArrayLike<number>;
  /** 16 floats: from model space to world space; the identity if not given. */
  world?: ArrayLike<number>;
  /** False: attached objects are scaled with the joint. */
  keepsSize?: boolean;
}

const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const localFloats = 10;

/**
 * The vertices that `Pose.skin` has computed last, of one mesh or of all, as views of the module's memory: take them from here
 * again after a call that may allocate, see `Runtime`.
 */
export class SkinnedVertices {
  readonly #buffers: VertexBuffers;
  readonly #first: number;
  readonly #count: number;
  #positions: Float32Array<ArrayBuffer> | undefined;
  #normals: Float32Array<ArrayBuffer> | undefined;
  #tangents: Float32Array<ArrayBuffer> | undefined;

  /** @internal */
  constructor(buffers: VertexBuffers, first: number, count: number) {
    this.#buffers = buffers;
    this.#first = first;
    this.#count = count;
  }

  #part(all: FloatBuffer, before: Float32Array<ArrayBuffer> | undefined, size: number): Float32Array<ArrayBuffer> {
    const { array } = all;
    if (before !== undefined && before.buffer === array.buffer) return before;
    return array.subarray(size * this.#first, size * (this.#first + this.#count));
  }

  /** x y z per vertex: metres, model space. */
  get positions(): Float32Array<ArrayBuffer> {
    return (this.#positions = this.#part(this.#buffers.positions, this.#positions, 3));
  }

  /** x y z per vertex, unit length; zero if the file has none. Throws BAD_ARGUMENT if they have never been asked for. */
  get normals(): Float32Array<ArrayBuffer> {
    return (this.#normals = this.#part(this.#buffers.wanted('normals'), this.#normals, 3));
  }

  /** x y z per vertex, unit length, and w, the handedness. Throws BAD_ARGUMENT if they have never been asked for. */
  get tangents(): Float32Array<ArrayBuffer> {
    return (this.#tangents = this.#part(this.#buffers.wanted('tangents'), this.#tangents, 4));
  }
}

/** The memory for the vertices of all meshes. */
interface VertexBuffers {
  positions: FloatBuffer;
  wanted(what: 'normals' | 'tangents'): FloatBuffer;
}

/**
 * A pose of a model: the joints' local transforms and the morph targets' weights. Methods that change it return it, so calls can
 * be chained. Results of `modelMatrices`, `palette` and `skin` are views of the module's memory that the same method overwrites
 * the next time; `slice()` copies them. Only making a pose and its first `skin`, also the first with normals, tangents or dual
 * quaternions, allocate.
 */
export class Pose extends Handle {
  readonly model: Model;
  readonly #locals: FloatBuffer;
  readonly #matrices: FloatBuffer;
  readonly #weights: FloatBuffer;
  readonly #mask: FloatBuffer;
  readonly #palettes: readonly FloatBuffer[];
  #positions: FloatBuffer | undefined;
  #normals: FloatBuffer | undefined;
  #tangents: FloatBuffer | undefined;
  #buffers: VertexBuffers | undefined;
  #skinned: SkinnedVertices | undefined;
  readonly #skinnedMeshes: (SkinnedVertices | undefined)[] = [];

  /**
   * Makes a pose, at rest, or a copy of another pose of the model. Throws OUT_OF_MEMORY, DISPOSED; BAD_ARGUMENT for a pose of
   * another model.
   */
  constructor(model: Model, from?: Pose) {
    if (from !== undefined) model.checkOwn(from, 'pose');
    const { runtime } = model;
    const { functions, error } = runtime;
    const handle = runtime.checkHandle(
      from === undefined ? functions.bendy_pose_new(model.handle, error) : functions.bendy_pose_copy(from.handle, error),
    );
    super(runtime, handle, () => functions.bendy_pose_free(handle));
    this.own(model.useFile());
    this.model = model;
    const joints = model.joints.length;
    this.#locals = this.ownFloats(localFloats * joints);
    this.#matrices = this.ownFloats(16 * joints);
    this.#weights = this.ownFloats(model.morphTargets.length);
    this.#mask = this.ownFloats(joints);
    this.#palettes = model.meshes.map((mesh) => this.ownFloats(16 * mesh.boneCount));
  }

  /** Sets the pose to rest. */
  reset(): this {
    this.runtime.check(this.runtime.functions.bendy_set_rest(this.handle, this.runtime.error));
    return this;
  }

  /** Returns a new pose that is equal to this one. Throws OUT_OF_MEMORY. */
  copy(): Pose {
    return new Pose(this.model, this);
  }

  /**
   * Sets the pose to a clip at a time on the clip's time line, in seconds, clamped to its ends; see `Playback` for loops. Whatever
   * the clip does not animate is set to rest. Throws NOT_FOUND; BAD_ARGUMENT for NaN, and for a clip of another model: see `Binding`.
   */
  sample(clip: Key<Clip>, seconds: number): this {
    const { runtime } = this;
    runtime.check(runtime.functions.bendy_sample(this.handle, this.model.clips.number(clip), seconds, runtime.error));
    return this;
  }

  /** As `sample`, for a clip of the model that a binding animates with. Throws NOT_FOUND, BAD_ARGUMENT. */
  sampleBound(binding: Binding, clip: Key<Clip>, seconds: number): this {
    const { runtime } = this;
    this.model.checkOwn({ model: binding.posed }, 'binding');
    const number = binding.animated.clips.number(clip);
    runtime.check(runtime.functions.bendy_sample_bound(this.handle, binding.handle, number, seconds, runtime.error));
    return this;
  }

  /** The address of a mask, which is copied into the module's memory; 0 for none. */
  #maskAt(mask: ArrayLike<number> | undefined): number {
    if (mask === undefined) return 0;
    const count = this.model.joints.length;
    if (mask.length !== count) throw new BendyError('bad_argument', `the mask has ${mask.length} numbers for ${count} joints`);
    this.#mask.array.set(mask);
    return this.#mask.at;
  }

  /**
   * Blends the pose towards another pose of the same model: weight 0 leaves it unchanged, 1 makes it equal to `other`; any finite
   * weight is allowed. `mask` scales the weight, one number per joint. Throws BAD_ARGUMENT.
   */
  blend(other: Pose, weight: number, mask?: ArrayLike<number>): this {
    const { runtime } = this;
    this.model.checkOwn(other, 'pose');
    runtime.check(runtime.functions.bendy_blend(this.handle, other.handle, weight, this.#maskAt(mask), runtime.error));
    return this;
  }

  /** Turns the pose into its difference from a reference, as an input for `add`. Throws BAD_ARGUMENT. */
  makeAdditive(reference: Pose): this {
    this.model.checkOwn(reference, 'pose');
    this.runtime.check(this.runtime.functions.bendy_make_additive(this.handle, reference.handle, this.runtime.error));
    return this;
  }

  /** Adds a difference that `makeAdditive` made, scaled by a weight and per joint by `mask`. Throws BAD_ARGUMENT. */
  add(difference: Pose, weight = 1, mask?: ArrayLike<number>): this {
    const { runtime } = this;
    this.model.checkOwn(difference, 'pose');
    runtime.check(runtime.functions.bendy_add(this.handle, difference.handle, weight, this.#maskAt(mask), runtime.error));
    return this;
  }

  /** Moves every joint into the range that its constraints allow. */
  constrain(): this {
    this.runtime.check(this.runtime.functions.bendy_constrain(this.handle, this.runtime.error));
    return this;
  }

  /** Returns the local transform of a joint: a fresh copy. Throws NOT_FOUND, BAD_ARGUMENT. */
  local(joint: Key<Joint>): Transform {
    const { runtime } = this;
    const { scratch } = runtime;
    runtime.check(
      runtime.functions.bendy_get_local(this.handle, this.model.joints.number(joint), 1, scratch, runtime.error),
    );
    const numbers = Array.from(runtime.copyFloats(scratch, localFloats));
    return {
      rotation: numbers.slice(0, 4) as Quaternion,
      translation: numbers.slice(4, 7) as Vector3,
      scale: numbers.slice(7, 10) as Vector3,
    };
  }

  /** Sets parts of a joint's local transform. Throws NOT_FOUND; BAD_ARGUMENT for a rotation that is not a unit quaternion. */
  setLocal(joint: Key<Joint>, transform: Partial<Readonly<Transform>>): this {
    const { runtime } = this;
    const { scratch, functions, error } = runtime;
    const number = this.model.joints.number(joint);
    runtime.check(functions.bendy_get_local(this.handle, number, 1, scratch, error));
    if (transform.rotation) runtime.putFloats(scratch, transform.rotation, 4, 'rotation');
    if (transform.translation) runtime.putFloats(scratch + 16, transform.translation, 3, 'translation');
    if (transform.scale) runtime.putFloats(scratch + 28, transform.scale, 3, 'scale');
    runtime.check(functions.bendy_set_local(this.handle, number, 1, scratch, error));
    return this;
  }

  /**
   * The local transforms of all joints, ten floats each: rotation x y z w, translation x y z in metres, scale x y z. A view of the
   * module's memory: to change the pose, write into it and call `setLocals`.
   */
  get locals(): Float32Array<ArrayBuffer> {
    const { runtime } = this;
    const count = this.model.joints.length;
    runtime.check(runtime.functions.bendy_get_local(this.handle, 0, count, this.#locals.at, runtime.error));
    return this.#locals.array;
  }

  /** Sets the local transforms of all joints, laid out as in `locals`. Throws BAD_ARGUMENT. */
  setLocals(locals: ArrayLike<number>): this {
    const { runtime } = this;
    const count = this.model.joints.length;
    const { array } = this.#locals;
    if (locals.length !== array.length) {
      throw new BendyError('bad_argument', `${locals.length} numbers for ${count} joints: ${array.length} are needed`);
    }
    if (locals !== array) array.set(locals);
    runtime.check(runtime.functions.bendy_set_local(this.handle, 0, count, this.#locals.at, runtime.error));
    return this;
  }

  /** The weights of all morph targets, a view of the module's memory; `setMorphWeights` changes them. Usually 0 to 1. */
  get morphWeights(): Float32Array<ArrayBuffer> {
    const { runtime } = this;
    const count = this.model.morphTargets.length;
    runtime.check(runtime.functions.bendy_get_weights(this.handle, 0, count, this.#weights.at, runtime.error));
    return this.#weights.array;
  }

  /** Sets the weights of morph targets, from target `first` on. Throws BAD_ARGUMENT for too many, or what is not finite. */
  setMorphWeights(weights: ArrayLike<number>, first = 0): this {
    const { runtime } = this;
    const all = this.model.morphTargets.length;
    if (!Number.isInteger(first) || first < 0 || first + weights.length > all) {
      throw new BendyError('bad_argument', `there are ${all} morph targets`);
    }
    this.#weights.array.set(weights, first);
    runtime.check(
      runtime.functions.bendy_set_weights(this.handle, first, weights.length, this.#weights.at + 4 * first, runtime.error),
    );
    return this;
  }

  /**
   * Inverse kinematics: moves an IK chain so that its tip reaches a position (x, y, z in metres, model space) within its joints'
   * constraints, starting from the current pose. A target that is not reached is a result, not an error. Throws NOT_FOUND,
   * BAD_ARGUMENT.
   */
  reach(chain: Key<Chain>, target: ArrayLike<number>, options: ReachOptions = {}): ReachResult {
    const { runtime } = this;
    const { functions, error, scratch } = runtime;
    const number = this.model.chains.number(chain);
    const at = runtime.struct(reachOptionsLayout);
    const result = runtime.struct(reachResultLayout, scratch + 256);
    const position = runtime.putFloats(scratch + 512, target, 3, 'target');
    const rotation = options.rotation ? runtime.putFloats(scratch + 576, options.rotation, 4, 'rotation') : 0;
    if (options.pole) runtime.putFloats(at + reachOptionsLayout.pole, options.pole, 3, 'pole');
    const { view } = runtime;
    view.setUint32(at + reachOptionsLayout.solver, word(solverWords, options.solver ?? 'any', 'solver'), true);
    view.setUint32(at + reachOptionsLayout.iterations, options.iterations ?? 0, true);
    view.setUint32(at + reachOptionsLayout.restarts, options.restarts ?? 8, true);
    view.setFloat32(at + reachOptionsLayout.tolerance, options.tolerance ?? 0, true);
    view.setFloat32(at + reachOptionsLayout.influence, options.influence ?? 1, true);
    view.setFloat32(at + reachOptionsLayout.softness, options.softness ?? 0, true);
    view.setFloat32(at + reachOptionsLayout.gain, options.gain ?? 1, true);
    view.setFloat32(at + reachOptionsLayout.stepLimit, options.stepLimit ?? 0.2, true);
    view.setUint32(at + reachOptionsLayout.ignoreConstraints, options.obeyConstraints === false ? 1 : 0, true);
    view.setUint32(at + reachOptionsLayout.hasPole, options.pole ? 1 : 0, true);
    view.setUint32(at + reachOptionsLayout.carryTarget, options.carryTarget ? 1 : 0, true);
    runtime.check(functions.bendy_reach(this.handle, number, position, rotation, at, result, error));
    const { status, distance, angle, iterations } = readBendyReachResult(runtime, result);
    const name = reachStatusWords[status]!;
    return { status: name, reached: name === 'reached' || name === 'aimed', distance, angle, iterations };
  }

  /** Solves every chain that follows a target joint, in order of priority. */
  reachAll(): this {
    this.runtime.check(this.runtime.functions.bendy_reach_all(this.handle, this.runtime.error));
    return this;
  }

  /** Computes 16 floats per joint, column by column: from joint space to model space or, if `world` (16 floats) is given, to it. */
  modelMatrices(world?: ArrayLike<number>): Float32Array<ArrayBuffer> {
    const { runtime } = this;
    const count = this.model.joints.length;
    const at = world === undefined ? 0 : runtime.putFloats(runtime.scratch, world, 16, 'world');
    runtime.check(
      runtime.functions.bendy_joint_matrices(this.handle, 0, count, at, this.#matrices.at, runtime.error),
    );
    return this.#matrices.array;
  }

  /**
   * Computes the skinning palette of a mesh: 16 floats per bone, column by column, from mesh space to model space, for skinning on
   * the GPU. Throws NOT_FOUND; BAD_ARGUMENT for a rigid mesh.
   */
  palette(mesh: Key<Mesh>): Float32Array<ArrayBuffer> {
    const { runtime } = this;
    const number = this.model.meshes.number(mesh);
    const count = this.model.meshes[number]!.boneCount;
    const buffer = this.#palettes[number]!;
    runtime.check(runtime.functions.bendy_bone_matrices(this.handle, number, buffer.at, count, runtime.error));
    return buffer.array;
  }

  /**
   * Applies morph targets and skins the vertices of all meshes, mesh after mesh (`Mesh.firstVertex`), or of one. The result is the
   * same object every time. Throws NOT_FOUND, BAD_ARGUMENT, OUT_OF_MEMORY.
   */
  skin(options?: SkinOptions): SkinnedVertices {
    const { runtime, model } = this;
    const { scratch } = runtime;
    const vertexCount = model.vertexCount;
    this.#positions ??= this.ownFloats(3 * vertexCount);
    if (options?.normals) this.#normals ??= this.ownFloats(3 * vertexCount);
    if (options?.tangents) this.#tangents ??= this.ownFloats(4 * vertexCount);
    const mesh = options?.mesh === undefined ? undefined : model.meshes[model.meshes.number(options.mesh)]!;
    const first = mesh?.firstVertex ?? 0;
    const count = mesh?.vertexCount ?? vertexCount;
    const out = runtime.struct(verticesLayout);
    const given = runtime.struct(skinOptionsLayout, scratch + 256);
    const { view } = runtime;
    view.setUint32(out + verticesLayout.capacity, count, true);
    view.setUint32(out + verticesLayout.positions, this.#positions.at + 12 * first, true);
    if (options?.normals) view.setUint32(out + verticesLayout.normals, this.#normals!.at + 12 * first, true);
    if (options?.tangents) view.setUint32(out + verticesLayout.tangents, this.#tangents!.at + 16 * first, true);
    view.setUint32(given + skinOptionsLayout.mesh, mesh?.number ?? none, true);
    if (options?.lod !== undefined) model.checkOwn(options.lod, 'level of detail');
    view.setUint32(given + skinOptionsLayout.lod, options?.lod?.handle ?? 0, true);
    view.setUint32(given + skinOptionsLayout.method, word(skinMethodWords, options?.method ?? 'linear', 'method'), true);
    runtime.check(runtime.functions.bendy_skin(this.handle, given, out, runtime.error));
    if (mesh === undefined) return (this.#skinned ??= new SkinnedVertices(this.#vertexBuffers(), 0, vertexCount));
    return (this.#skinnedMeshes[mesh.number] ??= new SkinnedVertices(this.#vertexBuffers(), first, count));
  }

  #vertexBuffers(): VertexBuffers {
    return (this.#buffers ??= {
      positions: this.#positions!,
      wanted: (what) => {
        const buffer = what === 'normals' ? this.#normals : this.#tangents;
        if (buffer === undefined) throw new BendyError('bad_argument', `skin({ ${what}: true }) has not been called`);
        return buffer;
      },
    });
  }

  /**
   * Returns 16 floats, a fresh array: the matrix from a socket, an attachment point on a joint, to model space, or to world space if
   * `world` is given. The joint's axes are first made orthonormal, unless `keepsSize` is false. `joint` null: the model's own
   * space. Throws NOT_FOUND, BAD_ARGUMENT.
   */
  socket(joint: Key<Joint> | null, options: SocketOptions = {}): Float32Array<ArrayBuffer> {
    const { runtime } = this;
    const { scratch } = runtime;
    const number = joint === null ? none : this.model.joints.number(joint);
    const socket = runtime.struct(socketLayout);
    runtime.view.setUint32(socket + socketLayout.joint, number, true);
    runtime.view.setUint32(socket + socketLayout.keepsSize, options.keepsSize === false ? 0 : 1, true);
    runtime.putFloats(socket + socketLayout.offset, options.offset ?? identity, 16, 'offset');
    const world = options.world ? runtime.putFloats(scratch + 256, options.world, 16, 'world') : 0;
    const out = scratch + 512;
    runtime.check(runtime.functions.bendy_socket_matrix(this.handle, socket, world, out, runtime.error));
    return runtime.copyFloats(out, 16);
  }
}

/** The number of a word in an enumeration. */
export function word<T extends string>(words: readonly T[], word: T, name: string): number {
  const number = words.indexOf(word);
  if (number < 0) throw new BendyError('bad_argument', `${name} ${JSON.stringify(word)} is none of ${words.join(', ')}`);
  return number;
}
