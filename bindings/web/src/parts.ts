// The parts of a model other than meshes and clips, as plain objects.
import type {
  BendyChain,
  BendyConstraint,
  BendyImage,
  BendyJoint,
  BendyJointSubmesh,
  BendyMaterial,
  BendySubmesh,
  BendyTexture,
  BendyTextureUse,
  BendyTransform,
} from './generated/bindings.js';
import type { Item } from './items.js';
import type { Model } from './model.js';

/** Three numbers: x, y, z. */
export type Vector3 = [number, number, number];
/** A unit quaternion: x, y, z, w. */
export type Quaternion = [number, number, number, number];

/** A transform relative to the parent: translation * rotation * scale. */
export interface Transform extends BendyTransform {}

/** A joint of the skeleton. */
export interface Joint extends Item, BendyJoint {}

/** An IK chain: the joints on the path from the effector up to the start. */
export interface Chain extends Item, Omit<BendyChain, 'links'> {
  /** The numbers of its joints, from start to effector. */
  readonly links: readonly number[];
  /** How much each link turns, 0 to 1. */
  readonly weights: readonly number[];
}

/** A joint's limits. Rotations are relative to the rest pose, about the axes of `frame`. */
export interface Constraint extends BendyConstraint {
  readonly number: number;
}

/** A draw call: a range of a mesh's indices with one material. */
export interface Submesh extends BendySubmesh {
  readonly number: number;
}

/** A range of a mesh's index list that belongs to one joint. */
export interface JointSubmesh extends BendyJointSubmesh {
  readonly number: number;
}

/** How a material uses a texture. */
export interface TextureUse extends Readonly<BendyTextureUse> {}

/** A material of glTF's metallic-roughness model; colour textures are multiplied with the colours. */
export interface Material extends Item, BendyMaterial {}

/** One encoding of a texture's image: embedded bytes, or a link relative to the file. */
export interface Image extends Omit<BendyImage, 'bytes' | 'byteCount' | 'uri'> {
  /** A copy of the encoded image; null for a link. */
  readonly bytes: Uint8Array<ArrayBuffer> | null;
  /** As the file's author wrote it: where it leads is for the reader to check, by what it resolves to. Null for embedded bytes. */
  readonly uri: string | null;
}

/** A sampler and one or more encodings of the same image, in order of preference. */
export interface Texture extends Item, Omit<BendyTexture, 'images'> {
  readonly images: readonly Image[];
}

export function readChain(model: Model, number: number): Chain {
  const { calls } = model.runtime;
  const chain = calls.bendy_get_chain(model, number);
  const { joints, weights } = calls.bendy_get_links(model, number, chain.links);
  return { ...chain, number, links: Array.from(joints), weights: Array.from(weights) };
}

function readImage(model: Model, texture: number, image: number): Image {
  const { runtime } = model;
  const { bytes, byteCount, uri, ...fields } = runtime.calls.bendy_get_image(model, texture, image);
  const isLink = bytes === 0;
  return { ...fields, bytes: isLink ? null : runtime.bytes.slice(bytes, bytes + byteCount), uri: isLink ? uri : null };
}

export function readTexture(model: Model, number: number): Texture {
  const texture = model.runtime.calls.bendy_get_texture(model, number);
  return { ...texture, number, images: Array.from({ length: texture.images }, (_, image) => readImage(model, number, image)) };
}
