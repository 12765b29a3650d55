// The soft shadow below the character: its outline seen from the ground, lighter with height, and blurred.
import * as THREE from 'three';

const texels = 256;
const spread = 2.2; // texels from one sample of the blur to the next
/** The layer of what throws a shadow. */
export const shadowLayer = 1;

const blurVertex = 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }';
const blurFragment = `
uniform sampler2D map;
uniform vec2 step;
varying vec2 at;
void main() {
  float sum = 0.0, weights = 0.0;
  for (int k = -4; k <= 4; ++k) {
    float weight = exp(-0.18 * float(k * k));
    sum += weight * texture2D(map, at + float(k) * step).r;
    weights += weight;
  }
  gl_FragColor = vec4(vec3(sum / weights), 1.0);
}`;
const planeVertex = `
uniform mat4 fromGround;
varying vec2 at;
void main() {
  vec4 place = modelMatrix * vec4(position, 1.0);
  at = (fromGround * place).xy * 0.5 + 0.5;
  gl_Position = projectionMatrix * viewMatrix * place;
}`;
const planeFragment = `
uniform sampler2D map;
uniform float strength;
varying vec2 at;
void main() {
  float edge = 1.0 - smoothstep(0.36, 0.5, length(at - 0.5));
  float near = 1.0 - texture2D(map, at).r; // to the ground: feet throw darker shadows than hands that hang low
  gl_FragColor = vec4(vec3(0.0), strength * edge * near * near);
}`;

export class ContactShadow {
  readonly plane: THREE.Mesh;
  readonly #camera = new THREE.OrthographicCamera();
  readonly #outline = new THREE.WebGLRenderTarget(texels, texels);
  readonly #half = new THREE.WebGLRenderTarget(texels, texels);
  readonly #black = new THREE.MeshBasicMaterial({ color: 0x000000, side: THREE.DoubleSide });
  readonly #fog = new THREE.Fog(0xffffff, 0, 1);
  readonly #white = new THREE.Color(0xffffff);
  readonly #blur = new THREE.ShaderMaterial({ vertexShader: blurVertex, fragmentShader: blurFragment, uniforms: { map: { value: null }, step: { value: new THREE.Vector2() } }, depthTest: false, depthWrite: false });
  readonly #screen = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), this.#blur);
  readonly #material: THREE.ShaderMaterial;

  constructor() {
    this.#camera.layers.set(shadowLayer);
    this.#screen.layers.set(shadowLayer);
    this.#screen.frustumCulled = false;
    this.#material = new THREE.ShaderMaterial({
      vertexShader: planeVertex,
      fragmentShader: planeFragment,
      uniforms: { map: { value: this.#outline.texture }, strength: { value: 0.5 }, fromGround: { value: new THREE.Matrix4() } },
      transparent: true,
      depthWrite: false,
    });
    this.plane = new THREE.Mesh(new THREE.PlaneGeometry(1, 1).rotateX(-Math.PI / 2), this.#material);
    this.plane.renderOrder = -1;
  }

  set strength(strength: number) {
    this.#material.uniforms['strength']!.value = strength;
  }

  /** Puts the shadow below a box. */
  fit(box: THREE.Box3): void {
    const size = box.getSize(new THREE.Vector3());
    const middle = box.getCenter(new THREE.Vector3());
    const wide = 1.5 * Math.max(size.x, size.z, 0.5 * size.y, 1e-6);
    const reach = Math.max(0.3 * size.y, 1e-6); // what is higher throws no shadow
    const bottom = box.min.y - 0.002 * size.y;
    Object.assign(this.#camera, { left: -wide / 2, right: wide / 2, top: wide / 2, bottom: -wide / 2, near: 0, far: reach });
    this.#camera.position.set(middle.x, bottom, middle.z);
    this.#camera.up.set(0, 0, 1);
    this.#camera.lookAt(middle.x, bottom + 1, middle.z);
    this.#camera.updateProjectionMatrix();
    this.#camera.updateMatrixWorld();
    this.#fog.near = 0;
    this.#fog.far = reach;
    this.plane.position.set(middle.x, bottom, middle.z);
    this.plane.scale.setScalar(wide);
    (this.#material.uniforms['fromGround']!.value as THREE.Matrix4).multiplyMatrices(this.#camera.projectionMatrix, this.#camera.matrixWorldInverse);
  }

  /** Renders the shadow of what is on the shadow's layer. */
  draw(renderer: THREE.WebGLRenderer, scene: THREE.Scene): void {
    const { background, fog, overrideMaterial } = scene;
    Object.assign(scene, { background: this.#white, fog: this.#fog, overrideMaterial: this.#black });
    renderer.setRenderTarget(this.#outline);
    renderer.render(scene, this.#camera);
    Object.assign(scene, { background, fog, overrideMaterial });
    this.#smear(renderer, this.#outline, this.#half, 1 / texels, 0);
    this.#smear(renderer, this.#half, this.#outline, 0, 1 / texels);
    renderer.setRenderTarget(null);
  }

  #smear(renderer: THREE.WebGLRenderer, from: THREE.WebGLRenderTarget, to: THREE.WebGLRenderTarget, x: number, y: number): void {
    const { map, step } = this.#blur.uniforms;
    map!.value = from.texture;
    (step!.value as THREE.Vector2).set(spread * x, spread * y);
    renderer.setRenderTarget(to);
    renderer.render(this.#screen, this.#camera);
  }
}
