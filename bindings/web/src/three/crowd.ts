import {
  BufferAttribute,
  type BufferGeometry,
  DataTexture,
  FloatType,
  Group,
  type IUniform,
  InstancedBufferAttribute,
  InstancedMesh,
  type Material,
  Matrix4,
  MeshDepthMaterial,
  MeshDistanceMaterial,
  RGBADepthPacking,
  REVISION,
  RGBAFormat,
} from 'three';
import { BendyError, type Clip, Crowd, type Key, type Mesh } from '../index.js';
import { repeats } from '../engines/player.js';
import { described } from '../errors.js';
import { checkIndex } from '../items.js';
import { checkNumber } from '../numbers.js';
import { checkOptions, optionNames } from '../options.js';
import type { BendyCharacter } from './character.js';
import { none } from '../runtime.js';
import { isSkinnedByRuntime, type Part, withIndex } from './parts.js';

/** Options of `BendyCrowd.play`. */
export interface CrowdPlayOptions {
  /** Seconds after the clip's start at which the member begins; 0 if not given. */
  offset?: number;
  /** 1, if not given: as authored. Negative plays backwards. */
  speed?: number;
  /** Whether the clip repeats. If not given: unless its `extras` have `"loop": false`. */
  loop?: boolean;
}

const playNames = optionNames<CrowdPlayOptions>({ offset: true, speed: true, loop: true });

/** What a member plays. */
interface Playing {
  readonly clip: Clip;
  readonly speed: number;
  readonly loop: boolean;
  /** Seconds after the clip's start. */
  time: number;
}

const matricesInRow = 512; // 2,048 texels, which every WebGL 2 has
const influencesInSet = 4;
const longest = 1e15; // seconds, so that no time becomes infinite
const mostInfluences = 8; // WebGL has 16 attributes, of which the place of a member takes four

/** Why a crowd cannot draw a part; null if it can. */
function refusal({ scene }: BendyCharacter, object: Part['object'], mesh: Mesh): string | null {
  if (!('isMesh' in object)) return 'consists of lines or points';
  if (mesh.influenceCount > mostInfluences) return `has ${mesh.influenceCount} influences a vertex, more than ${mostInfluences}`;
  if (isSkinnedByRuntime(object, scene)) return "is skinned by a BendyAnimator: skin: 'wasm'";
  const isMovedBySeveral = mesh.isRigid && mesh.mover === null && mesh.movers().some((joint) => joint !== none);
  return isMovedBySeveral ? 'has no bones and is moved by several joints' : null;
}

/** The influences of a mesh as attributes, four to each: bones and weights of the first, of the second. */
function influencesOf({ vertexCount, influenceCount, bones, weights }: Mesh): BufferAttribute[] {
  return Array.from({ length: Math.ceil(influenceCount / influencesInSet) }, (_, set) => {
    const [setBones, setWeights] = [new Float32Array(influencesInSet * vertexCount), new Float32Array(influencesInSet * vertexCount)];
    const end = Math.min(influencesInSet, influenceCount - influencesInSet * set);
    for (let vertex = 0; vertex < vertexCount; ++vertex) {
      for (let k = 0; k < end; ++k) {
        const from = influenceCount * vertex + influencesInSet * set + k;
        setBones[influencesInSet * vertex + k] = bones[from]!;
        setWeights[influencesInSet * vertex + k] = weights[from]!;
      }
    }
    return [setBones, setWeights].map((numbers) => new BufferAttribute(numbers, influencesInSet));
  }).flat();
}

/** Declares crowdSkin(), the matrix of a vertex: the weighted sum of its bones' matrices, or the only one of a rigid mesh. */
function skinningShader(sets: number): string {
  const ofSet = (set: number): string =>
    ['x', 'y', 'z', 'w'].map((c) => `skin += crowdWeights${set}.${c} * crowdMatrix(int(crowdBones${set}.${c}));\n`).join('');
  const all = Array.from({ length: sets }, (_, set) => set);
  return `
    uniform highp sampler2D crowdMatrices;
    uniform int crowdFirst; // the first matrix of this mesh in those of a member
    uniform int crowdCount; // matrices of a member
    ${all.map((set) => `attribute vec4 crowdBones${set};\nattribute vec4 crowdWeights${set};`).join('\n')}
    mat4 crowdMatrix(int bone) {
      int matrix = gl_InstanceID * crowdCount + crowdFirst + bone;
      ivec2 at = ivec2(4 * (matrix % ${matricesInRow}), matrix / ${matricesInRow});
      return mat4(texelFetch(crowdMatrices, at, 0), texelFetch(crowdMatrices, at + ivec2(1, 0), 0),
        texelFetch(crowdMatrices, at + ivec2(2, 0), 0), texelFetch(crowdMatrices, at + ivec2(3, 0), 0));
    }
    mat4 crowdSkin() {
      ${sets === 0 ? 'return crowdMatrix(0);' : `mat4 skin = mat4(0.0);\n${all.map(ofSet).join('')}return skin;`}
    }`;
}

const skinNormal = `
    mat3 crowdNormal = mat3(crowdSkin());
    objectNormal = crowdNormal * objectNormal;
    #ifdef USE_TANGENT
      objectTangent = crowdNormal * objectTangent;
    #endif`;
const skinVertex = 'transformed = (crowdSkin() * vec4(transformed, 1.0)).xyz;';

/** Lets a material draw members of a crowd. */
function patch<T extends Material>(material: T, sets: number, uniforms: Record<string, IUniform>): T {
  material.customProgramCacheKey = () => `bendy crowd ${sets}`;
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace('#include <skinning_pars_vertex>', skinningShader(sets))
      .replace('#include <skinnormal_vertex>', skinNormal)
      .replace('#include <skinning_vertex>', skinVertex);
  };
  return material;
}

/**
 * Many copies of a character, each at its own place and its own time of a clip. The runtime poses them, and three.js draws all copies
 * of a part with one call, by WebGLRenderer.
 *
 *     const crowd = new BendyCrowd(fox, 1000);
 *     for (let member = 0; member < crowd.size; ++member) {
 *       crowd.setMatrixAt(member, new Matrix4().setPosition(2 * member, 0, 0)).play(member, 'Walk', { offset: member * 0.1 });
 *     }
 *     scene.add(crowd);
 *     // each frame
 *     crowd.update(seconds);
 *
 * Morph targets keep their rest weights. Raycasts hit no member, and all members are drawn, whether the camera sees them or not.
 */
export class BendyCrowd extends Group {
  readonly character: BendyCharacter;
  /** The number of members. */
  readonly size: number;
  /** The drawn objects, one for each part of the character. They share `instanceMatrix`. */
  readonly parts: readonly InstancedMesh[];
  readonly #crowd: Crowd;
  readonly #matrices: DataTexture;
  readonly #places: InstancedBufferAttribute;
  readonly #playing: (Playing | null)[];
  readonly #influences = new Map<Mesh, BufferAttribute[]>();

  /**
   * Makes a crowd at rest, with all members at the origin, of copies of the character's materials and of its present level of detail.
   * Throws OUT_OF_MEMORY, DISPOSED; BAD_ARGUMENT for a negative size, for lines and points, for more than eight influences a vertex, for a
   * character whose vertices a BendyAnimator skins, and for a mesh without bones that several joints move.
   */
  constructor(character: BendyCharacter, size: number) {
    super();
    const model = character?.model as BendyCharacter['model'] | undefined;
    if (model === undefined) throw new BendyError('bad_argument', `expected the result of BendyLoader, found ${described(character)}`);
    for (const { object, mesh } of character.parts) {
      const why = refusal(character, object, model.meshes[mesh]!);
      if (why !== null) throw new BendyError('bad_argument', `a crowd cannot draw ${object.name}, which ${why}`);
    }
    this.#crowd = new Crowd(model, size);
    this.character = character;
    this.size = size;
    this.#playing = Array.from({ length: size }, () => null);
    const { matrixCount } = this.#crowd;
    const rows = Math.max(1, Math.ceil((matrixCount * size) / matricesInRow));
    this.#matrices = new DataTexture(new Float32Array(16 * matricesInRow * rows), 4 * matricesInRow, rows, RGBAFormat, FloatType);
    this.#places = new InstancedBufferAttribute(new Float32Array(16 * size), 16);
    for (let member = 0; member < size; ++member) this.setMatrixAt(member, new Matrix4());
    this.parts = character.parts.map(({ object, mesh }) => this.#makePart(object as InstancedMesh, model.meshes[mesh]!));
    if (this.parts.length > 0) this.add(...this.parts);
    this.update(0);
  }

  #makePart(object: { geometry: BufferGeometry; material: Material | Material[]; name: string }, mesh: Mesh): InstancedMesh {
    const geometry = withIndex(object.geometry, object.geometry.index!.clone()); // a level of detail changes the character's
    geometry.deleteAttribute('skinIndex');
    geometry.deleteAttribute('skinWeight');
    const influences = this.#influences.get(mesh) ?? (mesh.isRigid ? [] : influencesOf(mesh));
    this.#influences.set(mesh, influences);
    influences.forEach((attribute, k) => geometry.setAttribute(`crowd${k % 2 === 0 ? 'Bones' : 'Weights'}${k >> 1}`, attribute));
    const sets = influences.length / 2;
    const uniforms = {
      crowdMatrices: { value: this.#matrices },
      crowdFirst: { value: this.#crowd.firstMatrix(mesh) },
      crowdCount: { value: this.#crowd.matrixCount },
    };
    const part = new InstancedMesh(geometry, patch((object.material as Material).clone(), sets, uniforms), this.size);
    part.name = object.name;
    part.instanceMatrix = this.#places;
    part.frustumCulled = false; // its bounds are those of one member at rest,
    part.raycast = () => {}; // and so are its triangles
    if (mesh.morphTargets.length > 0) part.morphTargetInfluences = mesh.morphTargets.map(({ restWeight }) => restWeight);
    // Releases before 182 store depths in colours.
    const depth = Number.parseInt(REVISION) < 182 ? new MeshDepthMaterial({ depthPacking: RGBADepthPacking }) : new MeshDepthMaterial();
    part.customDepthMaterial = patch(depth, sets, uniforms);
    part.customDistanceMaterial = patch(new MeshDistanceMaterial(), sets, uniforms);
    return part;
  }

  /** Places a member, in the space of the crowd. Throws BAD_ARGUMENT. */
  setMatrixAt(member: number, matrix: Matrix4): this {
    matrix.toArray(this.#places.array, 16 * this.#check(member));
    this.#places.needsUpdate = true;
    return this;
  }

  /** Starts a clip, which `update` plays. Throws NOT_FOUND, BAD_ARGUMENT. */
  play(member: number, clip: Key<Clip>, options: CrowdPlayOptions = {}): this {
    checkOptions('play', options, playNames);
    const { offset = 0, speed = 1, loop } = options;
    if (!Number.isFinite(offset) || !Number.isFinite(speed)) {
      throw new BendyError('bad_argument', `offset ${offset} and speed ${speed} must be finite numbers`);
    }
    const found = this.character.model.clips.get(clip);
    this.#playing[this.#check(member)] = { clip: found, speed, loop: loop ?? repeats(found), time: offset };
    return this;
  }

  /** Ends what a member plays: it is at rest from the next `update` on. Throws BAD_ARGUMENT. */
  stop(member: number): this {
    this.#playing[this.#check(member)] = null;
    return this;
  }

  /** Advances all members by seconds, and poses them. Throws BAD_ARGUMENT unless the seconds are finite, DISPOSED. */
  update(seconds: number): this {
    if (this.#crowd.disposed) throw new BendyError('disposed', 'this BendyCrowd has been disposed');
    if (!Number.isFinite(checkNumber(seconds, 'seconds'))) throw new BendyError('bad_argument', `${seconds} seconds are not a finite number`);
    for (const [member, playing] of this.#playing.entries()) {
      if (playing === null) {
        this.#crowd.set(member, null, 0);
        continue;
      }
      const { clip, speed, loop } = playing;
      const length = clip.seconds;
      const time = Math.min(Math.max(playing.time + seconds * speed, -longest), longest);
      playing.time = !loop || length <= 0 ? Math.min(Math.max(time, 0), length) : time - length * Math.floor(time / length);
      this.#crowd.set(member, clip.number, clip.start + playing.time);
    }
    this.#crowd.play();
    (this.#matrices.image.data as Float32Array).set(this.#crowd.palettes);
    this.#matrices.needsUpdate = true;
    return this;
  }

  /** Releases the crowd's memory, here and on the GPU. The character stays usable. */
  override dispose(): void {
    this.dispatchEvent({ type: 'dispose' });
    this.#crowd.dispose();
    this.#matrices.dispose();
    for (const part of this.parts) {
      part.geometry.dispose();
      for (const material of [part.material as Material, part.customDepthMaterial!, part.customDistanceMaterial!]) material.dispose();
      part.dispose();
    }
  }

  #check(member: number): number {
    return checkIndex(member, this.size, 'member');
  }
}
