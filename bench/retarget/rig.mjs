// A body in a glTF file, posed by three.js.

import fs from 'node:fs';
import path from 'node:path';
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

globalThis.self ??= globalThis;
globalThis.ProgressEvent ??= class extends Event {};

/** The JSON and the buffer of a GLB file, or of a glTF file with its buffer beside it or inside. */
export function open(file) {
    const bytes = fs.readFileSync(file);
    if (bytes.toString('latin1', 0, 4) === 'glTF') {
        const size = bytes.readUInt32LE(12);
        return { json: JSON.parse(bytes.toString('utf8', 20, 20 + size)), buffer: bytes.subarray(28 + size) };
    }
    const json = JSON.parse(bytes.toString('utf8'));
    const uri = json.buffers?.[0]?.uri ?? '';
    const buffer = uri.startsWith('data:')
        ? Buffer.from(uri.slice(uri.indexOf(',') + 1), 'base64')
        : fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri)));
    return { json, buffer };
}

/** The file's nodes and clips as JSON with its buffer inside: what three.js reads without a browser. */
export function nodesOnly(file) {
    const { json, buffer } = open(file);
    for (const kind of ['materials', 'textures', 'images', 'samplers', 'meshes', 'skins', 'cameras', 'extensionsRequired']) delete json[kind];
    for (const clip of json.animations ?? []) clip.channels = clip.channels.filter((channel) => channel.target.path !== 'weights');
    for (const node of json.nodes) for (const kind of ['mesh', 'skin', 'camera', 'weights']) delete node[kind];
    json.buffers[0].uri = `data:application/octet-stream;base64,${buffer.toString('base64')}`;
    return json;
}

/** Role to number of node, from BENDY_joint_role; a joint of a chain has its place after the role. */
export function rolesIn(json) {
    const roles = new Map();
    json.nodes.forEach((node, number) => {
        const { role, place } = node.extensions?.BENDY_joint_role ?? {};
        if (role !== undefined) roles.set(place === undefined ? role : `${role} ${place}`, number);
    });
    return roles;
}

/** The same for another file with the same nodes, by their names; null if names do not tell. */
function rolesByName(json, other) {
    const roles = new Map();
    for (const [role, number] of rolesIn(other)) {
        const { name } = other.nodes[number];
        const found = json.nodes.flatMap((node, k) => (node.name === name ? [k] : []));
        if (found.length !== 1) return null;
        roles.set(role, found[0]);
    }
    return roles;
}

/** Name to the matrix of a joint as skins are bound, in the space of the vertices. */
function boundIn({ json, buffer }) {
    const bound = new Map();
    for (const { joints, inverseBindMatrices } of json.skins ?? []) {
        const { bufferView, byteOffset = 0 } = json.accessors[inverseBindMatrices];
        const at = (json.bufferViews[bufferView].byteOffset ?? 0) + byteOffset;
        joints.forEach((joint, n) => {
            const numbers = Array.from({ length: 16 }, (_, k) => buffer.readFloatLE(at + 64 * n + 4 * k));
            bound.set(json.nodes[joint].name, new THREE.Matrix4().fromArray(numbers).invert());
        });
    }
    return bound;
}

/** Loads a file's nodes and clips, with the roles that another file says. That file is loaded if names do not tell. A file
 * whose skins are bound to the pose in which the body stands may be named, if it does not stand at rest. */
export async function loadRig(file, rolesFile = file, stands = null) {
    const json = nodesOnly(file);
    const roles = file === rolesFile ? rolesIn(json) : rolesByName(json, open(rolesFile).json);
    if (!roles) return loadRig(rolesFile, rolesFile, stands);
    const limits = json.nodes.map((node) => node.extensions?.BENDY_joint_limits?.limits);
    const labels = json.nodes.map((node, number) => node.name ?? `#${number}`);
    json.nodes.forEach((node, number) => { node.name = `node${number}`; }); // three.js binds tracks by names
    const names = (json.animations ?? []).map((clip) => clip.name);
    const gltf = await new Promise((resolve, reject) => new GLTFLoader().parse(JSON.stringify(json), '', resolve, reject));
    const nodes = json.nodes.map((_, number) => gltf.scene.getObjectByName(`node${number}`));
    nodes.forEach((node, number) => {
        if (node) Object.assign(node, { number, label: labels[number], rest: node.quaternion.clone(), limit: limitOf(limits[number]) });
    });
    return new Rig(gltf, nodes, roles, names, stands && boundIn(open(stands)));
}

/** What poses obey: an IK solver's own limit is none of theirs. */
function limitOf(limits = []) {
    return limits.find((limit) => limit.scope === 'allButIk') ?? limits.find((limit) => (limit.scope ?? 'everyPose') === 'everyPose');
}

// Joints from hip or shoulder to foot or hand; of a leg also those that may touch the ground.
const humanLimbs = ['left', 'right'].flatMap((side) => [
    { bones: ['UpperArm', 'LowerArm', 'Hand'].map((bone) => side + bone) },
    { bones: ['UpperLeg', 'LowerLeg', 'Foot'].map((bone) => side + bone), foot: [`${side}Foot`, `${side}Toes`] },
]);

class Rig {
    constructor(gltf, nodes, roles, names, bound) {
        Object.assign(this, { scene: gltf.scene, animations: gltf.animations, nodes, roles, names });
        this.mixer = new THREE.AnimationMixer(this.scene);
        this.limited = nodes.filter((node) => node?.limit);
        this.axes = new THREE.Quaternion();
        this.scene.updateMatrixWorld(true);
        const places = nodes.map((node) => node?.position.clone());
        if (bound) this.stand(bound);
        const isHuman = this.has('leftUpperLeg');
        this.limbs = isHuman ? humanLimbs : this.chains();
        const rest = new Frame(this);
        const middle = (bones) => bones.reduce((sum, bone) => sum.add(rest.place(bone)), new THREE.Vector3()).divideScalar(bones.length);
        const beginOf = (side) => middle(this.limbs.map((limb) => limb.bones[0]).filter((bone) => bone.startsWith(side)));
        const legs = this.limbs.filter((limb) => limb.foot);
        const top = middle(isHuman ? ['head'] : legs.map((leg) => leg.bones[0]));
        const up = snapped(top.sub(middle(legs.map((leg) => leg.bones.at(-1)))).normalize(), 35);
        const across = beginOf('left').sub(beginOf('right'));
        const left = snapped(across.addScaledVector(up, -up.dot(across)).normalize(), 20);
        this.axes.setFromRotationMatrix(new THREE.Matrix4().makeBasis(left, up, left.clone().cross(up))).invert();
        this.rest = new Frame(this);
        if (!isHuman) this.divide();
        const { bones } = this.limbs.find((limb) => limb.foot);
        this.leg = bones.slice(1).reduce((sum, bone, n) => sum + this.rest.place(bones[n]).distanceTo(this.rest.place(bone)), 0);
        nodes.forEach((node, number) => { // clips may leave some at rest
            node?.quaternion.copy(node.rest);
            node?.position.copy(places[number]);
        });
    }
    /** Turns joints as they are bound, and puts the hips there. */
    stand(bound) {
        this.scene.traverse((node) => {
            const matrix = bound.get(node.label);
            if (!matrix) return;
            const parent = node.parent.getWorldQuaternion(new THREE.Quaternion()).invert();
            node.quaternion.copy(parent.multiply(new THREE.Quaternion().setFromRotationMatrix(new THREE.Matrix4().extractRotation(matrix))));
            if (node === this.node('hips')) node.position.copy(node.parent.worldToLocal(new THREE.Vector3().setFromMatrixPosition(matrix)));
            node.updateMatrixWorld(true);
        });
    }
    /** The legs of an animal, whole. Exports have parents first, so joints of a chain are in order. */
    chains() {
        const legs = ['leftHindLeg', 'rightHindLeg', 'leftFrontLeg', 'rightFrontLeg'];
        const bonesOf = (leg) => [...this.roles.keys()].filter((role) => role.startsWith(leg));
        return legs.map((leg) => ({ bones: bonesOf(leg), foot: [] })).filter((leg) => leg.bones.length > 0);
    }
    /** Leaves of legs what is between hip or shoulder and foot, as decision 77 says where these are. */
    divide() {
        const height = (bone) => this.rest.place(bone).y;
        const ground = Math.min(...this.limbs.flatMap((leg) => leg.bones.map(height)));
        for (const leg of this.limbs) {
            const ahead = this.rest.way(leg.bones[0], leg.bones[1]).z * (leg.bones[0].includes('Hind') ? -1 : 1);
            if (leg.bones.length > 3 && ahead > 0.3) leg.bones.shift(); // a shoulder blade or pelvis
            const low = leg.bones.findIndex((bone, n) => n > 1 && height(bone) - ground < 0.25 * (height(leg.bones[0]) - ground));
            leg.foot = leg.bones.splice(low < 0 ? leg.bones.length - 1 : low);
            leg.bones.push(leg.foot[0]);
        }
    }
    has(role) { return this.roles.has(role); }
    node(role) { return this.nodes[this.roles.get(role)]; }
    clip(name) {
        const number = name.startsWith('#') ? Number(name.slice(1)) : this.names.indexOf(name);
        if (!this.animations[number]) throw new Error(`no clip ${name} among ${this.names}`);
        return this.animations[number];
    }
    /** The nodes from the root down to a role's. */
    above(role) {
        const found = [];
        for (let node = this.node(role); node && node !== this.scene; node = node.parent) found.push(node);
        return found;
    }
    at(clip, seconds) {
        if (this.playing !== clip) {
            this.mixer.stopAllAction();
            this.mixer.clipAction(clip).play();
            this.playing = clip;
        }
        this.mixer.setTime(seconds);
        this.scene.updateMatrixWorld(true);
        return new Frame(this);
    }
}

/** A unit vector, or the axis of the scene that is nearest to it if that is nearer than an angle. */
function snapped(vector, degrees) {
    const parts = vector.toArray();
    const axis = [0, 1, 2].find((k) => Math.abs(parts[k]) >= Math.cos((degrees * Math.PI) / 180));
    return axis === undefined ? vector.clone() : new THREE.Vector3().setComponent(axis, Math.sign(parts[axis]));
}

/** One pose, in the body's axes: X left, Y up, Z forward. */
class Frame {
    constructor(rig) {
        this.rig = rig;
        this.locals = rig.nodes.map((node) => node?.quaternion.clone());
        this.places = new Map();
        this.turns = new Map();
        for (const [role, number] of rig.roles) {
            const world = rig.nodes[number].matrixWorld;
            this.places.set(role, new THREE.Vector3().setFromMatrixPosition(world).applyQuaternion(rig.axes));
            const turn = new THREE.Quaternion().setFromRotationMatrix(new THREE.Matrix4().extractRotation(world)).premultiply(rig.axes);
            this.turns.set(role, turn);
        }
    }
    place(role) { return this.places.get(role).clone(); }
    way(role, end) { return this.place(end).sub(this.place(role)).normalize(); }
    /** Since rest. */
    turn(role) { return this.turns.get(role).clone().multiply(this.rig.rest.turns.get(role).clone().invert()); }
    local(node) { return this.locals[node.number]; }
}

/** The angle between two rotations, radians; exact for small ones too, of quaternions that floats have rounded. */
export function angleBetween(a, b) {
    const by = a.clone().invert().multiply(b);
    return 2 * Math.atan2(Math.hypot(by.x, by.y, by.z), Math.abs(by.w));
}

// ---- limits, as spec/constraints.md has them

const isFree = ([low, high]) => !(high - low < 2 * Math.PI);

/** How far an angle is beyond a range on the circle, radians: below 0 before its start, 0 inside. */
function beyond(angle, range = [-Infinity, Infinity]) {
    if (isFree(range)) return 0;
    const middle = (range[0] + range[1]) / 2;
    const turned = angle - middle - 2 * Math.PI * Math.round((angle - middle) / (2 * Math.PI));
    return Math.sign(turned) * Math.max(0, Math.abs(turned) - (range[1] - range[0]) / 2);
}

const outside = (angle, range) => Math.abs(beyond(angle, range));

function outsideEllipse(y, z, limit) {
    const half = (range, s) => {
        const angle = s < 0 ? -range[0] : range[1];
        return angle >= Math.PI ? (Number.isFinite(angle) ? 1 : Infinity) : Math.sin(angle / 2);
    };
    const free = [-Infinity, Infinity];
    const [a, b] = [half(limit.y ?? free, y), half(limit.z ?? free, z)];
    const share = Math.hypot(a > 0 ? y / a : 0, b > 0 ? z / b : 0);
    const length = Math.hypot(y, z);
    const beside = 2 * Math.asin(Math.min(1, Math.hypot(a > 0 ? 0 : y, b > 0 ? 0 : z)));
    const over = share > 1 ? 2 * Math.asin(Math.min(1, length)) - 2 * Math.asin(Math.min(1, length / share)) : 0;
    return Math.max(beside, over);
}

/** Both triples of Euler angles about X, Y and Z of a rotation. */
function eulerForms(r, order = 'XYZ') {
    // `order` lists the axes in the order in which they turn the node; three.js names the product from the left.
    const found = new THREE.Euler().setFromQuaternion(r, [...order].reverse().join(''));
    const middle = order[1].toLowerCase();
    const angles = { x: found.x, y: found.y, z: found.z };
    const other = { x: found.x + Math.PI, y: found.y + Math.PI, z: found.z + Math.PI, [middle]: Math.PI - angles[middle] };
    return [angles, other];
}

/**
 * The angle from a rotation to the one whose Euler angles are moved into a box. Where the middle angle is a right one, the outer two
 * turn about one axis, and only their sum or difference is known: then it is shared out in many ways, and the best counts.
 */
function outsideBox(r, form, limit) {
    const [first, middle, last] = [...(limit.order ?? 'XYZ')].map((axis) => axis.toLowerCase());
    const distance = (angles) => {
        const at = new THREE.Euler(0, 0, 0, [...(limit.order ?? 'XYZ')].reverse().join(''));
        for (const axis of ['x', 'y', 'z']) at[axis] = angles[axis] - beyond(angles[axis], limit[axis]);
        return r.angleTo(new THREE.Quaternion().setFromEuler(at));
    };
    let nearest = distance(form);
    if (Math.abs(Math.cos(form[middle])) > 0.05) return nearest;
    for (let k = -180; k <= 180; k += 1) {
        for (const sign of [1, -1]) {
            const angle = (k * Math.PI) / 180;
            nearest = Math.min(nearest, distance({ ...form, [first]: form[first] + angle, [last]: form[last] + sign * angle }));
        }
    }
    return nearest;
}

/** How far a local rotation is outside the limit of its node, radians. */
export function violationOf(node, rotation) {
    const { limit } = node;
    const frame = new THREE.Quaternion(...(limit.frame ?? [0, 0, 0, 1]));
    const r = frame.clone().invert().multiply(node.rest.clone().invert()).multiply(rotation).multiply(frame).normalize();
    if (r.w < 0) r.set(-r.x, -r.y, -r.z, -r.w);
    const angle = 2 * Math.atan2(Math.hypot(r.x, r.y, r.z), r.w);
    if (limit.model === 'free') return 0;
    if (limit.model === 'locked') return angle;
    if (limit.model === 'largestAngle') return Math.max(0, angle - (limit.angle ?? Infinity));
    if (limit.model === 'eulerBox') return Math.min(...eulerForms(r, limit.order).map((form) => outsideBox(r, form, limit)));
    const twist = 2 * Math.atan2(r.x, r.w);
    const about = new THREE.Quaternion(Math.sin(twist / 2), 0, 0, Math.cos(twist / 2));
    const swing = r.clone().multiply(about.invert());
    if (swing.w < 0) swing.set(-swing.x, -swing.y, -swing.z, -swing.w);
    const twisted = outside(twist, limit.x);
    if (limit.model === 'hinge') return Math.max(twisted, 2 * Math.asin(Math.min(1, Math.hypot(swing.y, swing.z))));
    if (limit.model === 'swingTwistEllipse') return Math.max(twisted, outsideEllipse(swing.y, swing.z, limit));
    const swung = (part, range) => outside(2 * Math.atan2(part, swing.w), range);
    return Math.max(twisted, swung(swing.y, limit.y), swung(swing.z, limit.z));
}
