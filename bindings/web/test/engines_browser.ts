// Draws a character by Babylon.js and PlayCanvas, and compares its outline with triangles filled here. engines_browser.test.mjs bundles it:
// a module of JavaScript, but node takes files of that name for tests.
import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { Color3, Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Scene } from '@babylonjs/core/scene.js';
import * as pc from 'playcanvas';
import * as babylon from '../dist/engines/babylon.js';
import * as playcanvas from '../dist/engines/playcanvas.js';

const size = 96;
const half = 1.2; // metres, of the picture
const centre = [0, 0.9]; // of the picture, x and y

/** Model space, from the front, to pixels. */
const place = (positions, vertex) => [
  (size * (positions[3 * vertex] - centre[0] + half)) / (2 * half),
  (size * (half - positions[3 * vertex + 1] + centre[1])) / (2 * half),
];

/** The triangles that face the camera, by mesh; engines that cull the wrong side would draw none of them. */
function facing(character) {
  return character.parts.map(({ mesh }) => {
    const positions = character.pose.skin({ mesh }).positions.slice();
    const front = [];
    for (let k = 0; k < mesh.indexCount; k += 3) {
      const triangle = [...mesh.indices.subarray(k, k + 3)];
      const [a, b, c] = triangle.map((vertex) => place(positions, vertex));
      if ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0) front.push(...triangle); // y runs down: anticlockwise
    }
    return { positions, front };
  });
}

function newCanvas() {
  const canvas = Object.assign(document.createElement('canvas'), { width: size, height: size });
  canvas.style = `width: ${size}px; height: ${size}px`;
  document.body.append(canvas);
  return canvas;
}

function mask(canvas) {
  const copy = Object.assign(document.createElement('canvas'), { width: size, height: size });
  const context = copy.getContext('2d', { willReadFrequently: true });
  context.drawImage(canvas, 0, 0, size, size);
  const { data } = context.getImageData(0, 0, size, size);
  return Array.from({ length: size * size }, (_, k) => data[4 * k] > 127);
}

function expected(meshes) {
  const canvas = newCanvas();
  const context = canvas.getContext('2d');
  context.fillStyle = 'white';
  for (const { positions, front } of meshes) {
    for (let k = 0; k < front.length; k += 3) {
      context.beginPath();
      for (const vertex of front.slice(k, k + 3)) context.lineTo(...place(positions, vertex));
      context.fill();
    }
  }
  return mask(canvas);
}

/** Whether a pixel is along the outline, where two ways of filling triangles differ. */
function isOutline(wanted, k) {
  const steps = [-size - 1, -size, -size + 1, -1, 1, size - 1, size, size + 1];
  return steps.some((step) => (wanted[k + step] ?? wanted[k]) !== wanted[k]);
}

async function byBabylon(isRightHanded, skin) {
  const canvas = newCanvas();
  const scene = new Scene(new Engine(canvas, false, { preserveDrawingBuffer: true }));
  scene.useRightHandedSystem = isRightHanded;
  scene.clearColor = new Color4(0, 0, 0, 1);
  const camera = new FreeCamera('camera', new Vector3(centre[0], centre[1], 5), scene);
  camera.setTarget(new Vector3(centre[0], centre[1], 0));
  camera.mode = 1; // orthographic
  Object.assign(camera, { orthoLeft: -half, orthoRight: half, orthoBottom: -half, orthoTop: half, minZ: 0.1, maxZ: 20 });
  const character = await babylon.loadBendy('/mannequin.bendy', scene, { skin });
  character.pose.sample('Walk', 0.35);
  character.apply();
  const meshes = facing(character);
  character.parts.forEach(({ object, mesh }, k) => object.setIndices(meshes[k].front, mesh.vertexCount));
  for (const material of scene.materials) if ('unlit' in material) Object.assign(material, { unlit: true, albedoColor: Color3.White(), albedoTexture: null });
  await scene.whenReadyAsync();
  scene.render();
  return [mask(canvas), expected(meshes)];
}

async function byPlayCanvas(skin) {
  const canvas = newCanvas();
  const app = new pc.Application(canvas, { graphicsDeviceOptions: { antialias: false, preserveDrawingBuffer: true } });
  app.setCanvasResolution(pc.RESOLUTION_FIXED, size, size);
  const camera = new pc.Entity();
  camera.addComponent('camera', { projection: pc.PROJECTION_ORTHOGRAPHIC, orthoHeight: half, clearColor: new pc.Color(0, 0, 0) });
  camera.setPosition(centre[0], centre[1], 5);
  app.root.addChild(camera);
  const character = await playcanvas.loadBendy('/mannequin.bendy', app, { skin });
  app.root.addChild(character.entity);
  character.pose.sample('Walk', 0.35);
  character.apply();
  const meshes = facing(character);
  character.parts.forEach(({ instances }, k) => {
    instances[0].mesh.setIndices(meshes[k].front);
    instances[0].mesh.update(pc.PRIMITIVE_TRIANGLES, false);
    for (const { material } of instances) {
      Object.assign(material, { useLighting: false, emissive: new pc.Color(1, 1, 1), emissiveMap: null });
      material.update();
    }
  });
  app.start();
  for (let k = 0; k < 3; ++k) await new Promise((resolve) => app.once('frameend', resolve));
  return [mask(canvas), expected(meshes)];
}

const results = (globalThis.partial = {});
for (const [name, draw] of Object.entries({
  'Babylon.js, right-handed': () => byBabylon(true),
  'Babylon.js, left-handed': () => byBabylon(false),
  'Babylon.js, skinned by the runtime': () => byBabylon(false, 'wasm'),
  PlayCanvas: () => byPlayCanvas(),
  'PlayCanvas, skinned by the runtime': () => byPlayCanvas('wasm'),
})) {
  try {
    const [found, wanted] = await draw();
    results[name] = { drawn: wanted.filter(Boolean).length, different: found.filter((is, k) => is !== wanted[k] && !isOutline(wanted, k)).length };
  } catch (error) {
    results[name] = { failed: String(error?.stack ?? error) };
  }
}
globalThis.results = results;
