// The handles of IK chains: buttons on the picture, to drag or to move by keys.
import * as THREE from 'three';
import type { Character } from './character.js';
import { make } from './elements.js';

/** What handles need of the picture. */
export interface View {
  readonly camera: THREE.PerspectiveCamera;
  readonly canvas: HTMLCanvasElement;
  /** The length of the character's diagonal, metres. */
  readonly size: number;
}

const invitationWidth = 200; // CSS pixels that the text beside a handle takes
const keyStep = 0.02; // of the character's size
const directions: Record<string, [number, number, number]> = {
  ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowDown: [0, -1, 0], ArrowUp: [0, 1, 0], PageUp: [0, 0, -1], PageDown: [0, 0, 1],
};

/** "IK_LeftArm": "left arm". */
export function chainLabel({ name, number }: { name: string; number: number }): string {
  const words = name.replace(/^IK[_ ]?/i, '').replace(/([a-z])([A-Z])/g, '$1 $2').replace(/[_.:]+/g, ' ').trim().toLowerCase();
  return words || `chain ${number}`;
}

const nameOf = (chain: { name: string; number: number }): string =>
  `Move the ${chainLabel(chain)}: arrow keys, page up and page down; Escape lets go`;

export class Handles {
  /** Called when a chain is taken, and when it is let go or put down: undefined. */
  onHold: (chain: number | undefined) => void = () => {};
  readonly #buttons = new Map<number, HTMLButtonElement>();
  readonly #ray = new THREE.Raycaster();
  #character: Character | undefined;
  #dragged: { chain: number; plane: THREE.Plane } | undefined;

  constructor(
    readonly layer: HTMLElement,
    readonly view: View,
  ) {}

  show(character: Character | undefined): void {
    this.#dragged = undefined;
    this.#character = character;
    this.#buttons.clear();
    for (const chain of character?.limbs ?? []) {
      const handle = make('button', { type: 'button', className: 'handle', title: `Drag the ${chainLabel(chain)}` });
      handle.setAttribute('aria-label', nameOf(chain));
      handle.addEventListener('pointerdown', (event) => this.#press(event, chain.number, handle));
      handle.addEventListener('pointermove', (event) => this.#move(event));
      for (const end of ['pointerup', 'pointercancel']) handle.addEventListener(end, () => this.#putDown());
      handle.addEventListener('keydown', (event) => this.#key(event, chain.number));
      handle.addEventListener('blur', () => this.#putDown());
      handle.addEventListener('dblclick', () => character?.letGo(chain.number));
      this.#buttons.set(chain.number, handle);
    }
    this.layer.replaceChildren(...this.#buttons.values());
  }

  /** Marks the handle to try first, by a text beside it. */
  invite(chain: number, text: string): void {
    const handle = this.#buttons.get(chain);
    if (!handle) return;
    handle.classList.add('inviting');
    handle.setAttribute('aria-label', `${text}. ${handle.getAttribute('aria-label')}`); // a name that has the text
    handle.append(make('span', { className: 'invitation' }, text));
  }

  /** Puts the handles where the tips and targets are. */
  place(): void {
    const { canvas, camera } = this.view;
    const { clientWidth: width, clientHeight: height } = canvas;
    for (const [chain, handle] of this.#buttons) {
      const at = this.#positionOf(chain).project(camera);
      handle.style.transform = `translate(${(((at.x + 1) / 2) * width).toFixed(1)}px, ${(((1 - at.y) / 2) * height).toFixed(1)}px)`;
      handle.classList.toggle('holding', this.#character!.targets.has(chain));
      handle.classList.toggle('narrow', ((1 - at.x) / 2) * width < invitationWidth);
      handle.hidden = Math.abs(at.x) > 1 || Math.abs(at.y) > 1;
    }
  }

  /** The position of a chain's handle on the page, in CSS pixels. */
  placeOf(chain: number): { x: number; y: number } {
    const box = this.#buttons.get(chain)!.getBoundingClientRect();
    return { x: box.left + box.width / 2, y: box.top + box.height / 2 };
  }

  #positionOf(chain: number): THREE.Vector3 {
    const character = this.#character!;
    return (character.targets.get(chain) ?? character.tip(chain)).clone();
  }

  #press(event: PointerEvent, chain: number, handle: HTMLButtonElement): void {
    if (event.button !== 0) return;
    event.preventDefault();
    handle.focus();
    handle.setPointerCapture(event.pointerId);
    const towards = this.view.camera.getWorldDirection(new THREE.Vector3());
    this.#dragged = { chain, plane: new THREE.Plane().setFromNormalAndCoplanarPoint(towards, this.#positionOf(chain)) };
    this.#welcome();
    this.onHold(chain);
  }

  #move(event: PointerEvent): void {
    if (!this.#dragged) return;
    const box = this.view.canvas.getBoundingClientRect();
    const pointer = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    this.#ray.setFromCamera(pointer, this.view.camera);
    const at = this.#ray.ray.intersectPlane(this.#dragged.plane, new THREE.Vector3());
    if (at) this.#character?.reachFor(this.#dragged.chain, at);
  }

  #key(event: KeyboardEvent, chain: number): void {
    const direction = directions[event.key];
    if (event.key === 'Escape' || event.key === 'Delete') {
      this.#character?.letGo(chain);
      this.onHold(undefined);
    } else if (direction && !event.ctrlKey && !event.metaKey && !event.altKey) {
      const step = new THREE.Vector3(...direction).multiplyScalar(keyStep * this.view.size).applyQuaternion(this.view.camera.quaternion);
      this.#character?.reachFor(chain, this.#positionOf(chain).add(step));
      this.#welcome();
      this.onHold(chain);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  #putDown(): void {
    this.#dragged = undefined;
    this.onHold(undefined);
  }

  /** Somebody has taken a handle: no invitation is needed. */
  #welcome(): void {
    for (const { number, name } of this.#character!.limbs) {
      const handle = this.#buttons.get(number)!;
      handle.setAttribute('aria-label', nameOf({ number, name }));
      handle.classList.remove('inviting');
      handle.replaceChildren();
    }
  }
}
