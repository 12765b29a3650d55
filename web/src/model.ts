import { asBytes } from './bytes.js';
import { Clip } from './clip.js';
import { BendyError } from './errors.js';
import { openOptionsLayout } from './generated/bindings.js';
import { checkIndex, indexOwn, Items, type Key } from './items.js';
import { init, loadedRuntime } from './load.js';
import { Mesh, type MorphTarget } from './mesh.js';
import {
  type Chain,
  type Constraint,
  type Joint,
  type Material,
  parseJson,
  type Quaternion,
  readChain,
  readConstraint,
  readJoint,
  readMaterial,
  readSubmesh,
  readTexture,
  type Submesh,
  type Texture,
} from './parts.js';
import { Pose } from './pose.js';
import { Handle, none, type Runtime } from './runtime.js';

/** How a model is opened. */
export interface OpenOptions {
  /** Which object of the file; 0 if not given. */
  object?: number;
  /** False: the bytes are not checked against their integrity sums before `checkSums`. True if not given. */
  checkSums?: boolean;
  /** The instance of the module to open it in; the default one if not given. */
  runtime?: Runtime;
}

/** The bytes of a file in the module's memory: released with the last object that uses them. */
class FileBytes {
  readonly at: number;
  readonly #runtime: Runtime;
  #users = 1;

  constructor(runtime: Runtime, bytes: Uint8Array) {
    this.#runtime = runtime;
    this.at = runtime.allocate(bytes.length);
    runtime.bytes.set(bytes, this.at);
  }

  use(): void {
    ++this.#users;
  }

  release(): void {
    if (--this.#users === 0) this.#runtime.release(this.at);
  }
}

/** A character: an opened and checked file. Immutable. Lists and arrays that have been read stay usable after it has been disposed. */
export class Model extends Handle {
  readonly #file: FileBytes;
  #joints: Items<Joint> | undefined;
  #parents: Int32Array<ArrayBuffer> | undefined;
  #meshes: Items<Mesh> | undefined;
  #clips: Items<Clip> | undefined;
  #chains: Items<Chain> | undefined;
  #materials: Items<Material> | undefined;
  #textures: Items<Texture> | undefined;
  #constraints: readonly Constraint[] | undefined;
  #submeshes: readonly Submesh[] | undefined;
  #morphTargets: Items<MorphTarget> | undefined;
  #vertexCount: number | undefined;

  private constructor(runtime: Runtime, handle: number, file: FileBytes) {
    super(runtime, handle, () => {
      runtime.functions.bendy_close(handle);
      file.release();
    });
    this.#file = file;
  }

  /**
   * Opens a bendy file, loading the module if `init` has not. The bytes are copied into the module's memory. Rejects with a
   * BendyError: MALFORMED, INVALID or UNSUPPORTED kinds with code, path and offset; OUT_OF_MEMORY; BAD_ARGUMENT for what is no bytes,
   * such as an address.
   */
  static async open(bytes: ArrayBuffer | Uint8Array, options: OpenOptions = {}): Promise<Model> {
    return Model.openSync(bytes, { ...options, runtime: options.runtime ?? (await init()) });
  }

  /** As `open`, at once. Throws the same, and BAD_ARGUMENT before `init` is done. */
  static openSync(bytes: ArrayBuffer | Uint8Array, options: OpenOptions = {}): Model {
    const runtime = options.runtime ?? loadedRuntime();
    const { functions, error } = runtime;
    const content = asBytes(bytes);
    const file = new FileBytes(runtime, content);
    try {
      const at = runtime.struct(openOptionsLayout);
      runtime.view.setUint32(at + openOptionsLayout.object, checkIndex(options.object ?? 0, none, 'object'), true);
      runtime.view.setUint32(at + openOptionsLayout.sumsLater, options.checkSums === false ? 1 : 0, true);
      return new Model(runtime, runtime.checkHandle(functions.bendy_open_borrowed(file.at, content.byteLength, at, error)), file);
    } catch (failure) {
      file.release();
      throw failure;
    }
  }

  /** @internal Keeps the file's bytes, and the lists, for an object that uses the model; the result gives the bytes back. */
  useFile(): () => void {
    const file = this.#file;
    void [this.joints, this.meshes, this.clips, this.chains, this.morphTargets, this.vertexCount];
    file.use();
    return () => file.release();
  }

  /** Checks all bytes against their integrity sums. Throws the first chunk that differs: SUM_MISMATCH with path and offset. */
  checkSums(): void {
    this.runtime.check(this.runtime.functions.bendy_check_sums(this.handle, this.runtime.error));
  }

  /** The name of the object; "" if it has none. */
  get name(): string {
    return this.runtime.text(this.runtime.functions.bendy_model_name(this.handle));
  }

  /** Application-specific data of the object: JSON, parsed; null if there is none. */
  get extras(): unknown {
    return parseJson(this.runtime.text(this.runtime.functions.bendy_model_extras(this.handle)));
  }

  /** Application-specific data of the whole file: JSON, parsed; null if there is none. */
  get fileExtras(): unknown {
    return parseJson(this.runtime.text(this.runtime.functions.bendy_file_extras(this.handle)));
  }

  /** The joints. A parent comes before its children. */
  get joints(): Items<Joint> {
    return (this.#joints ??= Items.make('joint', this.runtime.functions.bendy_joint_count(this.handle), (number) =>
      readJoint(this.runtime, this.handle, number),
    ));
  }

  /** For each joint its parent, or -1 for a root. */
  get parents(): Int32Array<ArrayBuffer> {
    return (this.#parents ??= Int32Array.from(this.joints, (joint) => joint.parent ?? -1));
  }

  get meshes(): Items<Mesh> {
    return (this.#meshes ??= Items.make(
      'mesh',
      this.runtime.functions.bendy_mesh_count(this.handle),
      (number) => new Mesh(this, number),
    ));
  }

  get clips(): Items<Clip> {
    return (this.#clips ??= Items.make(
      'clip',
      this.runtime.functions.bendy_clip_count(this.handle),
      (number) => new Clip(this, number),
    ));
  }

  /** The IK chains. */
  get chains(): Items<Chain> {
    return (this.#chains ??= Items.make('chain', this.runtime.functions.bendy_chain_count(this.handle), (number) =>
      readChain(this.runtime, this.handle, number),
    ));
  }

  get materials(): Items<Material> {
    return (this.#materials ??= Items.make('material', this.runtime.functions.bendy_material_count(this.handle), (number) =>
      readMaterial(this.runtime, this.handle, number),
    ));
  }

  /** The textures, with copies of their images. */
  get textures(): Items<Texture> {
    return (this.#textures ??= Items.make('texture', this.runtime.functions.bendy_texture_count(this.handle), (number) =>
      readTexture(this.runtime, this.handle, number),
    ));
  }

  /** The constraints, ordered by joint. */
  get constraints(): readonly Constraint[] {
    const count = this.runtime.functions.bendy_constraint_count(this.handle);
    return (this.#constraints ??= Array.from({ length: count }, (_, number) => readConstraint(this.runtime, this.handle, number)));
  }

  /** The draw calls of all meshes. */
  get submeshes(): readonly Submesh[] {
    const count = this.runtime.functions.bendy_submesh_count(this.handle);
    return (this.#submeshes ??= Array.from({ length: count }, (_, number) => readSubmesh(this.runtime, this.handle, number)));
  }

  /** The morph targets of all meshes, mesh after mesh. */
  get morphTargets(): Items<MorphTarget> {
    if (this.#morphTargets === undefined) {
      const all = this.meshes.flatMap((mesh) => [...mesh.morphTargets]);
      this.#morphTargets = Items.make('morph target', all.length, (number) => all[number]!);
    }
    return this.#morphTargets;
  }

  /** The number of vertices of all meshes together. */
  get vertexCount(): number {
    return (this.#vertexCount ??= Number(this.runtime.functions.bendy_vertex_count(this.handle)));
  }

  /** Whether the file has levels of detail: see `LevelOfDetail`. */
  get hasLevels(): boolean {
    return this.runtime.functions.bendy_has_levels(this.handle) !== 0;
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
    const { runtime, handle } = this;
    const count = this.joints.length;
    const number = this.joints.number(joint);
    return runtime.fetchFloats(count, (at) =>
      runtime.functions.bendy_mask_below(handle, number, inside, outside, at, count, runtime.error),
    );
  }

  /**
   * Returns the legal rotation nearest to a local rotation of a constraint's joint, and the angle between the two in radians: 0 if
   * the rotation is legal. Throws BAD_ARGUMENT for a constraint of another model, and for a rotation that is not a unit quaternion.
   */
  clampRotation(constraint: Constraint | number, rotation: ArrayLike<number>): { rotation: Quaternion; violation: number } {
    const { runtime, handle } = this;
    const { functions, error, scratch } = runtime;
    const { constraints } = this;
    const number =
      typeof constraint === 'number'
        ? checkIndex(constraint, constraints.length, 'constraint')
        : indexOwn(constraints, constraint, 'constraint');
    runtime.putFloats(scratch, rotation, 4, 'rotation');
    const relative = scratch + 32;
    const violation = scratch + 64;
    runtime.check(functions.bendy_to_constraint_space(handle, number, scratch, relative, error));
    runtime.check(functions.bendy_clamp_rotation(handle, number, relative, relative, violation, error));
    runtime.check(functions.bendy_from_constraint_space(handle, number, relative, scratch, error));
    return {
      rotation: Array.from(runtime.copyFloats(scratch, 4)) as Quaternion,
      violation: runtime.view.getFloat64(violation, true),
    };
  }

  /** @internal Throws unless both are in the same memory. */
  checkSameRuntime(other: Handle): void {
    if (other.runtime !== this.runtime) throw new BendyError('bad_argument', 'the objects belong to different runtimes');
  }

  /** @internal Throws unless something was made from this model. */
  checkOwn(made: { readonly model: Model }, kind: string): void {
    if (made.model !== this) throw new BendyError('bad_argument', `the ${kind} belongs to another model`);
  }
}
