import type { BendyClip, BendyCurve, BendyMarker, BendyTrack } from './generated/bindings.js';
import { Items, type Item } from './items.js';
import type { Model } from './model.js';
import type { Runtime } from './runtime.js';

/** An event at a time of a clip: a footstep, a hit. */
export interface Marker extends Item, BendyMarker {}

/** One animated property of a clip. */
export interface Track extends Omit<BendyTrack, 'times' | 'values'> {
  /** Seconds, one per key, ascending: a copy. */
  readonly times: Float32Array<ArrayBuffer>;
  /** `components` numbers per key; if cubic, in-tangent, value and out-tangent of each key: a copy. */
  readonly values: Float32Array<ArrayBuffer>;
}

/** How many numbers each key of a track or curve has. */
function valueCount({ keys, components, interpolation }: Pick<BendyTrack, 'keys' | 'components' | 'interpolation'>): number {
  return keys * components * (interpolation === 'cubic' ? 3 : 1);
}

export interface Curve extends Omit<BendyCurve, 'times'> {}

/** A named curve: one to four animated numbers, such as a material's colour or a camera's field of view. */
export class Curve implements Item {
  readonly number: number;
  /** Seconds, one per key, ascending. */
  readonly times: Float32Array<ArrayBuffer>;
  /** `components` numbers per key; if cubic, in-tangent, value and out-tangent of each key. */
  readonly values: Float32Array<ArrayBuffer>;
  readonly #model: Model;
  readonly #clip: number;

  /** @internal */
  constructor(model: Model, clip: number, number: number) {
    const { runtime } = model;
    const { calls } = runtime;
    const { times, ...fields } = calls.bendy_get_curve(model, clip, number);
    Object.assign(this, fields);
    this.number = number;
    this.times = runtime.copyFloats(times, fields.keys);
    this.values = calls.bendy_get_curve_values(model, clip, number, valueCount(fields));
    this.#model = model;
    this.#clip = clip;
  }

  /**
   * Returns `components` numbers at a time on the clip's time line, in seconds, clamped to the first and last key. `out` receives
   * them if it is given. Throws BAD_ARGUMENT for NaN, DISPOSED.
   */
  sample(seconds: number, out?: Float32Array): Float32Array {
    const { calls } = this.#model.runtime;
    const values = calls.bendy_sample_curve(this.#model, this.#clip, this.number, seconds, this.components);
    if (out === undefined) return values;
    out.set(values);
    return out;
  }
}

export interface Clip extends BendyClip {}

/** An animation clip. */
export class Clip implements Item {
  readonly number: number;
  readonly markers: Items<Marker>;
  readonly curves: Items<Curve>;
  readonly #model: Model;
  #tracks: readonly Track[] | undefined;

  /** @internal */
  constructor(model: Model, number: number) {
    const { calls } = model.runtime;
    Object.assign(this, calls.bendy_get_clip(model, number));
    this.number = number;
    this.markers = Items.make('marker', calls.bendy_marker_count(model, number), (marker) => ({
      ...calls.bendy_get_marker(model, number, marker),
      number: marker,
    }));
    this.curves = Items.make('curve', calls.bendy_curve_count(model, number), (curve) => new Curve(model, number, curve));
    this.#model = model;
  }

  /** Its length in seconds. */
  get seconds(): number {
    return this.end - this.start;
  }

  /** The times of a packed clip's frames in seconds, ascending. Between them it is linear; rotations follow the great arc. */
  get packedTimes(): Float32Array<ArrayBuffer> {
    const { calls } = this.#model.runtime;
    const count = calls.bendy_packed_frame_count(this.#model, this.number);
    return calls.bendy_packed_frame_times(this.#model, this.number, count);
  }

  /** Its tracks, copied at the first access; without those of a packed clip. */
  get tracks(): readonly Track[] {
    const { runtime } = this.#model;
    return (this.#tracks ??= Array.from({ length: runtime.calls.bendy_track_count(this.#model, this.number) }, (_, number) =>
      this.#track(runtime, number),
    ));
  }

  #track(runtime: Runtime, number: number): Track {
    const track = runtime.calls.bendy_get_track(this.#model, this.number, number);
    return {
      ...track,
      times:
        track.times === 0
          ? Float32Array.from({ length: track.keys }, (_, key) => this.start + key / this.frameRate)
          : runtime.copyFloats(track.times, track.keys),
      values: runtime.copyFloats(track.values, valueCount(track)),
    };
  }
}
