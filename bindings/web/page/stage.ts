// The picture: a three.js scene with the character, handles for IK targets, and the ranges of joints.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import type { Character } from './character.js';

const dark = matchMedia('(prefers-color-scheme: dark)');
const handleColour = 0x0072b2;
const activeColour = 0xd55e00;
const mostPixelRatio = 2;
const grabDistance = 28; // CSS pixels, for fingers

export class Stage {
  readonly #renderer: THREE.WebGLRenderer;
  readonly #scene = new THREE.Scene();
  readonly #camera = new THREE.PerspectiveCamera(35, 1, 0.01, 1000);
  readonly #controls: OrbitControls;
  readonly #grid = new THREE.Group();
  readonly #handles = new THREE.Group();
  readonly #ranges = new THREE.Group();
  readonly #bones = new THREE.Group();
  readonly #pointer = new THREE.Vector2(2, 2);
  readonly #ray = new THREE.Raycaster();
  #character: Character | undefined;
  #dragged: { handle: THREE.Mesh; plane: THREE.Plane } | undefined;
  #size = 1;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.#renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, mostPixelRatio));
    this.#renderer.toneMapping = THREE.NeutralToneMapping;
    const pmrem = new THREE.PMREMGenerator(this.#renderer);
    this.#scene.environment = pmrem.fromScene(new RoomEnvironment(), 0.04).texture;
    pmrem.dispose();
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(2, 4, 3);
    this.#scene.add(sun, this.#grid, this.#handles, this.#ranges, this.#bones);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.enableDamping = true;
    new ResizeObserver(() => this.#resize()).observe(canvas);
    const paint = () => {
      this.#scene.background = new THREE.Color(dark.matches ? 0x1a1f22 : 0xeef1f0);
    };
    dark.addEventListener('change', paint);
    paint();
    canvas.addEventListener('pointermove', (event) => this.#move(event));
    canvas.addEventListener('pointerdown', (event) => this.#press(event), { capture: true }); // before the controls
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, () => this.#release());
  }

  /** Shows a character, with the camera in front of it, in place of the one before. */
  show(character: Character | undefined): void {
    this.#release();
    if (this.#character) this.#scene.remove(this.#character.object);
    this.#clear(this.#grid);
    this.#clear(this.#handles);
    this.#clear(this.#ranges);
    this.setSkeleton(false);
    this.#character = character;
    if (!character) return;
    this.#scene.add(character.object);
    const box = character.box();
    const size = box.getSize(new THREE.Vector3());
    this.#size = Math.max(size.length(), 1e-6);
    const middle = box.getCenter(new THREE.Vector3());
    const away = (0.62 * this.#size) / Math.tan(THREE.MathUtils.degToRad(this.#camera.fov / 2));
    this.#camera.position.copy(middle).add(new THREE.Vector3(0.5, 0.2, 0.85).normalize().multiplyScalar(away));
    this.#camera.near = away / 200;
    this.#camera.far = away * 50;
    this.#camera.updateProjectionMatrix();
    this.#controls.target.copy(middle);
    this.#controls.update();
    const step = 10 ** Math.floor(Math.log10(this.#size));
    const grid = new THREE.GridHelper(4 * step, 40, 0x888888, 0x888888);
    grid.position.set(middle.x, box.min.y, middle.z);
    const material = grid.material as THREE.Material;
    material.transparent = true;
    material.opacity = 0.25;
    this.#grid.add(grid);
    for (const chain of character.limbs) {
      const handle = new THREE.Mesh(
        new THREE.SphereGeometry(0.016 * this.#size, 20, 14),
        new THREE.MeshBasicMaterial({ color: handleColour, depthTest: false, transparent: true, opacity: 0.85 }),
      );
      handle.renderOrder = 2;
      handle.userData['chain'] = chain.number;
      this.#handles.add(handle);
    }
    this.#resize();
  }

  /** Whether the chains' handles can be dragged. */
  set showsHandles(shown: boolean) {
    this.#handles.visible = shown;
    this.#ranges.visible = shown;
  }

  setSkeleton(shown: boolean): void {
    this.#clear(this.#bones);
    if (!shown || !this.#character) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(this.#character.bones(), 3));
    const bones = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: handleColour, depthTest: false, transparent: true }));
    bones.frustumCulled = false;
    bones.renderOrder = 1;
    this.#bones.add(bones);
  }

  setWireframe(shown: boolean): void {
    this.#character?.object.traverse((object) => {
      const materials = (object as THREE.Mesh).material;
      for (const material of [materials ?? []].flat()) (material as THREE.MeshStandardMaterial).wireframe = shown;
    });
  }

  /** The pointer's position in model space, on a plane in front of the character. */
  pointerTarget(): THREE.Vector3 | undefined {
    if (Math.abs(this.#pointer.x) > 1 || Math.abs(this.#pointer.y) > 1 || !this.#character) return undefined;
    this.#ray.setFromCamera(this.#pointer, this.#camera);
    const towards = this.#camera.getWorldDirection(new THREE.Vector3());
    const near = this.#controls.target.clone().addScaledVector(towards, -0.45 * this.#size);
    return this.#ray.ray.intersectPlane(new THREE.Plane().setFromNormalAndCoplanarPoint(towards, near), new THREE.Vector3()) ?? undefined;
  }

  /** Draws the character in its current pose. */
  draw(): void {
    const character = this.#character;
    if (character) {
      for (const handle of this.#handles.children as THREE.Mesh[]) {
        const chain: number = handle.userData['chain'];
        const target = character.targets.get(chain);
        (handle.material as THREE.MeshBasicMaterial).color.setHex(target ? activeColour : handleColour);
        handle.position.copy(target ?? character.tip(chain));
      }
      for (const bones of this.#bones.children as THREE.LineSegments[]) {
        const { position } = bones.geometry.attributes;
        character.bones(position!.array as Float32Array);
        position!.needsUpdate = true;
      }
      for (const { userData } of this.#ranges.children) character.placeRange(userData['range'], 0.09 * this.#size);
    }
    this.#controls.update();
    this.#renderer.render(this.#scene, this.#camera);
  }

  /** The position of a chain's handle on the page, in CSS pixels. */
  handlePlace(chain: number): { x: number; y: number } {
    return this.#onPage(this.#handles.children.find((one) => one.userData['chain'] === chain)!);
  }

  #onPage(handle: THREE.Object3D): { x: number; y: number } {
    const at = handle.position.clone().project(this.#camera);
    const box = this.canvas.getBoundingClientRect();
    return { x: box.left + ((at.x + 1) / 2) * box.width, y: box.top + ((1 - at.y) / 2) * box.height };
  }

  #drawRanges(chain: number): void {
    this.#clear(this.#ranges);
    for (const range of this.#character!.ranges(chain)) {
      range.object.matrixAutoUpdate = false;
      range.object.userData['range'] = range;
      this.#ranges.add(range.object);
    }
  }

  #clear(group: THREE.Group): void {
    group.traverse((object) => {
      const { geometry, material } = object as THREE.Mesh;
      geometry?.dispose();
      for (const one of [material ?? []].flat()) one.dispose();
    });
    group.clear();
  }

  #place(event: PointerEvent): void {
    const box = this.canvas.getBoundingClientRect();
    this.#pointer.set(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    this.#ray.setFromCamera(this.#pointer, this.#camera);
  }

  #press(event: PointerEvent): void {
    this.#place(event);
    if (!this.#handles.visible) return;
    const away = (handle: THREE.Object3D) => {
      const { x, y } = this.#onPage(handle);
      return Math.hypot(event.clientX - x, event.clientY - y);
    };
    const [handle] = (this.#handles.children as THREE.Mesh[]).sort((a, b) => away(a) - away(b));
    if (!handle || away(handle) > grabDistance) return;
    const towards = this.#camera.getWorldDirection(new THREE.Vector3());
    this.#dragged = { handle, plane: new THREE.Plane().setFromNormalAndCoplanarPoint(towards, handle.position) };
    this.#controls.enabled = false;
    this.canvas.setPointerCapture(event.pointerId);
    this.#drawRanges(handle.userData['chain']);
  }

  #move(event: PointerEvent): void {
    this.#place(event);
    if (!this.#dragged) return;
    const at = this.#ray.ray.intersectPlane(this.#dragged.plane, new THREE.Vector3());
    if (at) this.#character?.targets.set(this.#dragged.handle.userData['chain'], at);
  }

  #release(): void {
    this.#dragged = undefined;
    this.#controls.enabled = true;
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
  }
}
