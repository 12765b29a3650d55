import {
  componentTypeWords,
  meshLayout,
  morphTargetLayout,
  readBendyMesh,
  readBendyMorphTarget,
  readBendyStream,
  streamKindWords,
  streamLayout,
} from './generated/bindings.js';
import { Items, type Item } from './items.js';
import type { Model } from './model.js';
import { orNull, parseJson } from './parts.js';

/** What the numbers of a stream are. */
export type StreamKind = (typeof streamKindWords)[number];
/** How a file stores the numbers of a stream. */
export type StoredArray = Uint8Array | Int8Array | Uint16Array | Int16Array | Uint32Array | Float32Array;

const arrayOf = { u8: Uint8Array, i8: Int8Array, u16: Uint16Array, i16: Int16Array, u32: Uint32Array, f32: Float32Array };

/** One attribute of a mesh's vertices, or its index list. */
export class Stream {
  readonly kind: StreamKind;
  /** Of an attribute; otherwise "". */
  readonly name: string;
  /** The set of texture coordinates or colours; otherwise 0. */
  readonly set: number;
  /** The number of vertices, or of indices. */
  readonly elements: number;
  /** Numbers per element. */
  readonly components: number;
  /** Whether integers in `stored` stand for 0 to 1 or, signed, -1 to 1. */
  readonly normalised: boolean;
  readonly #model: Model;
  readonly #mesh: number;
  readonly #number: number;

  /** @internal */
  constructor(model: Model, mesh: number, number: number) {
    const { runtime } = model;
    const out = runtime.struct(streamLayout);
    runtime.check(runtime.functions.bendy_get_stream(model.handle, mesh, number, out, runtime.error));
    const raw = readBendyStream(runtime, out);
    this.kind = streamKindWords[raw.kind]!;
    this.name = raw.name;
    this.set = raw.set;
    this.elements = raw.elements;
    this.components = raw.components;
    this.normalised = raw.normalised !== 0;
    this.#model = model;
    this.#mesh = mesh;
    this.#number = number;
  }

  /** Returns a fresh copy of the numbers, decoded: elements * components. Throws OUT_OF_MEMORY, DISPOSED. */
  numbers(): Float32Array<ArrayBuffer> {
    const { runtime, handle } = this.#model;
    const count = this.elements * this.components;
    return runtime.fetchFloats(count, (at) =>
      runtime.functions.bendy_get_numbers(handle, this.#mesh, this.#number, at, count, runtime.error),
    );
  }

  /** Returns a fresh copy of bones, indices or an unsigned attribute. Throws BAD_ARGUMENT for other streams, OUT_OF_MEMORY. */
  integers(): Uint32Array<ArrayBuffer> {
    const { runtime, handle } = this.#model;
    const count = this.elements * this.components;
    return runtime.fetchIntegers(count, (at) =>
      runtime.functions.bendy_get_integers(handle, this.#mesh, this.#number, at, count, runtime.error),
    );
  }

  /**
   * Returns a fresh copy of the numbers as the file stores them, as a graphics API takes them; null if the file has another
   * encoding. Throws DISPOSED.
   */
  stored(): StoredArray | null {
    const { runtime, handle } = this.#model;
    const out = runtime.struct(streamLayout);
    runtime.check(runtime.functions.bendy_get_stream(handle, this.#mesh, this.#number, out, runtime.error));
    const { data, dataSize, type } = readBendyStream(runtime, out);
    if (data === 0) return null;
    return new arrayOf[componentTypeWords[type]!](runtime.bytes.slice(data, data + dataSize).buffer);
  }
}

/** A morph target: displacements of some of a mesh's vertices. */
export class MorphTarget implements Item {
  readonly name: string;
  /** Its place among the targets of all meshes, as in `Pose.morphWeights`. */
  readonly number: number;
  readonly mesh: number;
  readonly restWeight: number;
  /** The number of vertices that it displaces. */
  readonly vertexCount: number;
  readonly hasPositions: boolean;
  readonly hasNormals: boolean;
  readonly hasTangents: boolean;
  readonly #model: Model;

  /** @internal */
  constructor(model: Model, number: number) {
    const { runtime } = model;
    const out = runtime.struct(morphTargetLayout);
    runtime.check(runtime.functions.bendy_get_morph_target(model.handle, number, out, runtime.error));
    const raw = readBendyMorphTarget(runtime, out);
    this.name = raw.name;
    this.number = number;
    this.mesh = raw.mesh;
    this.restWeight = raw.restWeight;
    this.vertexCount = raw.vertices;
    this.hasPositions = raw.hasPositions !== 0;
    this.hasNormals = raw.hasNormals !== 0;
    this.hasTangents = raw.hasTangents !== 0;
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
    const { runtime, handle } = this.#model;
    const count = this.vertexCount;
    return runtime.borrow(40 * count, (vertices) => {
      const positions = vertices + 4 * count;
      const normals = positions + 12 * count;
      const tangents = normals + 12 * count;
      runtime.check(
        runtime.functions.bendy_get_displacements(handle, this.number, vertices, positions, normals, tangents, count, runtime.error),
      );
      return {
        vertices: runtime.copyIntegers(vertices, count),
        positions: runtime.copyFloats(positions, 3 * count),
        normals: runtime.copyFloats(normals, 3 * count),
        tangents: runtime.copyFloats(tangents, 3 * count),
      };
    });
  }
}

/**
 * A mesh. Its arrays are copies that are made at the first access and stay valid, also after the model has been disposed. They
 * hold floats whatever the encoding in the file; `streams` has that.
 */
export class Mesh implements Item {
  readonly name: string;
  readonly number: number;
  /** The number of vertices. */
  readonly vertexCount: number;
  /** Its first vertex among those of all meshes, as `Pose.skin` writes them. */
  readonly firstVertex: number;
  /** The number of indices. */
  readonly indexCount: number;
  /** The joint that carries the mesh, or null. */
  readonly joint: number | null;
  /** The joint that moves all vertices of a rigid mesh, or null; see `movers`. */
  readonly mover: number | null;
  /** Whether it has no bones: each vertex is moved by one joint. */
  readonly isRigid: boolean;
  /** The number of matrices that `Pose.palette` computes; 0 if it is rigid. */
  readonly boneCount: number;
  /** The number of bones per vertex; 0 if it is rigid. */
  readonly influenceCount: number;
  readonly hasNormals: boolean;
  readonly hasTangents: boolean;
  /** Its morph targets. */
  readonly morphTargets: Items<MorphTarget>;
  /** Application-specific data: JSON, parsed; null if there is none. */
  readonly extras: unknown;
  /** Its attributes and its index list as the file has them. */
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
    const { runtime, handle } = model;
    const out = runtime.struct(meshLayout);
    runtime.check(runtime.functions.bendy_get_mesh(handle, number, out, runtime.error));
    const raw = readBendyMesh(runtime, out);
    this.name = raw.name;
    this.number = number;
    this.vertexCount = raw.vertices;
    this.firstVertex = raw.firstVertex;
    this.indexCount = raw.indices;
    this.joint = orNull(raw.joint);
    this.mover = orNull(raw.mover);
    this.isRigid = raw.bones === 0;
    this.boneCount = raw.bones;
    this.influenceCount = raw.influences;
    this.hasNormals = raw.hasNormals !== 0;
    this.hasTangents = raw.hasTangents !== 0;
    this.morphTargets = Items.make('morph target', raw.targets, (k) => new MorphTarget(model, raw.firstMorphTarget + k));
    this.extras = parseJson(raw.extras);
    const streams = runtime.functions.bendy_stream_count(handle, number);
    this.streams = Array.from({ length: streams }, (_, stream) => new Stream(model, number, stream));
    this.#model = model;
    this.#textureCoordSets = raw.textureCoordSets;
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
    const { runtime, handle } = this.#model;
    return (this.#textureCoords ??= Array.from({ length: this.#textureCoordSets }, (_, set) =>
      runtime.fetchFloats(2 * this.vertexCount, (at) =>
        runtime.functions.bendy_get_texture_coords(handle, this.number, set, at, 2 * this.vertexCount, runtime.error),
      ),
    ));
  }

  /** For each set linear red, green, blue and possibly alpha per vertex: `length / vertexCount` says how many. */
  get colours(): readonly Float32Array<ArrayBuffer>[] {
    return (this.#colours ??= this.streams.filter((stream) => stream.kind === 'colours').map((stream) => stream.numbers()));
  }

  /** The index list: three per triangle, unless a submesh says otherwise. */
  get indices(): Uint32Array<ArrayBuffer> {
    const { runtime, handle } = this.#model;
    return (this.#indices ??= runtime.fetchIntegers(this.indexCount, (at) =>
      runtime.functions.bendy_get_indices(handle, this.number, at, this.indexCount, runtime.error),
    ));
  }

  get #influenced(): { bones: Uint32Array<ArrayBuffer>; weights: Float32Array<ArrayBuffer> } {
    const { runtime, handle } = this.#model;
    const count = this.vertexCount * this.influenceCount;
    return (this.#influences ??= runtime.borrow(8 * count, (bones) => {
      const weights = bones + 4 * count;
      runtime.check(runtime.functions.bendy_get_influences(handle, this.number, bones, weights, count, runtime.error));
      return { bones: runtime.copyIntegers(bones, count), weights: runtime.copyFloats(weights, count) };
    }));
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
    const { runtime, handle } = this.#model;
    const count = this.boneCount;
    return (this.#palette ??= runtime.borrow(68 * count, (joints) => {
      const matrices = joints + 4 * count;
      runtime.check(runtime.functions.bendy_get_bind_palette(handle, this.number, joints, matrices, count, runtime.error));
      return { joints: runtime.copyIntegers(joints, count), inverseBind: runtime.copyFloats(matrices, 16 * count) };
    }));
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
    const { runtime, handle } = this.#model;
    return runtime.fetchIntegers(this.vertexCount, (at) =>
      runtime.functions.bendy_get_movers(handle, this.number, at, this.vertexCount, runtime.error),
    );
  }
}
