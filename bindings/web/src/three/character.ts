import { AnimationClip, Bone, type Camera, Group, type KeyframeTrack, Object3D, PropertyBinding, type Skeleton, SkinnedMesh } from 'three';
import { clone as cloneObjects } from 'three/addons/utils/SkeletonUtils.js';
import { type Chain, type Constraint, type Items, LevelOfDetail, type Model } from '../index.js';
import { lazyClip, makeClips } from './clips.js';
import { Materials } from './materials.js';
import { nameGiver } from './names.js';
import { bindParts, makeParts, type Part, type PlacedPart } from './parts.js';
import { ShearedBone, ShearedObject3D } from './shear.js';
import type { Textures } from './textures.js';

/** The result of BendyLoader: a superset of the commonly used parts of GLTFLoader's result. */
export interface BendyCharacter {
  /** Contains the root joints. */
  scene: Group;
  /** The scene, for programs that expect the result of GLTFLoader. */
  scenes: Group[];
  /** Empty: the runtime has no cameras. */
  cameras: Camera[];
  /** For AnimationMixer. The tracks of a clip are made when they are first read. */
  animations: AnimationClip[];
  /** The IK chains: `BendyAnimator.reach` takes their names. */
  chains: Items<Chain>;
  /** The limits of the joints. */
  constraints: readonly Constraint[];
  /** The glTF source's information about itself: version, generator, copyright; empty for other sources. */
  asset: Record<string, unknown>;
  userData: Record<string, unknown>;
  /**
   * The model that the runtime poses. When it has been disposed, the scene and the animations stay usable: the file's memory is released
   * when the tracks of all of them have been read or set, `clip.tracks = []`, or when the garbage collector finds the animations.
   */
  model: Model;
  /** The object of each joint, numbered as in the model: a Bone if a skin uses it. */
  joints: Object3D[];
  /** The drawn objects. */
  parts: Part[];
  /** For textures without an image: why each of their images could not be loaded, one line each. */
  warnings: readonly string[];
}

/**
 * Names the joints in the order in which GLTFLoader names nodes, so that of several joints with one name the same ones get numbers:
 * the bones of a skinned mesh come when its joint and the descendants of that are done.
 */
function nameJoints(model: Model, uniqueName: (name: string) => string): string[] {
  const names: string[] = [];
  const name = (joint: number): void => {
    const original = model.joints[joint]!.name;
    names[joint] ??= original === '' ? '' : uniqueName(original);
  };
  const open: number[] = [];
  const leaveUntil = (joint: number | null): void => {
    while (open.length > 0 && open.at(-1) !== joint) {
      const left = open.pop();
      for (const mesh of model.meshes) if (mesh.joint === left && !mesh.isRigid) mesh.boneJoints.forEach(name);
    }
  };
  for (const { number, parent } of model.joints) {
    leaveUntil(parent);
    name(number);
    open.push(number);
  }
  leaveUntil(null);
  return names;
}

/** The object of a joint, with the parts attached to it. */
function makeJoint(isBone: boolean, hasShear: boolean, parts: readonly PlacedPart[]): Object3D {
  if (!isBone && !hasShear && parts.length === 1) return parts[0]!.object;
  const Type = isBone ? (hasShear ? ShearedBone : Bone) : hasShear ? ShearedObject3D : parts.length > 1 ? Group : Object3D;
  const object = new Type();
  for (const part of parts) object.add(part.object);
  return object;
}

/** The file's extras, which the converter makes from a source's `asset` and `extras`, in GLTFLoader's form. */
function sourceOf(fileExtras: unknown): { asset: Record<string, unknown>; userData: Record<string, unknown> } {
  const object = (value: unknown): Record<string, unknown> =>
    typeof value === 'object' && value !== null && !Array.isArray(value) ? { ...value } : {};
  const members = object(fileExtras);
  const isConverted = Object.keys(members).every((name) => name === 'asset' || name === 'extras');
  return isConverted ? { asset: object(members['asset']), userData: object(members['extras']) } : { asset: {}, userData: members };
}

/** @internal Makes the objects of a model. */
export async function makeCharacter(model: Model, textures: Textures): Promise<BendyCharacter> {
  const give = nameGiver();
  const uniqueName = (name: string): string => give(PropertyBinding.sanitizeNodeName(name)); // without characters that tracks cannot have
  const scene = new Group();
  if (model.name !== '') scene.name = uniqueName(model.name);
  if (typeof model.extras === 'object') Object.assign(scene.userData, model.extras);
  // Joints are named before meshes, as in GLTFLoader.
  const names = nameJoints(model, uniqueName);
  const parts = await makeParts(model, new Materials(model, textures), uniqueName);
  const isBone = new Set(model.meshes.flatMap((mesh) => (mesh.isRigid ? [] : Array.from(mesh.boneJoints))));
  const joints: Object3D[] = [];
  for (const { number, name, parent, rest, shear, extras } of model.joints) {
    const hasShear = shear.some((x) => x !== 0);
    const object = makeJoint(
      isBone.has(number),
      hasShear,
      parts.filter((part) => part.joint === number),
    );
    if (object instanceof ShearedBone || object instanceof ShearedObject3D) object.shear = shear;
    if (name !== '') {
      object.name = names[number]!;
      object.userData['name'] = name;
    }
    if (typeof extras === 'object') Object.assign(object.userData, extras);
    object.position.fromArray(rest.translation);
    object.quaternion.fromArray(rest.rotation);
    object.scale.fromArray(rest.scale);
    joints.push(object);
    (parent === null ? scene : joints[parent]!).add(object);
  }
  for (const part of parts) if (part.joint === null) scene.add(part.object);
  bindParts(model, parts, joints as Bone[]);
  scene.updateMatrixWorld(true);
  return {
    scene,
    scenes: [scene],
    cameras: [],
    animations: makeClips(model, joints, parts),
    chains: model.chains,
    constraints: model.constraints,
    ...sourceOf(model.fileExtras),
    model,
    joints,
    parts: parts.map(({ object, mesh, submeshes }) => ({ object, mesh, submeshes })),
    warnings: textures.warnings,
  };
}

/** The clip for copies of objects without a name, which its tracks find by their UUIDs. */
function retarget(clip: AnimationClip, copies: ReadonlyMap<string, Object3D>): AnimationClip {
  const rename = (track: KeyframeTrack): KeyframeTrack => {
    const end = track.name.lastIndexOf('.');
    const copy = copies.get(track.name.slice(0, end));
    if (copy === undefined) return track;
    const renamed = track.clone();
    renamed.name = copy.uuid + track.name.slice(end);
    return renamed;
  };
  const retargeted = lazyClip(clip.name, clip.duration, () => clip.tracks.map(rename));
  return Object.assign(retargeted, { blendMode: clip.blendMode, userData: clip.userData });
}

/**
 * Returns a second character with joints of its own, to be posed independently. It shares model, geometries and materials with the
 * first one, and clips whose joints have names.
 */
export function cloneCharacter(character: BendyCharacter): BendyCharacter {
  const scene = cloneObjects(character.scene) as Group;
  const copies = new Map<Object3D, Object3D>();
  const match = (object: Object3D, copy: Object3D): void => {
    copies.set(object, copy);
    object.children.forEach((child, k) => match(child, copy.children[k]!));
  };
  match(character.scene, scene);
  // Copied meshes have a skeleton each: those that share one share it again.
  const skeletons = new Map<Skeleton, Skeleton>();
  for (const { object } of character.parts) {
    if (!(object instanceof SkinnedMesh)) continue;
    const copy = copies.get(object) as SkinnedMesh | undefined;
    if (copy === undefined) continue; // taken out of the scene
    const shared = skeletons.get(object.skeleton);
    if (shared === undefined) skeletons.set(object.skeleton, copy.skeleton);
    else copy.bind(shared, copy.bindMatrix);
  }
  const nameless = character.joints.filter(({ name }) => name === '');
  const byUuid = new Map(nameless.map((joint) => [joint.uuid, copies.get(joint)!]));
  return {
    ...character,
    scene,
    scenes: [scene],
    animations: byUuid.size === 0 ? [...character.animations] : character.animations.map((clip) => retarget(clip, byUuid)),
    joints: character.joints.map((joint) => copies.get(joint)!),
    parts: character.parts.map((part) => ({ ...part, object: copies.get(part.object) as Part['object'] })),
  };
}

/**
 * Draws about this share of the triangles: 1 draws all, 0 as few as the file's levels of detail allow. Changes the geometries, which
 * clones share. Returns the largest deviation from the full surface in metres, as the file states it. Throws BAD_ARGUMENT,
 * OUT_OF_MEMORY, DISPOSED.
 */
export function setLevelOfDetail(character: BendyCharacter, share: number): number {
  const lod = new LevelOfDetail(character.model, share);
  try {
    for (const { object, mesh, submeshes } of character.parts) {
      const all = lod.indices(mesh);
      const index = object.geometry.index!;
      let count = 0;
      for (const number of submeshes) {
        const submesh = lod.submesh(number);
        index.array.set(all.subarray(submesh.first, submesh.first + submesh.count), count);
        count += submesh.count;
      }
      index.needsUpdate = true;
      object.geometry.setDrawRange(0, count);
    }
    return lod.error;
  } finally {
    lod.dispose();
  }
}
