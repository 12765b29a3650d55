// Tells the clips of a glTF file from another rest pose: the same motion, by other numbers.
//   node turn_rests.mjs SOURCE.glb REST OUT.glb
// SOURCE is an export that says roles, of a human that rests upright along Y, facing Z. OUT has neither roles nor limits. REST is
//   as_is             the same rest pose, for control
//   collarbones_up, feet_down, spine_bent, lies    with some bones turned
//   along_x           with all bones along X, as motion capture often has it
//   in_clip           with the pose in the middle of the first clip
//   FILE.glb          as the nodes of the same names rest there
// Where bones are turned, joints get other axes, as in BVH: each rests without a rotation. With G' = G C for the orientation G of
// a joint and a constant C of it, the local rotation R becomes inverse(C of the parent) R C and the translation t becomes
// inverse(C of the parent) t. Slerp and lerp commute with both, so motion between keys is the same, too.

import fs from 'node:fs';
import * as THREE from 'three';
import { angleBetween, open, rolesIn } from './rig.mjs';

const kBend = (40 * Math.PI) / 180; // of a bent spine, forward
const axis = { x: new THREE.Vector3(1, 0, 0), y: new THREE.Vector3(0, 1, 0) };
const identity = new THREE.Quaternion();
const trunk = ['spine', 'chest', 'upperChest', 'neck', 'head'];

const swing = (from, to) => new THREE.Quaternion().setFromUnitVectors(from.clone().normalize(), to);
const rotationOf = (node) => new THREE.Quaternion(...(node.rotation ?? [0, 0, 0, 1]));
const translationOf = (node) => new THREE.Vector3(...(node.translation ?? [0, 0, 0]));

/** The skeleton of a file at rest. */
class Skeleton {
    constructor(json) {
        this.nodes = json.nodes;
        this.roles = rolesIn(json);
        this.roleOf = new Map([...this.roles].map(([role, node]) => [node, role]));
        this.parents = json.nodes.map(() => -1);
        json.nodes.forEach((node, number) => { for (const child of node.children ?? []) this.parents[child] = number; });
        this.order = []; // parents first
        const visit = (number) => {
            this.order.push(number);
            for (const child of json.nodes[number].children ?? []) visit(child);
        };
        this.parents.forEach((parent, number) => { if (parent < 0) visit(number); });
        this.orientations = [];
        this.places = [];
        const matrices = [];
        for (const number of this.order) {
            const node = json.nodes[number];
            const scale = new THREE.Vector3(...(node.scale ?? [1, 1, 1]));
            const local = new THREE.Matrix4().compose(translationOf(node), rotationOf(node), scale);
            const parent = this.parents[number];
            matrices[number] = parent < 0 ? local : matrices[parent].clone().multiply(local);
            this.orientations[number] = (parent < 0 ? identity : this.orientations[parent]).clone().multiply(rotationOf(node));
            this.places[number] = new THREE.Vector3().setFromMatrixPosition(matrices[number]);
        }
    }
    way(from, to) { return this.places[this.roles.get(to)].clone().sub(this.places[this.roles.get(from)]); }
    /** For each node the turn of the nearest joint at or above it that `turns` has; null there ends a turn. */
    spread(turns) {
        const found = [];
        for (const number of this.order) {
            const role = this.roleOf.get(number);
            const above = this.parents[number] < 0 ? turns.root ?? identity : found[this.parents[number]];
            found[number] = role in turns ? turns[role] ?? identity : above;
        }
        return found;
    }
    size(number) { return (this.nodes[number].children ?? []).reduce((sum, child) => sum + this.size(child), 1); }
    /** The child to which a joint points. */
    next(number) {
        const children = this.nodes[number].children ?? [];
        const ofTrunk = children.find((child) => trunk.includes(this.roleOf.get(child)));
        return ofTrunk ?? children.sort((a, b) => this.size(b) - this.size(a))[0];
    }
    /** What the bones of each node are turned by, model space. */
    turns(rest) {
        const sides = ['left', 'right'];
        if (rest === 'lies') return this.spread({ root: new THREE.Quaternion().setFromAxisAngle(axis.x, -Math.PI / 2) });
        if (rest === 'spine_bent') {
            const ends = ['neck', ...sides.map((side) => side + (this.roles.has(`${side}Shoulder`) ? 'Shoulder' : 'UpperArm'))];
            const bent = new THREE.Quaternion().setFromAxisAngle(axis.x, kBend);
            return this.spread({ spine: bent, ...Object.fromEntries(ends.map((end) => [end, null])) });
        }
        if (rest === 'collarbones_up') {
            const has = sides.filter((side) => this.roles.has(`${side}Shoulder`));
            return has.length === 0 ? null : this.spread(Object.fromEntries(has.flatMap((side) => [
                [`${side}Shoulder`, swing(this.way(`${side}Shoulder`, `${side}UpperArm`), axis.y)], [`${side}UpperArm`, null]])));
        }
        if (rest === 'feet_down') {
            const has = sides.filter((side) => this.roles.has(`${side}Toes`));
            return has.length === 0 ? null : this.spread(Object.fromEntries(
                has.map((side) => [`${side}Foot`, swing(this.way(`${side}Foot`, `${side}Toes`), axis.y.clone().negate())])));
        }
        if (rest !== 'along_x') throw new Error(`no rest pose ${rest}`);
        const [turns, isBody] = [[], []];
        for (const number of this.order) {
            const next = this.next(number);
            const along = next === undefined ? null : this.places[next].clone().sub(this.places[number]);
            turns[number] = this.parents[number] < 0 ? identity : turns[this.parents[number]];
            isBody[number] = this.roleOf.get(number) === 'hips' || isBody[this.parents[number]] === true;
            if (isBody[number] && along?.length() > 1e-6) turns[number] = swing(along, axis.x);
        }
        return turns;
    }
}

/** Floats of an accessor, and a way to add an accessor. */
class Numbers {
    constructor(json, buffer) { Object.assign(this, { json, parts: [buffer], size: buffer.length, buffer }); }
    read(accessor, width) {
        const { bufferView, byteOffset = 0, count, componentType } = this.json.accessors[accessor];
        const view = this.json.bufferViews[bufferView];
        if (componentType !== 5126 || view.byteStride) throw new Error('only packed floats are read');
        const at = (view.byteOffset ?? 0) + byteOffset;
        return Array.from({ length: count }, (_, n) => Array.from({ length: width }, (_, k) => this.buffer.readFloatLE(at + 4 * (n * width + k))));
    }
    add(rows) {
        const bytes = Buffer.from(new Float32Array(rows.flat()).buffer);
        this.json.bufferViews.push({ buffer: 0, byteOffset: this.size, byteLength: bytes.length });
        this.parts.push(bytes);
        this.size += bytes.length;
        this.json.accessors.push({ bufferView: this.json.bufferViews.length - 1, componentType: 5126, count: rows.length,
            type: { 1: 'SCALAR', 3: 'VEC3', 4: 'VEC4' }[rows[0].length], ...(rows[0].length === 1 ? { min: rows[0], max: rows.at(-1) } : {}) });
        return this.json.accessors.length - 1;
    }
}

/** Other rest poses of the same joints. A joint that a clip does not turn is turned by a constant track. */
function restAs(json, numbers, rests) {
    for (const clip of json.animations) {
        const turned = new Set(clip.channels.filter(({ target }) => target.path === 'rotation').map(({ target }) => target.node));
        json.nodes.forEach((node, number) => {
            if (turned.has(number) || !rests[number] || angleBetween(rests[number], rotationOf(node)) < 1e-6) return;
            clip.samplers.push({ input: numbers.add([[0]]), output: numbers.add([rotationOf(node).toArray()]) });
            clip.channels.push({ sampler: clip.samplers.length - 1, target: { node: number, path: 'rotation' } });
        });
    }
    json.nodes.forEach((node, number) => { if (rests[number]) node.rotation = rests[number].toArray(); });
}

/** Rotations in the middle of the first clip. */
function inClip(json, numbers) {
    const { channels, samplers } = json.animations[0];
    const times = samplers.map(({ input }) => numbers.read(input, 1).flat());
    const middle = Math.max(...times.map((list) => list.at(-1))) / 2;
    const rests = [];
    for (const { sampler, target } of channels.filter(({ target }) => target.path === 'rotation')) {
        const keys = numbers.read(samplers[sampler].output, 4).map((key) => new THREE.Quaternion(...key));
        const after = times[sampler].findIndex((time) => time > middle);
        const [a, b] = after > 0 ? [after - 1, after] : after === 0 ? [0, 0] : [keys.length - 1, keys.length - 1];
        const share = a === b ? 0 : (middle - times[sampler][a]) / (times[sampler][b] - times[sampler][a]);
        rests[target.node] = keys[a].clone().slerp(keys[b], share);
    }
    return rests;
}

function turnBones(json, numbers, turns) {
    const { orientations, parents } = new Skeleton(json);
    const after = orientations.map((orientation, number) => turns[number].clone().multiply(orientation).invert());
    const before = parents.map((parent) => (parent < 0 ? identity : after[parent].clone().invert()));
    const rotated = (number, rotation) => before[number].clone().multiply(rotation).multiply(after[number]);
    for (const clip of json.animations) {
        clip.samplers = clip.channels.map(({ sampler }) => ({ ...clip.samplers[sampler] })); // one each
        clip.channels.forEach((channel, number) => { channel.sampler = number; });
        for (const { sampler, target } of clip.channels) {
            const own = clip.samplers[sampler];
            const change = (width, changed) => { own.output = numbers.add(numbers.read(own.output, width).map((key) => changed(key).toArray())); };
            if (target.path === 'rotation') change(4, (key) => rotated(target.node, new THREE.Quaternion(...key)));
            if (target.path === 'translation') change(3, (key) => new THREE.Vector3(...key).applyQuaternion(before[target.node]));
        }
    }
    json.nodes.forEach((node, number) => {
        node.rotation = rotated(number, rotationOf(node)).toArray();
        if (node.translation) node.translation = translationOf(node).applyQuaternion(before[number]).toArray();
    });
    restAs(json, numbers, json.nodes.map(() => identity));
}

/** Leaves of the nodes the skeleton that has roles: not meshes and what controls limbs in an editor. */
function keepSkeleton(json) {
    const { roles, order, parents } = new Skeleton(json);
    const kept = new Set();
    for (let node = roles.get('hips'); node >= 0; node = parents[node]) kept.add(node);
    const path = new Set(kept);
    for (const number of order) {
        const parent = parents[number];
        if (kept.has(parent) && (!path.has(parent) || parent === roles.get('hips'))) kept.add(number);
    }
    for (const node of json.nodes) {
        node.children = node.children?.filter((child) => kept.has(child));
        if (!node.children?.length) delete node.children;
    }
    for (const scene of json.scenes) scene.nodes = scene.nodes.filter((node) => kept.has(node));
    for (const clip of json.animations) clip.channels = clip.channels.filter(({ target }) => kept.has(target.node));
}

const [source, rest, out] = process.argv.slice(2);
const { json, buffer } = open(source);
const numbers = new Numbers(json, buffer);
keepSkeleton(json);
if (rest.endsWith('.glb')) {
    const other = new Map(open(rest).json.nodes.map((node) => [node.name, rotationOf(node)]));
    restAs(json, numbers, json.nodes.map((node) => other.get(node.name)));
} else if (rest === 'in_clip') {
    restAs(json, numbers, inClip(json, numbers));
} else if (rest !== 'as_is') {
    const turns = new Skeleton(json).turns(rest);
    if (!turns) {
        console.log(`there are no bones for ${rest}`);
        process.exit(0);
    }
    turnBones(json, numbers, turns);
}
for (const node of json.nodes) { delete node.extensions; delete node.extras; }
for (const kind of ['extensions', 'extensionsUsed', 'extras']) delete json[kind];
json.buffers = [{ byteLength: numbers.size }];
let text = Buffer.from(JSON.stringify(json));
text = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
const data = Buffer.concat(numbers.parts);
const chunk = (kind, bytes) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(bytes.length, 0);
    head.write(kind, 4, 'latin1');
    return Buffer.concat([head, bytes]);
};
const chunks = Buffer.concat([chunk('JSON', text), chunk('BIN\0', data)]);
const head = Buffer.from('glTF\x02\0\0\0\0\0\0\0', 'latin1');
head.writeUInt32LE(12 + chunks.length, 8);
fs.writeFileSync(out, Buffer.concat([head, chunks]));
