import type { BendyLodInfo } from './generated/bindings.js';
import { checkIndex, type Key } from './items.js';
import type { Mesh } from './mesh.js';
import type { Model } from './model.js';
import type { Submesh } from './parts.js';
import { OfModel } from './runtime.js';

/**
 * A model at one level of detail: which vertices are in use, and which triangles are drawn. A model whose file stores no levels of
 * detail has a single level: everything.
 */
export class LevelOfDetail extends OfModel {
  readonly #submeshes: number;

  /** Makes a level at full detail, or of a fraction of the triangles, 0 to 1. Throws BAD_ARGUMENT, OUT_OF_MEMORY. */
  constructor(model: Model, share = 1) {
    const { calls, functions } = model.runtime;
    super(model, calls.bendy_lod_new(model), functions.bendy_lod_free);
    this.#submeshes = model.submeshes.length;
    if (share !== 1) this.setShare(share);
  }

  /** Keeps about this fraction of the triangles: 1 keeps all, 0 as few as the file's sequence allows. */
  setShare(share: number): this {
    this.runtime.calls.bendy_lod_set_share(this, share);
    return this;
  }

  get #info(): BendyLodInfo {
    return this.runtime.calls.bendy_get_lod(this);
  }

  /** The largest deviation from the full surface in metres, as the file states it; 0 at full detail. */
  get error(): number {
    return this.#info.error;
  }

  /** The number of triangles of all meshes together. */
  get triangles(): number {
    return this.#info.triangles;
  }

  /** Returns how many vertices of a mesh are in use: the first ones. Throws NOT_FOUND. */
  vertices(mesh: Key<Mesh>): number {
    return this.runtime.calls.bendy_lod_vertices(this, this.model.meshes.number(mesh));
  }

  /** Returns a fresh copy of a mesh's index list at this level. Throws NOT_FOUND. */
  indices(mesh: Key<Mesh>): Uint32Array<ArrayBuffer> {
    return this.runtime.calls.bendy_lod_indices(this, this.model.meshes.number(mesh));
  }

  /** Returns a submesh at this level: a range of `indices`. Submeshes are numbered as in the model. Throws BAD_ARGUMENT. */
  submesh(number: number): Submesh {
    checkIndex(number, this.#submeshes, 'submesh');
    return { ...this.runtime.calls.bendy_lod_submesh(this, number), number };
  }
}
