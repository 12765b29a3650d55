// Draws a character by the runtime's palettes. The objects of its joints stay where they are, unless they carry something.
import { Matrix4, type Object3D, type Skeleton, SkinnedMesh } from 'three';
import type { Pose } from '../index.js';
import type { BendyCharacter } from './character.js';
import { BlendedSkeleton } from './influences.js';
import { isSkinnedByRuntime } from './parts.js';

/** Multiplies affine matrices, which are stored column by column, by another from the left. */
function multiply(by: Matrix4, matrices: Float32Array, out: Float32Array): void {
  const [a, b, c, , d, e, f, , g, h, i, , x, y, z] = by.elements;
  for (let at = 0; at < matrices.length; at += 4) {
    const p = matrices[at]!;
    const q = matrices[at + 1]!;
    const r = matrices[at + 2]!;
    const one = matrices[at + 3]!;
    out[at] = a * p + d * q + g * r + x * one;
    out[at + 1] = b * p + e * q + h * r + y * one;
    out[at + 2] = c * p + f * q + i * r + z * one;
    out[at + 3] = one;
  }
}

const identity = new Matrix4();

/** What a skeleton draws: the palette of a mesh, in model space. */
interface Drawn {
  readonly skeleton: Skeleton;
  readonly mesh: number;
  readonly palette: Float32Array;
  /** What three.js calls before it draws. */
  readonly update: () => void;
}

/** @internal The skeletons of a character, which take palettes, and the joints that have to move all the same. */
export class Palettes {
  readonly #character: BendyCharacter;
  readonly #drawn: Drawn[] = [];
  readonly #isJoint: ReadonlySet<Object3D>;
  readonly #isPart: ReadonlySet<Object3D>;
  readonly #parents: readonly (number | null)[];
  readonly #children: Int32Array;
  readonly #stay = (): void => {}; // of its own, so that another animator's stays
  #moved: number[] = [];
  #resting: Object3D[] = [];

  constructor(character: BendyCharacter) {
    this.#character = character;
    this.#isJoint = new Set(character.joints);
    this.#isPart = new Set(character.parts.map(({ object }) => object));
    this.#parents = character.model.joints.map(({ parent }) => parent);
    this.#children = new Int32Array(character.joints.length).fill(-1);
    character.scene.updateMatrixWorld(true);
    const seen = new Set<Skeleton>();
    for (const { object, mesh } of character.parts) {
      if (!(object instanceof SkinnedMesh)) continue;
      // three.js would compute them at the first picture, of joints that rest.
      if (object.boundingSphere === null) object.computeBoundingSphere();
      if (object.boundingBox === null) object.computeBoundingBox();
      const { skeleton } = object;
      if (seen.has(skeleton) || isSkinnedByRuntime(object, character.scene)) continue;
      seen.add(skeleton);
      const palette = new Float32Array(16 * skeleton.bones.length);
      const update = (): void => {
        const { matrixWorld } = character.scene;
        if (matrixWorld.equals(identity)) skeleton.boneMatrices!.set(palette);
        else multiply(matrixWorld, palette, skeleton.boneMatrices!);
        if (skeleton instanceof BlendedSkeleton) skeleton.blend();
        if (skeleton.boneTexture !== null) skeleton.boneTexture.needsUpdate = true;
      };
      skeleton.update = update;
      this.#drawn.push({ skeleton, mesh, palette, update });
    }
  }

  /** The joints that carry something, and those above them. */
  get moved(): readonly number[] {
    const { joints } = this.#character;
    let isSame = true;
    for (let k = 0; k < joints.length; ++k) isSame &&= joints[k]!.children.length === this.#children[k];
    if (!isSame) this.#find();
    return this.#moved;
  }

  #find(): void {
    const { joints } = this.#character;
    this.wake();
    const moves = joints.map((joint, k) => {
      this.#children[k] = joint.children.length;
      return this.#isPart.has(joint) || joint.children.some((child) => !this.#isJoint.has(child));
    });
    for (let k = joints.length - 1; k >= 0; --k) {
      const parent = this.#parents[k]!;
      if (moves[k] && parent !== null) moves[parent] = true;
    }
    this.#moved = [...joints.keys()].filter((k) => moves[k]);
    this.#resting = joints.filter((_, k) => !moves[k] && (this.#parents[k] === null || moves[this.#parents[k]!]));
    this.rest();
  }

  /** three.js leaves out the joints that carry nothing, and what is below them, when it updates the scene. */
  rest(): void {
    for (const joint of this.#resting) joint.updateMatrixWorld = this.#stay;
  }

  /** Ends that. */
  wake(): void {
    for (const joint of this.#resting) {
      if (joint.updateMatrixWorld === this.#stay) delete (joint as Partial<Object3D>).updateMatrixWorld;
    }
  }

  /** Copies the palettes of a pose. */
  take(pose: Pose): void {
    for (const { mesh, palette } of this.#drawn) palette.set(pose.palette(mesh));
  }

  /** Gives the skeletons back to three.js. */
  dispose(): void {
    this.wake();
    for (const { skeleton, update } of this.#drawn) if (skeleton.update === update) delete (skeleton as Partial<Skeleton>).update;
  }
}
