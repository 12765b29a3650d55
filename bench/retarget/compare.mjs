// Compares directions of bones in clips, by three.js.
//   node compare.mjs JOBS.json
// Jobs: [{ "source": glTF, "clip": its name, "control": glTF or null, "others": { name: glTF } }], exports that say roles. The control
// and the others have this clip alone and are of one body. Prints for each job a line of JSON: for each name { "most", "p99": of the
// bone that is farthest off, the largest angle and the 99th percentile, degrees, "bone", "at": seconds }. A bone is off by the angle
// to the control's, and by "either": { "most", ... }, the lesser of that and the angle to the source's. Without a control, only limbs
// are compared, with the source's.

import fs from 'node:fs';
import * as THREE from 'three';
import { loadRig } from './rig.mjs';

const kRate = 60; // frames a second
const kDegrees = 180 / Math.PI;
const quarters = [0, 1, 2, 3].map((n) => new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(0, 1, 0), (n * Math.PI) / 2));
const kLeast = 1e-6; // metres: a shorter bone has no direction
const both = (bones) => ['left', 'right'].flatMap((side) => bones.map(([from, to]) => [`${side}${from}`, `${side}${to}`]));
const limbs = both([['UpperArm', 'LowerArm'], ['LowerArm', 'Hand'], ['UpperLeg', 'LowerLeg'], ['LowerLeg', 'Foot']]);
const others = [
    ['leftUpperLeg', 'rightUpperLeg'], ['leftUpperArm', 'rightUpperArm'], // hips and shoulders
    ...['hips', 'spine', 'chest', 'upperChest'].flatMap((from, n, all) => [...all.slice(n + 1), 'neck'].map((to) => [from, to])),
    ['neck', 'head'], ...both([['Shoulder', 'UpperArm'], ['Hand', 'MiddleProximal'], ['Foot', 'Toes']]),
];

/** Where joints with a role are in the frames of a clip. */
function placesOf(rig, clip) {
    const frames = [];
    for (let k = 0; k === 0 || k / kRate < clip.duration; ++k) {
        rig.at(clip, k / kRate);
        const placeOf = (number) => new THREE.Vector3().setFromMatrixPosition(rig.nodes[number].matrixWorld);
        frames.push(new Map([...rig.roles].map(([role, number]) => [role, placeOf(number)])));
    }
    return frames;
}

/** The angles between a bone's directions, frame by frame; empty if a body lacks it. */
function anglesOf([from, to], frames, others, turn = quarters[0]) {
    const way = (frame) => frame.get(to)?.clone().sub(frame.get(from) ?? frame.get(to)) ?? new THREE.Vector3();
    if (Math.min(way(frames[0]).length(), way(others[0]).length()) < kLeast) return [];
    return others.slice(0, frames.length).map((frame, k) => way(frame).angleTo(way(frames[k]).applyQuaternion(turn)) * kDegrees);
}

/** The bone that is farthest off. */
function worst(bones) {
    const found = { most: 0, p99: 0, bone: '', at: 0 };
    for (const { bone, angles } of bones) {
        const most = angles.reduce((a, b) => Math.max(a, b), 0);
        if (most > found.most) Object.assign(found, { most, bone, at: angles.indexOf(most) / kRate });
        found.p99 = Math.max(found.p99, [...angles].sort((a, b) => a - b)[Math.floor(0.99 * angles.length)] ?? 0);
    }
    return found;
}

/** By how many quarters about the vertical a body faces away from another one: VRM 0 faces -Z. */
function facing(frames, others) {
    const sum = (turn) => limbs.reduce((all, bone) => anglesOf(bone, frames, others, turn).reduce((a, b) => a + b, all), 0);
    return quarters.map((turn) => ({ turn, off: sum(turn) })).sort((a, b) => a.off - b.off)[0].turn;
}

function compare(source, control, other) {
    const turn = facing(source, other);
    const compared = (control ? [...limbs, ...others] : limbs).map((bone) => {
        const beside = anglesOf(bone, source, other, turn);
        const angles = control ? anglesOf(bone, control, other) : beside;
        return { bone: bone.join(' > '), angles, either: angles.map((angle, k) => Math.min(angle, beside[k] ?? angle)) };
    });
    return { ...worst(compared), either: worst(compared.map(({ bone, either }) => ({ bone, angles: either }))) };
}

for (const job of JSON.parse(fs.readFileSync(process.argv[2], 'utf8'))) {
    const line = {};
    const played = async (file, name) => {
        const rig = await loadRig(file);
        return placesOf(rig, name === undefined ? rig.animations[0] : rig.clip(name));
    };
    const source = await played(job.source, job.clip);
    const control = job.control && (await played(job.control));
    for (const [name, file] of Object.entries(job.others)) line[name] = compare(source, control, await played(file));
    console.log(JSON.stringify(line));
}
