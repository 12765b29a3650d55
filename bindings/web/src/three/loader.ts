import { FileLoader, Loader, LoaderUtils, type LoadingManager } from 'three';
import { BendyError, init, Model, type OpenOptions } from '../index.js';
import { described } from '../errors.js';
import { type BendyCharacter, makeCharacter } from './character.js';
import { type Ktx2Decoder, Textures } from './textures.js';

/**
 * Loads bendy files as GLTFLoader loads glTF: AnimationMixer, SkeletonHelper and react-three-fiber's `useLoader` take the result.
 *
 *     const { scene, animations } = await new BendyLoader().loadAsync('fox.bendy');
 */
export class BendyLoader extends Loader<BendyCharacter> {
  /** Options for opening files: which object of a file, and in which instance of the runtime. */
  openOptions: OpenOptions = {};
  /** Whether to load images from addresses outside the folder of the file. */
  allowsForeignLinks = false;
  #ktx2: Ktx2Decoder | null = null;

  /** `manager`: three.js's default one if not given. */
  constructor(manager?: LoadingManager) {
    super(manager);
  }

  /** Decodes KTX2 images by a KTX2Loader. Without one, the next image of the texture is used, or none. */
  setKTX2Loader(loader: Ktx2Decoder | null): this {
    this.#ktx2 = loader;
    return this;
  }

  /** Starts loading the runtime's module before the first file needs it. `load` does so while it fetches the file. */
  preload(): this {
    // An error is reported with the next file.
    if (this.openOptions.runtime === undefined) init().catch(() => {});
    return this;
  }

  /** Loads a file. `onError` receives a BendyError: of kind `io` if the file cannot be fetched, otherwise as from `Model.open`. */
  override load(
    url: string,
    onLoad: (character: BendyCharacter) => void,
    onProgress?: (event: ProgressEvent) => void,
    onError?: (error: unknown) => void,
  ): void {
    if (typeof url !== 'string') {
      const found = url === undefined ? 'is missing' : `is ${described(url)}`;
      const error = new BendyError('bad_argument', `the address of the file ${found}: a text is expected; parseAsync takes bytes`);
      if (onError === undefined) throw error;
      return onError(error);
    }
    const base = LoaderUtils.extractUrlBase(url);
    const path = this.resourcePath || (this.path === '' ? base : LoaderUtils.resolveURL(base, this.path));
    this.preload();
    this.manager.itemStart(url);
    const fail = (error: unknown): void => {
      if (onError === undefined) console.error(error);
      else onError(error);
      this.manager.itemError(url);
      this.manager.itemEnd(url);
    };
    const file = new FileLoader(this.manager);
    file.setPath(this.path);
    file.setResponseType('arraybuffer');
    file.setRequestHeader(this.requestHeader);
    file.setWithCredentials(this.withCredentials);
    const parse = (bytes: string | ArrayBuffer): void =>
      this.parse(
        bytes as ArrayBuffer,
        path,
        (character) => {
          onLoad(character);
          this.manager.itemEnd(url);
        },
        fail,
      );
    file.load(url, parse, onProgress, (error) =>
      fail(
        Object.assign(new BendyError('io', `${url}: ${error instanceof Error ? error.message : String(error)}`), {
          cause: error,
        }),
      ),
    );
  }

  /** Makes a character from the bytes of a file. Links to images are relative to `path`. */
  parse(
    bytes: ArrayBuffer | Uint8Array,
    path: string,
    onLoad: (character: BendyCharacter) => void,
    onError?: (error: unknown) => void,
  ): void {
    this.parseAsync(bytes, path).then(onLoad, onError ?? console.error);
  }

  /** As `parse`. Rejects with the BendyError of `Model.open`. */
  async parseAsync(bytes: ArrayBuffer | Uint8Array, path = ''): Promise<BendyCharacter> {
    const model = await Model.open(bytes, this.openOptions);
    const { allowsForeignLinks } = this;
    const textures = new Textures(model, { loader: this, path, ktx2: this.#ktx2, allowsForeignLinks });
    try {
      return await makeCharacter(model, textures);
    } catch (error) {
      model.dispose();
      throw error;
    }
  }
}
