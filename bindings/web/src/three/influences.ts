// Skinning with more than four influences per vertex. three.js takes four, so a vertex that has more follows one "blended bone",
// whose matrix is the weighted sum of its bones' matrices. The skeleton computes these whenever the renderer updates it.
import {
  type Bone,
  BufferAttribute,
  DataTexture,
  FloatType,
  Matrix4,
  RGBAFormat,
  Skeleton,
  SkinnedMesh,
  type Vector3,
  Vector4,
} from 'three';
import type { Mesh } from '../index.js';

/** The bones and weights of each blended bone: `size` of them, padded with zero weights. */
export interface Blends {
  readonly size: number;
  readonly count: number;
  readonly bones: Uint32Array;
  readonly weights: Float32Array;
}

/** The influences of a mesh in three.js's form. A bone from `boneCount` on is a blended bone. */
export interface Influences {
  readonly skinIndex: BufferAttribute;
  readonly skinWeight: BufferAttribute;
  /** Null if no vertex has more than four. */
  readonly blends: Blends | null;
}

/** Reads the influences of a skinned mesh. */
export function readInfluences(mesh: Mesh): Influences {
  const { vertexCount, influenceCount: size, boneCount, bones, weights } = mesh;
  const indices = new Uint32Array(4 * vertexCount);
  const shares = new Float32Array(4 * vertexCount);
  const blendOf = new Map<string, number>();
  const blended: number[] = []; // the vertex that each blended bone is made from
  for (let vertex = 0; vertex < vertexCount; ++vertex) {
    const end = size * (vertex + 1);
    let used = 0;
    for (let k = end - size; k < end; ++k) {
      if (weights[k] === 0) continue;
      if (used < 4) {
        indices[4 * vertex + used] = bones[k]!;
        shares[4 * vertex + used] = weights[k]!;
      }
      ++used;
    }
    if (used <= 4) continue;
    let key = '';
    for (let k = end - size; k < end; ++k) if (weights[k] !== 0) key += `${bones[k]} ${weights[k]},`;
    let blend = blendOf.get(key);
    if (blend === undefined) {
      blend = blended.push(vertex) - 1;
      blendOf.set(key, blend);
    }
    indices.fill(0, 4 * vertex, 4 * vertex + 4)[4 * vertex] = boneCount + blend;
    shares.fill(0, 4 * vertex, 4 * vertex + 4)[4 * vertex] = 1;
  }
  // Shaders take indices as floats, so these hold numbers beyond 16 bits.
  const ArrayType = boneCount + blended.length <= 0x10000 ? Uint16Array : Float32Array;
  const gather = (from: Uint32Array | Float32Array, to: Uint32Array | Float32Array): void =>
    blended.forEach((vertex, blend) => to.set(from.subarray(size * vertex, size * (vertex + 1)), size * blend));
  const blends: Blends = {
    size,
    count: blended.length,
    bones: new Uint32Array(size * blended.length),
    weights: new Float32Array(size * blended.length),
  };
  gather(bones, blends.bones);
  gather(weights, blends.weights);
  return {
    skinIndex: new BufferAttribute(new ArrayType(indices), 4),
    skinWeight: new BufferAttribute(shares, 4),
    blends: blended.length === 0 ? null : blends,
  };
}

/** A skeleton with blended bones after its own. */
export class BlendedSkeleton extends Skeleton {
  readonly blends: Blends;

  constructor(bones: Bone[], boneInverses: Matrix4[], blends: Blends) {
    super(bones, boneInverses);
    this.blends = blends;
    this.boneMatrices = new Float32Array(16 * (bones.length + blends.count));
  }

  override update(): void {
    super.update();
    this.blend();
  }

  /** Computes the matrices of the blended bones from those of the others. */
  blend(): void {
    const matrices = this.boneMatrices!;
    const { size, count, bones, weights } = this.blends;
    const first = 16 * this.bones.length;
    matrices.fill(0, first, first + 16 * count);
    for (let k = 0; k < size * count; ++k) {
      const weight = weights[k]!;
      const to = first + 16 * Math.floor(k / size);
      const from = 16 * bones[k]!;
      if (weight !== 0) for (let i = 0; i < 16; ++i) matrices[to + i]! += weight * matrices[from + i]!;
    }
  }

  override computeBoneTexture(): this {
    // As in Skeleton, for all bones: four texels per matrix, a square whose side is a multiple of 4.
    const side = 4 * Math.ceil(Math.sqrt(4 * (this.bones.length + this.blends.count)) / 4);
    const matrices = new Float32Array(4 * side * side);
    matrices.set(this.boneMatrices!);
    this.boneMatrices = matrices;
    this.boneTexture = new DataTexture(matrices, side, side, RGBAFormat, FloatType);
    this.boneTexture.needsUpdate = true;
    return this;
  }

  override clone(): BlendedSkeleton {
    return new BlendedSkeleton(this.bones, this.boneInverses, this.blends);
  }
}

const boneMatrix = new Matrix4();

/** A skinned mesh with a BlendedSkeleton: computes positions on the CPU, for raycasts and bounding boxes, with all influences. */
export class BlendedSkinnedMesh extends SkinnedMesh {
  override applyBoneTransform(index: number, vector: Vector3): Vector3;
  override applyBoneTransform(index: number, vector: Vector4): Vector4;
  override applyBoneTransform(index: number, vector: Vector3 | Vector4): Vector3 | Vector4;
  override applyBoneTransform(index: number, vector: Vector3 | Vector4): Vector3 | Vector4 {
    const { skeleton } = this;
    const blend = this.geometry.getAttribute('skinIndex').getX(index) - skeleton.bones.length;
    if (blend < 0 || !(skeleton instanceof BlendedSkeleton)) return super.applyBoneTransform(index, vector);
    const { size, bones, weights } = skeleton.blends;
    const base = new Vector4(vector.x, vector.y, vector.z, vector instanceof Vector4 ? vector.w : 1).applyMatrix4(
      this.bindMatrix,
    );
    const sum = new Vector4(0, 0, 0, 0);
    for (let k = size * blend; k < size * (blend + 1); ++k) {
      if (weights[k] === 0) continue;
      const bone = bones[k]!;
      boneMatrix.multiplyMatrices(skeleton.bones[bone]!.matrixWorld, skeleton.boneInverses[bone]!);
      sum.addScaledVector(base.clone().applyMatrix4(boneMatrix), weights[k]!);
    }
    sum.w = base.w;
    sum.applyMatrix4(this.bindMatrixInverse);
    if (vector instanceof Vector4) return vector.copy(sum);
    return vector.set(sum.x, sum.y, sum.z);
  }
}
