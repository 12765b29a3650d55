// What moves a character: its own clips, or those of another one.
import { type Clip, CrossFade, type Model, Playback, type Pose } from '../src/index.js';
import { Borrowed } from '../src/three/borrowed.js';

/** Plays the clips of a model, one after another, into a pose. */
export class Motion {
  clip = 0;
  readonly clips: readonly Clip[];
  readonly #crossFade: CrossFade;
  #playback: Playback | undefined;

  constructor(
    readonly model: Model,
    readonly pose: Pose,
  ) {
    this.clips = [...model.clips];
    this.#crossFade = new CrossFade(model);
  }

  play(clip: number, fade: number): void {
    this.clip = clip;
    const playback = new Playback(this.model, clip);
    playback.mode = 'repeat';
    this.#crossFade.play(clip, { playback, fade: this.#playback ? fade : 0 });
    this.#playback?.dispose();
    this.#playback = playback;
  }

  get #clock(): Playback | undefined {
    return this.#playback && this.#crossFade.getPlayback(this.#playback);
  }
  get seconds(): number {
    return this.#clock?.seconds ?? 0;
  }
  get share(): number {
    return this.#clock?.share ?? 0;
  }
  seek(share: number): void {
    const clock = this.#clock;
    if (clock) this.#crossFade.setPlayback(clock.seekShare(share));
  }

  /** Whether the clip still fades in over the one before. */
  get isFading(): boolean {
    return this.#playback !== undefined && this.#crossFade.playing.length > 1;
  }

  step(seconds: number): void {
    if (this.#playback) this.#crossFade.advance(seconds);
  }

  /** Advances the clips, and sets the pose: at rest if there are none. */
  update(seconds: number): void {
    this.step(seconds);
    if (this.#playback) this.#crossFade.sample(this.pose);
    else this.pose.reset();
  }

  dispose(): void {
    this.#playback?.dispose();
    this.#crossFade.dispose();
  }
}

/** Plays the clips of another model on the pose of a character. Owns the other model. */
export class BorrowedMotion extends Motion {
  readonly #borrowed: Borrowed;
  readonly #target: Pose;

  /** Throws BAD_ARGUMENT if one of the two lacks roles. */
  constructor(source: Model, target: Pose) {
    const borrowed = new Borrowed(source, target.model);
    super(source, borrowed.pose);
    this.#borrowed = borrowed;
    this.#target = target;
  }

  override seek(share: number): void {
    super.seek(share);
    this.#borrowed.reset();
  }

  override update(seconds: number): void {
    super.update(seconds);
    this.#borrowed.apply(this.#target, seconds);
  }

  override dispose(): void {
    super.dispose();
    this.#borrowed.dispose();
  }
}
