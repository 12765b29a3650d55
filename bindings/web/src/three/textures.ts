import {
  ClampToEdgeWrapping,
  ImageBitmapLoader,
  LinearFilter,
  LinearMipmapLinearFilter,
  LinearMipmapNearestFilter,
  type Loader,
  type MagnificationTextureFilter,
  type MinificationTextureFilter,
  MirroredRepeatWrapping,
  NearestFilter,
  NearestMipmapLinearFilter,
  NearestMipmapNearestFilter,
  NoColorSpace,
  RepeatWrapping,
  Texture as ThreeTexture,
} from 'three';
import type { Image, Model, Texture, TextureUse } from '../index.js';
import { addressOfLink } from './links.js';

/** The part of three.js's KTX2Loader that decodes KTX2 images. */
export interface Ktx2Decoder {
  parse(bytes: ArrayBuffer, onLoad: (texture: ThreeTexture) => void, onError?: (error: unknown) => void): unknown;
}

/** The sources of images. */
export interface ImageOptions {
  readonly loader: Loader;
  /** The base of relative links. */
  readonly path: string;
  readonly ktx2: Ktx2Decoder | null;
  readonly allowsForeignLinks: boolean;
}

const filters = {
  unspecified: undefined,
  nearest: NearestFilter,
  linear: LinearFilter,
  nearest_mipmap_nearest: NearestMipmapNearestFilter,
  linear_mipmap_nearest: LinearMipmapNearestFilter,
  nearest_mipmap_linear: NearestMipmapLinearFilter,
  linear_mipmap_linear: LinearMipmapLinearFilter,
};
const wraps = { repeat: RepeatWrapping, clamp_to_edge: ClampToEdgeWrapping, mirrored_repeat: MirroredRepeatWrapping };

/** Makes three.js's textures from a model's. */
export class Textures {
  readonly #model: Model;
  readonly #options: ImageOptions;
  readonly #loaded = new Map<number, Promise<ThreeTexture | null>>();
  readonly #uses = new Map<string, Promise<ThreeTexture | null>>();
  /** Why textures have no image: one line for each image that was tried. */
  readonly warnings: string[] = [];

  constructor(model: Model, options: ImageOptions) {
    this.#model = model;
    this.#options = options;
  }

  /** The texture with a material's settings. Null if it has no image, or none that can be decoded. */
  use(use: TextureUse, colourSpace: string = NoColorSpace): Promise<ThreeTexture | null> {
    const key = JSON.stringify([use.texture, use.set, use.offset, use.scale, use.rotation, colourSpace]);
    const found = this.#uses.get(key);
    if (found !== undefined) return found;
    const made = this.#load(use.texture).then((loaded) => {
      if (loaded === null) return null;
      const texture = loaded.clone(); // shares the image
      texture.channel = use.set;
      texture.colorSpace = colourSpace;
      texture.offset.fromArray(use.offset);
      texture.repeat.fromArray(use.scale);
      texture.rotation = use.rotation;
      if (use.rotation !== 0) {
        // three.js rotates before scaling, glTF and Bendy after scaling.
        const [u, v] = use.scale;
        const [c, s] = [Math.cos(use.rotation), Math.sin(use.rotation)];
        texture.matrix.set(u * c, v * s, use.offset[0], -u * s, v * c, use.offset[1], 0, 0, 1);
        texture.matrixAutoUpdate = false;
      }
      return texture;
    });
    this.#uses.set(key, made);
    return made;
  }

  #load(number: number): Promise<ThreeTexture | null> {
    let loaded = this.#loaded.get(number);
    if (loaded === undefined) {
      loaded = this.#make(this.#model.textures[number]!);
      this.#loaded.set(number, loaded);
    }
    return loaded;
  }

  async #make(source: Texture): Promise<ThreeTexture | null> {
    const texture = await this.#decode(source);
    if (texture === null) return null;
    const uri = source.images.find((image) => image.uri !== null)?.uri;
    texture.name = source.name || (uri && !/^data:/i.test(uri) ? uri : '');
    texture.flipY = false;
    texture.magFilter = (filters[source.magFilter] ?? LinearFilter) as MagnificationTextureFilter;
    texture.minFilter = (filters[source.minFilter] ?? LinearMipmapLinearFilter) as MinificationTextureFilter;
    texture.wrapS = wraps[source.wrapS];
    texture.wrapT = wraps[source.wrapT];
    texture.generateMipmaps =
      !('isCompressedTexture' in texture) && texture.minFilter !== NearestFilter && texture.minFilter !== LinearFilter;
    if (typeof source.extras === 'object') Object.assign(texture.userData, source.extras);
    return texture;
  }

  /** The first of the images that can be decoded. */
  async #decode(source: Texture): Promise<ThreeTexture | null> {
    const reasons: string[] = [];
    for (const image of source.images) {
      try {
        const texture = await this.#decodeImage(image);
        if (texture === null) throw new Error(image.media === 'ktx2' ? 'KTX2 images need a KTX2Loader' : 'it has no bytes and no link');
        if (image.media !== 'other') texture.userData['mimeType'] = `image/${image.media}`;
        return texture;
      } catch (error) {
        const why = error instanceof Error ? error.message : String(error);
        const name = image.uri === null || /^data:/i.test(image.uri) ? '' : ` ${image.uri.replace(/\p{Cc}/gu, encodeURIComponent)}`;
        reasons.push(`the image${name} of texture ${source.number} cannot be loaded: ${why}`);
        console.warn(`BendyLoader: ${reasons.at(-1)}`);
      }
    }
    this.warnings.push(...reasons);
    return null;
  }

  async #decodeImage({ media, bytes, uri }: Image): Promise<ThreeTexture | null> {
    const { loader, path, ktx2, allowsForeignLinks } = this.#options;
    if (bytes !== null) {
      if (media === 'ktx2') {
        if (ktx2 === null) return null;
        return new Promise<ThreeTexture>((resolve, reject) => ktx2.parse(bytes.buffer, resolve, reject));
      }
      if (typeof createImageBitmap === 'undefined') return new ThreeTexture();
      const blob = new Blob([bytes], media === 'other' ? {} : { type: `image/${media}` });
      return ofBitmap(await createImageBitmap(blob, { premultiplyAlpha: 'none', colorSpaceConversion: 'none' }));
    }
    if (uri === null) return null;
    const url = addressOfLink(uri, path, allowsForeignLinks);
    const handler = loader.manager.getHandler(uri);
    if (handler !== null) return (await handler.loadAsync(url)) as ThreeTexture;
    if (typeof createImageBitmap === 'undefined') return new ThreeTexture();
    const bitmaps = new ImageBitmapLoader(loader.manager)
      .setCrossOrigin(loader.crossOrigin)
      .setWithCredentials(loader.withCredentials)
      .setRequestHeader(loader.requestHeader);
    return ofBitmap(await bitmaps.loadAsync(url));
  }
}

function ofBitmap(bitmap: ImageBitmap): ThreeTexture {
  const texture = new ThreeTexture(bitmap);
  texture.needsUpdate = true;
  return texture;
}
