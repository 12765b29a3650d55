// The clips of a model as three.js's.
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

type Keys = Pick<Track, 'path' | 'target' | 'interpolation' | 'times' | 'values'>;

function makeTrack(object: Object3D, { path, interpolation, times, values }: Keys): KeyframeTrack {
  const mode = interpolation === 'step' ? InterpolateDiscrete : InterpolateLinear;
  // The constructor types its arrays as arrays of numbers, and takes typed arrays.
  const [keys, numbers] = [times, values] as unknown as [number[], number[]];
  const track = new trackTypes[path](`${object.name || object.uuid}.${properties[path]}`, keys, numbers, mode);
  if (interpolation !== 'cubic') return track;
  const Type = path === 'rotation' ? CubicRotationInterpolant : CubicInterpolant;
  // KeyframeTrack.clone copies this method, and GLTFExporter looks for the mark.
  const factory = function (this: KeyframeTrack, result: TypedArray): Interpolant {
    return new Type(this.times, this.values, this.getValueSize() / 3, result);
  };
  return Object.assign(track, { createInterpolant: Object.assign(factory, { isInterpolantFactoryMethodGLTFCubicSpline: true }) });
}

/** The tracks of what a clip stores as frames, sampled by the runtime. Properties that stay at rest get none. */
function* sampledTracks(model: Model, clip: Clip, rate: number): Generator<Keys> {
  const stored = new Set(clip.tracks.map(({ path, target }) => `${path} ${target}`));
  const steps = Math.max(Math.ceil(clip.seconds * rate - 1e-3), 0);
  const times = Float32Array.from({ length: steps + 1 }, (_, k) => Math.min(clip.start + k / rate, clip.end));
  times[steps] = clip.end;
  const pose = model.pose();
  const rest = { locals: pose.locals.slice(), weights: pose.morphWeights.slice() };
  const frames = Array.from(times, (time) => {
    pose.sample(clip, time);
    return { locals: pose.locals.slice(), weights: pose.morphWeights.slice() };
  });
  pose.dispose();
  const track = (path: Track['path'], target: number, what: 'locals' | 'weights', first: number, count: number): Keys | null => {
    if (stored.has(`${path} ${target}`)) return null;
    const part = (frame: typeof rest): Float32Array => frame[what].subarray(first, first + count);
    const start = part(frames[0]!);
    const isSame = (a: Float32Array, b: Float32Array): boolean => a.every((x, i) => x === b[i]);
    const isConstant = frames.every((frame) => isSame(part(frame), start));
    if (isConstant && isSame(start, part(rest))) return null;
    const values = new Float32Array((isConstant ? 1 : frames.length) * count);
    for (let k = 0; k * count < values.length; ++k) values.set(part(frames[k]!), k * count);
    return { path, target, interpolation: 'linear', times: times.subarray(0, values.length / count), values };
  };
  for (const { number } of model.joints) {
    yield* [
      track('translation', number, 'locals', 10 * number + 4, 3),
      track('rotation', number, 'locals', 10 * number, 4),
      track('scale', number, 'locals', 10 * number + 7, 3),
    ].filter((keys) => keys !== null);
  }
  for (const mesh of model.meshes) {
    const first = mesh.morphTargets[0]?.number;
    if (first === undefined) continue;
    const keys = track('weights', mesh.number, 'weights', first, mesh.morphTargets.length);
    if (keys !== null) yield keys;
  }
}

/** Makes three.js's clips. Packed clips are sampled `rate` times a second. */
export function makeClips(model: Model, joints: readonly Object3D[], parts: readonly Part[], rate: number): AnimationClip[] {
  return model.clips.map((clip) => {
    const keys: Keys[] = [...clip.tracks];
    // Clips that play whole frames of a mesh have a frame rate.
    const playsFrames = clip.frameRate > 0 && model.morphTargets.length > 0;
    if (clip.isPacked) keys.push(...sampledTracks(model, clip, rate));
    else if (playsFrames) keys.push(...sampledTracks(model, clip, clip.frameRate));
    const tracks = keys.flatMap((track) => {
      if (track.path !== 'weights') return [makeTrack(joints[track.target]!, track)];
      const objects = parts.filter(({ mesh, object }) => mesh === track.target && object.morphTargetInfluences !== undefined);
      return objects.map(({ object }) => makeTrack(object, track));
    });
    const made = new AnimationClip(clip.name || `animation_${clip.number}`, clip.end, tracks);
    if (typeof clip.extras === 'object') made.userData = { ...clip.extras };
    return made;
  });
}
