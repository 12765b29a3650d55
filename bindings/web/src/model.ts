import { asBytes } from './bytes.js';
import { Clip } from './clip.js';
import { BendyError } from './errors.js';
import { fetchBytes } from './fetch.js';
import type { BendyOpenOptions } from './generated/bindings.js';
import { checkIndex, indexOwn, Items, type Key } from './items.js';
import { init, loadedRuntime } from './load.js';
import { Mesh, type MorphTarget } from './mesh.js';
import type { RotationLike } from './numbers.js';
import { checkOptions, optionNames } from './options.js';
import {
  type Chain,
  type Constraint,
  type Joint,
  type JointSubmesh,
  type Material,
  type Quaternion,
  readChain,
  readTexture,
  type Submesh,
  type Texture,
} from './parts.js';
import { Pose } from './pose.js';
import { Handle, type Runtime } from './runtime.js';

/** Options for opening a model. */
export interface OpenOptions extends Omit<BendyOpenOptions, 'sumsLater' | 'copied'> {
  /** False: the bytes are not checked against their integrity sums until `checkSums`. True if not given. */
  checkSums?: boolean;
  /** The instance of the module to open it in; the default one if not given. */
  runtime?: Runtime;
}

/** @internal */
export const openNames = optionNames<OpenOptions>({ object: true, checkSums: true, runtime: true });

/** An opened file in the module's memory, with its bytes: closed and released with the last object that uses it. */
class OpenFile {
  /** The address of the opened file. */
  readonly handle: number;
  readonly #runtime: Runtime;
  readonly #bytes: number;
  #users = 0;

  constructor(runtime: Runtime, bytes: Uint8Array, { object, checkSums }: OpenOptions) {
    this.#runtime = runtime;
    this.#bytes = runtime.allocate(bytes.length);
    runtime.bytes.set(bytes, this.#bytes);
    try {
      this.handle = runtime.calls.bendy_open_borrowed(this.#bytes, bytes.length, { object, sumsLater: checkSums === false });
    } catch (failure) {
      runtime.release(this.#bytes);
      throw failure;
    }
  }

  use(): this {
    ++this.#users;
    return this;
  }

  release(): void {
    if (--this.#users > 0) return;
    this.#runtime.functions.bendy_close(this.handle);
    this.#runtime.release(this.#bytes);
  }
}

/** The error for a file of another kind, which says what to do with it. */
function withAdvice({ kind, message, code, path, offset }: BendyError, content: Uint8Array): BendyError {
  const isPage = /^\s*<(!doctype html|html)/i.test(new TextDecoder().decode(content.subarray(0, 200)));
  const advice = isPage ? 'it is a web page: is the address right?' : 'convert() of bendy/tools makes one from glTF and other files';
  return new BendyError(kind, `${message}; ${advice}`, code, path, offset);
}

/** A character: an opened and checked file. Immutable. Lists and arrays that have been read stay usable after it has been disposed. */
export class Model extends Handle {
  readonly #file: OpenFile;
  #joints: Items<Joint> | undefined;
  #parents: Int32Array<ArrayBuffer> | undefined;
  #meshes: Items<Mesh> | undefined;
  #clips: Items<Clip> | undefined;
  #chains: Items<Chain> | undefined;
  #materials: Items<Material> | undefined;
  #textures: Items<Texture> | undefined;
  #constraints: readonly Constraint[] | undefined;
  #submeshes: readonly Submesh[] | undefined;
  #jointSubmeshes: readonly JointSubmesh[] | undefined;
  #morphTargets: Items<MorphTarget> | undefined;
  #vertexCount: number | undefined;

  private constructor(runtime: Runtime, file: OpenFile) {
    super(runtime, file?.handle, () => file.release());
    this.#file = file;
  }

  /**
   * Opens a bendy file, given as its bytes or as an address to fetch, loading the module if `init` has not. The bytes are copied
   * into the module's memory. Rejects with a BendyError: MALFORMED, INVALID or UNSUPPORTED kinds with code, path and offset; IO if
   * file or module cannot be fetched; OUT_OF_MEMORY; BAD_ARGUMENT for anything else.
   */
  static async open(source: ArrayBuffer | Uint8Array | string | URL, options: OpenOptions = {}): Promise<Model> {
    checkOptions('Model.open', options, openNames);
    const isAddress = typeof source === 'string' || source instanceof URL;
    const [bytes, runtime] = await Promise.all([isAddress ? fetchBytes(source) : source, options.runtime ?? init()]);
    return Model.openSync(bytes, { ...options, runtime });
  }

  /** As `open`, synchronously. Throws the same errors, and BAD_ARGUMENT before `init` is done. */
  static openSync(bytes: ArrayBuffer | Uint8Array, options: OpenOptions = {}): Model {
    checkOptions('Model.openSync', options, openNames);
    const runtime = options.runtime ?? loadedRuntime();
    const content = asBytes(bytes);
    try {
      return new Model(runtime, new OpenFile(runtime, content, options).use());
    } catch (failure) {
      throw failure instanceof BendyError && failure.code === 'NOT_A_BENDY_FILE' ? withAdvice(failure, content) : failure;
    }
  }

  /** @internal Keeps the file's bytes and the lists alive for an object that uses the model; the result releases them. */
  useFile(): () => void {
    void [this.joints, this.parents, this.meshes, this.clips, this.chains, this.morphTargets, this.vertexCount];
    const file = this.#file.use();
    return () => file.release();
  }

  /** @internal The same file as a model of its own, which stays readable when this one has been disposed. */
  share(): Model {
    return new Model(this.runtime, this.#file.use());
  }

  /** Checks all bytes against their integrity sums. Throws for the first wrong chunk: SUM_MISMATCH with path and offset. */
  checkSums(): void {
    this.runtime.calls.bendy_check_sums(this);
  }

  /** The name of the object; "" if it has none. */
  get name(): string {
    return this.runtime.calls.bendy_model_name(this);
  }

  /** Application-specific data of the object: JSON, parsed; null if there is none. */
  get extras(): unknown {
    return this.runtime.calls.bendy_model_extras(this);
  }

  /** Application-specific data of the whole file: JSON, parsed; null if there is none. */
  get fileExtras(): unknown {
    return this.runtime.calls.bendy_file_extras(this);
  }

  /** The joints. A parent comes before its children. */
  get joints(): Items<Joint> {
    const { calls } = this.runtime;
    return (this.#joints ??= Items.make('joint', calls.bendy_joint_count(this), (number) => ({
      ...calls.bendy_get_joint(this, number),
      number,
    })));
  }

  /** For each joint its parent, or -1 for a root. */
  get parents(): Int32Array<ArrayBuffer> {
    const { runtime } = this;
    return (this.#parents ??= runtime.copyIndices(runtime.calls.bendy_joint_parents(this), this.joints.length));
  }

  get meshes(): Items<Mesh> {
    const { calls } = this.runtime;
    return (this.#meshes ??= Items.make('mesh', calls.bendy_mesh_count(this), (number) => new Mesh(this, number)));
  }

  get clips(): Items<Clip> {
    const { calls } = this.runtime;
    return (this.#clips ??= Items.make('clip', calls.bendy_clip_count(this), (number) => new Clip(this, number)));
  }

  /** The IK chains. */
  get chains(): Items<Chain> {
    const { calls } = this.runtime;
    return (this.#chains ??= Items.make('chain', calls.bendy_chain_count(this), (number) => readChain(this, number)));
  }

  /** The numbers of the chains in the order in which `Pose.reachAll` solves them. */
  get chainOrder(): Int32Array<ArrayBuffer> {
    return this.runtime.copyIndices(this.runtime.calls.bendy_chain_order(this), this.chains.length);
  }

  get materials(): Items<Material> {
    const { calls } = this.runtime;
    return (this.#materials ??= Items.make('material', calls.bendy_material_count(this), (number) => ({
      ...calls.bendy_get_material(this, number),
      number,
    })));
  }

  /** The textures, with copies of their images. */
  get textures(): Items<Texture> {
    const { calls } = this.runtime;
    return (this.#textures ??= Items.make('texture', calls.bendy_texture_count(this), (number) => readTexture(this, number)));
  }

  /** The constraints, ordered by joint. */
  get constraints(): readonly Constraint[] {
    const { calls } = this.runtime;
    return (this.#constraints ??= Array.from({ length: calls.bendy_constraint_count(this) }, (_, number) => ({
      ...calls.bendy_get_constraint(this, number),
      number,
    })));
  }

  /** The draw calls of all meshes. */
  get submeshes(): readonly Submesh[] {
    const { calls } = this.runtime;
    return (this.#submeshes ??= Array.from({ length: calls.bendy_submesh_count(this) }, (_, number) => ({
      ...calls.bendy_get_submesh(this, number),
      number,
    })));
  }

  /** The ranges of the meshes' index lists that belong to one joint: for hit tests, severed limbs, culling. */
  get jointSubmeshes(): readonly JointSubmesh[] {
    const { calls } = this.runtime;
    return (this.#jointSubmeshes ??= Array.from({ length: calls.bendy_joint_submesh_count(this) }, (_, number) => ({
      ...calls.bendy_get_joint_submesh(this, number),
      number,
    })));
  }

  /** The morph targets of all meshes, mesh after mesh. */
  get morphTargets(): Items<MorphTarget> {
    if (this.#morphTargets === undefined) {
      const all = this.meshes.flatMap((mesh) => [...mesh.morphTargets]);
      this.#morphTargets = Items.make('morph target', this.runtime.calls.bendy_morph_target_count(this), (number) => all[number]!);
    }
    return this.#morphTargets;
  }

  /** The number of vertices of all meshes together. */
  get vertexCount(): number {
    return (this.#vertexCount ??= this.runtime.calls.bendy_vertex_count(this));
  }

  /** Whether the file has levels of detail: see `LevelOfDetail`. */
  get hasLevels(): boolean {
    return this.runtime.calls.bendy_has_levels(this) !== 0;
  }

  /** Returns a new pose, at rest. Throws OUT_OF_MEMORY, DISPOSED. */
  pose(): Pose {
    return new Pose(this);
  }

  /** Returns a new pose of a clip at a time: see `Pose.sample`. */
  sample(clip: Key<Clip>, seconds: number): Pose {
    return new Pose(this).sample(clip, seconds);
  }

  /**
   * Returns a mask for `Pose.blend` and `Pose.add`, one number per joint: `inside` for a joint and its descendants, `outside` for
   * all others. Throws NOT_FOUND, BAD_ARGUMENT.
   */
  maskBelow(joint: Key<Joint>, inside = 1, outside = 0): Float32Array<ArrayBuffer> {
    const number = this.joints.number(joint);
    return this.runtime.calls.bendy_mask_below(this, number, inside, outside, this.joints.length);
  }

  /**
   * Returns the legal rotation nearest to a local rotation of a constraint's joint, and the angle between the two in radians: 0 if
   * the rotation is legal. Throws BAD_ARGUMENT for a constraint of another model, and for a rotation that is not a unit quaternion.
   */
  clampRotation(constraint: Constraint | number, rotation: RotationLike): { rotation: Quaternion; violation: number } {
    const { calls } = this.runtime;
    const number = this.#constraintNumber(constraint);
    const relative = calls.bendy_to_constraint_space(this, number, rotation);
    const { clamped, violation } = calls.bendy_clamp_rotation(this, number, relative);
    const legal = calls.bendy_from_constraint_space(this, number, clamped);
    return { rotation: Array.from(legal) as Quaternion, violation };
  }

  #constraintNumber(constraint: Constraint | number): number {
    const { constraints } = this;
    return typeof constraint === 'number'
      ? checkIndex(constraint, constraints.length, 'constraint')
      : indexOwn(constraints, constraint, 'constraint');
  }

  /** Returns the constraint of a joint in poses or, if `inReach`, in IK solvers; null if it has none. Throws NOT_FOUND. */
  constraintOf(joint: Key<Joint>, inReach = false): Constraint | null {
    const { calls } = this.runtime;
    const number = this.joints.number(joint);
    const found = inReach ? calls.bendy_joint_ik_constraint(this, number) : calls.bendy_joint_constraint(this, number);
    return found === null ? null : this.constraints[found]!;
  }

  /** @internal Throws unless the object was made from this model. */
  checkOwn(made: { readonly model: Model }, kind: string): void {
    if (made.model !== this) throw new BendyError('bad_argument', `the ${kind} belongs to another model`);
  }
}
