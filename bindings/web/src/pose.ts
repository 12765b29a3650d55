import type { Binding } from './binding.js';
import { type BodyReach, type BodyReached, type EffectorTarget, targetNames } from './body_reach.js';
import type { Clip } from './clip.js';
import { BendyError } from './errors.js';
import {
  type BendyReachOptions,
  type BendyReachRequest,
  type BendyReachResult,
  type BendySkinOptions,
  type BendySocket,
  reachOptionsNames,
  reachRequestNames,
  readBendyTransform,
  skinOptionsNames,
  socketNames,
  transformLayout,
  verticesLayout,
} from './generated/bindings.js';
import { MadePose } from './generated/classes.js';
import type { Key } from './items.js';
import type { LevelOfDetail } from './lod.js';
import type { Mesh } from './mesh.js';
import type { Model } from './model.js';
import { checkNumbers, type PointLike, type RotationLike } from './numbers.js';
import { checkOptions, optionNames } from './options.js';
import type { Chain, Joint, Transform } from './parts.js';
import type { ReachState } from './reach_state.js';
import type { FloatBuffer } from './runtime.js';

type ChainReachOptions = Omit<BendyReachOptions, 'state'> & {
  /** What the chains of this character did last; if not given, each call is by itself. */
  state?: ReachState;
};

/** Options of `Pose.reach`. The chain gives the defaults. */
export interface ReachOptions extends ChainReachOptions {
  /** The desired orientation of the tip: unit quaternion x, y, z, w, model space. */
  rotation?: RotationLike;
}

const reachNames = optionNames<ReachOptions>({ ...reachOptionsNames, rotation: true });

/** A chain that `Pose.reachChains` moves, and its target. */
export interface ReachRequest extends Omit<BendyReachRequest, 'chain' | 'position' | 'options'> {
  chain: Key<Chain>;
  options?: ChainReachOptions;
  /** x, y, z in metres, model space. */
  position: PointLike;
}

const requestNames = optionNames<ReachRequest>(reachRequestNames);
const nestedNames = optionNames<BendyReachOptions>(reachOptionsNames);

/** The result of `Pose.reach`. */
export interface ReachResult extends BendyReachResult {
  /** Whether the tip is at the target, within the tolerance, or points at it. */
  readonly reached: boolean;
}

function withReached(result: BendyReachResult): ReachResult {
  return { ...result, reached: result.status === 'reached' || result.status === 'aimed' };
}

/** Options of `Pose.skin`. */
export interface SkinOptions extends Omit<BendySkinOptions, 'mesh'> {
  /** One mesh; all if not given. */
  mesh?: Key<Mesh>;
  /** Whether to compute normals. */
  normals?: boolean;
  /** Whether to compute tangents. */
  tangents?: boolean;
  /** Computes only the vertices in use at that level; the others keep their values. */
  lod?: LevelOfDetail;
}

const skinNames = optionNames<SkinOptions>({ ...skinOptionsNames, normals: true, tangents: true });

/** Options of `Pose.socket`. */
export interface SocketOptions extends Omit<BendySocket, 'joint'> {
  /** 16 floats: from model space to world space; the identity if not given. */
  world?: ArrayLike<number>;
}

const { joint: _, ...socketOptions } = socketNames;
const namesOfSocket = optionNames<SocketOptions>({ ...socketOptions, world: true });

/** Parts of a joint's local transform. */
export interface TransformParts {
  /** Unit quaternion. */
  rotation?: RotationLike | undefined;
  /** Metres. */
  translation?: PointLike | undefined;
  scale?: PointLike | undefined;
}

const transformNames = optionNames<TransformParts>({ rotation: true, translation: true, scale: true });
const transformAdvice = { position: 'translation', quaternion: 'rotation' };

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

  /** x y z per vertex, unit length; zero if the file has none. Throws BAD_ARGUMENT if they have never been requested. */
  get normals(): Float32Array<ArrayBuffer> {
    return (this.#normals = this.#part(this.#buffers.wanted('normals'), this.#normals, 3));
  }

  /** x y z per vertex, unit length, and w, the handedness. Throws BAD_ARGUMENT if they have never been requested. */
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
export class Pose extends MadePose {
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
    const { calls, functions } = model.runtime;
    super(model, from === undefined ? calls.bendy_pose_new(model) : calls.bendy_pose_copy(from), functions.bendy_pose_free);
    const joints = model.joints.length;
    this.#locals = this.ownFloats(localFloats * joints);
    this.#matrices = this.ownFloats(16 * joints);
    this.#weights = this.ownFloats(model.morphTargets.length);
    this.#mask = this.ownFloats(joints);
    this.#palettes = model.meshes.map((mesh) => this.ownFloats(16 * mesh.boneCount));
  }

  /** Returns a new pose that is equal to this one. Throws OUT_OF_MEMORY. */
  copy(): Pose {
    return new Pose(this.model, this);
  }

  /** As `sample`, for a clip of the model that a binding animates with. Throws NOT_FOUND, BAD_ARGUMENT. */
  sampleBound(binding: Binding, clip: Key<Clip>, seconds: number): this {
    this.model.checkOwn({ model: binding.posed }, 'binding');
    const number = binding.animated.clips.number(clip);
    this.runtime.calls.bendy_sample_bound(this, binding, number, seconds);
    return this;
  }

  /** The address of a mask copied into the module's memory; 0 for none. */
  #maskAt(mask: ArrayLike<number> | undefined): number {
    if (mask === undefined) return 0;
    const count = this.model.joints.length;
    if (mask.length !== count) throw new BendyError('bad_argument', `the mask has ${mask.length} numbers for ${count} joints`);
    this.#mask.array.set(checkNumbers(mask, 'mask'));
    return this.#mask.at;
  }

  /**
   * Blends the pose towards another pose of the same model: weight 0 leaves it unchanged, 1 makes it equal to `other`; any finite
   * weight is allowed. `mask` scales the weight, one number per joint. Throws BAD_ARGUMENT.
   */
  blend(other: Pose, weight: number, mask?: ArrayLike<number>): this {
    this.runtime.calls.bendy_blend(this, other, weight, this.#maskAt(mask));
    return this;
  }

  /** Adds a difference that `makeAdditive` made, scaled by a weight and per joint by `mask`. Throws BAD_ARGUMENT. */
  add(difference: Pose, weight = 1, mask?: ArrayLike<number>): this {
    this.runtime.calls.bendy_add(this, difference, weight, this.#maskAt(mask));
    return this;
  }

  /** Returns the local transform of a joint: a fresh copy. Throws NOT_FOUND, BAD_ARGUMENT. */
  local(joint: Key<Joint>): Transform {
    const { calls, spare } = this.runtime;
    calls.bendy_get_local(this, this.model.joints.number(joint), 1, spare);
    return readBendyTransform(this.runtime, spare);
  }

  /** Sets parts of a joint's local transform. Throws NOT_FOUND; BAD_ARGUMENT for a rotation that is not a unit quaternion. */
  setLocal(joint: Key<Joint>, transform: TransformParts): this {
    checkOptions('setLocal', transform, transformNames, transformAdvice);
    const { runtime } = this;
    const { calls, spare } = runtime;
    const number = this.model.joints.number(joint);
    calls.bendy_get_local(this, number, 1, spare);
    if (transform.rotation) runtime.putFloats(spare, transform.rotation, 4, 'rotation');
    if (transform.translation) runtime.putFloats(spare + transformLayout.translation, transform.translation, 3, 'translation');
    if (transform.scale) runtime.putFloats(spare + transformLayout.scale, transform.scale, 3, 'scale');
    calls.bendy_set_local(this, number, 1, spare);
    return this;
  }

  /**
   * The local transforms of all joints, ten floats each: rotation x y z w, translation x y z in metres, scale x y z. A view of the
   * module's memory: to change the pose, write into it and call `setLocals`.
   */
  get locals(): Float32Array<ArrayBuffer> {
    const count = this.model.joints.length;
    this.runtime.calls.bendy_get_local(this, 0, count, this.#locals.at);
    return this.#locals.array;
  }

  /** Sets the local transforms of all joints, laid out as in `locals`. Throws BAD_ARGUMENT. */
  setLocals(locals: ArrayLike<number>): this {
    const count = this.model.joints.length;
    const { array } = this.#locals;
    if (locals.length !== array.length) {
      throw new BendyError('bad_argument', `${locals.length} numbers for ${count} joints: ${array.length} are needed`);
    }
    if (locals !== array) array.set(checkNumbers(locals, 'locals'));
    this.runtime.calls.bendy_set_local(this, 0, count, this.#locals.at);
    return this;
  }

  /** The weights of all morph targets, a view of the module's memory; `setMorphWeights` changes them. Usually 0 to 1. */
  get morphWeights(): Float32Array<ArrayBuffer> {
    const count = this.model.morphTargets.length;
    this.runtime.calls.bendy_get_weights(this, 0, count, this.#weights.at);
    return this.#weights.array;
  }

  /** Sets the weights of morph targets, from target `first` on. Throws BAD_ARGUMENT for too many, or one that is not finite. */
  setMorphWeights(weights: ArrayLike<number>, first = 0): this {
    const all = this.model.morphTargets.length;
    if (!Number.isInteger(first) || first < 0 || first + weights.length > all) {
      throw new BendyError('bad_argument', `there are ${all} morph targets`);
    }
    this.#weights.array.set(checkNumbers(weights, 'weights'), first);
    this.runtime.calls.bendy_set_weights(this, first, weights.length, this.#weights.at + 4 * first);
    return this;
  }

  /**
   * Inverse kinematics: moves an IK chain so that its tip reaches a position (x, y, z in metres, model space, as an array or an object) within its joints'
   * constraints, starting from the current pose. A target that is not reached is a result, not an error. Throws NOT_FOUND,
   * BAD_ARGUMENT.
   */
  reach(chain: Key<Chain>, target: PointLike, options: ReachOptions = {}): ReachResult {
    checkOptions('reach', options, reachNames);
    const number = this.model.chains.number(chain);
    return withReached(this.runtime.calls.bendy_reach(this, number, target, options.rotation, options));
  }

  /**
   * As `reach` for one request after another, with the same pose as the result; faster, since limbs of two bones that do not move one
   * another, such as arms and legs, are solved side by side. Returns a result for each request. If one of them has a bad argument,
   * nothing is moved. Throws NOT_FOUND, BAD_ARGUMENT.
   */
  reachChains(requests: readonly ReachRequest[]): ReachResult[] {
    const numbered = requests.map((request) => {
      checkOptions('a request', request, requestNames);
      if (request.options) checkOptions('reachChains', request.options, nestedNames);
      return { ...request, chain: this.model.chains.number(request.chain) };
    });
    return this.runtime.calls.bendy_reach_chains(this, numbered).map(withReached);
  }

  /**
   * Full-body IK: moves the joints between the body's root and its effectors so that each effector is at its target, or as near to it
   * as all targets, weighted, allow; within the joints' constraints and starting from the current pose. IK chains play no part.
   * `targets` has one for each effector. A target that is not reached is a result, not an error. Throws BAD_ARGUMENT; the pose is then
   * as before.
   */
  reachBody(body: BodyReach, targets: readonly EffectorTarget[]): BodyReached {
    for (const target of targets) checkOptions('a target', target, targetNames);
    const { isReached: reached, ...result } = this.runtime.calls.bendy_reach_body(this, body, targets);
    return { ...result, reached };
  }

  /** Computes 16 floats per joint, column by column: from joint space to model space or, if `world` (16 floats) is given, to it. */
  modelMatrices(world?: ArrayLike<number>): Float32Array<ArrayBuffer> {
    this.runtime.calls.bendy_joint_matrices(this, 0, this.model.joints.length, world, this.#matrices.at);
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
  skin(options: SkinOptions = {}): SkinnedVertices {
    checkOptions('skin', options, skinNames);
    const { runtime, model } = this;
    const { normals, tangents, mesh: key, ...others } = options;
    const vertexCount = model.vertexCount;
    this.#positions ??= this.ownFloats(3 * vertexCount);
    if (normals) this.#normals ??= this.ownFloats(3 * vertexCount);
    if (tangents) this.#tangents ??= this.ownFloats(4 * vertexCount);
    const mesh = key === undefined ? undefined : model.meshes.get(key);
    const first = mesh?.firstVertex ?? 0;
    const count = mesh?.vertexCount ?? vertexCount;
    const out = runtime.struct(verticesLayout, runtime.spare);
    const { view } = runtime;
    view.setUint32(out + verticesLayout.capacity, count, true);
    view.setUint32(out + verticesLayout.positions, this.#positions.at + 12 * first, true);
    if (normals) view.setUint32(out + verticesLayout.normals, this.#normals!.at + 12 * first, true);
    if (tangents) view.setUint32(out + verticesLayout.tangents, this.#tangents!.at + 16 * first, true);
    runtime.calls.bendy_skin(this, { ...others, mesh: mesh?.number }, out);
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
    checkOptions('socket', options, namesOfSocket);
    const { world, ...socket } = options;
    const number = joint === null ? null : this.model.joints.number(joint);
    return this.runtime.calls.bendy_socket_matrix(this, { ...socket, joint: number }, world);
  }
}
