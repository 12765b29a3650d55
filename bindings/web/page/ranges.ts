// The rotations that the constraint of a joint allows, as fans and cones: spec/constraints.md.
import * as THREE from 'three';
import type { Constraint } from '../src/index.js';

const coneColour = 0xd55e00;
const axisColours = [0xcc3311, 0x009e73, 0x0072b2];
const twistColour = 0xcc79a7;
const twistSize = 0.4; // of the cone's radius
const sides = 72;
const widest = 0.9995; // sine of half the angle: the cone is nearly a sphere
const fullTurn = 2 * Math.PI;

const unitAxis = (axis: number) => new THREE.Vector3().setComponent(axis, 1);

/** The component of a direction perpendicular to an axis, as a unit vector; the next axis if that is too small. */
function across(direction: THREE.Vector3, axis: number): THREE.Vector3 {
  const rest = direction.clone().setComponent(axis, 0);
  return rest.length() > 0.3 * direction.length() ? rest.normalize() : unitAxis((axis + 1) % 3);
}

/** A surface from the origin to a polyline, with the polyline. */
function makeFan(rim: THREE.Vector3[], isClosed: boolean, color: number): THREE.Group {
  const points = isClosed ? [...rim, rim[0]!] : rim;
  const geometry = new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), ...points]);
  geometry.setIndex(points.slice(1).flatMap((_, k) => [0, k + 1, k + 2]));
  const material = { color, transparent: true, depthTest: false };
  const surface = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ ...material, opacity: 0.22, side: THREE.DoubleSide }));
  const line = new THREE.Line(
    new THREE.BufferGeometry().setFromPoints(isClosed ? points : [new THREE.Vector3(), ...points, new THREE.Vector3()]),
    new THREE.LineBasicMaterial({ ...material, opacity: 0.9 }),
  );
  surface.renderOrder = 1;
  line.renderOrder = 2;
  return new THREE.Group().add(surface, line);
}

/** The range of rotations about an axis, as an arc swept by `zero`; undefined if it is free or empty. */
function makeArc(low: number, high: number, axis: number, zero: THREE.Vector3, color: number): THREE.Group | undefined {
  if (!(high - low < fullTurn) || high - low < 1e-3) return undefined;
  const steps = Math.max(1, Math.ceil((high - low) / 0.08));
  const rim = Array.from({ length: steps + 1 }, (_, k) => zero.clone().applyAxisAngle(unitAxis(axis), low + ((high - low) * k) / steps));
  return makeFan(rim, false, color);
}

/** The largest legal swing about (0 y z), as the sine of half its angle. */
function widestSwing({ model, rotationMin, rotationMax }: Constraint, y: number, z: number): number {
  const [a, b] = [y, z].map((component, k) => {
    const limit = component < 0 ? -rotationMin[k + 1]! : rotationMax[k + 1]!;
    return limit === Infinity ? Infinity : limit >= Math.PI ? 1 : Math.sin(limit / 2);
  }) as [number, number];
  const tiny = 1e-6;
  if (model === 'swing_twist_ellipse') {
    const slope = Math.hypot(Math.abs(y) < tiny ? 0 : y / Math.max(a, 1e-9), Math.abs(z) < tiny ? 0 : z / Math.max(b, 1e-9));
    return slope * widest > 1 ? 1 / slope : widest;
  }
  const tangent = (half: number, component: number) => (half >= widest || Math.abs(component) < tiny ? 1e6 : half / Math.sqrt(1 - half * half) / Math.abs(component));
  const least = Math.min(tangent(a, y), tangent(b, z));
  return Math.min(widest, least / Math.sqrt(1 + least * least));
}

function makeSwingCone(constraint: Constraint): THREE.Group {
  const rim = Array.from({ length: sides }, (_, k) => {
    const [y, z] = [Math.cos((fullTurn * k) / sides), Math.sin((fullTurn * k) / sides)];
    const sine = widestSwing(constraint, y, z);
    return unitAxis(0).applyQuaternion(new THREE.Quaternion(0, sine * y, sine * z, Math.sqrt(1 - sine * sine)));
  });
  return makeFan(rim, true, coneColour);
}

function makeRoundCone(halfAngle: number, middle: THREE.Vector3): THREE.Group {
  const side = middle.clone().cross(unitAxis(Math.abs(middle.x) < 0.9 ? 0 : 1)).normalize();
  const edge = middle.clone().applyAxisAngle(side, halfAngle);
  return makeFan(Array.from({ length: sides }, (_, k) => edge.clone().applyAxisAngle(middle, (fullTurn * k) / sides)), true, coneColour);
}

/**
 * The directions that a constraint allows, in its frame and with radius 1; empty if it allows all or none.
 *
 * @param bone - the bone's direction in the constraint's frame, with the joint at rest
 */
export function drawRange(constraint: Constraint, bone: THREE.Vector3): THREE.Group {
  const { model, rotationMin: low, rotationMax: high } = constraint;
  const towards = bone.lengthSq() > 0 ? bone.clone().normalize() : unitAxis(0);
  const drawing = new THREE.Group();
  const add = (part: THREE.Group | undefined, size = 1) => {
    part?.scale.setScalar(size);
    if (part) drawing.add(part);
  };
  if (model === 'hinge') {
    add(makeArc(low[0], high[0], 0, across(towards, 0), axisColours[0]!));
  } else if (model === 'swing_twist_ellipse' || model === 'swing_twist_pyramid') {
    add(makeSwingCone(constraint));
    add(makeArc(low[0], high[0], 0, unitAxis(1), twistColour), twistSize);
  } else if (model === 'euler_box') {
    for (const axis of [0, 1, 2] as const) add(makeArc(low[axis], high[axis], axis, across(towards, axis), axisColours[axis]!));
  } else if (model === 'largest_angle' && high[0] < Math.PI) {
    add(makeRoundCone(high[0], towards));
  }
  return drawing;
}
