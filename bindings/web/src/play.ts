import type { Clip, Marker } from './clip.js';
import { BendyError } from './errors.js';
import { type BendyPlaying, type Easing, playedLayout } from './generated/bindings.js';
import { MadeFade, MadePlayback } from './generated/classes.js';
import type { Key } from './items.js';
import { loadedRuntime } from './load.js';
import type { Model } from './model.js';
import { checkNumber } from './numbers.js';
import { checkOptions, optionNames } from './options.js';
import { Pose } from './pose.js';
import { OfModel, type Runtime } from './runtime.js';

const mostMarkers = 128;

/** The markers of a clip that the interval at an address has passed, in playback order: at most 128. */
function markersPassed(model: Model, clip: Clip, played: number): Marker[] {
  const { calls, spare } = model.runtime;
  const count = calls.bendy_collect_markers(model, clip.number, played, spare, mostMarkers);
  return Array.from(model.runtime.copyIntegers(spare, count), (marker) => clip.markers[marker]!);
}

/** The clock of a clip: its current time and speed. Time does not drift, however long it plays. Calls do not allocate. */
export class Playback extends MadePlayback {
  readonly clip: Clip;
  /** @internal The interval of the last `advance`, as a bendy_played. */
  readonly played: number;

  /** Makes a clock at the start of a clip, which repeats if the clip loops. Throws NOT_FOUND, BAD_ARGUMENT, OUT_OF_MEMORY. */
  constructor(model: Model, clip: Key<Clip>) {
    const { calls, functions } = model.runtime;
    const found = model.clips.get(clip);
    super(model, calls.bendy_playback_new(model, found.number), functions.bendy_playback_free);
    this.clip = found;
    this.played = this.runtime.struct(playedLayout, this.ownBytes(playedLayout.size));
  }

  /** Advances by seconds times the speed. Throws BAD_ARGUMENT if they are not finite. */
  advance(seconds: number): this {
    this.runtime.calls.bendy_playback_advance(this, seconds, this.played);
    return this;
  }

  /** Returns the markers that the last `advance` has passed, in playback order: at most 128. */
  markers(): Marker[] {
    return markersPassed(this.model, this.clip, this.played);
  }
}

/** One of the clips that a CrossFade plays. */
export interface Playing extends Omit<BendyPlaying, 'clip'> {
  readonly clip: Clip;
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

const playNames = optionNames<PlayOptions>({ fade: true, easing: true, playback: true });

/**
 * Clips of one model, each of which fades in over those before it. A clip that is interrupted keeps playing beneath the next one,
 * so nothing jumps. At most four play at a time. Only `play` allocates.
 */
export class CrossFade extends OfModel {
  /** @internal The memory for `played`, as a bendy_played. */
  readonly #played: number;
  readonly #scratch: Pose;

  /** Throws OUT_OF_MEMORY. */
  constructor(model: Model) {
    const { calls, functions } = model.runtime;
    super(model, calls.bendy_crossfade_new(model), functions.bendy_crossfade_free);
    this.#played = this.runtime.struct(playedLayout, this.ownBytes(playedLayout.size));
    const scratch = new Pose(model);
    this.#scratch = scratch;
    this.own(() => scratch.dispose());
  }

  /** Starts a clip; the first one is visible in full at once. Throws NOT_FOUND, BAD_ARGUMENT. */
  play(clip: Key<Clip>, options: PlayOptions = {}): this {
    checkOptions('play', options, playNames);
    const number = this.model.clips.number(clip);
    const { fade = 0, easing = 'smooth', playback } = options;
    this.runtime.calls.bendy_crossfade_play(this, number, playback, checkNumber(fade, 'fade'), easing);
    return this;
  }

  /** Advances all clocks and fades; then drops the clips that are covered completely. */
  advance(seconds: number): this {
    this.runtime.calls.bendy_crossfade_advance(this, seconds);
    return this;
  }

  /** Sets a pose of the model to the mix. Throws BAD_ARGUMENT if nothing plays, and for a pose of another model. */
  sample(pose: Pose): this {
    this.runtime.calls.bendy_sample_crossfade(pose, this, this.#scratch);
    return this;
  }

  /** @internal Whether anything plays. */
  get isPlaying(): boolean {
    return this.runtime.calls.bendy_crossfade_count(this) > 0;
  }

  /** The clips that play, the oldest first. */
  get playing(): Playing[] {
    const { calls } = this.runtime;
    return Array.from({ length: calls.bendy_crossfade_count(this) }, (_, number) => {
      const playing = calls.bendy_get_playing(this, number);
      return { ...playing, clip: this.model.clips[playing.clip]! };
    });
  }

  /** @internal The interval of a clip in the last `advance`, as a bendy_played. */
  played(number: number): number {
    const { runtime } = this;
    runtime.check(runtime.functions.bendy_get_played(this.handle, number, this.#played, runtime.error));
    return this.#played;
  }

  /** Returns the markers that the clips have passed in the last `advance`, clip by clip, the oldest first: at most 128 of each. */
  markers(): Marker[] {
    return this.playing.flatMap(({ clip }, number) => markersPassed(this.model, clip, this.played(number)));
  }

  /** Copies the clock of the newest clip into `playback` and returns it. Throws BAD_ARGUMENT if nothing plays. */
  getPlayback(playback: Playback): Playback {
    const newest = this.runtime.calls.bendy_crossfade_count(this) - 1;
    if (newest < 0) throw new BendyError('bad_argument', 'nothing plays');
    this.runtime.calls.bendy_crossfade_get_playback(this, newest, playback);
    return playback;
  }

  /** Copies a clock into the newest clip's: changes its speed or time. Throws BAD_ARGUMENT if nothing plays. */
  setPlayback(playback: Playback): this {
    this.runtime.calls.bendy_crossfade_set_playback(this, playback);
    return this;
  }
}

/** Returns the eased weight at a fraction of the way, 0 to 1. */
export function ease(easing: Easing, share: number): number {
  return loadedRuntime().calls.bendy_ease(easing, share);
}

/** A weight that moves towards another over time: of a layer, of an additive pose. Calls do not allocate. */
export class Fade extends MadeFade {
  /** Throws OUT_OF_MEMORY; BAD_ARGUMENT if the weight is not finite. */
  constructor(runtime: Runtime, weight: number) {
    super(runtime, runtime.calls.bendy_fade_new(weight), runtime.functions.bendy_fade_free);
  }
}
