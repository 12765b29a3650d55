import { BendyError, Model } from '../index.js';
import { type BendyCharacter, BendyLoader, type BendyAnimator } from '../three/index.js';
import { orbitKeys } from './orbit.js';
import { Stage } from './stage.js';

const style = `
:host { display: block; position: relative; width: 300px; height: 300px; contain: content; }
:host([hidden]) { display: none; }
canvas, img { position: absolute; inset: 0; width: 100%; height: 100%; }
canvas { display: block; outline-offset: -2px; }
:host([camera-controls]) canvas { touch-action: pan-y; cursor: grab; }
:host([camera-controls]) canvas:active { cursor: grabbing; }
img { object-fit: contain; pointer-events: none; }
img[hidden] { display: none; }
`;

/** How far loading has come. */
export interface ViewerProgress {
  /** The bytes so far. */
  loaded: number;
  /** All bytes; 0 if the server does not say. */
  total: number;
}

/** The events of a viewer; the others are those of every element. They do not bubble. */
export interface ViewerEvents {
  /** The character is shown. */
  load: CustomEvent<BendyCharacter>;
  /** The character, or its clip, cannot be shown. The error is also on the console, unless a listener calls `preventDefault`. */
  error: CustomEvent<BendyError>;
  progress: CustomEvent<ViewerProgress>;
}

export interface BendyViewerElement {
  addEventListener<K extends keyof ViewerEvents>(type: K, listener: (event: ViewerEvents[K]) => void, options?: AddEventListenerOptions | boolean): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: AddEventListenerOptions | boolean): void;
  removeEventListener<K extends keyof ViewerEvents>(type: K, listener: (event: ViewerEvents[K]) => void, options?: EventListenerOptions | boolean): void;
  removeEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: EventListenerOptions | boolean): void;
}

const BaseElement = (globalThis.HTMLElement ?? class {}) as typeof HTMLElement;

/**
 * An element that shows a character. It loads when it comes near the visible part of the page, and draws only while something moves.
 *
 * Attributes, which are properties too: `src`, the address of the bendy file; `motions`, the address of another file, whose clips the character
 * plays in place of its own, whatever its build, if the joints of both have roles; `clip`, by name or number, which repeats, the first one if absent,
 * at rest if empty; `poster`, an image to show until then; `alt`, a description; `camera-controls` (`cameraControls`), whether pointer,
 * wheel and keys turn the camera; `paused`, whether time stands still. If the reader prefers reduced motion, it starts paused, and `play` plays.
 */
export class BendyViewerElement extends BaseElement {
  static readonly observedAttributes = ['src', 'motions', 'clip', 'poster', 'alt', 'camera-controls', 'paused'];
  #canvas: HTMLCanvasElement;
  readonly #poster: HTMLImageElement;
  readonly #near = typeof IntersectionObserver === 'undefined' ? undefined : new IntersectionObserver((seen) => this.#seen(seen), { rootMargin: '200px' });
  readonly #sizes = typeof ResizeObserver === 'undefined' ? undefined : new ResizeObserver(() => this.#resize());
  #stage: Stage | null = null;
  #character: BendyCharacter | null = null;
  #wanted: object | null = null; // stands for the file that is shown or on its way
  #isLoading = false;
  #isNear = false;

  constructor() {
    super();
    const shadow = this.attachShadow({ mode: 'open' });
    const sheet = new CSSStyleSheet(); // allowed by policies that forbid inline styles
    sheet.replaceSync(style);
    shadow.adoptedStyleSheets = [sheet];
    this.#canvas = this.#makeCanvas();
    this.#poster = document.createElement('img');
    this.#poster.part.add('poster');
    this.#poster.alt = ''; // the canvas has the description
    this.#poster.loading = 'lazy';
    this.#poster.hidden = true;
    shadow.append(this.#canvas, this.#poster);
    this.#describe();
    this.#control();
  }

  get src(): string {
    return this.getAttribute('src') ?? '';
  }
  set src(src: string) {
    this.#set('src', src);
  }

  get motions(): string {
    return this.getAttribute('motions') ?? '';
  }
  set motions(motions: string) {
    this.#set('motions', motions);
  }

  /** Null if absent: the first clip. */
  get clip(): string | null {
    return this.getAttribute('clip');
  }
  set clip(clip: string | null) {
    this.#set('clip', clip);
  }

  get poster(): string {
    return this.getAttribute('poster') ?? '';
  }
  set poster(poster: string) {
    this.#set('poster', poster);
  }

  get alt(): string {
    return this.getAttribute('alt') ?? '';
  }
  set alt(alt: string) {
    this.#set('alt', alt);
  }

  get cameraControls(): boolean {
    return this.hasAttribute('camera-controls');
  }
  set cameraControls(has: boolean) {
    this.toggleAttribute('camera-controls', has);
  }

  get paused(): boolean {
    return this.hasAttribute('paused');
  }
  set paused(is: boolean) {
    this.toggleAttribute('paused', is);
  }

  /** The character that is shown; null before `load`. The viewer disposes of it when another one comes, or it leaves the page. */
  get character(): BendyCharacter | null {
    return this.#character;
  }

  /** The animator of the character, to blend and reach; null before `load`. */
  get animator(): BendyAnimator | null {
    return this.#stage?.animator ?? null;
  }

  /** The names of the clips that the character plays: its own, or those of `motions`. */
  get clips(): string[] {
    return this.animator?.clips.map(({ name }) => name) ?? [];
  }

  /** The camera's angles in radians: `theta` around the vertical from the front, `phi` from straight above. */
  get cameraAngles(): { theta: number; phi: number } | null {
    return this.#stage?.orbit.angles ?? null;
  }

  play(): void {
    this.paused = false;
  }

  pause(): void {
    this.paused = true;
  }

  connectedCallback(): void {
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) this.paused = true;
    this.#near?.observe(this);
    this.#sizes?.observe(this);
  }

  disconnectedCallback(): void {
    queueMicrotask(() => {
      if (!this.isConnected) this.#release(); // and has not been moved to another place
    });
  }

  attributeChangedCallback(name: string): void {
    if (name === 'src') {
      this.#wanted = null;
      void this.#load();
    } else if (name === 'motions') void this.#changeMotions();
    else if (name === 'clip') this.#play(0.3);
    else if (name === 'poster') this.#showPoster();
    else if (name === 'alt') this.#describe();
    else if (name === 'camera-controls') this.#control();
    else if (this.#stage !== null) this.#stage.playing = !this.paused;
  }

  #set(name: string, value: string | null | undefined, element: HTMLElement = this): void {
    if (value == null) element.removeAttribute(name);
    else element.setAttribute(name, value);
  }

  #makeCanvas(): HTMLCanvasElement {
    const canvas = document.createElement('canvas');
    canvas.part.add('canvas');
    return canvas;
  }

  #release(): void {
    this.#near?.disconnect();
    this.#sizes?.disconnect();
    this.#wanted = null;
    this.#isNear = this.#isLoading = false;
    if (this.#stage === null) return;
    this.#stage.dispose();
    [this.#stage, this.#character] = [null, null];
    // A canvas that has lost its context does not draw again.
    const canvas = this.#makeCanvas();
    this.#canvas.replaceWith(canvas);
    this.#canvas = canvas;
    this.#describe();
    this.#control();
    this.#showPoster();
  }

  #describe(): void {
    this.#canvas.setAttribute('aria-label', this.alt || 'animated character');
  }

  #control(): void {
    const has = this.cameraControls;
    // Screen readers pass keys to an application only.
    this.#set('role', has ? 'application' : 'img', this.#canvas);
    this.#set('aria-roledescription', has ? '3D view' : null, this.#canvas);
    this.#set('tabindex', has ? '0' : null, this.#canvas);
    this.#set('aria-keyshortcuts', has ? orbitKeys : null, this.#canvas);
    if (this.#stage !== null) this.#stage.orbit.enabled = has;
  }

  #showPoster(): void {
    if (this.poster !== '') this.#poster.src = this.poster;
    this.#poster.hidden = this.poster === '' || this.#character !== null;
  }

  #seen(seen: readonly IntersectionObserverEntry[]): void {
    this.#isNear = seen.at(-1)!.isIntersecting;
    if (this.#stage !== null) this.#stage.visible = this.#isNear;
    void this.#load();
  }

  #resize(): void {
    this.#stage?.resize(this.clientWidth, this.clientHeight);
  }

  #fail(error: unknown): void {
    const failure = error instanceof BendyError ? error : Object.assign(new BendyError('io', String(error)), { cause: error });
    // Like an uncaught exception: on the console, unless a listener deals with it.
    if (this.dispatchEvent(new CustomEvent('error', { detail: failure, cancelable: true }))) console.error(failure);
  }

  /** Null if there are none, or if they cannot be opened. */
  async #openMotions(): Promise<Model | null> {
    const { motions } = this;
    if (motions === '') return null;
    try {
      return await Model.open(motions);
    } catch (error) {
      if (motions === this.motions) this.#fail(error);
      return null;
    }
  }

  async #changeMotions(): Promise<void> {
    const { animator, motions } = this;
    if (animator === null || this.#isLoading) return; // what is on its way will have them
    const source = await this.#openMotions();
    if (animator !== this.animator || motions !== this.motions || this.#isLoading) return source?.dispose();
    this.#borrow(source);
    this.#play(0);
  }

  #borrow(source: Model | null): void {
    try {
      this.animator!.borrow(source);
    } catch (error) {
      source?.dispose();
      this.animator!.borrow(null);
      this.#fail(error);
    }
  }

  async #load(): Promise<void> {
    if (!this.#isNear || this.#wanted !== null) return;
    const wanted = (this.#wanted = {});
    this.#setLoading(this.src !== '');
    if (this.src === '') return this.#show(null);
    const isCurrent = (): boolean => this.#wanted === wanted;
    const progress = ({ loaded, total }: ViewerProgress): void => {
      if (isCurrent()) this.dispatchEvent(new CustomEvent('progress', { detail: { loaded, total } }));
    };
    let { motions } = this;
    const opening = this.#openMotions(); // at the same time
    let character: BendyCharacter | null = null;
    let failure: unknown = null;
    try {
      character = await new BendyLoader().loadAsync(this.src, progress);
    } catch (error) {
      failure = error;
    }
    let source = await opening;
    while (isCurrent() && motions !== this.motions) {
      source?.dispose();
      ({ motions } = this);
      source = await this.#openMotions();
    }
    if (!isCurrent() || character === null) {
      character?.model.dispose();
      source?.dispose();
    }
    if (!isCurrent()) return;
    this.#setLoading(false);
    if (character === null) this.#fail(failure);
    else this.#show(character, source);
  }

  #setLoading(is: boolean): void {
    this.#isLoading = is;
    this.#set('aria-busy', is ? 'true' : null, this.#canvas);
  }

  #show(character: BendyCharacter | null, motions: Model | null = null): void {
    try {
      if (this.#stage === null) {
        if (character === null) return;
        this.#stage = new Stage(this.#canvas);
      }
      this.#stage.show(character);
    } catch (error) {
      character?.model.dispose();
      motions?.dispose();
      return this.#fail(error);
    }
    this.#character = character;
    if (motions !== null) this.#borrow(motions);
    this.#control();
    this.#stage.playing = !this.paused;
    this.#resize();
    this.#play(0);
    this.#showPoster();
    if (character !== null) this.dispatchEvent(new CustomEvent('load', { detail: character }));
  }

  #play(fade: number): void {
    const animator = this.animator;
    if (animator === null) return;
    const clip = this.clip ?? (animator.clips.length > 0 ? 0 : '');
    try {
      if (clip === '') this.#stage!.rest();
      else animator.play(clip, { fade });
    } catch (error) {
      this.#fail(error);
    }
    this.#stage!.draw();
  }
}
