// What the pages share: a picture of characters on a ground, with a camera to turn.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { BendyLoader } from 'bendy/three';

/** Loads a character that casts shadows. */
export async function load(address) {
  const character = await new BendyLoader().loadAsync(address);
  for (const { object } of character.parts) object.castShadow = true;
  return character;
}

/** Draws scenes side by side on a ground, in the element .stage; calls `frame` with the seconds since its last call. */
export function show(scenes, frame, { distance = 4, height = 1 } = {}) {
  const element = document.querySelector('.stage');
  const renderer = new THREE.WebGLRenderer({ antialias: true });
  renderer.shadowMap.enabled = true;
  element.append(renderer.domElement);
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0xe8ecef);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x8090a0, 2.2), ...scenes, makeGround(), makeSun());
  const camera = new THREE.PerspectiveCamera(35, 1, 0.05, 100);
  camera.position.set(0.4 * distance, height + 0.3 * distance, distance);
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.target.set(0, height, 0);
  const isStill = matchMedia('(prefers-reduced-motion: reduce)').matches;
  let last = performance.now();
  let frames = 0;
  renderer.setAnimationLoop((now) => {
    const { clientWidth: width, clientHeight: tall } = element;
    renderer.setSize(width, tall, false);
    camera.aspect = width / tall;
    camera.updateProjectionMatrix();
    controls.update();
    frame(isStill && frames > 0 ? 0 : Math.min(0.1, (now - last) / 1000));
    last = now;
    renderer.render(scene, camera);
    document.documentElement.dataset.frames = ++frames;
  });
  return { scene, camera, canvas: renderer.domElement, controls };
}

function makeGround() {
  const ground = new THREE.Mesh(new THREE.CircleGeometry(12, 64), new THREE.ShadowMaterial({ opacity: 0.25 }));
  ground.rotation.x = -Math.PI / 2;
  ground.receiveShadow = true;
  return ground;
}

function makeSun() {
  const sun = new THREE.DirectionalLight(0xffffff, 2.5);
  sun.position.set(3, 6, 4);
  sun.castShadow = true;
  sun.shadow.mapSize.set(1024, 1024);
  Object.assign(sun.shadow.camera, { left: -6, right: 6, top: 6, bottom: -6 });
  sun.shadow.camera.updateProjectionMatrix();
  return sun;
}
