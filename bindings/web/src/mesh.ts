import type { BendyMesh, BendyMorphTarget, BendyStream, StreamKind } from './generated/bindings.js';
import { Items, type Item } from './items.js';
import type { Model } from './model.js';

/** How a file stores the numbers of a stream. */
export type StoredArray = Uint8Array | Int8Array | Uint16Array | Int16Array | Uint32Array | Float32Array;

const arrayOf = { u8: Uint8Array, i8: Int8Array, u16: Uint16Array, i16: Int16Array, u32: Uint32Array, f32: Float32Array };

export interface Stream extends Omit<BendyStream, 'data' | 'dataSize'> {}

/** One attribute of a mesh's vertices, or its index list. */
export class Stream {
  readonly #model: Model;
  readonly #mesh: number;
  readonly #number: number;

  /** @internal */
  constructor(model: Model, mesh: number, number: number) {
    const { data: _, dataSize: __, ...fields } = model.runtime.calls.bendy_get_stream(model, mesh, number);
    Object.assign(this, fields);
    this.#model = model;
    this.#mesh = mesh;
    this.#number = number;
  }

  /** Returns a fresh copy of the numbers, decoded: elements * components. Throws OUT_OF_MEMORY, DISPOSED. */
  numbers(): Float32Array<ArrayBuffer> {
    const { calls } = this.#model.runtime;
    return calls.bendy_get_numbers(this.#model, this.#mesh, this.#number, this.elements * this.components);
  }

  /** Returns a fresh copy of bones, indices or an unsigned attribute. Throws BAD_ARGUMENT for other streams, OUT_OF_MEMORY. */
  integers(): Uint32Array<ArrayBuffer> {
    const { calls } = this.#model.runtime;
    return calls.bendy_get_integers(this.#model, this.#mesh, this.#number, this.elements * this.components);
  }

  /**
   * Returns a fresh copy of the numbers as the file stores them, as a graphics API takes them; null if the file has another
   * encoding. Throws DISPOSED.
   */
  stored(): StoredArray | null {
    const { runtime } = this.#model;
    const { data, dataSize } = runtime.calls.bendy_get_stream(this.#model, this.#mesh, this.#number);
    if (data === 0) return null;
    return new arrayOf[this.type](runtime.bytes.slice(data, data + dataSize).buffer);
  }
}

export interface MorphTarget extends Omit<BendyMorphTarget, 'vertices'> {}

/** A morph target: displacements of some of a mesh's vertices. */
export class MorphTarget implements Item {
  /** Its place among the targets of all meshes, as in `Pose.morphWeights`. */
  readonly number: number;
  /** The number of vertices that it displaces. */
  readonly vertexCount: number;
  readonly #model: Model;

  /** @internal */
  constructor(model: Model, number: number) {
    const { vertices, ...fields } = model.runtime.calls.bendy_get_morph_target(model, number);
    Object.assign(this, fields);
    this.number = number;
    this.vertexCount = vertices;
    this.#model = model;
  }

  /**
   * Returns what the target adds at weight 1, as fresh copies: the index of each displaced vertex, ascending, and for each of them
   * x y z of the position in metres, of the normal and of the tangent, zero where the target has none. Throws OUT_OF_MEMORY.
   */
  displacements(): {
    vertices: Uint32Array<ArrayBuffer>;
    positions: Float32Array<ArrayBuffer>;
    normals: Float32Array<ArrayBuffer>;
    tangents: Float32Array<ArrayBuffer>;
  } {
    return this.#model.runtime.calls.bendy_get_displacements(this.#model, this.number, this.vertexCount);
  }
}

/** The members of the struct that a mesh has under another name, or as arrays. */
type Renamed = 'vertices' | 'indices' | 'bones' | 'influences' | 'targets' | 'firstMorphTarget' | 'textureCoordSets';

export interface Mesh extends Omit<BendyMesh, Renamed> {}

/**
 * A mesh. Its arrays are copies that are made at the first access and stay valid, also after the model has been disposed. They
 * hold floats whatever the encoding in the file; `streams` has that.
 */
export class Mesh implements Item {
  readonly number: number;
  /** The number of vertices. */
  readonly vertexCount: number;
  /** The number of indices. */
  readonly indexCount: number;
  /** Whether it has no bones: each vertex is moved by one joint. */
  readonly isRigid: boolean;
  /** The number of matrices that `Pose.palette` computes; 0 if it is rigid. */
  readonly boneCount: number;
  /** The number of bones per vertex; 0 if it is rigid. */
  readonly influenceCount: number;
  /** Its morph targets. */
  readonly morphTargets: Items<MorphTarget>;
  /** Its attributes and its index list as stored in the file. */
  readonly streams: readonly Stream[];
  readonly #model: Model;
  readonly #textureCoordSets: number;
  #positions: Float32Array<ArrayBuffer> | undefined;
  #normals: Float32Array<ArrayBuffer> | undefined;
  #tangents: Float32Array<ArrayBuffer> | undefined;
  #textureCoords: Float32Array<ArrayBuffer>[] | undefined;
  #colours: Float32Array<ArrayBuffer>[] | undefined;
  #indices: Uint32Array<ArrayBuffer> | undefined;
  #influences: { bones: Uint32Array<ArrayBuffer>; weights: Float32Array<ArrayBuffer> } | undefined;
  #palette: { joints: Uint32Array<ArrayBuffer>; inverseBind: Float32Array<ArrayBuffer> } | undefined;

  /** @internal */
  constructor(model: Model, number: number) {
    const { calls } = model.runtime;
    const { vertices, indices, bones, influences, targets, firstMorphTarget, textureCoordSets, ...fields } =
      calls.bendy_get_mesh(model, number);
    Object.assign(this, fields);
    this.number = number;
    this.vertexCount = vertices;
    this.indexCount = indices;
    this.isRigid = bones === 0;
    this.boneCount = bones;
    this.influenceCount = influences;
    this.morphTargets = Items.make('morph target', targets, (k) => new MorphTarget(model, firstMorphTarget + k));
    const streams = calls.bendy_stream_count(model, number);
    this.streams = Array.from({ length: streams }, (_, stream) => new Stream(model, number, stream));
    this.#model = model;
    this.#textureCoordSets = textureCoordSets;
  }

  #find(kind: StreamKind): Stream | undefined {
    return this.streams.find((stream) => stream.kind === kind);
  }

  /** x y z per vertex at rest, without morph targets: metres, mesh space. */
  get positions(): Float32Array<ArrayBuffer> {
    return (this.#positions ??= this.#find('positions')?.numbers() ?? new Float32Array(0));
  }

  /** x y z per vertex, or null. */
  get normals(): Float32Array<ArrayBuffer> | null {
    return (this.#normals ??= this.#find('normals')?.numbers()) ?? null;
  }

  /** x y z per vertex and w, the handedness, 1 or -1; or null. */
  get tangents(): Float32Array<ArrayBuffer> | null {
    return (this.#tangents ??= this.#find('tangents')?.numbers()) ?? null;
  }

  /** For each set u v per vertex: v = 0 is the top edge of the image. */
  get textureCoords(): readonly Float32Array<ArrayBuffer>[] {
    const { calls } = this.#model.runtime;
    return (this.#textureCoords ??= Array.from({ length: this.#textureCoordSets }, (_, set) =>
      calls.bendy_get_texture_coords(this.#model, this.number, set, 2 * this.vertexCount),
    ));
  }

  /** For each set linear red, green, blue and possibly alpha per vertex: `length / vertexCount` says how many. */
  get colours(): readonly Float32Array<ArrayBuffer>[] {
    return (this.#colours ??= this.streams.filter((stream) => stream.kind === 'colours').map((stream) => stream.numbers()));
  }

  /** The index list: three per triangle, unless a submesh says otherwise. */
  get indices(): Uint32Array<ArrayBuffer> {
    return (this.#indices ??= this.#model.runtime.calls.bendy_get_indices(this.#model, this.number, this.indexCount));
  }

  get #influenced(): { bones: Uint32Array<ArrayBuffer>; weights: Float32Array<ArrayBuffer> } {
    const { calls } = this.#model.runtime;
    const count = this.vertexCount * this.influenceCount;
    return (this.#influences ??= calls.bendy_get_influences(this.#model, this.number, count));
  }

  /** `influenceCount` bones per vertex: indices into the matrices of `Pose.palette`. Throws BAD_ARGUMENT for a rigid mesh. */
  get bones(): Uint32Array<ArrayBuffer> {
    return this.#influenced.bones;
  }

  /** The weights of the bones: those of a vertex sum to 1. Throws BAD_ARGUMENT for a rigid mesh. */
  get weights(): Float32Array<ArrayBuffer> {
    return this.#influenced.weights;
  }

  get #bindPalette(): { joints: Uint32Array<ArrayBuffer>; inverseBind: Float32Array<ArrayBuffer> } {
    const { calls } = this.#model.runtime;
    return (this.#palette ??= calls.bendy_get_bind_palette(this.#model, this.number, this.boneCount));
  }

  /** The joint of each bone. Throws BAD_ARGUMENT for a rigid mesh. */
  get boneJoints(): Uint32Array<ArrayBuffer> {
    return this.#bindPalette.joints;
  }

  /** 16 floats per bone: its inverse bind matrix, from mesh space to joint space. Throws BAD_ARGUMENT for a rigid mesh. */
  get inverseBind(): Float32Array<ArrayBuffer> {
    return this.#bindPalette.inverseBind;
  }

  /** Returns for each vertex the joint that moves it, or 0xffffffff; a fresh copy. Throws BAD_ARGUMENT if it is not rigid. */
  movers(): Uint32Array<ArrayBuffer> {
    return this.#model.runtime.calls.bendy_get_movers(this.#model, this.number, this.vertexCount);
  }
}
