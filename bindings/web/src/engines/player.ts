// What the adapters for Babylon.js and PlayCanvas share: a model that plays, and which meshes an engine can skin by itself.
import { BendyError, type Clip, CrossFade, type Image, type Key, type Mesh, Model, type OpenOptions, type PlayOptions, Playback, type Pose, type Texture } from '../index.js';
import { openNames } from '../model.js';
import { checkNumber } from '../numbers.js';
import { checkOptions, optionNames } from '../options.js';

/** A file: its bytes, or its address. */
export type Source = ArrayBuffer | Uint8Array | string | URL;

/** Options of an adapter's loader. */
export interface EngineOptions extends OpenOptions {
  /**
   * Who skins the vertices. `gpu`, if not given: the engine, by the palettes that the runtime computes, except for meshes that it
   * cannot skin: those with morph targets, with more influences per vertex than it takes, and rigid ones. `wasm`: the runtime.
   */
  skin?: 'gpu' | 'wasm';
}

/** Options for playing a clip. */
export interface ClipOptions extends Omit<PlayOptions, 'playback'> {
  /** 1, if not given: as authored. */
  speed?: number;
  /** Whether the clip repeats. If not given: unless its `extras` have `"loop": false`. */
  loop?: boolean;
}

const clipNames = optionNames<ClipOptions>({ fade: true, easing: true, speed: true, loop: true });
const engineNames = [...openNames, 'skin'];

/** Whether a clip repeats if the caller does not say. `clip.loops` does not decide: glTF has no such flag, so it is false in most files. */
export function repeats({ extras }: Clip): boolean {
  const loop = (extras as { loop?: unknown } | null)?.loop;
  return loop !== false && loop !== 0; // 0: as Blender writes booleans
}

/** Starts a clip that fades in over what plays. Throws NOT_FOUND, BAD_ARGUMENT. */
export function startClip(fade: CrossFade, clip: Key<Clip>, given: ClipOptions = {}): void {
  checkOptions('play', given, clipNames);
  const { speed, loop, ...options } = given;
  const playback = new Playback(fade.model, clip);
  try {
    if (speed !== undefined) playback.speed = speed;
    playback.mode = (loop ?? repeats(playback.clip)) ? 'repeat' : 'once';
    if (playback.speed < 0) playback.seekShare(1);
    fade.play(clip, { ...options, playback });
  } finally {
    playback.dispose();
  }
}

/** A character that plays clips. A subclass writes the pose to the objects of an engine. */
export abstract class Player {
  readonly model: Model;
  /** The current pose, for anything that the methods here do not offer: `apply` writes it. */
  readonly pose: Pose;
  readonly #fade: CrossFade;

  /** @internal */
  constructor(model: Model) {
    this.model = model;
    this.pose = model.pose();
    this.#fade = new CrossFade(model);
  }

  /** Starts a clip, which `update` plays and which fades in over what plays now. Throws NOT_FOUND, BAD_ARGUMENT. */
  play(clip: Key<Clip>, options: ClipOptions = {}): this {
    this.#check();
    startClip(this.#fade, clip, options);
    return this;
  }

  /**
   * Advances what plays by seconds, sets the pose to it and writes it. `adjust` is called in between: it may blend and reach. If
   * nothing plays, the pose stays, and is written.
   */
  update(seconds: number, adjust?: (pose: Pose) => void): this {
    this.#check();
    checkNumber(seconds, 'seconds');
    if (this.#fade.playing.length > 0) this.#fade.advance(seconds).sample(this.pose);
    adjust?.(this.pose);
    return this.apply();
  }

  /** Writes the pose. */
  abstract apply(): this;

  #check(): void {
    if (this.pose.disposed) throw new BendyError('disposed', 'this character has been disposed');
  }

  /** Removes the character from the engine, and releases its memory and its model. */
  dispose(): void {
    this.#fade.dispose();
    this.pose.dispose();
    this.model.dispose();
  }
}

/** Opens a file and makes a character of it. What fails leaves no memory in use. */
export async function loadCharacter<T>(source: Source, given: EngineOptions, make: (model: Model) => T): Promise<T> {
  checkOptions('loadBendy', given, engineNames);
  const { skin: _, ...options } = given;
  const model = await Model.open(source, options);
  try {
    return make(model);
  } catch (error) {
    model.dispose();
    throw error;
  }
}

/** Whether an engine that takes some influences per vertex can skin a mesh. */
export function canSkin(mesh: Mesh, influences: number, { skin }: EngineOptions): boolean {
  return skin !== 'wasm' && !mesh.isRigid && mesh.influenceCount <= influences && mesh.morphTargets.length === 0;
}

/** Four of a mesh's influences per vertex, from influence `first` on, padded with weight 0. */
export function fourInfluences(mesh: Mesh, first: number): { bones: Float32Array; weights: Float32Array } {
  const four = { bones: new Float32Array(4 * mesh.vertexCount), weights: new Float32Array(4 * mesh.vertexCount) };
  const { bones, weights, influenceCount } = mesh;
  const count = Math.min(4, influenceCount - first);
  for (let to = 0, from = first; to < four.bones.length; to += 4, from += influenceCount) {
    four.bones.set(bones.subarray(from, from + count), to);
    four.weights.set(weights.subarray(from, from + count), to);
  }
  return four;
}

/** The first image of a texture that browsers decode, embedded in the file; null if there is none. */
export function embeddedImage(texture: Texture): (Image & { bytes: Uint8Array<ArrayBuffer> }) | null {
  const found = texture.images.find((image) => image.bytes !== null && image.media !== 'ktx2' && image.media !== 'other');
  return (found as (Image & { bytes: Uint8Array<ArrayBuffer> }) | undefined) ?? null;
}

/** The media type of an image. */
export function mediaType({ media }: Image): string {
  return `image/${media}`;
}
