/**
 * Bendy's characters in Babylon.js: `bendy/babylon`.
 *
 *     const fox = await loadBendy('fox.bendy', scene);
 *     fox.play('Walk');
 *     scene.onBeforeRenderObservable.add(() => fox.update(engine.getDeltaTime() / 1000));
 *
 * Babylon.js keeps the 16 numbers of a matrix as Bendy does, although it multiplies row vectors: its `a.multiply(b)` is what column
 * vectors write as b * a. So a palette is `inverseBind.multiply(joint)`. The product in the order of the page of a textbook,
 * `joint.multiply(inverseBind)`, is 2.77 off for the mannequin's Idle at 0 s. And `Bone.updateMatrix(matrix)` also rebinds the bone,
 * so that it never moves. Here each bone of Babylon.js is one matrix of `Pose.palette`, without parent and bound at the identity:
 * neither product nor inverse is left to the engine, and shear stays.
 *
 * @packageDocumentation
 */
import { Bone } from '@babylonjs/core/Bones/bone.js';
import { Skeleton } from '@babylonjs/core/Bones/skeleton.js';
import { VertexBuffer } from '@babylonjs/core/Buffers/buffer.js';
import { Material } from '@babylonjs/core/Materials/material.js';
import { MultiMaterial } from '@babylonjs/core/Materials/multiMaterial.js';
import { PBRMaterial } from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
import { Texture } from '@babylonjs/core/Materials/Textures/texture.js';
import { Color3 } from '@babylonjs/core/Maths/math.color.js';
import { Matrix, Quaternion } from '@babylonjs/core/Maths/math.vector.js';
import { Mesh } from '@babylonjs/core/Meshes/mesh.js';
import { SubMesh } from '@babylonjs/core/Meshes/subMesh.js';
import { TransformNode } from '@babylonjs/core/Meshes/transformNode.js';
import type { Scene } from '@babylonjs/core/scene.js';
import type { Joint, Key, Material as BendyMaterial, Mesh as BendyMesh, Model, TextureUse } from '../index.js';
import { canSkin, embeddedImage, type EngineOptions, fourInfluences, loadCharacter, mediaType, Player, type Source } from './player.js';

export type { ClipOptions, EngineOptions, Source } from './player.js';

const mostInfluences = 8;
let textureCount = 0; // Babylon.js shares textures of one address

/** A mesh of Babylon.js, and the mesh of the model that it draws. */
export interface BabylonPart {
  readonly mesh: BendyMesh;
  readonly object: Mesh;
  /** One bone for each matrix of the mesh's palette; null if the runtime skins the vertices. */
  readonly skeleton: Skeleton | null;
}

/** A character in a scene. Its space, below `root`, is the model's: metres, right-handed, y up. */
export class BabylonCharacter extends Player {
  readonly root: TransformNode;
  readonly parts: readonly BabylonPart[];
  readonly #nodes = new Map<number, TransformNode>();
  readonly #materials: Material[];

  /** @internal */
  constructor(model: Model, scene: Scene, options: EngineOptions) {
    super(model);
    this.root = new TransformNode(model.name || 'bendy', scene);
    if (!scene.useRightHandedSystem) {
      // As Babylon.js does with glTF: mirrored, and turned so that the character still faces the same way.
      this.root.scaling.z = -1;
      this.root.rotationQuaternion = new Quaternion(0, 1, 0, 0);
    }
    const made = [...model.materials].map((material) => makeMaterial(material, model, scene));
    this.#materials = [...made, new PBRMaterial('default', scene)];
    this.parts = model.meshes
      .filter((mesh) => mesh.positions.length > 0)
      .map((mesh) => makePart(mesh, model, scene, this.root, this.#materials, canSkin(mesh, mostInfluences, options)));
    this.apply();
  }

  /** A node that follows a joint from `apply` to `apply`, below `root`: parent of what the joint carries. Throws NOT_FOUND. */
  attach(joint: Key<Joint>): TransformNode {
    const { number, name } = this.model.joints.get(joint);
    let node = this.#nodes.get(number);
    if (node === undefined) {
      node = new TransformNode(name, this.root.getScene());
      node.parent = this.root;
      node.rotationQuaternion = new Quaternion();
      this.#nodes.set(number, node);
      this.#follow(node, number);
    }
    return node;
  }

  #follow(node: TransformNode, joint: number): void {
    Matrix.FromArray(this.pose.socket(joint)).decompose(node.scaling, node.rotationQuaternion!, node.position);
  }

  override apply(): this {
    for (const { mesh, object, skeleton } of this.parts) {
      if (skeleton !== null) {
        const palette = this.pose.palette(mesh);
        skeleton.bones.forEach((bone, k) => {
          Matrix.FromArrayToRef(palette, 16 * k, bone.getLocalMatrix());
          bone.markAsDirty();
        });
        continue;
      }
      const skinned = this.pose.skin({ mesh, normals: mesh.hasNormals, tangents: mesh.hasTangents });
      object.updateVerticesData(VertexBuffer.PositionKind, skinned.positions);
      if (mesh.hasNormals) object.updateVerticesData(VertexBuffer.NormalKind, skinned.normals);
      if (mesh.hasTangents) object.updateVerticesData(VertexBuffer.TangentKind, skinned.tangents);
    }
    for (const [joint, node] of this.#nodes) this.#follow(node, joint);
    return this;
  }

  override dispose(): void {
    for (const { object, skeleton } of this.parts) for (const one of [skeleton, object.material]) one?.dispose();
    this.root.dispose();
    for (const material of this.#materials) material.dispose(false, true);
    super.dispose();
  }
}

function makePart(mesh: BendyMesh, model: Model, scene: Scene, root: TransformNode, materials: Material[], isSkinned: boolean): BabylonPart {
  const object = new Mesh(mesh.name || `mesh_${mesh.number}`, scene, root);
  object.sideOrientation = scene.useRightHandedSystem ? Material.CounterClockWiseSideOrientation : Material.ClockWiseSideOrientation;
  object.alwaysSelectAsActiveMesh = true; // its bounds change from frame to frame
  object.setVerticesData(VertexBuffer.PositionKind, mesh.positions, !isSkinned);
  if (mesh.normals !== null) object.setVerticesData(VertexBuffer.NormalKind, mesh.normals, !isSkinned);
  if (mesh.tangents !== null) object.setVerticesData(VertexBuffer.TangentKind, mesh.tangents, !isSkinned);
  const kinds = [VertexBuffer.UVKind, VertexBuffer.UV2Kind];
  mesh.textureCoords.slice(0, kinds.length).forEach((coords, set) => object.setVerticesData(kinds[set]!, coords));
  const [colours] = mesh.colours;
  if (colours !== undefined) object.setVerticesData(VertexBuffer.ColorKind, colours, false, colours.length / mesh.vertexCount);
  object.setIndices(mesh.indices, mesh.vertexCount);
  const submeshes = model.submeshes.filter((one) => one.mesh === mesh.number && one.topology === 'triangles' && one.count > 0);
  const used = new MultiMaterial(object.name, scene);
  used.subMaterials = submeshes.map(({ material }) => materials[material ?? materials.length - 1]!);
  object.material = used;
  object.subMeshes = [];
  submeshes.forEach(({ first, count }, k) => new SubMesh(k, 0, mesh.vertexCount, first, count, object)); // has bounds: what blends is sorted by them
  return { mesh, object, skeleton: isSkinned ? bind(object, mesh, scene) : null };
}

/** Gives an object the influences of a mesh, and a skeleton without hierarchy: one bone per matrix of the palette. */
function bind(object: Mesh, mesh: BendyMesh, scene: Scene): Skeleton {
  const skeleton = new Skeleton(object.name, `bendy_${object.uniqueId}`, scene);
  for (let bone = 0; bone < mesh.boneCount; ++bone) {
    new Bone(`${mesh.name}_${bone}`, skeleton, null, Matrix.Identity());
  }
  const first = fourInfluences(mesh, 0);
  object.setVerticesData(VertexBuffer.MatricesIndicesKind, first.bones);
  object.setVerticesData(VertexBuffer.MatricesWeightsKind, first.weights);
  if (mesh.influenceCount > 4) {
    const second = fourInfluences(mesh, 4);
    object.setVerticesData(VertexBuffer.MatricesIndicesExtraKind, second.bones);
    object.setVerticesData(VertexBuffer.MatricesWeightsExtraKind, second.weights);
  }
  object.numBoneInfluencers = mesh.influenceCount;
  object.skeleton = skeleton;
  return skeleton;
}


function makeMaterial(source: BendyMaterial, model: Model, scene: Scene): PBRMaterial {
  const made = new PBRMaterial(source.name, scene);
  const texture = (use: TextureUse | null): Texture | null => (use === null ? null : makeTexture(use, model, scene));
  made.albedoColor = Color3.FromArray(source.baseColour);
  made.alpha = source.baseColour[3];
  made.albedoTexture = texture(source.baseColourTexture);
  made.metallic = source.metallic;
  made.roughness = source.roughness;
  made.metallicTexture = texture(source.metallicRoughnessTexture);
  made.useRoughnessFromMetallicTextureGreen = made.useMetallnessFromMetallicTextureBlue = true;
  made.useRoughnessFromMetallicTextureAlpha = false;
  made.bumpTexture = texture(source.normalTexture);
  made.invertNormalMapX = !scene.useRightHandedSystem;
  made.invertNormalMapY = scene.useRightHandedSystem;
  made.emissiveColor = Color3.FromArray(source.emissive);
  made.emissiveTexture = texture(source.emissiveTexture);
  made.backFaceCulling = !source.doubleSided;
  made.twoSidedLighting = source.doubleSided;
  made.unlit = source.unlit;
  made.useAlphaFromAlbedoTexture = source.alphaMode !== 'opaque' && made.albedoTexture !== null;
  if (made.albedoTexture !== null) made.albedoTexture.hasAlpha = source.alphaMode !== 'opaque';
  made.transparencyMode = { opaque: 0, mask: 1, blend: 2 }[source.alphaMode];
  made.alphaCutOff = source.alphaCutoff;
  return made;
}

/** A texture of an image inside the file, as the material uses it. Babylon.js decodes no other here. */
function makeTexture(use: TextureUse, model: Model, scene: Scene): Texture | null {
  const source = model.textures[use.texture]!;
  const image = embeddedImage(source);
  if (image === null) return null;
  const options = { invertY: false, buffer: new Blob([image.bytes], { type: mediaType(image) }), deleteBuffer: true };
  const made = new Texture(`data:bendy_${++textureCount}`, scene, options);
  const wraps = { repeat: Texture.WRAP_ADDRESSMODE, clamp_to_edge: Texture.CLAMP_ADDRESSMODE, mirrored_repeat: Texture.MIRROR_ADDRESSMODE };
  [made.wrapU, made.wrapV, made.coordinatesIndex] = [wraps[source.wrapS], wraps[source.wrapT], use.set];
  [[made.uOffset, made.vOffset], [made.uScale, made.vScale], made.wAng] = [use.offset, use.scale, -use.rotation];
  [made.uRotationCenter, made.vRotationCenter] = [0, 0];
  return made;
}

/** Loads a character into a scene. Rejects with the BendyError of `Model.open`. */
export function loadBendy(source: Source, scene: Scene, options: EngineOptions = {}): Promise<BabylonCharacter> {
  return loadCharacter(source, options, (model) => new BabylonCharacter(model, scene, options));
}
