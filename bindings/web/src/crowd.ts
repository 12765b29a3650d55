import type { Clip } from './clip.js';
import { BendyError } from './errors.js';
import { crowdMemberLayout, verticesLayout } from './generated/bindings.js';
import { checkIndex, type Key } from './items.js';
import type { LevelOfDetail } from './lod.js';
import type { Mesh } from './mesh.js';
import type { Model } from './model.js';
import { checkNumber } from './numbers.js';
import { checkOptions, optionNames } from './options.js';
import { type FloatBuffer, none, OfModel } from './runtime.js';

const crowdNames = optionNames<{ positions?: boolean }>({ positions: true });

/**
 * Many characters of one model, each at a time of a clip, in one call: their palettes, one after another, as a texture of a GPU
 * takes them. `positions` adds their skinned vertices. Only making it allocates.
 */
export class Crowd extends OfModel {
  /** The number of characters. */
  readonly size: number;
  /** The number of matrices per character: of all meshes, mesh after mesh; see `firstMatrix`. */
  readonly matrixCount: number;
  readonly #members: number;
  readonly #palettes: FloatBuffer;
  readonly #positions: FloatBuffer | undefined;
  /** By member: keeps clips and levels alive until they are replaced. */
  readonly #lods = new Map<number, LevelOfDetail>();

  /** Makes a crowd at rest. Throws OUT_OF_MEMORY; BAD_ARGUMENT for a negative size. */
  constructor(model: Model, size: number, options: { positions?: boolean } = {}) {
    checkOptions('Crowd', options, crowdNames);
    if (!Number.isInteger(size) || size < 0) throw new BendyError('bad_argument', `a crowd cannot have ${size} characters`);
    const { runtime } = model;
    const { calls, functions } = runtime;
    super(model, calls.bendy_crowd_new(model, 1), functions.bendy_crowd_free);
    this.size = size;
    this.matrixCount = calls.bendy_crowd_palette_size(this);
    this.#palettes = this.ownFloats(16 * this.matrixCount * size);
    this.#members = this.ownBytes(crowdMemberLayout.size * size);
    const vertexCount = model.vertexCount;
    let vertices = 0;
    if (options.positions) {
      this.#positions = this.ownFloats(3 * vertexCount * size);
      vertices = this.ownBytes(verticesLayout.size * size);
    }
    const { view } = runtime;
    for (let member = 0; member < size; ++member) {
      const at = runtime.struct(crowdMemberLayout, this.#member(member));
      view.setUint32(at + crowdMemberLayout.clip, none, true);
      view.setUint32(at + crowdMemberLayout.palette, this.#palettes.at + 64 * this.matrixCount * member, true);
      if (this.#positions === undefined) continue;
      const out = runtime.struct(verticesLayout, vertices + verticesLayout.size * member);
      view.setUint32(out + verticesLayout.capacity, vertexCount, true);
      view.setUint32(out + verticesLayout.positions, this.#positions.at + 12 * vertexCount * member, true);
      view.setUint32(at + crowdMemberLayout.vertices, out, true);
    }
  }

  #member(member: number): number {
    return this.#members + crowdMemberLayout.size * checkIndex(member, this.size, 'member');
  }

  /** Returns the index of a mesh's first matrix within a character. A rigid mesh has one; neighbours with equal palettes share theirs. Throws NOT_FOUND. */
  firstMatrix(mesh: Key<Mesh>): number {
    return this.runtime.calls.bendy_crowd_first_matrix(this, this.model.meshes.number(mesh));
  }

  /**
   * Sets what a character plays: a clip, or null for the rest pose, at a time in seconds. `lod` is used by
   * each `play`, and must not be disposed before the last one. Throws NOT_FOUND; BAD_ARGUMENT for a clip or a level of another model.
   */
  set(member: number, clip: Key<Clip> | null, seconds: number, lod?: LevelOfDetail): this {
    const at = this.#member(member);
    const { view } = this.runtime;
    if (lod !== undefined) this.model.checkOwn(lod, 'level of detail');
    view.setUint32(at + crowdMemberLayout.clip, clip === null ? none : this.model.clips.number(clip), true);
    view.setFloat32(at + crowdMemberLayout.seconds, checkNumber(seconds, 'seconds'), true);
    view.setUint32(at + crowdMemberLayout.lod, lod?.handle ?? 0, true);
    if (lod === undefined) this.#lods.delete(member);
    else this.#lods.set(member, lod);
    return this;
  }

  /** Poses all characters. Throws BAD_ARGUMENT, or DISPOSED for a level of detail; in that case nothing has changed. */
  play(): this {
    for (const lod of this.#lods.values()) void lod.handle;
    this.runtime.calls.bendy_crowd_play(this, this.#members, this.size, 0);
    return this;
  }

  /** 16 floats per matrix, `matrixCount` matrices per character: a view of the module's memory, see `Runtime`. */
  get palettes(): Float32Array<ArrayBuffer> {
    void this.handle;
    return this.#palettes.array;
  }

  /** x y z per vertex, `Model.vertexCount` vertices per character: a view, as `palettes`; null if not requested. */
  get positions(): Float32Array<ArrayBuffer> | null {
    void this.handle;
    return this.#positions?.array ?? null;
  }
}
