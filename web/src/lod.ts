import { lodInfoLayout, readBendyLodInfo, submeshLayout } from './generated/bindings.js';
import { checkIndex, type Key } from './items.js';
import type { Mesh } from './mesh.js';
import type { Model } from './model.js';
import { type Submesh, submeshAt } from './parts.js';
import { Handle } from './runtime.js';

/**
 * A model at one level of detail: which vertices are in use, and which triangles are drawn. A model whose file stores no levels of
 * detail has a single level: everything.
 */
export class LevelOfDetail extends Handle {
  readonly model: Model;
  readonly #submeshes: number;

  /** Makes a level at full detail, or of a share of the triangles, 0 to 1. Throws BAD_ARGUMENT, OUT_OF_MEMORY. */
  constructor(model: Model, share = 1) {
    const { runtime } = model;
    const { functions, error } = runtime;
    const handle = runtime.checkHandle(functions.bendy_lod_new(model.handle, error));
    super(runtime, handle, () => functions.bendy_lod_free(handle));
    this.own(model.useFile());
    this.model = model;
    this.#submeshes = model.submeshes.length;
    if (share !== 1) this.setShare(share);
  }

  /** Keeps about this share of the triangles: 1 keeps all, 0 as few as the file's sequence allows. */
  setShare(share: number): this {
    this.runtime.check(this.runtime.functions.bendy_lod_set_share(this.handle, share, this.runtime.error));
    return this;
  }

  get #info(): { error: number; triangles: number } {
    const out = this.runtime.struct(lodInfoLayout);
    this.runtime.check(this.runtime.functions.bendy_get_lod(this.handle, out, this.runtime.error));
    return readBendyLodInfo(this.runtime, out);
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
    return this.runtime.functions.bendy_lod_vertices(this.handle, this.model.meshes.number(mesh));
  }

  /** Returns a fresh copy of a mesh's index list at this level. Throws NOT_FOUND. */
  indices(mesh: Key<Mesh>): Uint32Array<ArrayBuffer> {
    const { runtime } = this;
    const { functions, error, scratch } = runtime;
    const at = functions.bendy_lod_indices(this.handle, this.model.meshes.number(mesh), scratch, error);
    return at === 0 ? new Uint32Array(0) : runtime.copyIntegers(at, runtime.view.getUint32(scratch, true));
  }

  /** Returns a submesh at this level: a range of `indices`. Submeshes are numbered as in the model. Throws BAD_ARGUMENT. */
  submesh(number: number): Submesh {
    checkIndex(number, this.#submeshes, 'submesh');
    const out = this.runtime.struct(submeshLayout);
    this.runtime.check(this.runtime.functions.bendy_lod_submesh(this.handle, number, out, this.runtime.error));
    return submeshAt(this.runtime, out, number);
  }
}
