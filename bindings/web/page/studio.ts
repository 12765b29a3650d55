// The light around the character: a few soft lamps, blurred for each roughness by a formula. Rendering such a map takes seconds
// where there is no GPU.
import * as THREE from 'three';

/** A soft lamp: radiance colour * exp(sharpness * (cos(angle to its direction) - 1)). */
interface Lamp {
  direction: [number, number, number];
  sharpness: number;
  colour: [number, number, number];
}

interface Surroundings {
  /** Radiance from above and from below. */
  sky: [number, number, number];
  ground: [number, number, number];
  lamps: Lamp[];
}

const surroundings = {
  Studio: {
    sky: [0.68, 0.7, 0.74],
    ground: [0.42, 0.4, 0.38],
    lamps: [
      { direction: [0.7, 0.75, 0.75], sharpness: 7, colour: [2.6, 2.48, 2.34] },
      { direction: [-1, 0.25, 0.5], sharpness: 5, colour: [0.35, 0.42, 0.55] },
      { direction: [-0.5, 0.7, -1], sharpness: 12, colour: [2.4, 2.5, 2.7] },
    ],
  },
  Overcast: { sky: [1.05, 1.08, 1.12], ground: [0.4, 0.4, 0.39], lamps: [{ direction: [0.2, 1, 0.3], sharpness: 3, colour: [0.35, 0.35, 0.36] }] },
  Sunset: {
    sky: [0.3, 0.33, 0.5],
    ground: [0.22, 0.16, 0.14],
    lamps: [
      { direction: [1, 0.25, 0.45], sharpness: 14, colour: [5.2, 2.6, 1.15] },
      { direction: [-0.8, 0.4, -0.8], sharpness: 5, colour: [0.5, 0.5, 0.95] },
    ],
  },
  Night: {
    sky: [0.07, 0.09, 0.15],
    ground: [0.04, 0.04, 0.06],
    lamps: [
      { direction: [-0.7, 0.8, 0.4], sharpness: 10, colour: [0.85, 1.1, 1.7] },
      { direction: [0.9, 0.1, -0.7], sharpness: 12, colour: [1.6, 0.8, 0.35] },
    ],
  },
} satisfies Record<string, Surroundings>;

export type SurroundingsName = keyof typeof surroundings;
export const surroundingsNames = Object.keys(surroundings) as SurroundingsName[];

const faceSize = 64;
const levels = 4; // down to 8 texels, where three.js reads the diffuse light
const cosineSharpness = 2.13; // of the lobe that fits the cosine

/** The roughness that a level is for: three.js reads level r (2 - r) of the last. */
const roughnessOf = (level: number): number => 1 - Math.sqrt(1 - level / (levels - 1));

/** The direction of a texel of a cube map's face, as WebGL orders them: +X, -X, +Y, -Y, +Z, -Z. */
function texelDirection(face: number, u: number, v: number): [number, number, number] {
  switch (face) {
    case 0: return [1, -v, -u];
    case 1: return [-1, -v, u];
    case 2: return [u, 1, v];
    case 3: return [u, -1, -v];
    case 4: return [u, -v, 1];
    default: return [-u, -v, -1];
  }
}

/** The lamps and the sky as a surface of this roughness mirrors them. */
function blurred({ sky, ground, lamps }: Surroundings, roughness: number): { mean: number[]; slope: number[]; lamps: Lamp[] } {
  const kernel = roughness === 0 ? Infinity : Math.max(cosineSharpness, 0.5 / roughness ** 4);
  const steepness = roughness === 1 ? 2 / 3 : 1 - roughness / 3;
  return {
    mean: sky.map((value, c) => (value + ground[c]!) / 2),
    slope: sky.map((value, c) => (steepness * (value - ground[c]!)) / 2),
    lamps: lamps.map(({ direction, sharpness, colour }) => {
      const wide = kernel === Infinity ? sharpness : (sharpness * kernel) / (sharpness + kernel);
      const energy = (k: number): number => (1 - Math.exp(-2 * k)) / k; // of a lobe of height 1
      const dim = energy(sharpness) / energy(wide);
      const length = Math.hypot(...direction);
      return {
        direction: direction.map((value) => value / length) as Lamp['direction'],
        sharpness: wide,
        colour: colour.map((value) => value * dim) as Lamp['colour'],
      };
    }),
  };
}

function faceLevel(face: number, size: number, light: ReturnType<typeof blurred>): Uint16Array {
  const texels = new Uint16Array(4 * size * size);
  const one = THREE.DataUtils.toHalfFloat(1);
  for (let row = 0, at = 0; row < size; ++row) {
    for (let column = 0; column < size; ++column, at += 4) {
      const [x, y, z] = texelDirection(face, (2 * column + 1) / size - 1, (2 * row + 1) / size - 1);
      const scale = 1 / Math.hypot(x, y, z);
      for (let c = 0; c < 3; ++c) {
        let sum = light.mean[c]! + light.slope[c]! * y * scale;
        for (const { direction, sharpness, colour } of light.lamps) {
          const cosine = (x * direction[0] + y * direction[1] + z * direction[2]) * scale;
          sum += colour[c]! * Math.exp(sharpness * (cosine - 1));
        }
        texels[at + c] = THREE.DataUtils.toHalfFloat(sum);
      }
      texels[at + 3] = one;
    }
  }
  return texels;
}

/** A texture for `Scene.environment`, in the form in which three.js keeps what PMREMGenerator makes. */
export function makeEnvironment(name: SurroundingsName): THREE.Texture {
  const lights = Array.from({ length: levels }, (_, level) => blurred(surroundings[name], roughnessOf(level)));
  const faces = Array.from({ length: 6 }, (_, face) => ({
    width: faceSize,
    height: faceSize,
    mipmaps: lights.map((light, level) => {
      const size = faceSize >> level;
      return { width: size, height: size, data: faceLevel(face, size, light) };
    }),
  }));
  // three.js's only kind of cube texture whose levels are all given is the compressed one. It takes plain texels, too.
  const texture = new THREE.CompressedCubeTexture(
    faces as unknown as THREE.CompressedTextureMipmap[],
    THREE.RGBAFormat as unknown as THREE.CompressedPixelFormat,
    THREE.HalfFloatType,
  );
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.magFilter = THREE.LinearFilter;
  texture.colorSpace = THREE.LinearSRGBColorSpace;
  Object.assign(texture, { isPMREMTexture: true });
  texture.needsUpdate = true;
  return texture;
}

// The backdrop.

export const backdropNames = ['Soft', 'White', 'Black', 'Transparent', 'Colour'] as const;
export type BackdropName = (typeof backdropNames)[number];

/** The colour scheme's soft gradient, bright where the character stands: page.css has its colours, and paints it below the poster. */
function softBackdrop(): THREE.Texture {
  const style = getComputedStyle(document.documentElement);
  const tones = ['--backdrop-middle', '--backdrop', '--backdrop-edge'].map((name) => style.getPropertyValue(name).trim());
  const canvas = Object.assign(document.createElement('canvas'), { width: 512, height: 512 });
  const context = canvas.getContext('2d')!;
  const gradient = context.createRadialGradient(256, 236, 0, 256, 236, 380);
  for (const [k, colour] of tones.entries()) gradient.addColorStop([0, 0.5, 1][k]!, colour);
  context.fillStyle = gradient;
  context.fillRect(0, 0, 512, 512);
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  return texture;
}

/** The backdrop as the CSS of an element above the soft one. */
export function backdropStyle(name: BackdropName, colour: string): string {
  if (name === 'Soft') return '';
  return name === 'Transparent' ? 'var(--checks)' : `#${backdropColour(name, colour).getHexString()}`;
}

const backdropColour = (name: BackdropName, colour: string): THREE.Color => new THREE.Color(name === 'White' ? '#ffffff' : name === 'Black' ? '#000000' : colour);

/** The backdrop as `Scene.background`. */
export function makeBackdrop(name: BackdropName, colour: string): THREE.Texture | THREE.Color | null {
  if (name === 'Transparent') return null;
  if (name === 'Soft') return softBackdrop();
  return backdropColour(name, colour);
}
