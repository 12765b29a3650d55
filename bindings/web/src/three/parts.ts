// The meshes of a model as three.js objects.
import {
  type Bone,
  BufferAttribute,
  BufferGeometry,
  LineSegments,
  type Material,
  Matrix4,
  Mesh as ThreeMesh,
  type Object3D,
  Points,
  Skeleton,
  SkinnedMesh,
} from 'three';
import type { Mesh, Model, Stream, Submesh } from '../index.js';
import { BlendedSkeleton, BlendedSkinnedMesh, type Influences, readInfluences } from './influences.js';
import { none } from '../runtime.js';
import type { Materials } from './materials.js';
import { nameGiver } from './names.js';

/** An object that three.js draws: the submeshes of one mesh that have the same material, topology and moving joint. */
export interface Part {
  /** A SkinnedMesh if the mesh is skinned. */
  readonly object: ThreeMesh | LineSegments | Points;
  /** The number of the mesh. */
  readonly mesh: number;
  /** The numbers of the submeshes. */
  readonly submeshes: readonly number[];
}

/** A part, and the joint that its object belongs to: the one that moves it or, if it is skinned, the one it is attached to. */
export interface PlacedPart extends Part {
  readonly joint: number | null;
}

/** GLTFLoader's name for an attribute; null for one that is read in another way. */
function attributeName({ kind, set, name }: Stream): string | null {
  if (kind === 'positions') return 'position';
  if (kind === 'normals') return 'normal';
  if (kind === 'tangents') return 'tangent';
  if (kind === 'texture_coords') return set === 0 ? 'uv' : set < 4 ? `uv${set}` : `texcoord_${set}`;
  if (kind === 'colours') return set === 0 ? 'color' : `color_${set}`;
  return kind === 'attribute' ? name.toLowerCase() : null;
}

/** A geometry without an index, which all parts of a mesh share. Null if the mesh has no positions. */
function sharedGeometry(mesh: Mesh, influences: Influences | null): BufferGeometry | null {
  const geometry = new BufferGeometry();
  for (const stream of mesh.streams) {
    const name = attributeName(stream);
    if (name !== null) geometry.setAttribute(name, new BufferAttribute(stream.numbers(), stream.components));
  }
  if (!geometry.hasAttribute('position')) return null;
  if (influences !== null) {
    geometry.setAttribute('skinIndex', influences.skinIndex);
    geometry.setAttribute('skinWeight', influences.skinWeight);
  }
  const targets = mesh.morphTargets;
  const hasNormals = mesh.hasNormals && targets.some((target) => target.hasNormals);
  const positions: BufferAttribute[] = [];
  const normals: BufferAttribute[] = [];
  const give = nameGiver();
  const names = targets.map(({ name }) => name && give(name)).map((name, k) => name || give(String(k)));
  for (const [k, target] of targets.entries()) {
    const moved = target.displacements();
    const spread = (values: Float32Array): BufferAttribute => {
      const all = new Float32Array(3 * mesh.vertexCount);
      for (const [i, vertex] of moved.vertices.entries()) for (let c = 0; c < 3; ++c) all[3 * vertex + c] = values[3 * i + c]!;
      const attribute = new BufferAttribute(all, 3);
      attribute.name = names[k]!; // updateMorphTargets makes the dictionary from it
      return attribute;
    };
    positions.push(spread(moved.positions));
    if (hasNormals) normals.push(spread(moved.normals));
  }
  if (targets.length > 0) {
    geometry.morphAttributes.position = positions;
    if (hasNormals) geometry.morphAttributes.normal = normals;
    geometry.morphTargetsRelative = true;
  }
  return geometry;
}

/** A geometry with the attributes of another, and its own index. */
export function withIndex(shared: BufferGeometry, index: BufferAttribute | null): BufferGeometry {
  const geometry = new BufferGeometry();
  for (const [name, attribute] of Object.entries(shared.attributes)) geometry.setAttribute(name, attribute);
  Object.assign(geometry.morphAttributes, shared.morphAttributes);
  geometry.morphTargetsRelative = shared.morphTargetsRelative;
  geometry.setIndex(index);
  geometry.setDrawRange(shared.drawRange.start, shared.drawRange.count);
  return geometry;
}

/** Whether an animator has given an object vertices in model space, and one bone that carries them to the world. */
export function isSkinnedByRuntime(object: Part['object'], scene: Object3D): boolean {
  return object instanceof SkinnedMesh && object.skeleton.bones[0] === scene;
}

function makeObject(
  topology: Submesh['topology'],
  influences: Influences | null,
  geometry: BufferGeometry,
  material: Material,
): Part['object'] {
  if (topology === 'lines') return new LineSegments(geometry, material);
  if (topology === 'points') return new Points(geometry, material);
  if (influences === null) return new ThreeMesh(geometry, material);
  return influences.blends === null ? new SkinnedMesh(geometry, material) : new BlendedSkinnedMesh(geometry, material);
}

/** The submeshes of a mesh that form one part each, and the joint of each. */
function groupSubmeshes(model: Model, mesh: Mesh): { joint: number | null; submeshes: Submesh[] }[] {
  const groups = new Map<string, { joint: number | null; submeshes: Submesh[] }>();
  const movers = mesh.isRigid && mesh.mover === null ? mesh.movers() : null;
  for (const submesh of model.submeshes) {
    if (submesh.mesh !== mesh.number || submesh.count === 0) continue;
    const mover = movers?.[mesh.indices[submesh.first]!] ?? mesh.mover;
    const joint = mesh.isRigid ? (mover === none ? null : mover) : mesh.joint;
    const key = `${joint} ${submesh.material} ${submesh.topology}`;
    const group = groups.get(key);
    if (group === undefined) groups.set(key, { joint, submeshes: [submesh] });
    else group.submeshes.push(submesh);
  }
  return [...groups.values()];
}

/** Makes the objects of all meshes. `uniqueName` is called once for each. */
export async function makeParts(model: Model, materials: Materials, uniqueName: (name: string) => string): Promise<PlacedPart[]> {
  const parts: Promise<PlacedPart>[] = [];
  for (const mesh of model.meshes) {
    const influences = mesh.isRigid ? null : readInfluences(mesh);
    const shared = sharedGeometry(mesh, influences);
    if (shared === null) continue;
    const IndexType = mesh.vertexCount > 0xffff ? Uint32Array : Uint16Array;
    for (const { joint, submeshes } of groupSubmeshes(model, mesh)) {
      const indices = new IndexType(submeshes.reduce((sum, { count }) => sum + count, 0));
      let at = 0;
      for (const { first, count } of submeshes) {
        indices.set(mesh.indices.subarray(first, first + count), at);
        at += count;
      }
      const geometry = withIndex(shared, new BufferAttribute(indices, 1));
      const { material, topology } = submeshes[0]!;
      const surface = {
        topology,
        hasNormals: mesh.hasNormals,
        hasTangents: mesh.hasTangents,
        hasColours: geometry.hasAttribute('color'),
      };
      const name = uniqueName(mesh.name || `mesh_${mesh.number}`);
      const make = (threeMaterial: Material): PlacedPart => {
        const object = makeObject(topology, influences, geometry, threeMaterial);
        object.name = name;
        if (typeof mesh.extras === 'object') Object.assign(object.userData, mesh.extras);
        // A file has each name once, in its target; glTF has them in the mesh's extras.
        const targetNames = mesh.morphTargets.map((target) => target.name);
        if (targetNames.length > 0 && targetNames.every(Boolean)) object.userData['targetNames'] = targetNames;
        mesh.morphTargets.forEach((target, k) => (object.morphTargetInfluences![k] = target.restWeight));
        return { object, mesh: mesh.number, submeshes: submeshes.map(({ number }) => number), joint };
      };
      parts.push(materials.use(material, surface).then(make)); // all images are decoded at once
    }
  }
  return Promise.all(parts);
}

function areEqual(a: ArrayLike<number>, b: ArrayLike<number>): boolean {
  if (a.length !== b.length) return false;
  for (let k = 0; k < a.length; ++k) if (a[k] !== b[k]) return false;
  return true;
}

/** Binds the skinned parts to bones. Parts of a mesh share a skeleton, and meshes with the same palette, unless they have blended bones. */
export function bindParts(model: Model, parts: readonly Part[], bones: readonly Bone[]): void {
  const made: { mesh: Mesh; isBlended: boolean; skeleton: Skeleton }[] = [];
  for (const { object, mesh: number } of parts) {
    if (!(object instanceof SkinnedMesh)) continue;
    const mesh = model.meshes[number]!;
    const isBlended = object instanceof BlendedSkinnedMesh;
    const isSame = (other: Mesh): boolean => areEqual(other.boneJoints, mesh.boneJoints) && areEqual(other.inverseBind, mesh.inverseBind);
    const found = made.find((one) => one.mesh === mesh || (!one.isBlended && !isBlended && isSame(one.mesh)));
    if (found !== undefined) {
      object.bind(found.skeleton, new Matrix4());
      continue;
    }
    const ofMesh = Array.from(mesh.boneJoints, (joint) => bones[joint]!);
    const inverses = ofMesh.map((_, bone) => new Matrix4().fromArray(mesh.inverseBind, 16 * bone));
    const skeleton = isBlended ? new BlendedSkeleton(ofMesh, inverses, readInfluences(mesh).blends!) : new Skeleton(ofMesh, inverses);
    made.push({ mesh, isBlended, skeleton });
    object.bind(skeleton, new Matrix4());
  }
}
