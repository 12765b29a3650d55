import { type Bone, Object3D, Skeleton, SkinnedMesh, Vector3 } from 'three';
import type { GLTF, GLTFLoaderPlugin, GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import { type EulerBox, eulerBox } from './euler_limits.js';

/** A chain as CCDIKSolver takes it. The numbers are those of `GltfRig.mesh.skeleton.bones`. */
export interface GltfChain {
  /** The name of the chain in the file. */
  readonly name: string;
  target: number;
  effector: number;
  /** From the effector's end of the chain to its start. */
  links: { index: number; rotationMin?: Vector3; rotationMax?: Vector3 }[];
  iteration: number;
  blendFactor?: number;
}

/** The limits and IK chains of a glTF file, for three.js's CCDIKSolver: `new CCDIKSolver(rig.mesh, rig.iks)`; and what joints are. */
export interface GltfRig {
  /** Draws nothing. The bones of its skeleton are the objects of all chains. */
  readonly mesh: SkinnedMesh;
  readonly iks: GltfChain[];
  /** The object that each chain reaches for, by the chain's name: its target in the file, or an object made for it at the tip. */
  readonly targets: ReadonlyMap<string, Object3D>;
  /** What the objects are in the body, by the words of BENDY_joint_role: one for `leftHand`, all of a `tail` from the body outwards. */
  readonly roles: ReadonlyMap<string, readonly Object3D[]>;
}

type Json = Record<string, unknown>;

/** CCDIKSolver's steps where the file leaves them open. */
const usualIterations = 10;

const isObject = (value: unknown): value is Json => typeof value === 'object' && value !== null && !Array.isArray(value);

/**
 * Reads BENDY_joint_limits, BENDY_joint_role and BENDY_ik_chains, which `bendy export` writes, into `userData.rig` of what GLTFLoader
 * returns. What is faulty is left out, with a warning on the console.
 *
 *     const { scene, userData } = await new GLTFLoader().register((parser) => new GltfRigPlugin(parser)).loadAsync('fox.glb');
 *     const solver = new CCDIKSolver(userData.rig.mesh, userData.rig.iks);
 */
export class GltfRigPlugin implements GLTFLoaderPlugin {
  readonly name = 'BENDY_ik_chains';
  readonly #parser: GLTFParser;

  constructor(parser: GLTFParser) {
    this.#parser = parser;
  }

  async afterRoot(gltf: GLTF): Promise<void> {
    gltf.userData['rig'] = await new RigReader(this.#parser, gltf.scene).read();
  }
}

class RigReader {
  readonly #bones: Object3D[] = [];
  readonly #targets = new Map<string, Object3D>();
  readonly #boxes = new Map<Object3D, EulerBox | null>();
  readonly #nodes: readonly unknown[];

  constructor(
    readonly parser: GLTFParser,
    readonly scene: Object3D,
  ) {
    const { nodes } = parser.json as { nodes?: unknown };
    this.#nodes = Array.isArray(nodes) ? nodes : [];
  }

  async read(): Promise<GltfRig> {
    const { extensions } = this.parser.json as { extensions?: unknown };
    const extension = isObject(extensions) ? extensions['BENDY_ik_chains'] : undefined;
    const chains = isObject(extension) ? extension['chains'] : undefined;
    const iks: GltfChain[] = [];
    this.scene.updateMatrixWorld(true);
    for (const [k, chain] of (Array.isArray(chains) ? chains : []).entries()) {
      try {
        const read = isObject(chain) ? await this.#readChain(chain, `chain ${k}`) : null;
        if (read !== null) iks.push(read);
      } catch (error) {
        console.warn(`GltfRigPlugin: extensions.BENDY_ik_chains.chains[${k}] left out: ${(error as Error).message}`);
      }
    }
    const mesh = new SkinnedMesh();
    mesh.skeleton = new Skeleton(this.#bones as Bone[]);
    return { mesh, iks, targets: this.#targets, roles: this.#roles() };
  }

  #roles(): Map<string, Object3D[]> {
    const found: { role: string; place: number; object: Object3D }[] = [];
    this.scene.traverse((object) => {
      const [number, extension] = this.#extension(object, 'BENDY_joint_role');
      if (!isObject(extension)) return;
      const { role, place = 0 } = extension;
      if (typeof role === 'string' && Number.isInteger(place)) found.push({ role, place: place as number, object });
      else console.warn(`GltfRigPlugin: nodes[${number}].extensions.BENDY_joint_role left out: a word and a whole number are expected`);
    });
    const roles = new Map<string, Object3D[]>();
    for (const { role, object } of found.sort((a, b) => a.place - b.place)) roles.set(role, [...(roles.get(role) ?? []), object]);
    return roles;
  }

  /** The number of an object's node, and an extension of that. */
  #extension(object: Object3D, name: string): [number: number | undefined, extension: unknown] {
    const number = this.parser.associations.get(object)?.nodes;
    const node = number === undefined ? undefined : this.#nodes[number];
    const extensions = isObject(node) ? node['extensions'] : undefined;
    return [number, isObject(extensions) ? extensions[name] : undefined];
  }

  /** Null if nothing of the chain can turn. */
  async #readChain(chain: Json, unnamed: string): Promise<GltfChain | null> {
    const [start, effector] = [await this.#node(chain, 'start'), await this.#node(chain, 'effector')];
    const target = chain['target'] === undefined ? null : await this.#node(chain, 'target');
    const given = chain['tipOffset'] ?? [0, 0, 0];
    if (!Array.isArray(given) || given.length !== 3 || !given.every(Number.isFinite))
      throw new Error('tipOffset: three numbers are expected');
    const path = [effector];
    for (let joint = effector; joint !== start; path.push(joint)) {
      if (joint.parent === null) throw new Error('start: it is neither the effector nor above it');
      joint = joint.parent;
    }
    const offset = new Vector3().fromArray(given as number[]);
    const hasOffset = offset.lengthSq() > 0;
    if (!hasOffset) path.shift(); // the effector does not move its own origin
    if (path.length === 0) return null;
    const links = path.map((joint) => this.#link(joint));
    const name = typeof chain['name'] === 'string' && chain['name'] !== '' ? chain['name'] : unnamed;
    const tip = hasOffset ? this.#made(`${name} tip`, effector, offset) : effector;
    const goal = target ?? this.#made(`${name} target`, this.scene, this.scene.worldToLocal(tip.getWorldPosition(new Vector3())));
    if (!this.#targets.has(name)) this.#targets.set(name, goal);
    const { iterations, influence } = chain;
    return {
      name,
      target: this.#number(goal),
      effector: this.#number(tip),
      links,
      iteration: Number.isInteger(iterations) && (iterations as number) > 0 ? (iterations as number) : usualIterations,
      ...(typeof influence === 'number' && influence >= 0 && influence < 1 ? { blendFactor: influence } : {}),
    };
  }

  /** The object of the node whose number a member is. */
  async #node(chain: Json, key: string): Promise<Object3D> {
    const number = chain[key];
    if (!Number.isInteger(number) || (number as number) < 0 || (number as number) >= this.#nodes.length)
      throw new Error(`${key}: the number of a node is expected, below ${this.#nodes.length}`);
    return (await this.parser.getDependency('node', number as number)) as Object3D;
  }

  #number(object: Object3D): number {
    const known = this.#bones.indexOf(object);
    return known >= 0 ? known : this.#bones.push(object) - 1;
  }

  #made(name: string, parent: Object3D, position: Vector3): Object3D {
    const object = new Object3D();
    object.name = name;
    object.position.copy(position);
    parent.add(object);
    object.updateMatrixWorld(true);
    return object;
  }

  #link(joint: Object3D): GltfChain['links'][number] {
    const link = { index: this.#number(joint) };
    if (!this.#boxes.has(joint)) this.#boxes.set(joint, this.#boxOf(joint));
    const box = this.#boxes.get(joint);
    return box ? { ...link, rotationMin: box.min, rotationMax: box.max } : link;
  }

  /** The limit that a joint has for IK. Its object takes the order of the Euler angles; its rotation stays as it is. */
  #boxOf(joint: Object3D): EulerBox | null {
    const [number, extension] = this.#extension(joint, 'BENDY_joint_limits');
    const limits = isObject(extension) && Array.isArray(extension['limits']) ? extension['limits'].filter(isObject) : [];
    const limit = limits.find(({ scope }) => scope === 'ikOnly') ?? limits.find(({ scope }) => (scope ?? 'everyPose') === 'everyPose');
    if (limit === undefined) return null;
    try {
      const box = eulerBox(limit, joint.quaternion, joint.rotation.order);
      if (box !== null) joint.rotation.reorder(box.order);
      return box;
    } catch (error) {
      const place = `nodes[${number}].extensions.BENDY_joint_limits.limits[${limits.indexOf(limit)}]`;
      console.warn(`GltfRigPlugin: ${place} left out: ${(error as Error).message}`);
      return null;
    }
  }
}
