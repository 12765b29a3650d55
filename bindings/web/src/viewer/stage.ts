// The picture of one character: lights, camera, and frames only when something has changed.
import {
  ACESFilmicToneMapping,
  Box3,
  DirectionalLight,
  HemisphereLight,
  type Material,
  type Mesh,
  PerspectiveCamera,
  Scene,
  Sphere,
  Texture,
  WebGLRenderer,
} from 'three';
import { BendyError } from '../index.js';
import { BendyAnimator, type BendyCharacter } from '../three/index.js';
import { Orbit } from './orbit.js';

const longestFrame = 0.1; // seconds: after a pause, time does not jump

/** Draws a character into a canvas. */
export class Stage {
  readonly orbit: Orbit;
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(30, 1);
  #character: BendyCharacter | null = null;
  #animator: BendyAnimator | null = null;
  #playing = false;
  #visible = true;
  #before = 0;
  #frame = 0;

  /** Throws UNSUPPORTED if the browser has no WebGL 2. */
  constructor(canvas: HTMLCanvasElement) {
    try {
      this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    } catch (error) {
      throw Object.assign(new BendyError('unsupported', 'this browser offers no WebGL 2'), { cause: error });
    }
    this.#renderer.toneMapping = ACESFilmicToneMapping;
    // Not an environment: to filter one takes a browser that draws in software many seconds.
    const [key, rim] = [new DirectionalLight(0xffffff, 2.2), new DirectionalLight(0xffffff, 1)];
    key.position.set(1, 2, 3);
    rim.position.set(-2, 2, -3);
    this.#scene.add(new HemisphereLight(0xffffff, 0x998877, 2), key, rim);
    this.orbit = new Orbit(this.#camera, canvas, () => this.draw());
  }

  /** The character that is shown, and what plays it. */
  get animator(): BendyAnimator | null {
    return this.#animator;
  }

  /** Shows a character, which the stage owns from now on, and frames it at rest. Null: nothing. */
  show(character: BendyCharacter | null): void {
    this.#release();
    this.#character = character;
    if (character === null) return this.draw();
    this.#animator = new BendyAnimator(character);
    this.#scene.add(character.scene);
    character.scene.updateMatrixWorld(true);
    this.orbit.frame(new Box3().setFromObject(character.scene, true).getBoundingSphere(new Sphere()));
    this.draw();
  }

  /** Stops what plays, and sets the character to rest. */
  rest(): void {
    this.#animator?.stop();
    this.draw();
  }

  set playing(playing: boolean) {
    this.#playing = playing;
    this.draw();
  }

  set visible(visible: boolean) {
    this.#visible = visible;
    this.draw();
  }

  resize(width: number, height: number): void {
    if (width === 0 || height === 0) return;
    this.#camera.aspect = width / height;
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.#renderer.setSize(width, height, false);
    this.orbit.update();
    this.#render(performance.now()); // at once: a canvas that has changed its size is empty
  }

  /** Draws in the next frame. */
  draw(): void {
    if (this.#frame === 0 && this.#visible) this.#frame = requestAnimationFrame((now) => this.#render(now));
  }

  dispose(): void {
    cancelAnimationFrame(this.#frame);
    this.#visible = false;
    this.#release();
    this.#renderer.dispose();
    this.#renderer.forceContextLoss(); // browsers allow only some 16
  }

  #render(now: number): void {
    this.#frame = 0;
    const seconds = Math.min((now - this.#before) / 1000, longestFrame);
    this.#before = now;
    this.#animator?.update(this.#playing ? Math.max(seconds, 0) : 0);
    this.#renderer.render(this.#scene, this.#camera);
    if (this.#playing && this.#animator !== null) this.draw();
  }

  #release(): void {
    const character = this.#character;
    if (character === null) return;
    this.#animator?.dispose();
    this.#scene.remove(character.scene);
    for (const { object } of character.parts) {
      object.geometry.dispose();
      for (const material of [(object as Mesh).material].flat() as Material[]) {
        for (const value of Object.values(material)) if (value instanceof Texture) value.dispose();
        material.dispose();
      }
    }
    for (const clip of character.animations) clip.tracks = []; // which would keep the file
    character.model.dispose();
    [this.#character, this.#animator] = [null, null];
  }
}
