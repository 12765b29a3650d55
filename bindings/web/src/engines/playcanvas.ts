/**
 * Bendy's characters in PlayCanvas: `bendy/playcanvas`.
 *
 *     const fox = await loadBendy('fox.bendy', app);
 *     app.root.addChild(fox.entity);
 *     fox.play('Walk');
 *     app.on('update', (seconds) => fox.update(seconds));
 *
 * @packageDocumentation
 */
import * as pc from 'playcanvas';
import type { Joint, Key, Material, Mesh, Model, TextureUse } from '../index.js';
import { canSkin, embeddedImage, type EngineOptions, fourInfluences, loadCharacter, mediaType, Player, type Source } from './player.js';

export type { ClipOptions, EngineOptions, Source } from './player.js';

const mostInfluences = 4;

/** A skin whose matrices are the runtime's palette. PlayCanvas would multiply the joints' matrices itself, and without shear. */
class PaletteSkin extends pc.SkinInstance {
  constructor(device: pc.GraphicsDevice, mesh: Mesh) {
    const matrices = Array.from({ length: mesh.boneCount }, () => new pc.Mat4());
    super(new pc.Skin(device, matrices, matrices.map((_, bone) => `${mesh.name}_${bone}`)));
  }

  /** Writes 16 floats per bone, column by column, as three rows of four: the form of the engine's texture. */
  write(palette: Float32Array): void {
    const rows = this.matrixPalette;
    for (let from = 0, to = 0; from < palette.length; from += 16) {
      for (let row = 0; row < 3; ++row) for (let column = 0; column < 4; ++column) rows[to++] = palette[from + 4 * column + row]!;
    }
  }

  override updateMatrices(): void {}

  override updateMatrixPalette(): void {
    this.uploadBones(this.skin.device);
  }
}

/** What PlayCanvas draws of a mesh of the model. */
export interface PlayCanvasPart {
  readonly mesh: Mesh;
  /** One for each submesh; they share their vertices. */
  readonly instances: readonly pc.MeshInstance[];
  /** The matrices by which PlayCanvas skins; null if the runtime skins the vertices. */
  readonly skin: pc.SkinInstance | null;
}

/** A character. Its space, below `entity`, is the model's: metres, right-handed, y up. */
export class PlayCanvasCharacter extends Player {
  readonly entity: pc.Entity;
  readonly parts: readonly PlayCanvasPart[];
  readonly #device: pc.GraphicsDevice;
  readonly #nodes = new Map<number, pc.Entity>();
  readonly #materials: pc.StandardMaterial[];

  /** @internal */
  constructor(model: Model, app: pc.AppBase, options: EngineOptions) {
    super(model);
    this.entity = new pc.Entity(model.name || 'bendy', app);
    this.#device = app.graphicsDevice;
    this.#materials = [...[...model.materials].map((material) => makeMaterial(material, model, this.#device)), new pc.StandardMaterial()];
    this.parts = model.meshes
      .filter((mesh) => mesh.positions.length > 0)
      .map((mesh) => this.#makePart(mesh, canSkin(mesh, mostInfluences, options)));
    this.entity.addComponent('render', { meshInstances: this.parts.flatMap(({ instances }) => instances) });
    for (const { mesh, instances } of this.parts) {
      // What blends is sorted by its bounds. The component has set its own, of nothing.
      for (const instance of instances) instance.setCustomAabb(boundsAtRest(mesh, instance.mesh!.primitive[0]!));
    }
    this.apply();
  }

  /** An entity that follows a joint from `apply` to `apply`, below `entity`: parent of what the joint carries. Throws NOT_FOUND. */
  attach(joint: Key<Joint>): pc.Entity {
    const { number, name } = this.model.joints.get(joint);
    let node = this.#nodes.get(number);
    if (node === undefined) {
      node = new pc.Entity(name);
      this.entity.addChild(node);
      this.#nodes.set(number, node);
      this.#follow(node, number);
    }
    return node;
  }

  #follow(node: pc.Entity, joint: number): void {
    const matrix = new pc.Mat4();
    matrix.data.set(this.pose.socket(joint));
    node.setLocalPosition(matrix.getTranslation());
    node.setLocalRotation(new pc.Quat().setFromMat4(matrix));
    node.setLocalScale(matrix.getScale());
  }

  override apply(): this {
    for (const { mesh, instances, skin } of this.parts) {
      if (skin instanceof PaletteSkin) {
        skin.write(this.pose.palette(mesh));
        continue;
      }
      const drawn = instances[0]?.mesh;
      if (drawn == null) continue;
      const skinned = this.pose.skin({ mesh, normals: mesh.hasNormals, tangents: mesh.hasTangents });
      drawn.setPositions(skinned.positions);
      if (mesh.hasNormals) drawn.setNormals(skinned.normals);
      if (mesh.hasTangents) drawn.setVertexStream(pc.SEMANTIC_TANGENT, skinned.tangents, 4);
      drawn.update(pc.PRIMITIVE_TRIANGLES, false);
    }
    for (const [joint, node] of this.#nodes) this.#follow(node, joint);
    return this;
  }

  override dispose(): void {
    this.entity.destroy();
    for (const material of this.#materials) {
      for (const texture of [material.diffuseMap, material.metalnessMap, material.normalMap, material.emissiveMap]) texture?.destroy();
      material.destroy();
    }
    super.dispose();
  }

  #makePart(mesh: Mesh, isSkinned: boolean): PlayCanvasPart {
    const drawn = new pc.Mesh(this.#device, { storageVertex: false });
    if (!isSkinned) drawn.clear(true, false, mesh.vertexCount, mesh.indexCount);
    drawn.setPositions(mesh.positions);
    if (mesh.normals !== null) drawn.setNormals(mesh.normals);
    if (mesh.tangents !== null) drawn.setVertexStream(pc.SEMANTIC_TANGENT, mesh.tangents, 4);
    mesh.textureCoords.slice(0, 2).forEach((coords, set) => drawn.setUvs(set, coords));
    const [colours] = mesh.colours;
    if (colours !== undefined) drawn.setColors(colours, colours.length / mesh.vertexCount);
    if (isSkinned) {
      const { bones, weights } = fourInfluences(mesh, 0);
      drawn.setVertexStream(pc.SEMANTIC_BLENDINDICES, bones, 4);
      drawn.setVertexStream(pc.SEMANTIC_BLENDWEIGHT, weights, 4);
    }
    drawn.setIndices(mesh.indices);
    drawn.update(pc.PRIMITIVE_TRIANGLES, false);
    const skin = isSkinned ? new PaletteSkin(this.#device, mesh) : null;
    const submeshes = this.model.submeshes.filter((one) => one.mesh === mesh.number && one.topology === 'triangles' && one.count > 0);
    const instances = submeshes.map(({ material, first, count }, k) => {
      let part = drawn;
      if (k > 0) {
        part = new pc.Mesh(this.#device);
        part.vertexBuffer = drawn.vertexBuffer;
        part.indexBuffer = [...drawn.indexBuffer];
      }
      part.primitive[0] = { type: pc.PRIMITIVE_TRIANGLES, base: first, baseVertex: 0, count, indexed: true };
      const instance = new pc.MeshInstance(part, this.#materials[material ?? this.#materials.length - 1]!, this.entity);
      if (skin !== null) instance.skinInstance = skin;
      instance.cull = false; // its bounds change from frame to frame
      return instance;
    });
    return { mesh, instances, skin };
  }
}

/** The box of some of a mesh's triangles. */
function boundsAtRest({ positions, indices }: Mesh, { base, count }: { base: number; count: number }): pc.BoundingBox {
  const points = new Float32Array(3 * count);
  indices.subarray(base, base + count).forEach((vertex, k) => points.set(positions.subarray(3 * vertex, 3 * vertex + 3), 3 * k));
  const box = new pc.BoundingBox();
  box.compute(points);
  return box;
}

function makeMaterial(source: Material, model: Model, device: pc.GraphicsDevice): pc.StandardMaterial {
  const made = new pc.StandardMaterial();
  const texture = (use: TextureUse | null, isColour = false): pc.Texture | null => (use && makeTexture(use, model, device, isColour));
  const colour = ([red, green, blue]: readonly number[]): pc.Color => new pc.Color(red, green, blue).gamma(); // which takes sRGB
  made.name = source.name;
  made.diffuse = colour(source.baseColour);
  made.opacity = source.baseColour[3];
  made.useMetalness = true;
  made.metalness = source.metallic;
  made.gloss = 1 - source.roughness;
  made.emissive = colour(source.emissive);
  made.useLighting = !source.unlit;
  if (source.doubleSided) made.twoSidedLighting = true;
  made.cull = source.doubleSided ? pc.CULLFACE_NONE : pc.CULLFACE_BACK;
  made.diffuseMap = texture(source.baseColourTexture, true);
  if (source.alphaMode !== 'opaque') Object.assign(made, { opacityMap: made.diffuseMap, opacityMapChannel: 'a' });
  if (source.alphaMode === 'mask') made.alphaTest = source.alphaCutoff;
  if (source.alphaMode === 'blend') made.blendType = pc.BLEND_NORMAL;
  made.metalnessMap = made.glossMap = texture(source.metallicRoughnessTexture);
  if (made.glossMap !== null) Object.assign(made, { metalnessMapChannel: 'b', glossMapChannel: 'g', glossInvert: true, gloss: source.roughness });
  made.normalMap = texture(source.normalTexture);
  made.emissiveMap = texture(source.emissiveTexture, true);
  made.update();
  return made;
}

/** A texture of an image inside the file, white until it is decoded. PlayCanvas decodes no other here. */
function makeTexture(use: TextureUse, model: Model, device: pc.GraphicsDevice, isColour: boolean): pc.Texture | null {
  const source = model.textures[use.texture]!;
  const image = embeddedImage(source);
  if (image === null || typeof createImageBitmap === 'undefined') return null;
  const wraps = { repeat: pc.ADDRESS_REPEAT, clamp_to_edge: pc.ADDRESS_CLAMP_TO_EDGE, mirrored_repeat: pc.ADDRESS_MIRRORED_REPEAT };
  const format = isColour ? pc.PIXELFORMAT_SRGBA8 : pc.PIXELFORMAT_RGBA8;
  const made = new pc.Texture(device, { name: source.name, width: 1, height: 1, format, addressU: wraps[source.wrapS], addressV: wraps[source.wrapT] });
  const blob = new Blob([image.bytes], { type: mediaType(image) });
  createImageBitmap(blob, { premultiplyAlpha: 'none' }).then(
    (bitmap) => made.setSource(bitmap as unknown as HTMLCanvasElement), // which it also takes
    (error: unknown) => console.warn(`bendy: an image of texture ${use.texture} cannot be decoded: ${String(error)}`),
  );
  return made;
}

/** Loads a character; `entity` is still to be added to the scene. Rejects with the BendyError of `Model.open`. */
export function loadBendy(source: Source, app: pc.AppBase, options: EngineOptions = {}): Promise<PlayCanvasCharacter> {
  return loadCharacter(source, options, (model) => new PlayCanvasCharacter(model, app, options));
}
