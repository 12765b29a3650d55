// A camera that turns around a point: by pointer, wheel and keys.
import { MathUtils, type PerspectiveCamera, Sphere, Spherical, Vector3 } from 'three';

const steepest = Math.PI / 2 - 0.05;
const keyStep = Math.PI / 24;
const zoomStep = 1.15;

/** What a key does: turn to the side, turn up, zoom. */
const keys: Record<string, readonly [number, number, number]> = {
  ArrowLeft: [-keyStep, 0, 1],
  ArrowRight: [keyStep, 0, 1],
  ArrowUp: [0, keyStep, 1],
  ArrowDown: [0, -keyStep, 1],
  '+': [0, 0, 1 / zoomStep],
  '=': [0, 0, 1 / zoomStep],
  '-': [0, 0, zoomStep],
};

/** The keys, as `aria-keyshortcuts` lists them. */
export const orbitKeys = 'ArrowLeft ArrowRight ArrowUp ArrowDown Plus -';

/** Turns a camera around a sphere. `changed` is called when it has moved. */
export class Orbit {
  enabled = false;
  readonly #camera: PerspectiveCamera;
  readonly #changed: () => void;
  readonly #target = new Vector3();
  readonly #place = new Spherical(1, Math.PI / 2, 0);
  readonly #pointers = new Map<number, { x: number; y: number }>();
  #radius = 1;

  constructor(camera: PerspectiveCamera, element: HTMLElement, changed: () => void) {
    this.#camera = camera;
    this.#changed = changed;
    element.addEventListener('pointerdown', (event) => this.#down(event, element));
    element.addEventListener('pointermove', (event) => this.#move(event, element));
    for (const name of ['pointerup', 'pointercancel'] as const) {
      element.addEventListener(name, (event) => this.#pointers.delete(event.pointerId));
    }
    element.addEventListener('wheel', (event) => this.#wheel(event), { passive: false });
    element.addEventListener('keydown', (event) => this.#key(event));
  }

  /** Looks at a sphere from the front, slightly from above. */
  frame(sphere: Sphere): void {
    this.#target.copy(sphere.center);
    this.#radius = Math.max(sphere.radius, 1e-6);
    this.#place.set(this.#distance(), MathUtils.degToRad(80), MathUtils.degToRad(20));
    this.update();
  }

  /** The angles, in radians: around the vertical from the front, and from straight above. */
  get angles(): { theta: number; phi: number } {
    const { theta, phi } = this.#place;
    return { theta, phi };
  }

  /** Writes the camera, after a change of its aspect ratio too. */
  update(): void {
    const camera = this.#camera;
    camera.position.setFromSpherical(this.#place).add(this.#target);
    camera.lookAt(this.#target);
    camera.near = Math.max(this.#place.radius - 4 * this.#radius, 0.01 * this.#radius);
    camera.far = this.#place.radius + 4 * this.#radius;
    camera.updateProjectionMatrix();
  }

  /** From where the sphere fills the picture. */
  #distance(): number {
    const half = MathUtils.degToRad(this.#camera.fov / 2);
    return this.#radius / Math.sin(Math.min(half, Math.atan(Math.tan(half) * this.#camera.aspect)));
  }

  #turn(side: number, up: number, zoom: number): void {
    const place = this.#place;
    place.theta += side;
    place.phi = MathUtils.clamp(place.phi - up, Math.PI / 2 - steepest, Math.PI / 2 + steepest);
    place.radius = MathUtils.clamp(place.radius * zoom, 1.1 * this.#radius, 10 * this.#radius);
    this.update();
    this.#changed();
  }

  #down(event: PointerEvent, element: HTMLElement): void {
    if (!this.enabled) return;
    this.#pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    element.setPointerCapture(event.pointerId);
  }

  #move(event: PointerEvent, element: HTMLElement): void {
    const before = this.#pointers.get(event.pointerId);
    if (!this.enabled || before === undefined) return;
    const others = [...this.#pointers].filter(([id]) => id !== event.pointerId).map(([, point]) => point);
    const gap = (point: { x: number; y: number }): number => Math.hypot(point.x - others[0]!.x, point.y - others[0]!.y);
    const now = { x: event.clientX, y: event.clientY };
    const perPixel = Math.PI / Math.max(element.clientHeight, 1);
    if (others.length === 0) this.#turn((before.x - now.x) * perPixel, (now.y - before.y) * perPixel, 1);
    else this.#turn(0, 0, Math.max(gap(before), 1) / Math.max(gap(now), 1));
    this.#pointers.set(event.pointerId, now);
  }

  #wheel(event: WheelEvent): void {
    if (!this.enabled) return;
    event.preventDefault();
    this.#turn(0, 0, zoomStep ** MathUtils.clamp(event.deltaY / 50, -1, 1));
  }

  #key(event: KeyboardEvent): void {
    const change = keys[event.key];
    if (!this.enabled || change === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    this.#turn(...change);
  }
}
