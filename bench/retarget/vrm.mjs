// Compares a VRM Animation that Bendy has put on a VRM avatar with what three-vrm-animation makes of it.
//   node vrm.mjs AVATAR.vrm MOTION.vrma EXPORT.glb
// EXPORT is the avatar's, with the motion as its only clip, retargeted with --rests-alike and without limits and planting.
// Prints the largest angle between the orientations of a bone, radians, and the largest distance of the hips, metres.

import fs from 'node:fs';
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { VRMHumanoidLoaderPlugin, VRMMetaLoaderPlugin } from '@pixiv/three-vrm-core';
import { VRMAnimationLoaderPlugin, createVRMAnimationHumanoidTracks } from '@pixiv/three-vrm-animation';
import { angleBetween, loadRig, nodesOnly } from './rig.mjs';

async function load(file, plugins) {
    const loader = new GLTFLoader();
    for (const Plugin of plugins) loader.register((parser) => new Plugin(parser));
    return new Promise((resolve, reject) => loader.parse(JSON.stringify(nodesOnly(file)), '', resolve, reject));
}

const [avatar, motion, exported] = process.argv.slice(2);
const { scene, userData } = await load(avatar, [VRMMetaLoaderPlugin, VRMHumanoidLoaderPlugin]);
const humanoid = userData.vrmHumanoid;
const [animation] = (await load(motion, [VRMAnimationLoaderPlugin])).userData.vrmAnimations;
const tracks = createVRMAnimationHumanoidTracks(animation, humanoid, userData.vrmMeta.metaVersion);
const clip = new THREE.AnimationClip('motion', animation.duration, [...tracks.translation.values(), ...tracks.rotation.values()]);
scene.add(humanoid.normalizedHumanBonesRoot);
const mixer = new THREE.AnimationMixer(scene);
mixer.clipAction(clip).play();

const ours = await loadRig(exported);
const own = ours.animations[0];
const most = {};
let moved = 0;
for (let seconds = 0; seconds < clip.duration; seconds += 1 / 60) {
    mixer.setTime(seconds);
    humanoid.update();
    scene.updateMatrixWorld(true);
    ours.at(own, seconds);
    for (const role of ours.roles.keys()) {
        const theirs = humanoid.getRawBoneNode(role);
        if (!theirs || !tracks.rotation.has(role)) continue;
        const angle = angleBetween(theirs.getWorldQuaternion(new THREE.Quaternion()), ours.node(role).getWorldQuaternion(new THREE.Quaternion()));
        most[role] = Math.max(most[role] ?? 0, angle);
    }
    const at = (node) => node.getWorldPosition(new THREE.Vector3());
    moved = Math.max(moved, at(humanoid.getRawBoneNode('hips')).distanceTo(at(ours.node('hips'))));
}
const [bone, radians] = Object.entries(most).sort((a, b) => b[1] - a[1])[0];
console.log(JSON.stringify({ radians, bone, metres: moved, bones: tracks.rotation.size, seconds: clip.duration }));
