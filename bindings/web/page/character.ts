// A character that plays clips and reaches for targets: the runtime, and the three.js objects that it moves.
import * as THREE from 'three';
import { type Chain, type Clip, type Constraint, LevelOfDetail, type Model, type Pose, ReachState } from '../src/index.js';
import { BendyAnimator, type BendyCharacter, BendyLoader, setLevelOfDetail } from '../src/three/index.js';
import { BorrowedMotion, Motion } from './motion.js';
import { drawRange } from './ranges.js';
import { counted } from './units.js';

const letGoSeconds = 0.3;
const turnSeconds = 0.12; // of the head, towards the pointer

/** A chain's target, model space, and how much the chain follows it. */
interface Target {
  position: THREE.Vector3;
  influence: number;
  isLeaving: boolean;
}

/** The order in which clips are preferred as the first: those that show a character at ease, and poses without motion last. */
function rankOfClip({ name, seconds }: Clip): number {
  if (seconds < 0.1 || /t[-_ ]?pose|a[-_ ]pose|\bbind\b|\brest\b|\breset\b/i.test(name)) return 3;
  return /idle|breath/i.test(name) ? 0 : /walk/i.test(name) ? 1 : 2;
}

/**
 * Gives materials without a texture a white one if others have one, so that all have the same program: without a GPU, each takes
 * about as long to compile as a picture takes to draw.
 */
function sharePrograms({ parts }: BendyCharacter): void {
  const materials = parts.flatMap(({ object }) => object.material).filter((material) => material instanceof THREE.MeshStandardMaterial);
  if (!materials.some(({ map }) => map)) return;
  const white = new THREE.DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
  white.colorSpace = THREE.SRGBColorSpace;
  white.needsUpdate = true;
  for (const material of materials) material.map ??= white;
}

/** The rotations that the constraint of a joint allows. */
export interface Range {
  constraint: Constraint;
  object: THREE.Object3D;
}

export class Character {
  /** Weights of morph targets that replace those of the clip, by their numbers. */
  weights = new Map<number, number>();
  /** The results of the chains that reach. */
  readonly results = new Map<number, string>();
  obeysConstraints = true;
  #targets = new Map<number, Target>();
  #leader: Character | undefined;
  #gaze: Target | undefined; // what the look chain points at
  readonly chains: readonly Chain[];
  /** The chain that looks at the pointer. */
  readonly lookChain: Chain | undefined;
  /** The chains that the user can drag. */
  readonly limbs: readonly Chain[];
  readonly #model: Model;
  readonly #pose: Pose;
  readonly #reached: ReachState;
  readonly #animator: BendyAnimator;
  readonly #detail: LevelOfDetail;
  readonly #own: Motion;
  #borrowed: BorrowedMotion | undefined;
  readonly #box: THREE.Box3;
  #matrices: Float32Array; // of the joints, after the last update

  private constructor(readonly result: BendyCharacter) {
    this.#model = result.model;
    sharePrograms(result);
    this.#animator = new BendyAnimator(result);
    this.#pose = this.#animator.pose;
    this.chains = [...this.#model.chains];
    this.lookChain = this.chains.find(({ name, solver }) => solver === 'aim' && /look|head/i.test(name));
    this.limbs = this.chains.filter((chain) => chain !== this.lookChain);
    this.#detail = new LevelOfDetail(this.#model);
    this.#reached = new ReachState(this.#model);
    this.#own = new Motion(this.#model, this.#pose);
    this.#matrices = this.#pose.modelMatrices().slice();
    this.#box = this.#measure();
  }

  /** Opens a bendy file. Rejects with a BendyError. `findFile`: the bytes of an image that the file links to. */
  static async open(bytes: Uint8Array, findFile: (uri: string) => Uint8Array | undefined): Promise<Character> {
    const manager = new THREE.LoadingManager();
    const addresses: string[] = [];
    manager.setURLModifier((uri) => {
      if (/^data:/i.test(uri)) return uri;
      const found = findFile(uri);
      if (!found) throw new Error('it is not among the files that were given: give both at once');
      const address = URL.createObjectURL(new Blob([found as BlobPart]));
      addresses.push(address);
      return address;
    });
    try {
      return new Character(await new BendyLoader(manager).parseAsync(bytes));
    } finally {
      for (const address of addresses) URL.revokeObjectURL(address);
    }
  }

  /** Why images are missing. */
  get warnings(): readonly string[] {
    return this.result.warnings;
  }

  get object(): THREE.Object3D {
    return this.result.scene;
  }
  get morphTargets(): { name: string; number: number; weight: number }[] {
    return [...this.#model.morphTargets].map(({ name, number, restWeight }) => ({ name, number, weight: restWeight }));
  }
  get hasLevels(): boolean {
    return this.#model.hasLevels;
  }
  get triangles(): number {
    return this.#detail.triangles;
  }
  get facts(): string {
    const { joints, clips, vertexCount } = this.#model;
    return [counted(vertexCount, 'vertex', 'vertices'), counted(joints.length, 'joint', 'joints'), counted(clips.length, 'clip', 'clips')].join(', ');
  }
  get #motion(): Motion {
    return this.#borrowed ?? this.#own;
  }
  /** Those that move it: its own, or another character's. */
  get clips(): readonly Clip[] {
    return this.#motion.clips;
  }
  get clip(): number {
    return this.#motion.clip;
  }
  get isBorrowing(): boolean {
    return this.#borrowed !== undefined;
  }

  /** Plays the clips of another model from now on, which it then owns. Throws BAD_ARGUMENT if one of the two lacks roles. */
  borrow(source: Model): void {
    const borrowed = new BorrowedMotion(source, this.#pose);
    this.returnClips();
    this.#borrowed = borrowed;
  }

  /** Plays its own clips again. */
  returnClips(): void {
    this.#borrowed?.dispose();
    this.#borrowed = undefined;
  }

  /** The initial clip: the first of those that show the character at its best. */
  get firstClip(): number {
    const ranks = this.clips.map(rankOfClip);
    return Math.max(0, ranks.indexOf(Math.min(...ranks)));
  }

  /** The targets of the chains that reach, model space, by chain number. */
  get targets(): ReadonlyMap<number, THREE.Vector3> {
    return new Map([...this.#targets].filter(([, { isLeaving }]) => !isLeaving).map(([chain, { position }]) => [chain, position]));
  }

  /** Makes a chain reach for a point in model space. */
  reachFor(chain: number, position: THREE.Vector3): void {
    this.#targets.set(chain, { position, influence: 1, isLeaving: false });
  }

  /** Does from now on what another character of the same joints does: its clip, targets and weights. */
  follow(leader: Character): void {
    this.#leader = leader;
    this.#targets = leader.#targets;
    this.weights = leader.weights;
  }

  /** Lets a chain return to its clip. */
  letGo(chain: number): void {
    const target = this.#targets.get(chain);
    if (target) target.isLeaving = true;
  }

  play(clip: number, fade: number): void {
    this.#motion.play(clip, fade);
  }

  get seconds(): number {
    return this.#motion.seconds;
  }
  get share(): number {
    return this.#motion.share;
  }
  seek(share: number): void {
    this.#motion.seek(share);
  }
  step(seconds: number): void {
    this.#motion.step(seconds);
  }

  /** Sets the fraction of the triangles to draw. */
  setShare(share: number): void {
    this.#detail.setShare(share);
    setLevelOfDetail(this.result, share);
  }

  /**
   * Advances the clips, reaches, and moves the three.js objects.
   *
   * @param seconds - for the clips
   * @param passed - seconds since the last call
   * @param pointer - what the look chain points at
   */
  update(seconds: number, passed: number, pointer: THREE.Vector3 | undefined): void {
    if (this.#leader) {
      this.obeysConstraints = this.#leader.obeysConstraints;
      if (this.#leader.isBorrowing) this.#pose.setLocals(this.#leader.#pose.locals).setMorphWeights(this.#leader.#pose.morphWeights);
      else if (this.clips.length !== 0) this.#pose.sample(this.#leader.clip, this.#leader.seconds);
    } else {
      this.#motion.update(seconds);
    }
    for (const [target, weight] of this.weights) this.#pose.setMorphWeights([weight], target);
    this.results.clear();
    for (const chain of this.chains) {
      const target = chain === this.lookChain ? this.#look(pointer, passed) : this.#targets.get(chain.number);
      if (target) this.#reach(chain, target, passed);
      else this.#reached.forget(chain);
    }
    this.#animator.apply();
    this.#matrices = this.#pose.modelMatrices().slice();
  }

  /** What the look chain follows: the pointer, and after it has gone the place where it was, less and less. */
  #look(pointer: THREE.Vector3 | undefined, passed: number): Target | undefined {
    const share = 1 - Math.exp(-passed / turnSeconds);
    if (pointer) this.#gaze ??= { position: pointer.clone(), influence: 0, isLeaving: false };
    if (!this.#gaze) return undefined;
    if (pointer) this.#gaze.position.lerp(pointer, share);
    this.#gaze.influence += share * ((pointer ? 1 : 0) - this.#gaze.influence);
    if (!pointer && this.#gaze.influence < 0.01) this.#gaze = undefined;
    return this.#gaze;
  }

  #reach(chain: Chain, target: Target, passed: number): void {
    if (target.isLeaving && !this.#leader) target.influence -= passed / letGoSeconds;
    if (target.influence <= 0) return void this.#targets.delete(chain.number);
    const { influence, position } = target;
    const time = { state: this.#reached, seconds: Math.min(passed, 1) };
    const options = { ...time, obeyConstraints: this.obeysConstraints, ...(influence < 0.999 ? { influence } : {}) };
    const { status, distance, angle } = this.#pose.reach(chain.number, position.toArray(), options);
    if (target.isLeaving) return;
    const words = { reached: 'reached', aimed: 'aimed', out_of_reach: 'too far', not_reached: 'as near as it can' }[status];
    const left = chain.solver === 'aim' ? `${((180 / Math.PI) * angle).toFixed(1)}°` : `${(1000 * distance).toFixed(0)} mm`;
    this.results.set(chain.number, status === 'reached' || status === 'aimed' ? words : `${words}, ${left}`);
  }

  /** The position of a chain's tip in model space. */
  tip(number: number): THREE.Vector3 {
    const { links, tipOffset } = this.#model.chains[number]!;
    return new THREE.Vector3(...tipOffset).applyMatrix4(this.#matrix(links.at(-1)!));
  }

  /** The ranges of the constraints of a chain's joints, each to be placed at its joint. */
  ranges(number: number): Range[] {
    const { links, tipOffset } = this.#model.chains[number]!;
    return this.#model.constraints
      .filter(({ joint, scope }) => links.includes(joint) && scope !== 'all_but_ik')
      .map((constraint) => {
        const next = links[links.indexOf(constraint.joint) + 1];
        const bone = new THREE.Vector3(...(next === undefined ? tipOffset : this.#model.joints[next]!.rest.translation));
        return { constraint, object: drawRange(constraint, bone.applyQuaternion(new THREE.Quaternion(...constraint.frame).invert())) };
      });
  }

  /** Places a range at its joint: in the constraint's frame, which is the parent's with the joint at rest. */
  placeRange({ constraint, object }: Range, radius: number): void {
    const joint = this.#model.joints[constraint.joint]!;
    const parent = joint.parent === null ? new THREE.Matrix4() : this.#matrix(joint.parent);
    const rest = new THREE.Quaternion(...joint.rest.rotation).multiply(new THREE.Quaternion(...constraint.frame));
    const place = new THREE.Vector3().setFromMatrixPosition(this.#matrix(constraint.joint));
    const turn = new THREE.Quaternion().setFromRotationMatrix(new THREE.Matrix4().extractRotation(parent)).multiply(rest);
    object.matrix.compose(place, turn, new THREE.Vector3(radius, radius, radius));
  }

  /** The vertices in the current pose, or at rest: x y z in model space, a copy. */
  vertices(atRest = false): Float32Array {
    if (atRest) this.#pose.reset();
    return this.#pose.skin().positions.slice();
  }

  /** Draws the character with a material of its own and a colour for each vertex, which the result is for. */
  paint(): Float32Array {
    const colours = new Float32Array(3 * this.#model.vertexCount);
    for (const { object, mesh } of this.result.parts) {
      const { firstVertex, vertexCount, hasNormals } = this.#model.meshes[mesh]!;
      const own = colours.subarray(3 * firstVertex, 3 * (firstVertex + vertexCount));
      object.geometry.setAttribute('color', new THREE.BufferAttribute(own, 3));
      for (const material of [object.material].flat()) material.dispose();
      object.material = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 1, flatShading: !hasNormals });
    }
    return colours;
  }

  /** The colours of `paint` have changed. */
  repaint(): void {
    for (const { object } of this.result.parts) object.geometry.getAttribute('color')!.needsUpdate = true;
  }

  /** Whether the clip still fades in over the one before. */
  get isFading(): boolean {
    return this.#motion.isFading;
  }

  get hasMesh(): boolean {
    return this.#model.vertexCount !== 0;
  }

  /** Lines from joints to their children, in model space: x y z of both ends of each. */
  bones(points?: Float32Array): Float32Array {
    const children = this.#model.joints.filter(({ parent }) => parent !== null);
    const out = points ?? new Float32Array(6 * children.length);
    for (const [k, { number, parent }] of children.entries()) {
      for (const [end, joint] of [parent!, number].entries()) {
        for (let c = 0; c < 3; ++c) out[6 * k + 3 * end + c] = this.#matrices[16 * joint + 12 + c]!;
      }
    }
    return out;
  }

  /** A box around the character at rest and in its first clip. */
  box(): THREE.Box3 {
    return this.#box;
  }

  dispose(): void {
    for (const one of [this.#borrowed, this.#own, this.#reached, this.#detail, this.#animator]) one?.dispose();
    this.object.traverse((object) => {
      const { geometry, material } = object as THREE.Mesh;
      geometry?.dispose();
      for (const one of [material ?? []].flat()) {
        for (const value of Object.values(one)) if (value instanceof THREE.Texture) value.dispose();
        one.dispose();
      }
    });
    this.#model.dispose();
  }

  #matrix(joint: number): THREE.Matrix4 {
    return new THREE.Matrix4().fromArray(this.#matrices, 16 * joint);
  }

  #measure(): THREE.Box3 {
    const box = new THREE.Box3();
    const clip = this.clips[this.firstClip];
    this.#pose.reset();
    if (clip) this.#pose.sample(clip.number, clip.start);
    const { positions } = this.#pose.skin();
    for (let at = 0; at < positions.length; at += 3) box.expandByPoint(new THREE.Vector3().fromArray(positions, at));
    if (box.isEmpty()) {
      for (let joint = 0; joint < this.#model.joints.length; ++joint)
        box.expandByPoint(new THREE.Vector3().setFromMatrixPosition(this.#matrix(joint)));
    }
    return box.isEmpty() ? new THREE.Box3(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1)) : box;
  }
}
