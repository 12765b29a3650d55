// Draws glTF files with three.js as docs/viewer.md says that bendy draws them: camera, light, background, four samples a
// pixel. Takes its work from /jobs.json and sends the pixels of each picture to /picture/NUMBER.
import * as THREE from 'three';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

const degrees = Math.PI / 180;
const frames = 12; // in which the camera looks for the clip's bounds
const canvas = document.createElement('canvas');
const renderer = new THREE.WebGLRenderer({ canvas, preserveDrawingBuffer: true });
renderer.toneMapping = THREE.NoToneMapping;

/// The corners that something draws, at all times of the clip.
function boundsOf(scene, pose, times) {
  const box = new THREE.Box3();
  const point = new THREE.Vector3();
  for (const time of times) {
    pose(time);
    scene.traverse((object) => {
      if (!object.geometry) return;
      const { index, attributes } = object.geometry;
      const used = index ? new Set(index.array) : Array.from({ length: attributes.position.count }, (_, i) => i);
      for (const vertex of used) {
        if (object.getVertexPosition) object.getVertexPosition(vertex, point);
        else point.fromBufferAttribute(attributes.position, vertex);
        box.expandByPoint(point.applyMatrix4(object.matrixWorld));
      }
    });
  }
  return box;
}

/// The orbiting camera, as near as each corner of the box allows.
function cameraFor(box, job) {
  const angle = 0.6;
  const aspect = job.width / job.height;
  const [yaw, pitch] = [job.yaw * degrees, job.pitch * degrees];
  const outwards = new THREE.Vector3(Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch));
  const centre = box.getCenter(new THREE.Vector3());
  const radius = Math.max(0.5 * box.getSize(new THREE.Vector3()).length(), 1e-6);
  const camera = new THREE.PerspectiveCamera(angle / degrees, aspect, 1, 2);
  camera.position.copy(centre).add(outwards);
  camera.lookAt(centre);
  const toCamera = camera.quaternion.clone().invert();
  const upwards = Math.tan(0.5 * angle);
  let nearest = 0;
  for (let corner = 0; corner < 8; corner++) {
    const p = new THREE.Vector3(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
      corner & 4 ? box.max.z : box.min.z).sub(centre).applyQuaternion(toCamera);
    nearest = Math.max(nearest, p.z + Math.max(Math.abs(p.y) / upwards, Math.abs(p.x) / (upwards * aspect)));
  }
  const distance = Math.max(1.06 * nearest * job.distance, 1e-3 * radius);
  camera.position.copy(centre).addScaledVector(outwards, distance);
  camera.near = Math.max(distance - 4 * radius, 0.01 * Math.min(distance, radius));
  camera.far = distance + 4 * radius;
  camera.updateProjectionMatrix();
  return { camera, yaw };
}

let environment;
/// Radiance 0.22 from everywhere.
function evenLight() {
  if (environment) return environment;
  const generator = new THREE.PMREMGenerator(renderer);
  const room = new THREE.Scene();
  room.background = new THREE.Color(0.22, 0.22, 0.22);
  environment = generator.fromScene(room).texture;
  return environment;
}

function light(scene, yaw) {
  const towards = (angle, height, irradiance) => {
    const lamp = new THREE.DirectionalLight(0xffffff, irradiance);
    lamp.position.set(Math.sin(angle), height, Math.cos(angle));
    scene.add(lamp);
  };
  towards(yaw - 0.7, 0.85, 2.4);
  towards(yaw + 2.4, 0.6, 1.2);
  scene.add(new THREE.HemisphereLight(new THREE.Color(0.6, 0.6, 0.6), new THREE.Color(0.15, 0.15, 0.15), 1));
  scene.environment = evenLight();
}

/// A function that poses the scene at a time, and the times in which the bounds are looked for.
function posing(gltf, job) {
  const scene = gltf.scene;
  if (job.clip === undefined) return { pose: () => scene.updateMatrixWorld(true), times: [0] };
  const clip = gltf.animations[job.clip];
  const mixer = new THREE.AnimationMixer(scene);
  const action = mixer.clipAction(clip).setLoop(THREE.LoopOnce);
  action.clampWhenFinished = true;
  const pose = (time) => {
    action.reset().play(); // once at its end it stays there
    mixer.setTime(time);
    scene.updateMatrixWorld(true);
  };
  const start = Math.min(...clip.tracks.map((track) => track.times[0]));
  const times = Array.from({ length: frames }, (_, k) => start + (clip.duration - start) * k / (frames - 1));
  return { pose, times };
}

async function draw(job) {
  const gltf = await new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).loadAsync(job.url);
  const scene = new THREE.Scene();
  scene.add(gltf.scene);
  gltf.scene.traverse((object) => { object.frustumCulled = false; });
  const { pose, times } = posing(gltf, job);
  const { camera, yaw } = cameraFor(boundsOf(gltf.scene, pose, times), job);
  pose(job.time ?? 0);
  light(scene, yaw);
  scene.background = new THREE.Color(job.background);
  // Colours are blended, and samples mixed, as linear light; the driver encodes them as sRGB.
  const target = new THREE.WebGLRenderTarget(job.width, job.height, { colorSpace: THREE.SRGBColorSpace, samples: 4 });
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  const pixels = new Uint8Array(4 * job.width * job.height);
  await renderer.readRenderTargetPixelsAsync(target, 0, 0, job.width, job.height, pixels);
  renderer.setRenderTarget(null);
  target.dispose();
  return pixels; // from the bottom up
}

const send = (path, body) => fetch(path, { method: 'POST', body });
try {
  const jobs = await (await fetch('/jobs.json')).json();
  for (const [number, job] of jobs.entries()) {
    try {
      await send(`/result/${number}`, await draw(job));
    } catch (problem) {
      await send(`/failed/${number}`, String(problem?.stack ?? problem));
    }
  }
} catch (problem) {
  await send('/failed/all', String(problem?.stack ?? problem));
}
await send('/done', '');
