import { Bone, type Matrix4, Object3D, Vector3 as ThreeVector3 } from 'three';
import type { Vector3 } from '../index.js';

type Constructor = new () => Object3D;

/** Multiplies a matrix that consists of rotation and scale by the shear that belongs to that scale. */
function addShear(matrix: Matrix4, object: Object3D, [xy, xz, yz]: Readonly<Vector3>): void {
  const e = matrix.elements;
  const x = new ThreeVector3(1, 0, 0).applyQuaternion(object.quaternion);
  const y = new ThreeVector3(0, 1, 0).applyQuaternion(object.quaternion);
  for (let row = 0; row < 3; ++row) {
    e[4 + row]! += xy * x.getComponent(row);
    e[8 + row]! += xz * x.getComponent(row) + yz * y.getComponent(row);
  }
}

/** three.js composes a matrix of translation, rotation and scale; these objects also have the shear of a joint. */
function sheared<T extends Constructor>(base: T) {
  return class extends (base as Constructor) {
    /** xy, xz, yz: the elements above the diagonal of the scale matrix. */
    shear: Readonly<Vector3> = [0, 0, 0];

    override updateMatrix(): void {
      super.updateMatrix();
      addShear(this.matrix, this, this.shear);
    }

    override copy(source: this, recursive?: boolean): this {
      super.copy(source, recursive);
      this.shear = source.shear;
      return this;
    }
  };
}

/** A bone whose rest transform has shear. */
export const ShearedBone = sheared(Bone);
/** A joint that no skin uses, and whose rest transform has shear. */
export const ShearedObject3D = sheared(Object3D);
