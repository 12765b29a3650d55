import {
  clipLayout,
  curveLayout,
  curveTargetWords,
  interpolationWords,
  markerLayout,
  readBendyClip,
  readBendyCurve,
  readBendyMarker,
  readBendyTrack,
  trackLayout,
  trackPathWords,
} from './generated/bindings.js';
import { Items, type Item } from './items.js';
import type { Model } from './model.js';
import { orNull, parseJson } from './parts.js';

/** An event at a time of a clip: a footstep, a hit. */
export interface Marker extends Item {
  /** Seconds on the clip's time line. */
  readonly seconds: number;
}

/** How values between keys are computed. */
export type Interpolation = (typeof interpolationWords)[number];

/** One animated property of a clip. */
export interface Track {
  readonly path: (typeof trackPathWords)[number];
  /** A joint; for weights a mesh. */
  readonly target: number;
  readonly interpolation: Interpolation;
  /** 3, for rotations 4, for weights the number of targets of the mesh. */
  readonly components: number;
  /** Seconds, one per key, ascending: a copy. */
  readonly times: Float32Array<ArrayBuffer>;
  /** `components` numbers per key; if cubic, in-tangent, value and out-tangent of each key: a copy. */
  readonly values: Float32Array<ArrayBuffer>;
}

/** A named curve: one to four animated numbers, such as a material's colour or a camera's field of view. */
export class Curve implements Item {
  readonly name: string;
  readonly number: number;
  /** The property relative to the target, "pbrMetallicRoughness/baseColorFactor"; a JSON pointer if there is no target. */
  readonly path: string;
  readonly targetKind: (typeof curveTargetWords)[number];
  /** The number of the joint, material, mesh or texture, or null. */
  readonly target: number | null;
  /** How many numbers: 1 to 4. */
  readonly components: number;
  readonly interpolation: Interpolation;
  /** Seconds: the times of the first and the last key. */
  readonly start: number;
  readonly end: number;
  /** Seconds, one per key, ascending. */
  readonly times: Float32Array<ArrayBuffer>;
  /** `components` numbers per key; if cubic, in-tangent, value and out-tangent of each key. */
  readonly values: Float32Array<ArrayBuffer>;
  readonly #model: Model;
  readonly #clip: number;

  /** @internal */
  constructor(model: Model, clip: number, number: number) {
    const { runtime, handle } = model;
    const out = runtime.struct(curveLayout);
    runtime.check(runtime.functions.bendy_get_curve(handle, clip, number, out, runtime.error));
    const raw = readBendyCurve(runtime, out);
    this.name = raw.name;
    this.number = number;
    this.path = raw.path;
    this.targetKind = curveTargetWords[raw.targetKind]!;
    this.target = orNull(raw.target);
    this.components = raw.components;
    this.interpolation = interpolationWords[raw.interpolation]!;
    this.start = raw.start;
    this.end = raw.end;
    this.times = runtime.copyFloats(raw.times, raw.keys);
    const count = raw.keys * raw.components * (this.interpolation === 'cubic' ? 3 : 1);
    this.values = runtime.fetchFloats(count, (at) =>
      runtime.functions.bendy_get_curve_values(handle, clip, number, at, count, runtime.error),
    );
    this.#model = model;
    this.#clip = clip;
  }

  /**
   * Returns `components` numbers at a time on the clip's time line, in seconds, clamped to the first and last key. `out` receives
   * them if it is given. Throws BAD_ARGUMENT for NaN, DISPOSED.
   */
  sample(seconds: number, out: Float32Array = new Float32Array(this.components)): Float32Array {
    const { runtime, handle } = this.#model;
    const { scratch } = runtime;
    runtime.check(
      runtime.functions.bendy_sample_curve(handle, this.#clip, this.number, seconds, scratch, this.components, runtime.error),
    );
    for (let k = 0; k < this.components; ++k) out[k] = runtime.view.getFloat32(scratch + 4 * k, true);
    return out;
  }
}

/** An animation clip. */
export class Clip implements Item {
  readonly name: string;
  readonly number: number;
  /** Seconds: where its time line starts and ends. */
  readonly start: number;
  readonly end: number;
  /** Whether it is meant to be repeated. */
  readonly loops: boolean;
  /** Frames per second; 0 if its keys are not at fixed frames. */
  readonly frameRate: number;
  /** Whether tracks are stored as quantised frames; these are not among `tracks`, but `Pose.sample` plays them. */
  readonly isPacked: boolean;
  readonly markers: Items<Marker>;
  readonly curves: Items<Curve>;
  /** Application-specific data: JSON, parsed; null if there is none. */
  readonly extras: unknown;
  readonly #model: Model;
  #tracks: readonly Track[] | undefined;

  /** @internal */
  constructor(model: Model, number: number) {
    const { runtime, handle } = model;
    const { functions, error } = runtime;
    const out = runtime.struct(clipLayout);
    runtime.check(functions.bendy_get_clip(handle, number, out, error));
    const raw = readBendyClip(runtime, out);
    this.name = raw.name;
    this.number = number;
    this.start = raw.start;
    this.end = raw.end;
    this.loops = raw.loops !== 0;
    this.frameRate = raw.frameRate;
    this.isPacked = raw.isPacked !== 0;
    this.extras = parseJson(raw.extras);
    this.markers = Items.make('marker', functions.bendy_marker_count(handle, number), (marker) => {
      const at = runtime.struct(markerLayout);
      runtime.check(functions.bendy_get_marker(handle, number, marker, at, error));
      return { ...readBendyMarker(runtime, at), number: marker };
    });
    this.curves = Items.make('curve', functions.bendy_curve_count(handle, number), (curve) => new Curve(model, number, curve));
    this.#model = model;
  }

  /** Its length in seconds. */
  get seconds(): number {
    return this.end - this.start;
  }

  /** Of a packed clip: the times of its frames in seconds, ascending; between them it is linear, rotations follow the great arc. */
  get packedTimes(): Float32Array<ArrayBuffer> {
    const { runtime, handle } = this.#model;
    const count = runtime.functions.bendy_packed_frame_count(handle, this.number);
    return runtime.fetchFloats(count, (at) => runtime.functions.bendy_packed_frame_times(handle, this.number, at, count, runtime.error));
  }

  /** Its tracks, copied at the first access; without those of a packed clip. */
  get tracks(): readonly Track[] {
    const { runtime, handle } = this.#model;
    const count = runtime.functions.bendy_track_count(handle, this.number);
    return (this.#tracks ??= Array.from({ length: count }, (_, number) => {
      const out = runtime.struct(trackLayout);
      runtime.check(runtime.functions.bendy_get_track(handle, this.number, number, out, runtime.error));
      const raw = readBendyTrack(runtime, out);
      const interpolation = interpolationWords[raw.interpolation]!;
      return {
        path: trackPathWords[raw.path]!,
        target: raw.target,
        interpolation,
        components: raw.components,
        times:
          raw.times === 0
            ? Float32Array.from({ length: raw.keys }, (_, key) => this.start + key / this.frameRate)
            : runtime.copyFloats(raw.times, raw.keys),
        values: runtime.copyFloats(raw.values, raw.keys * raw.components * (interpolation === 'cubic' ? 3 : 1)),
      };
    }));
  }
}
