// Joint limits of glTF files (BENDY_joint_limits) as CCDIKSolver takes them: a box of Euler angles of the bone's rotation.
import { Euler, type EulerOrder, Quaternion, Vector3 } from 'three';

/** The Euler angles that a bone's rotation may have. */
export interface EulerBox {
  readonly order: EulerOrder;
  readonly min: Vector3;
  readonly max: Vector3;
}

type Range = readonly [number, number];

/** Into how many steps ranges are divided, to find the best order and then the box. */
const coarse = 6;
const fine = 24;
const orders: readonly EulerOrder[] = ['XYZ', 'XZY', 'YXZ', 'YZX', 'ZXY', 'ZYX'];
/** A range that is wider is not limited: the gaps between samples make the whole circle look narrower. */
const widest = 2 * Math.PI - 0.5;
const axes = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };

const between = ([low, high]: Range, steps: number): number[] =>
  Array.from({ length: steps + 1 }, (_, k) => low + ((high - low) * k) / steps);

/** A member that is [minimum, maximum], radians; null stands for a free end. */
function readRange(limit: Record<string, unknown>, key: string): Range {
  const value = limit[key];
  if (value === undefined) return [-Infinity, Infinity];
  const isEnd = (end: unknown): boolean => end === null || Number.isFinite(end);
  if (!Array.isArray(value) || value.length !== 2 || !value.every(isEnd)) throw new Error(`${key}: two numbers are expected`);
  const range: Range = [value[0] ?? -Infinity, value[1] ?? Infinity];
  if (range[0] > range[1]) throw new Error(`${key}: the minimum is above the maximum`);
  return range;
}

/** The range on the circle: a free one is all of it. */
const onCircle = ([low, high]: Range): Range => (high - low < 2 * Math.PI ? [low, high] : [-Math.PI, Math.PI]);

function turn(axis: keyof typeof axes, angle: number): Quaternion {
  return new Quaternion().setFromAxisAngle(axes[axis], angle);
}

/** The swings of a swing-twist model, by the length of the swing vector or, for a pyramid, by angles (spec/constraints.md). */
function swings(isEllipse: boolean, y: Range, z: Range, steps: number): Quaternion[] {
  const found: Quaternion[] = [];
  for (const u of between([-1, 1], 2 * (steps >> 1))) {
    for (const v of between([-1, 1], 2 * (steps >> 1))) {
      const limits = [Math.abs(y[u < 0 ? 0 : 1]), Math.abs(z[v < 0 ? 0 : 1])] as const;
      const bounded = limits.map((limit) => Math.min(limit, Math.PI)) as [number, number];
      const quaternion = new Quaternion();
      if (isEllipse) {
        const isFree = limits.includes(Infinity);
        // From the square to the disc, unless one limit is free: then the shape is a band.
        const p = isFree ? [u, v] : [u * Math.sqrt(1 - (v * v) / 2), v * Math.sqrt(1 - (u * u) / 2)];
        const [sy, sz] = [p[0]! * Math.sin(bounded[0] / 2), p[1]! * Math.sin(bounded[1] / 2)];
        if (sy * sy + sz * sz > 1) continue;
        quaternion.set(0, sy, sz, Math.sqrt(1 - sy * sy - sz * sz));
      } else {
        const [ty, tz] = [u * bounded[0], v * bounded[1]].map((angle) => Math.tan(Math.min(Math.max(angle / 2, -1.57), 1.57)));
        quaternion.set(0, ty!, tz!, 1).normalize();
      }
      found.push(quaternion);
    }
  }
  return found;
}

/** Rotations within a limit, in the space of its frame. Null: all rotations are. */
function samples(limit: Record<string, unknown>, steps: number): Quaternion[] | null {
  const { model } = limit;
  const [x, y, z] = ['x', 'y', 'z'].map((key) => readRange(limit, key)) as [Range, Range, Range];
  if (model === 'free') return null;
  if (model === 'locked') return [new Quaternion()];
  if (model === 'hinge') return between(onCircle(x), steps).map((angle) => turn('x', angle));
  if (model === 'swingTwistEllipse' || model === 'swingTwistPyramid') {
    const twists = between(onCircle(x), coarse).map((angle) => turn('x', angle));
    return swings(model === 'swingTwistEllipse', y, z, steps).flatMap((swing) => twists.map((twist) => swing.clone().multiply(twist)));
  }
  if (model === 'eulerBox') {
    const order = limit['order'] ?? 'XYZ';
    if (!orders.includes(order as EulerOrder)) throw new Error('order: the names of three axes are expected');
    // The first letter is the axis about which the joint turns first; three.js writes it last.
    const threes = [...(order as string)].reverse().join('') as EulerOrder;
    const ranges = [x, y, z].map((range) => between(onCircle(range), steps));
    return ranges[0]!.flatMap((a) =>
      ranges[1]!.flatMap((b) => ranges[2]!.map((c) => new Quaternion().setFromEuler(new Euler(a, b, c, threes)))),
    );
  }
  if (model === 'largestAngle') {
    const angle = limit['angle'] ?? Infinity;
    if (typeof angle !== 'number' || angle < 0) throw new Error('angle: a number of 0 or more is expected');
    if (angle >= Math.PI) return null;
    const directions = between([0, Math.PI], steps).flatMap((polar) =>
      between([0, 2 * Math.PI], 2 * steps).map((around) => new Vector3().setFromSphericalCoords(1, polar, around)),
    );
    return directions.flatMap((axis) => [angle / 2, angle].map((each) => new Quaternion().setFromAxisAngle(axis, each)));
  }
  throw new Error('model: it is not known');
}

/** The angle that is nearest to another on the circle. */
const near = (angle: number, other: number): number => other + Math.atan2(Math.sin(angle - other), Math.cos(angle - other));

function boxOf(rotations: readonly Quaternion[], rest: Quaternion, order: EulerOrder): EulerBox {
  const atRest = new Euler().setFromQuaternion(rest, order);
  const box = { order, min: new Vector3(Infinity, Infinity, Infinity), max: new Vector3(-Infinity, -Infinity, -Infinity) };
  for (const rotation of rotations) {
    const { x, y, z } = new Euler().setFromQuaternion(rotation, order);
    const angles = new Vector3(near(x, atRest.x), near(y, atRest.y), near(z, atRest.z));
    box.min.min(angles);
    box.max.max(angles);
  }
  return box;
}

/**
 * The smallest box of Euler angles that holds what a limit allows, of the order that makes it smallest. A hinge about an axis of the
 * bone is exact; other limits are wider than they should be. Null: nothing is limited. Throws an Error that names a faulty member.
 *
 * `limit`: one of BENDY_joint_limits. `rest`: the bone's rotation at rest. `usual`: the order that is taken if no other is better.
 */
export function eulerBox(limit: Record<string, unknown>, rest: Quaternion, usual: EulerOrder): EulerBox | null {
  const given = limit['frame'] ?? [0, 0, 0, 1];
  if (!Array.isArray(given) || given.length !== 4 || !given.every(Number.isFinite) || !given.some((c) => c !== 0))
    throw new Error('frame: four numbers that are a rotation are expected');
  const frame = new Quaternion().fromArray(given as number[]).normalize();
  const [frameBefore, frameAfter] = [rest.clone().multiply(frame), frame.clone().conjugate()];
  const inSteps = (steps: number): Quaternion[] | undefined =>
    samples(limit, steps)?.map((rotation) => frameBefore.clone().multiply(rotation).multiply(frameAfter));
  const few = inSteps(coarse);
  if (few === undefined) return null;
  const width = ({ min, max }: EulerBox): number => max.x - min.x + max.y - min.y + max.z - min.z;
  const boxes = [usual, ...orders].map((order) => boxOf(few, rest, order));
  const { order } = boxes.reduce((best, each) => (width(each) < width(best) - 1e-6 ? each : best));
  const box = boxOf(inSteps(fine)!, rest, order);
  let free = 0;
  for (const axis of ['x', 'y', 'z'] as const) {
    if (box.max[axis] - box.min[axis] < widest) continue;
    [box.min[axis], box.max[axis]] = [-Math.PI, Math.PI];
    ++free;
  }
  return free === 3 ? null : box;
}
