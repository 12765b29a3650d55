import { MadeLod } from './generated/classes.js';
import { checkIndex, type Key } from './items.js';
import type { Mesh } from './mesh.js';
import type { Model } from './model.js';
import type { Submesh } from './parts.js';

/**
 * A model at one level of detail: which vertices are in use, and which triangles are drawn. A model whose file stores no levels of
 * detail has a single level: everything.
 */
export class LevelOfDetail extends MadeLod {
  readonly #submeshes: number;

  /** Makes a level at full detail, or of a fraction of the triangles, 0 to 1. Throws BAD_ARGUMENT, OUT_OF_MEMORY. */
  constructor(model: Model, share = 1) {
    const { calls, functions } = model.runtime;
    super(model, calls.bendy_lod_new(model), functions.bendy_lod_free);
    this.#submeshes = model.submeshes.length;
    if (share !== 1) this.setShare(share);
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
