// Converts the clips of a model to three.js.
import {
  AnimationClip,
  InterpolateDiscrete,
  InterpolateLinear,
  Interpolant,
  type KeyframeTrack,
  NumberKeyframeTrack,
  type Object3D,
  Quaternion,
  QuaternionKeyframeTrack,
  type TypedArray,
  VectorKeyframeTrack,
} from 'three';
import type { Clip, Model, Track } from '../index.js';
import type { Part } from './parts.js';

/** Cubic splines as glTF and Bendy have them: in-tangent, value and out-tangent of each key. */
class CubicInterpolant extends Interpolant {
  override copySampleValue_(key: number): TypedArray {
    const size = this.valueSize;
    for (let i = 0; i < size; ++i) this.resultBuffer[i] = this.sampleValues[(3 * key + 1) * size + i]!;
    return this.resultBuffer;
  }

  override interpolate_(key: number, t0: number, t: number, t1: number): TypedArray {
    const size = this.valueSize;
    const values = this.sampleValues;
    const before = 3 * (key - 1) * size;
    const after = 3 * key * size;
    const d = t1 - t0;
    const u = (t - t0) / d;
    const [u2, u3] = [u * u, u * u * u];
    for (let i = 0; i < size; ++i) {
      this.resultBuffer[i] =
        (2 * u3 - 3 * u2 + 1) * values[before + size + i]! +
        d * (u3 - 2 * u2 + u) * values[before + 2 * size + i]! +
        (3 * u2 - 2 * u3) * values[after + size + i]! +
        d * (u3 - u2) * values[after + i]!;
    }
    return this.resultBuffer;
  }
}

const rotation = new Quaternion();

class CubicRotationInterpolant extends CubicInterpolant {
  override copySampleValue_(key: number): TypedArray {
    return this.#normalise(super.copySampleValue_(key));
  }

  override interpolate_(key: number, t0: number, t: number, t1: number): TypedArray {
    return this.#normalise(super.interpolate_(key, t0, t, t1));
  }

  #normalise(result: TypedArray): TypedArray {
    rotation
      .fromArray(result as Float32Array)
      .normalize()
      .toArray(result as Float32Array);
    return result;
  }
}

const trackTypes = {
  translation: VectorKeyframeTrack,
  rotation: QuaternionKeyframeTrack,
  scale: VectorKeyframeTrack,
  weights: NumberKeyframeTrack,
};
const properties = { translation: 'position', rotation: 'quaternion', scale: 'scale', weights: 'morphTargetInfluences' };

/** Numbers of a pose at rest and at several times, `size` at each. */
interface Frames {
  rest: Float32Array;
  size: number;
  frames: Float32Array;
}

type Keys = Pick<Track, 'path' | 'target' | 'interpolation' | 'times' | 'values'>;

function makeTrack(object: Object3D, { path, interpolation, times, values }: Keys): KeyframeTrack {
  const mode = interpolation === 'step' ? InterpolateDiscrete : InterpolateLinear;
  // The constructor's types ask for arrays of numbers, but it accepts typed arrays.
  const [keys, numbers] = [times, values] as unknown as [number[], number[]];
  const track = new trackTypes[path](`${object.name || object.uuid}.${properties[path]}`, keys, numbers, mode);
  if (interpolation !== 'cubic') return track;
  const Type = path === 'rotation' ? CubicRotationInterpolant : CubicInterpolant;
  // KeyframeTrack.clone copies this method, and GLTFExporter looks for its mark.
  const factory = function (this: KeyframeTrack, result: TypedArray): Interpolant {
    return new Type(this.times, this.values, this.getValueSize() / 3, result);
  };
  return Object.assign(track, { createInterpolant: Object.assign(factory, { isInterpolantFactoryMethodGLTFCubicSpline: true }) });
}

/** The frame times of a clip that stores frames, and its ends: between these times it is linear. */
function frameTimes(clip: Clip): Float32Array<ArrayBuffer> {
  const count = clip.frameRate > 0 ? Math.floor(clip.seconds * clip.frameRate + 1e-3) : -1;
  const even = Float32Array.from({ length: count + 1 }, (_, k) => clip.start + k / clip.frameRate);
  const inside = [...clip.packedTimes, ...even].filter((time) => time > clip.start && time < clip.end);
  return Float32Array.from(new Set([clip.start, ...inside, clip.end])).sort();
}

/** The tracks of a clip that stores frames, sampled by the runtime. Properties that stay at rest get none. */
function sampledTracks(model: Model, clip: Clip): Keys[] {
  const times = frameTimes(clip);
  const pose = model.pose();
  const [locals, weights] = [pose.locals, pose.morphWeights].map((rest) => ({
    rest: rest.slice(),
    size: rest.length,
    frames: new Float32Array(times.length * rest.length),
  })) as [Frames, Frames];
  for (const [k, time] of times.entries()) {
    pose.sample(clip, time);
    locals.frames.set(pose.locals, k * locals.size);
    weights.frames.set(pose.morphWeights, k * weights.size);
  }
  pose.dispose();
  const stored = new Set(clip.tracks.map(({ path, target }) => `${path} ${target}`));
  const tracks: Keys[] = [];
  const add = (path: Track['path'], target: number, { rest, size, frames }: Frames, first: number, count: number): void => {
    let [isConstant, isRest] = [true, true];
    for (let c = first; c < first + count; ++c) {
      isRest &&= frames[c] === rest[c];
      for (let at = c; isConstant && at < frames.length; at += size) isConstant = frames[at] === frames[c];
    }
    if ((isConstant && isRest) || stored.has(`${path} ${target}`)) return;
    const keys = isConstant ? 1 : times.length;
    const values = new Float32Array(keys * count);
    for (let k = 0; k < keys; ++k) for (let c = 0; c < count; ++c) values[k * count + c] = frames[k * size + first + c]!;
    tracks.push({ path, target, interpolation: 'linear', times: times.subarray(0, keys), values });
  };
  for (const { number } of model.joints) {
    add('translation', number, locals, 10 * number + 4, 3);
    add('rotation', number, locals, 10 * number, 4);
    add('scale', number, locals, 10 * number + 7, 3);
  }
  for (const mesh of model.meshes) {
    const first = mesh.morphTargets[0]?.number;
    if (first !== undefined) add('weights', mesh.number, weights, first, mesh.morphTargets.length);
  }
  return tracks;
}

/** The tracks of a clip. Those of a clip that stores frames are sampled at these. */
function makeTracks(model: Model, clip: Clip, joints: readonly Object3D[], parts: readonly Part[]): KeyframeTrack[] {
  const keys: Keys[] = [...clip.tracks];
  // Clips that play whole frames of a mesh have a frame rate.
  const playsFrames = clip.frameRate > 0 && model.morphTargets.length > 0;
  if (clip.isPacked || playsFrames) keys.push(...sampledTracks(model, clip));
  return keys.flatMap((track) => {
    if (track.path !== 'weights') return [makeTrack(joints[track.target]!, track)];
    const objects = parts.filter(({ mesh, object }) => mesh === track.target && object.morphTargetInfluences !== undefined);
    return objects.map(({ object }) => makeTrack(object, track));
  });
}

/** Makes a clip whose tracks are made when they are first read. `done` is called when they have been made, or others set. */
export function lazyClip(name: string, duration: number, make: () => KeyframeTrack[], done?: () => void): AnimationClip {
  const clip = new AnimationClip(name, duration, []);
  const set = (tracks: KeyframeTrack[]): KeyframeTrack[] => {
    Object.defineProperty(clip, 'tracks', { value: tracks, writable: true, enumerable: true, configurable: true });
    done?.();
    return tracks;
  };
  Object.defineProperty(clip, 'tracks', { get: () => set(make()), set, enumerable: true, configurable: true });
  return clip;
}

/** Makes three.js's clips. Their tracks are made when they are first read, also when the model has been disposed by then. */
export function makeClips(model: Model, joints: readonly Object3D[], parts: readonly Part[]): AnimationClip[] {
  if (model.clips.length === 0) return [];
  const source = model.share();
  let unread = model.clips.length;
  const done = (): void => {
    if (--unread === 0) source.dispose();
  };
  return model.clips.map(({ name, number, end, extras }) => {
    const make = (): KeyframeTrack[] => makeTracks(source, source.clips[number]!, joints, parts);
    const made = lazyClip(name || `animation_${number}`, end, make, done);
    if (typeof extras === 'object') made.userData = { ...extras };
    return made;
  });
}
