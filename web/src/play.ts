import type { Clip, Marker } from './clip.js';
import { BendyError } from './errors.js';
import { easingWords, loopModeWords, playbackInfoLayout, playedLayout, playingLayout, readBendyPlaying } from './generated/bindings.js';
import type { Key } from './items.js';
import type { Model } from './model.js';
import { Pose, word } from './pose.js';
import { Handle, type Runtime } from './runtime.js';

/** What happens at the end of a clip: `once` stops there, `repeat` continues at the start, `ping_pong` turns. */
export type LoopMode = (typeof loopModeWords)[number];
/** How a weight moves: `smooth` is 3t^2 - 2t^3. */
export type Easing = (typeof easingWords)[number];

const mostMarkers = 128;

/** The markers of a clip that an interval at an address has passed, in playback order: at most 128. */
function markersPassed(model: Model, clip: Clip, played: number): Marker[] {
  const { runtime } = model;
  const { scratch } = runtime;
  const count = scratch + 4 * mostMarkers;
  runtime.check(
    runtime.functions.bendy_collect_markers(model.handle, clip.number, played, scratch, mostMarkers, count, runtime.error),
  );
  return Array.from(runtime.copyIntegers(scratch, runtime.view.getUint32(count, true)), (marker) => clip.markers[marker]!);
}

/** The clock of a clip: its current time and speed. Time does not drift, however long it plays. Calls do not allocate. */
export class Playback extends Handle {
  readonly model: Model;
  readonly clip: Clip;
  /** @internal The interval that the last `advance` has played, as a bendy_played. */
  readonly played: number;
  readonly #info: number;

  /** Makes a clock at the start of a clip, which repeats if the clip loops. Throws NOT_FOUND, BAD_ARGUMENT, OUT_OF_MEMORY. */
  constructor(model: Model, clip: Key<Clip>) {
    const { runtime } = model;
    const { functions, error } = runtime;
    const found = model.clips.get(clip);
    const handle = runtime.checkHandle(functions.bendy_playback_new(model.handle, found.number, error));
    super(runtime, handle, () => functions.bendy_playback_free(handle));
    this.own(model.useFile());
    this.model = model;
    this.clip = found;
    this.played = runtime.struct(playedLayout, this.ownBytes(playedLayout.size));
    this.#info = runtime.struct(playbackInfoLayout, this.ownBytes(playbackInfoLayout.size));
  }

  /** Where the current state is, as a bendy_playback_info. */
  get #now(): number {
    this.runtime.check(this.runtime.functions.bendy_get_playback(this.handle, this.#info, this.runtime.error));
    return this.#info;
  }

  /** The current time on the clip's time line, as `Pose.sample` takes it. */
  get seconds(): number {
    return this.runtime.view.getFloat32(this.#now + playbackInfoLayout.seconds, true);
  }

  /** The current time as a fraction of the length, 0 to 1. */
  get share(): number {
    return this.runtime.view.getFloat64(this.#now + playbackInfoLayout.share, true);
  }

  /** Whether it has stopped at the end that it was heading for; only in mode `once`. */
  get isDone(): boolean {
    return this.runtime.view.getUint32(this.#now + playbackInfoLayout.isDone, true) !== 0;
  }

  /** The passes completed since the last seek, minus those undone backwards; 0 in mode `once`. */
  get passes(): number {
    return Number(this.runtime.view.getBigInt64(this.#now + playbackInfoLayout.passes, true));
  }

  /** 1: as authored; 0: paused; negative: backwards. Setting it throws BAD_ARGUMENT if it is not finite. */
  get speed(): number {
    return this.runtime.view.getFloat64(this.#now + playbackInfoLayout.speed, true);
  }

  set speed(speed: number) {
    this.runtime.check(this.runtime.functions.bendy_playback_set_speed(this.handle, speed, this.runtime.error));
  }

  /** What happens at the end. Setting it keeps the current time. */
  get mode(): LoopMode {
    return loopModeWords[this.runtime.view.getUint32(this.#now + playbackInfoLayout.mode, true)]!;
  }

  set mode(mode: LoopMode) {
    const number = word(loopModeWords, mode, 'mode');
    this.runtime.check(this.runtime.functions.bendy_playback_set_mode(this.handle, number, this.runtime.error));
  }

  /** Advances by seconds times the speed. Throws BAD_ARGUMENT if they are not finite. */
  advance(seconds: number): this {
    this.runtime.check(
      this.runtime.functions.bendy_playback_advance(this.handle, seconds, this.played, this.runtime.error),
    );
    return this;
  }

  /** Jumps to a time in seconds, clamped, without playing what lies between. */
  seek(seconds: number): this {
    this.runtime.check(this.runtime.functions.bendy_playback_seek(this.handle, seconds, this.runtime.error));
    return this;
  }

  /** Jumps to a fraction of the length. */
  seekShare(share: number): this {
    this.runtime.check(this.runtime.functions.bendy_playback_seek_share(this.handle, share, this.runtime.error));
    return this;
  }

  /** Returns the markers that the last `advance` has passed, in playback order: at most 128. */
  markers(): Marker[] {
    return markersPassed(this.model, this.clip, this.played);
  }
}

/** One of the clips that a CrossFade plays. */
export interface Playing {
  readonly clip: Clip;
  /** Its current time. */
  readonly seconds: number;
  /** 0 to 1: how far it covers the clips that began before it. */
  readonly weight: number;
  /** Its share of the result; all shares sum to 1. */
  readonly share: number;
}

/** Options of `CrossFade.play`. */
export interface PlayOptions {
  /** Seconds that the clip takes to fade in; 0 if not given. */
  fade?: number;
  /** `smooth` if not given. */
  easing?: Easing;
  /** A clock to copy: its speed, mode and time; the clip's own if not given. */
  playback?: Playback;
}

/**
 * Clips of one model, each of which fades in over those before it. A clip that is interrupted keeps playing beneath the next one,
 * so nothing jumps. At most four play at a time. Only `play` allocates.
 */
export class CrossFade extends Handle {
  readonly model: Model;
  /** @internal Where `played` is written, as a bendy_played. */
  readonly #played: number;
  readonly #scratch: Pose;

  /** Throws OUT_OF_MEMORY. */
  constructor(model: Model) {
    const { runtime } = model;
    const { functions, error } = runtime;
    const handle = runtime.checkHandle(functions.bendy_crossfade_new(model.handle, error));
    super(runtime, handle, () => functions.bendy_crossfade_free(handle));
    this.own(model.useFile());
    this.model = model;
    this.#played = runtime.struct(playedLayout, this.ownBytes(playedLayout.size));
    const scratch = new Pose(model);
    this.#scratch = scratch;
    this.own(() => scratch.dispose());
  }

  /** Starts a clip; the first one is visible in full at once. Throws NOT_FOUND, BAD_ARGUMENT. */
  play(clip: Key<Clip>, options: PlayOptions = {}): this {
    const { runtime } = this;
    const easing = word(easingWords, options.easing ?? 'smooth', 'easing');
    const number = this.model.clips.number(clip);
    if (options.playback !== undefined) this.model.checkSameRuntime(options.playback);
    const playback = options.playback?.handle ?? 0;
    runtime.check(
      runtime.functions.bendy_crossfade_play(this.handle, number, playback, options.fade ?? 0, easing, runtime.error),
    );
    return this;
  }

  /** Advances all clocks and fades; then drops the clips that are covered completely. */
  advance(seconds: number): this {
    this.runtime.check(this.runtime.functions.bendy_crossfade_advance(this.handle, seconds, this.runtime.error));
    return this;
  }

  /** Sets a pose of the model to the mix. Throws BAD_ARGUMENT if nothing plays, and for a pose of another model. */
  sample(pose: Pose): this {
    const { runtime } = this;
    this.model.checkOwn(pose, 'pose');
    runtime.check(
      runtime.functions.bendy_sample_crossfade(pose.handle, this.handle, this.#scratch.handle, runtime.error),
    );
    return this;
  }

  /** The clips that play, the oldest first. */
  get playing(): Playing[] {
    const { runtime } = this;
    return Array.from({ length: runtime.functions.bendy_crossfade_count(this.handle) }, (_, number) => {
      const out = runtime.struct(playingLayout);
      runtime.check(runtime.functions.bendy_get_playing(this.handle, number, out, runtime.error));
      const raw = readBendyPlaying(runtime, out);
      return { ...raw, clip: this.model.clips[raw.clip]! };
    });
  }

  /** @internal The interval that a clip has played in the last `advance`, as a bendy_played. */
  played(number: number): number {
    this.runtime.check(
      this.runtime.functions.bendy_get_played(this.handle, number, this.#played, this.runtime.error),
    );
    return this.#played;
  }

  /** Returns the markers that the clips have passed in the last `advance`, clip by clip, the oldest first: at most 128 of each. */
  markers(): Marker[] {
    return this.playing.flatMap(({ clip }, number) => markersPassed(this.model, clip, this.played(number)));
  }

  /** Throws BAD_ARGUMENT if nothing plays. Returns the clock of the newest clip, copied into `playback`. */
  getPlayback(playback: Playback): Playback {
    const newest = this.runtime.functions.bendy_crossfade_count(this.handle) - 1;
    if (newest < 0) throw new BendyError('bad_argument', 'nothing plays');
    this.model.checkSameRuntime(playback);
    this.runtime.check(
      this.runtime.functions.bendy_crossfade_get_playback(this.handle, newest, playback.handle, this.runtime.error),
    );
    return playback;
  }

  /** Copies a clock into that of the newest clip: changes its speed or time. Throws BAD_ARGUMENT if nothing plays. */
  setPlayback(playback: Playback): this {
    this.model.checkSameRuntime(playback);
    this.runtime.check(
      this.runtime.functions.bendy_crossfade_set_playback(this.handle, playback.handle, this.runtime.error),
    );
    return this;
  }
}

/** A weight that moves towards another over time: of a layer, of an additive pose. Calls do not allocate. */
export class Fade extends Handle {
  /** Throws OUT_OF_MEMORY; BAD_ARGUMENT if the weight is not finite. */
  constructor(runtime: Runtime, weight: number) {
    const { functions, error } = runtime;
    const handle = runtime.checkHandle(functions.bendy_fade_new(weight, error));
    super(runtime, handle, () => functions.bendy_fade_free(handle));
  }

  /** Starts a fade from the current weight; immediate if seconds is not above 0. */
  to(weight: number, seconds: number, easing: Easing = 'smooth'): this {
    const number = word(easingWords, easing, 'easing');
    this.runtime.check(this.runtime.functions.bendy_fade_to(this.handle, weight, seconds, number, this.runtime.error));
    return this;
  }

  /** Advances by seconds. */
  advance(seconds: number): this {
    this.runtime.check(this.runtime.functions.bendy_fade_advance(this.handle, seconds, this.runtime.error));
    return this;
  }

  /** The current weight. */
  get weight(): number {
    return this.runtime.functions.bendy_fade_weight(this.handle);
  }

  /** Whether the weight is reached. */
  get isDone(): boolean {
    return this.runtime.functions.bendy_fade_is_done(this.handle) !== 0;
  }
}
