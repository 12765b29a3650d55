// What a model consists of besides meshes and clips, as plain objects.
import {
  alphaModeWords,
  chainLayout,
  constraintLayout,
  constraintModelWords,
  constraintScopeWords,
  eulerOrderWords,
  filterWords,
  imageLayout,
  jointLayout,
  materialLayout,
  mediaWords,
  readBendyChain,
  readBendyConstraint,
  readBendyImage,
  readBendyJoint,
  readBendyMaterial,
  readBendySubmesh,
  readBendyTexture,
  type BendyTextureUse,
  solverWords,
  submeshLayout,
  textureLayout,
  topologyWords,
  wrapWords,
} from './generated/bindings.js';
import type { Item } from './items.js';
import { none, type Runtime } from './runtime.js';

/** Three numbers: x, y, z. */
export type Vector3 = [number, number, number];
/** A unit quaternion: x, y, z, w. */
export type Quaternion = [number, number, number, number];

/** A transform relative to the parent: translation * rotation * scale. */
export interface Transform {
  /** Unit quaternion x, y, z, w. */
  rotation: Quaternion;
  /** Metres. */
  translation: Vector3;
  /** Along the joint's axes; may be negative or zero. */
  scale: Vector3;
}

/** A joint of the skeleton. */
export interface Joint extends Item {
  /** The number of the parent, smaller than the joint's own, or null for a root. */
  readonly parent: number | null;
  /** The transform at rest. */
  readonly rest: Readonly<Transform>;
  /** xy, xz, yz: the elements above the diagonal of the scale matrix, which never change. */
  readonly shear: Readonly<Vector3>;
  /** Application-specific data: JSON, parsed; null if there is none. */
  readonly extras: unknown;
}

/** How a chain is solved: the solver that the file names (`any`), or one in particular. */
export type Solver = (typeof solverWords)[number];

/** An IK chain: the joints on the path from the effector up to the start. */
export interface Chain extends Item {
  /** The numbers of its joints, from start to effector. */
  readonly links: readonly number[];
  /** For each link how much it turns, 0 to 1. */
  readonly weights: readonly number[];
  /** The joint that the chain follows in `reachAll`, or null. */
  readonly target: number | null;
  /** The joint to bend towards, or null. */
  readonly pole: number | null;
  readonly solver: Solver;
  /** Whether the converter has guessed it. */
  readonly isProposed: boolean;
  /** Chains with a higher one are solved later and override the others. */
  readonly priority: number;
  /** 0 to 1: how far `reachAll` blends the solution into the pose. */
  readonly influence: number;
  /** Metres: the position of the tip in the effector's space. */
  readonly tipOffset: Readonly<Vector3>;
  readonly extras: unknown;
}

/** What a joint may do. Rotations are relative to the rest pose, about the axes of `frame`. */
export interface Constraint {
  readonly number: number;
  readonly joint: number;
  readonly model: (typeof constraintModelWords)[number];
  readonly eulerOrder: (typeof eulerOrderWords)[number];
  /** Where it holds: in every pose, in IK only, in all but IK. */
  readonly scope: (typeof constraintScopeWords)[number];
  /** Whether the converter has guessed it. */
  readonly isProposed: boolean;
  /** Unit quaternion: its X is the twist or hinge axis, its Y and Z the swing axes. */
  readonly frame: Readonly<Quaternion>;
  /** Radians about X, Y, Z of the frame; infinite where it is free. */
  readonly rotationMin: Readonly<Vector3>;
  readonly rotationMax: Readonly<Vector3>;
  /** Metres from the rest translation, along X, Y, Z of the frame; infinite where it is free. */
  readonly translationMin: Readonly<Vector3>;
  readonly translationMax: Readonly<Vector3>;
  /** 0 to 1 about X, Y, Z: how much an IK solver resists turning. */
  readonly stiffness: Readonly<Vector3>;
}

/** A draw call: a range of a mesh's indices with one material. */
export interface Submesh {
  readonly number: number;
  readonly mesh: number;
  readonly material: number | null;
  readonly topology: (typeof topologyWords)[number];
  /** Index into the mesh's index list. */
  readonly first: number;
  /** Number of indices. */
  readonly count: number;
}

/** How a material uses a texture. */
export interface TextureUse {
  readonly texture: number;
  /** The set of texture coordinates. */
  readonly set: number;
  /** Added to the coordinates after scale and rotation. */
  readonly offset: readonly [number, number];
  readonly scale: readonly [number, number];
  /** Radians, counter-clockwise about the origin. */
  readonly rotation: number;
}

/** A material of glTF's metallic-roughness model; colour textures are multiplied with the colours. */
export interface Material extends Item {
  /** Linear red, green, blue, alpha; 0 to 1. */
  readonly baseColour: readonly [number, number, number, number];
  /** Linear red, green, blue. */
  readonly emissive: Readonly<Vector3>;
  readonly metallic: number;
  readonly roughness: number;
  readonly alphaMode: (typeof alphaModeWords)[number];
  /** With `mask`, what has less alpha is not drawn. */
  readonly alphaCutoff: number;
  readonly doubleSided: boolean;
  /** Whether only the base colour is used, without lights. */
  readonly unlit: boolean;
  /** The factor of x and y of the normal texture. */
  readonly normalScale: number;
  readonly occlusionStrength: number;
  readonly baseColourTexture: TextureUse | null;
  readonly metallicRoughnessTexture: TextureUse | null;
  readonly normalTexture: TextureUse | null;
  readonly occlusionTexture: TextureUse | null;
  readonly emissiveTexture: TextureUse | null;
  /** The glTF source's extensions, and application-specific data: JSON, parsed; null if there is none. */
  readonly extensions: unknown;
  readonly extras: unknown;
}

/** One encoding of a texture's image: embedded bytes, or a link relative to the file. */
export interface Image {
  readonly media: (typeof mediaWords)[number];
  /** A copy of the encoded image; null for a link. */
  readonly bytes: Uint8Array<ArrayBuffer> | null;
  readonly uri: string | null;
}

/** A sampler and one or more encodings of the same image, in order of preference. */
export interface Texture extends Item {
  readonly images: readonly Image[];
  readonly magFilter: (typeof filterWords)[number];
  readonly minFilter: (typeof filterWords)[number];
  readonly wrapS: (typeof wrapWords)[number];
  readonly wrapT: (typeof wrapWords)[number];
  readonly extras: unknown;
}

/** An index that may be "none". */
export function orNull(index: number): number | null {
  return index === none ? null : index;
}

/** JSON of a file, which the format does not check. */
export function parseJson(text: string): unknown {
  if (text === '') return null;
  try {
    return JSON.parse(text) as unknown;
  } catch {
    return text;
  }
}

const isProposed = 2;

export function readJoint(runtime: Runtime, model: number, number: number): Joint {
  const out = runtime.struct(jointLayout);
  runtime.check(runtime.functions.bendy_get_joint(model, number, out, runtime.error));
  const { name, parent, rest, shear, extras } = readBendyJoint(runtime, out);
  return { name, number, parent: orNull(parent), rest, shear, extras: parseJson(extras) };
}

export function readChain(runtime: Runtime, model: number, number: number): Chain {
  const out = runtime.struct(chainLayout);
  runtime.check(runtime.functions.bendy_get_chain(model, number, out, runtime.error));
  const raw = readBendyChain(runtime, out);
  const count = raw.links;
  return runtime.borrow(8 * count, (at) => {
    runtime.check(runtime.functions.bendy_get_links(model, number, at, at + 4 * count, count, runtime.error));
    return {
      name: raw.name,
      number,
      links: Array.from(runtime.copyIntegers(at, count)),
      weights: Array.from(runtime.copyFloats(at + 4 * count, count)),
      target: orNull(raw.target),
      pole: orNull(raw.pole),
      solver: solverWords[raw.solver]!,
      isProposed: (raw.flags & isProposed) !== 0,
      priority: raw.priority,
      influence: raw.influence,
      tipOffset: raw.tipOffset,
      extras: parseJson(raw.extras),
    };
  });
}

export function readConstraint(runtime: Runtime, model: number, number: number): Constraint {
  const out = runtime.struct(constraintLayout);
  runtime.check(runtime.functions.bendy_get_constraint(model, number, out, runtime.error));
  const raw = readBendyConstraint(runtime, out);
  return {
    number,
    joint: raw.joint,
    model: constraintModelWords[raw.model]!,
    eulerOrder: eulerOrderWords[raw.eulerOrder]!,
    scope: constraintScopeWords[raw.scope]!,
    isProposed: (raw.flags & isProposed) !== 0,
    frame: raw.frame,
    rotationMin: raw.rotationMin,
    rotationMax: raw.rotationMax,
    translationMin: raw.translationMin,
    translationMax: raw.translationMax,
    stiffness: raw.stiffness,
  };
}

/** Reads the submesh that a call has written to the scratch memory. */
export function submeshAt(runtime: Runtime, at: number, number: number): Submesh {
  const { mesh, material, topology, first, count } = readBendySubmesh(runtime, at);
  return { number, mesh, material: orNull(material), topology: topologyWords[topology]!, first, count };
}

export function readSubmesh(runtime: Runtime, model: number, number: number): Submesh {
  const out = runtime.struct(submeshLayout);
  runtime.check(runtime.functions.bendy_get_submesh(model, number, out, runtime.error));
  return submeshAt(runtime, out, number);
}

function textureUse(raw: BendyTextureUse): TextureUse | null {
  return raw.texture === none ? null : raw;
}

export function readMaterial(runtime: Runtime, model: number, number: number): Material {
  const out = runtime.struct(materialLayout);
  runtime.check(runtime.functions.bendy_get_material(model, number, out, runtime.error));
  const { more: _, ...raw } = readBendyMaterial(runtime, out);
  return {
    ...raw,
    number,
    doubleSided: raw.doubleSided !== 0,
    alphaMode: alphaModeWords[raw.alphaMode]!,
    unlit: raw.unlit !== 0,
    baseColourTexture: textureUse(raw.baseColourTexture),
    metallicRoughnessTexture: textureUse(raw.metallicRoughnessTexture),
    normalTexture: textureUse(raw.normalTexture),
    occlusionTexture: textureUse(raw.occlusionTexture),
    emissiveTexture: textureUse(raw.emissiveTexture),
    extensions: parseJson(raw.extensions),
    extras: parseJson(raw.extras),
  };
}

function readImage(runtime: Runtime, model: number, texture: number, image: number): Image {
  const out = runtime.struct(imageLayout);
  runtime.check(runtime.functions.bendy_get_image(model, texture, image, out, runtime.error));
  const { media, bytes, byteCount, uri } = readBendyImage(runtime, out);
  return {
    media: mediaWords[media]!,
    bytes: bytes === 0 ? null : runtime.bytes.slice(bytes, bytes + byteCount),
    uri: bytes === 0 ? uri : null,
  };
}

export function readTexture(runtime: Runtime, model: number, number: number): Texture {
  const out = runtime.struct(textureLayout);
  runtime.check(runtime.functions.bendy_get_texture(model, number, out, runtime.error));
  const raw = readBendyTexture(runtime, out);
  return {
    name: raw.name,
    number,
    images: Array.from({ length: raw.images }, (_, image) => readImage(runtime, model, number, image)),
    magFilter: filterWords[raw.magFilter]!,
    minFilter: filterWords[raw.minFilter]!,
    wrapS: wrapWords[raw.wrapS]!,
    wrapT: wrapWords[raw.wrapT]!,
    extras: parseJson(raw.extras),
  };
}
