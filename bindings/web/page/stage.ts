// The picture: a three.js scene with characters side by side, their light and shadow, and the ranges of joints.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { Character } from './character.js';
import { isStill } from './elements.js';
import { ContactShadow, shadowLayer } from './ground.js';
import { type BackdropName, backdropStyle, makeBackdrop, makeEnvironment, type SurroundingsName } from './studio.js';

const dark = matchMedia('(prefers-color-scheme: dark)');
const boneColour = 0x0072b2;
const mostPixelRatio = 2;
const raise = 0.035; // of the picture's height: the bar of the clip is at the bottom
const orbitStep = 0.09; // radians
const viewDirection = new THREE.Vector3(0.42, 0.13, 0.9).normalize();

export class Stage {
  readonly camera = new THREE.PerspectiveCamera(30, 1, 0.01, 1000);
  /** The length of the first character's diagonal, metres. */
  size = 1;
  readonly #renderer: THREE.WebGLRenderer;
  readonly #scene = new THREE.Scene();
  readonly #controls: OrbitControls;
  readonly #shadow = new ContactShadow();
  readonly #ranges = new THREE.Group();
  readonly #bones = new THREE.Group();
  readonly #pointer = new THREE.Vector2(2, 2);
  readonly #ray = new THREE.Raycaster();
  readonly #box = new THREE.Box3();
  #characters: Character[] = [];
  #backdrop: BackdropName = 'Soft';
  #colour = '#8899aa';
  #isTaken = false;
  #hasShadow = false;
  #hasDrawn = false;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.#renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, mostPixelRatio));
    this.#renderer.toneMapping = THREE.NeutralToneMapping;
    this.#renderer.setClearAlpha(0);
    this.setSurroundings('Studio');
    this.#scene.add(this.#shadow.plane, this.#ranges, this.#bones);
    this.#controls = new OrbitControls(this.camera, canvas);
    this.#controls.enableDamping = !isStill.matches;
    isStill.addEventListener('change', () => (this.#controls.enableDamping = !isStill.matches));
    new ResizeObserver(() => this.#resize()).observe(canvas);
    dark.addEventListener('change', () => this.#paint());
    this.#paint();
    canvas.parentElement!.addEventListener('pointermove', (event) => this.#place(event));
    canvas.parentElement!.addEventListener('pointerleave', () => this.#pointer.set(2, 2));
  }

  /** Shows characters side by side, with the camera in front of them, in place of those before. */
  show(characters: Character[], keepsView = false): void {
    for (const { object } of this.#characters) this.#scene.remove(object);
    this.hideRanges();
    this.setSkeleton(false);
    this.#characters = characters;
    const [first] = characters;
    this.#hasShadow = first?.hasMesh ?? false;
    if (!first) return;
    const size = first.box().getSize(new THREE.Vector3());
    this.size = Math.max(size.length(), 1e-6);
    this.#box.makeEmpty();
    for (const [k, character] of characters.entries()) {
      character.object.position.x = k * 1.15 * Math.max(size.x, 0.4 * size.y);
      character.object.traverse((object) => object.layers.enable(shadowLayer));
      this.#scene.add(character.object);
      this.#box.union(character.box().clone().translate(character.object.position));
    }
    this.#shadow.fit(this.#box);
    this.#resize();
    if (!keepsView) this.resetView();
  }

  /** Looks at the characters from the front, a little from the side. */
  resetView(): void {
    if (this.#box.isEmpty()) return;
    const middle = this.#box.getCenter(new THREE.Vector3());
    const size = this.#box.getSize(new THREE.Vector3());
    const half = Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2));
    const wide = Math.hypot(size.x * viewDirection.z, size.z * viewDirection.x);
    const deep = Math.max(size.z, Math.min(size.x, this.size)) / 2;
    const away = Math.max((0.66 * size.y) / half, (0.62 * wide) / (half * this.camera.aspect), 1e-6) + deep;
    this.camera.position.copy(middle).addScaledVector(viewDirection, away);
    this.camera.near = away / 200;
    this.camera.far = away * 50;
    this.camera.updateProjectionMatrix();
    this.#controls.target.copy(middle);
    this.#controls.update();
  }

  /** Turns the camera about the characters, as by so many steps of a key, or brings it nearer. */
  turn(right: number, up: number, nearer = 0): void {
    const from = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(this.#controls.target));
    from.theta += right * orbitStep;
    from.phi = THREE.MathUtils.clamp(from.phi - up * orbitStep, 0.02, Math.PI - 0.02);
    from.radius *= 0.9 ** nearer;
    this.camera.position.copy(this.#controls.target).add(new THREE.Vector3().setFromSpherical(from));
    this.#controls.update();
  }

  /** Turns the camera about the vertical by an angle in radians. */
  revolve(angle: number): void {
    this.turn(angle / orbitStep, 0);
  }

  setSurroundings(name: SurroundingsName): void {
    this.#scene.environment?.dispose();
    this.#scene.environment = makeEnvironment(name);
  }

  /** The factor on all light, in powers of two. */
  setExposure(stops: number): void {
    this.#renderer.toneMappingExposure = 2 ** stops;
  }

  setBackdrop(name: BackdropName, colour: string): void {
    this.#backdrop = name;
    this.#colour = colour;
    this.canvas.style.background = backdropStyle(name, colour);
    this.#paint();
  }

  /** Whether the canvas is to be copied. Then the backdrop is in it; else it is below it, where the browser need not draw it again. */
  set isTaken(isTaken: boolean) {
    this.#isTaken = isTaken;
    this.#paint();
  }

  setSkeleton(shown: boolean): void {
    clear(this.#bones);
    const [character] = this.#characters;
    if (!shown || !character) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(character.bones(), 3));
    const bones = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: boneColour, depthTest: false, transparent: true }));
    bones.frustumCulled = false;
    bones.renderOrder = 1;
    this.#bones.add(bones);
  }

  setWireframe(shown: boolean): void {
    for (const { object } of this.#characters) {
      object.traverse((one) => {
        for (const material of [(one as THREE.Mesh).material ?? []].flat()) (material as THREE.MeshStandardMaterial).wireframe = shown;
      });
    }
  }

  /** Draws what the constraints of a chain's joints allow. */
  showRanges(chain: number): void {
    this.hideRanges();
    for (const range of this.#characters[0]!.ranges(chain)) {
      range.object.matrixAutoUpdate = false;
      range.object.userData['range'] = range;
      this.#ranges.add(range.object);
    }
  }

  hideRanges(): void {
    clear(this.#ranges);
  }

  /** The pointer's position in model space, on a plane in front of the character; undefined if it is elsewhere. */
  pointerTarget(): THREE.Vector3 | undefined {
    if (Math.abs(this.#pointer.x) > 1 || Math.abs(this.#pointer.y) > 1) return undefined;
    this.#ray.setFromCamera(this.#pointer, this.camera);
    const towards = this.camera.getWorldDirection(new THREE.Vector3());
    const near = this.#controls.target.clone().addScaledVector(towards, -0.45 * this.size);
    return this.#ray.ray.intersectPlane(new THREE.Plane().setFromNormalAndCoplanarPoint(towards, near), new THREE.Vector3()) ?? undefined;
  }

  /** Draws the characters in their current poses. */
  draw(): void {
    const [character] = this.#characters;
    if (character) {
      for (const bones of this.#bones.children as THREE.LineSegments[]) {
        const { position } = bones.geometry.attributes;
        character.bones(position!.array as Float32Array);
        position!.needsUpdate = true;
      }
      for (const { userData } of this.#ranges.children) character.placeRange(userData['range'], 0.09 * this.size);
    }
    this.#controls.update();
    // The first picture has no shadow: without a GPU, compiling its shaders takes as long as drawing the rest.
    this.#shadow.plane.visible = this.#hasShadow && this.#hasDrawn;
    if (this.#shadow.plane.visible) this.#shadow.draw(this.#renderer, this.#scene);
    this.#renderer.render(this.#scene, this.camera);
    this.#hasDrawn ||= this.#characters.length !== 0;
  }

  #paint(): void {
    const { background } = this.#scene;
    if (background instanceof THREE.Texture) background.dispose();
    this.#scene.background = this.#isTaken ? makeBackdrop(this.#backdrop, this.#colour) : null;
    this.#shadow.strength = this.#backdrop === 'Soft' && dark.matches ? 0.9 : 0.7;
  }

  #place(event: PointerEvent): void {
    const box = this.canvas.getBoundingClientRect();
    this.#pointer.set(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.#renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.setViewOffset(width, height, 0, raise * height, width, height);
    this.camera.updateProjectionMatrix();
  }
}

function clear(group: THREE.Group): void {
  group.traverse((object) => {
    const { geometry, material } = object as THREE.Mesh;
    geometry?.dispose();
    for (const one of [material ?? []].flat()) one.dispose();
  });
  group.clear();
}
