import {
  Color,
  DoubleSide,
  LinearSRGBColorSpace,
  LineBasicMaterial,
  Material as ThreeMaterial,
  MeshBasicMaterial,
  MeshPhysicalMaterial,
  MeshStandardMaterial,
  PointsMaterial,
  SRGBColorSpace,
  type Texture,
  Vector2,
} from 'three';
import type { Material, Model, Submesh, TextureUse } from '../index.js';
import type { Textures } from './textures.js';

/** A member of a glTF extension: the property of MeshPhysicalMaterial, and its type. */
type Field = readonly [property: string, kind: 'number' | 'colour' | 'texture' | 'colour texture'];

/** glTF's material extensions: what three.js sets for each when the extension is present, and its members. */
const extensions: Record<string, { readonly defaults: Record<string, unknown>; readonly fields: Record<string, Field> }> = {
  KHR_materials_clearcoat: {
    defaults: {},
    fields: {
      clearcoatFactor: ['clearcoat', 'number'],
      clearcoatTexture: ['clearcoatMap', 'texture'],
      clearcoatRoughnessFactor: ['clearcoatRoughness', 'number'],
      clearcoatRoughnessTexture: ['clearcoatRoughnessMap', 'texture'],
      clearcoatNormalTexture: ['clearcoatNormalMap', 'texture'],
    },
  },
  KHR_materials_diffuse_roughness: {
    defaults: { diffuseRoughness: 0 },
    fields: {
      diffuseRoughnessFactor: ['diffuseRoughness', 'number'],
      diffuseRoughnessTexture: ['diffuseRoughnessMap', 'texture'],
    },
  },
  KHR_materials_dispersion: { defaults: {}, fields: { dispersion: ['dispersion', 'number'] } },
  KHR_materials_iridescence: {
    defaults: {},
    fields: {
      iridescenceFactor: ['iridescence', 'number'],
      iridescenceTexture: ['iridescenceMap', 'texture'],
      iridescenceIor: ['iridescenceIOR', 'number'],
      iridescenceThicknessMinimum: ['iridescenceThicknessMinimum', 'number'],
      iridescenceThicknessMaximum: ['iridescenceThicknessMaximum', 'number'],
      iridescenceThicknessTexture: ['iridescenceThicknessMap', 'texture'],
    },
  },
  KHR_materials_sheen: {
    defaults: { sheen: 1, sheenRoughness: 0 },
    fields: {
      sheenColorFactor: ['sheenColor', 'colour'],
      sheenColorTexture: ['sheenColorMap', 'colour texture'],
      sheenRoughnessFactor: ['sheenRoughness', 'number'],
      sheenRoughnessTexture: ['sheenRoughnessMap', 'texture'],
    },
  },
  KHR_materials_transmission: {
    defaults: {},
    fields: { transmissionFactor: ['transmission', 'number'], transmissionTexture: ['transmissionMap', 'texture'] },
  },
  KHR_materials_volume: {
    defaults: {},
    fields: {
      thicknessFactor: ['thickness', 'number'],
      thicknessTexture: ['thicknessMap', 'texture'],
      attenuationDistance: ['attenuationDistance', 'number'],
      attenuationColor: ['attenuationColor', 'colour'],
    },
  },
  KHR_materials_ior: { defaults: {}, fields: { ior: ['ior', 'number'] } },
  KHR_materials_specular: {
    defaults: {},
    fields: {
      specularFactor: ['specularIntensity', 'number'],
      specularTexture: ['specularIntensityMap', 'texture'],
      specularColorFactor: ['specularColor', 'colour'],
      specularColorTexture: ['specularColorMap', 'colour texture'],
    },
  },
  EXT_materials_bump: {
    defaults: {},
    fields: { bumpFactor: ['bumpScale', 'number'], bumpTexture: ['bumpMap', 'texture'] },
  },
  KHR_materials_anisotropy: {
    defaults: {},
    fields: {
      anisotropyStrength: ['anisotropy', 'number'],
      anisotropyRotation: ['anisotropyRotation', 'number'],
      anisotropyTexture: ['anisotropyMap', 'texture'],
    },
  },
};

type Json = Record<string, unknown>;

/** JSON of a file can have any form: anything that glTF does not define is ignored. */
function asObject(value: unknown): Json | null {
  return typeof value === 'object' && value !== null && !Array.isArray(value) ? (value as Json) : null;
}

function numbersOf(value: unknown, count: number): number[] | null {
  return Array.isArray(value) && value.length === count && value.every((x) => typeof x === 'number') ? value : null;
}

function numberOf(value: unknown): number | null {
  return typeof value === 'number' ? value : null;
}

/** A textureInfo of glTF, with KHR_texture_transform, as a TextureUse. */
function textureUse(value: unknown, textureCount: number): TextureUse | null {
  const info = asObject(value);
  const texture = numberOf(info?.['index']);
  if (info === null || texture === null || !(texture >= 0 && texture < textureCount && Number.isInteger(texture))) return null;
  const transform = asObject(asObject(info['extensions'])?.['KHR_texture_transform']);
  return {
    texture,
    set: numberOf(transform?.['texCoord']) ?? numberOf(info['texCoord']) ?? 0,
    offset: (numbersOf(transform?.['offset'], 2) ?? [0, 0]) as [number, number],
    scale: (numbersOf(transform?.['scale'], 2) ?? [1, 1]) as [number, number],
    rotation: numberOf(transform?.['rotation']) ?? 0,
  };
}

function linear(colour: readonly number[]): Color {
  return new Color().setRGB(colour[0]!, colour[1]!, colour[2]!, LinearSRGBColorSpace);
}

/** Assigns the properties that the installed version of three.js has. */
function assign(material: ThreeMaterial, properties: Json): void {
  for (const [name, value] of Object.entries(properties)) {
    if (name in material) (material as unknown as Json)[name] = value;
  }
}

async function readExtensions(material: Material, textures: Textures, textureCount: number): Promise<Json> {
  const properties: Json = {};
  const loading: Promise<void>[] = [];
  const given = asObject(material.extensions) ?? {};
  for (const [name, { defaults, fields }] of Object.entries(extensions)) {
    const extension = asObject(given[name]);
    if (extension === null) continue;
    Object.assign(properties, defaults);
    for (const [member, [property, kind]] of Object.entries(fields)) {
      const value = extension[member];
      if (kind === 'number') {
        const number = numberOf(value);
        if (number !== null) properties[property] = number;
      } else if (kind === 'colour') {
        const colour = numbersOf(value, 3);
        if (colour !== null) properties[property] = linear(colour);
      } else {
        const use = textureUse(value, textureCount);
        if (use === null) continue;
        const texture = textures.use(use, kind === 'colour texture' ? SRGBColorSpace : undefined);
        loading.push(texture.then((loaded) => void (loaded !== null && (properties[property] = loaded))));
        const scale = numberOf(asObject(value)?.['scale']);
        if (member === 'clearcoatNormalTexture' && scale !== null) properties['clearcoatNormalScale'] = new Vector2(scale, scale);
      }
    }
  }
  await Promise.all(loading);
  if (properties['ior'] === 0) properties['ior'] = 1000; // glTF: infinitely dense
  if (properties['attenuationDistance'] === 0) properties['attenuationDistance'] = Infinity;
  return properties;
}

/** The properties of a mesh that affect its material. */
export interface Surface {
  readonly topology: Submesh['topology'];
  readonly hasNormals: boolean;
  readonly hasTangents: boolean;
  readonly hasColours: boolean;
}

/** Makes three.js's materials from a model's, as GLTFLoader does. */
export class Materials {
  readonly #model: Model;
  readonly #textures: Textures;
  readonly #made = new Map<number | null, Promise<ThreeMaterial>>();
  readonly #variants = new Map<string, Promise<ThreeMaterial>>();

  constructor(model: Model, textures: Textures) {
    this.#model = model;
    this.#textures = textures;
  }

  /** The material for a mesh; `number` null: the default for submeshes without a material. */
  use(number: number | null, surface: Surface): Promise<ThreeMaterial> {
    const key = JSON.stringify([number, surface.topology, surface.hasNormals, surface.hasTangents, surface.hasColours]);
    let variant = this.#variants.get(key);
    if (variant === undefined) {
      let made = this.#made.get(number);
      if (made === undefined) {
        made =
          number === null
            ? Promise.resolve(new MeshStandardMaterial({ metalness: 1 }))
            : this.#make(this.#model.materials[number]!);
        this.#made.set(number, made);
      }
      variant = made.then((material) => adapt(material, surface));
      this.#variants.set(key, variant);
    }
    return variant;
  }

  async #make(source: Material): Promise<ThreeMaterial> {
    const texture = (use: TextureUse | null, colourSpace?: string): Promise<Texture | null> =>
      use === null ? Promise.resolve(null) : this.#textures.use(use, colourSpace);
    const given = asObject(source.extensions) ?? {};
    const isPhysical = Object.keys(extensions).some((name) => name in given);
    const Type = source.unlit ? MeshBasicMaterial : isPhysical ? MeshPhysicalMaterial : MeshStandardMaterial;
    const material = new Type();
    material.name = source.name;
    material.color = linear(source.baseColour);
    material.opacity = source.baseColour[3];
    const isLit = material instanceof MeshStandardMaterial;
    const lit = (use: TextureUse | null, colourSpace?: string): Promise<Texture | null> => texture(isLit ? use : null, colourSpace);
    const [map, roughnessMap, normalMap, aoMap, emissiveMap, extended] = await Promise.all([
      texture(source.baseColourTexture, SRGBColorSpace),
      lit(source.metallicRoughnessTexture),
      lit(source.normalTexture),
      lit(source.occlusionTexture),
      lit(source.emissiveTexture, SRGBColorSpace),
      isLit ? readExtensions(source, this.#textures, this.#model.textures.length) : Promise.resolve<Json>({}),
    ]);
    material.map = map;
    if (source.doubleSided) material.side = DoubleSide;
    if (source.alphaMode === 'blend') {
      material.transparent = true;
      material.depthWrite = false;
    } else if (source.alphaMode === 'mask') {
      material.alphaTest = source.alphaCutoff;
    }
    if (isLit) {
      material.metalness = source.metallic;
      material.roughness = source.roughness;
      material.metalnessMap = material.roughnessMap = roughnessMap;
      material.normalMap = normalMap;
      material.normalScale.setScalar(source.normalTexture === null ? 1 : source.normalScale);
      material.aoMap = aoMap;
      if (source.occlusionTexture !== null) material.aoMapIntensity = source.occlusionStrength;
      material.emissive = linear(source.emissive);
      material.emissiveMap = emissiveMap;
      const strength = numberOf(asObject(given['KHR_materials_emissive_strength'])?.['emissiveStrength']);
      if (strength !== null) material.emissiveIntensity = strength;
      assign(material, extended);
      if (!('iridescenceThicknessMinimum' in material)) {
        // Older versions of three.js have one property for both.
        const { iridescenceThicknessMinimum: least, iridescenceThicknessMaximum: most } = extended;
        assign(material, { iridescenceThicknessRange: [least ?? 100, most ?? 400] });
      }
    }
    if (typeof source.extras === 'object') Object.assign(material.userData, source.extras);
    for (const [name, value] of Object.entries(given)) {
      if (name in extensions || name === 'KHR_materials_emissive_strength') continue;
      ((material.userData['gltfExtensions'] ??= {}) as Json)[name] = value;
    }
    return material;
  }
}

/** A copy of a material for a kind of mesh, if it needs one. */
function adapt(material: ThreeMaterial, { topology, hasNormals, hasTangents, hasColours }: Surface): ThreeMaterial {
  let adapted = material;
  const { color, map } = material as MeshBasicMaterial;
  if (topology !== 'triangles') {
    const Type = topology === 'points' ? PointsMaterial : LineBasicMaterial;
    const simple = new Type();
    ThreeMaterial.prototype.copy.call(simple, material);
    simple.color.copy(color);
    simple.map = map;
    if (simple instanceof PointsMaterial) simple.sizeAttenuation = false; // glTF's points are one pixel wide
    adapted = simple;
  }
  if (hasNormals && hasTangents && !hasColours) return adapted;
  adapted = adapted.clone();
  if (hasColours) adapted.vertexColors = true;
  if (!hasNormals) assign(adapted, { flatShading: true });
  if (!hasTangents) {
    // Without tangents three.js computes them in the shader, for texture coordinates that run upwards.
    if (adapted instanceof MeshStandardMaterial) adapted.normalScale.y *= -1;
    if (adapted instanceof MeshPhysicalMaterial) adapted.clearcoatNormalScale.y *= -1;
  }
  return adapted;
}
