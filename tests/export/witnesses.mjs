// What Khronos' validator says of glTF files, and how three.js poses them.
//   node witnesses.mjs JOBS.json
// Jobs: [{ "file": GLB or glTF, "frames": [{ "clip": number or -1, "time": seconds, "mesh": where a PLY file goes }] }]
// Prints, for each job: { "file", "errors": [validator's messages], "failed": what three.js said, if it gave up }

import fs from 'node:fs';
import path from 'node:path';
import validator from 'gltf-validator';
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

globalThis.self ??= globalThis;
globalThis.ProgressEvent ??= class extends Event {};

async function validate(file, bytes) {
    const report = await validator.validateBytes(new Uint8Array(bytes), {
        uri: path.basename(file),
        maxIssues: 0,
        externalResourceFunction: async (uri) => new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri)))),
    });
    return report.issues.messages.filter((m) => m.severity === 0).map((m) => `${m.code} ${m.pointer ?? ''} ${m.message}`);
}

/** The JSON and the buffer of a GLB file, or of a glTF file with one buffer beside it. */
function open(file, bytes) {
    if (bytes.toString('latin1', 0, 4) !== 'glTF') {
        const json = JSON.parse(bytes.toString('utf8'));
        const uri = json.buffers?.[0]?.uri;
        return { json, buffer: uri ? fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri))) : Buffer.alloc(0) };
    }
    const size = bytes.readUInt32LE(12);
    return { json: JSON.parse(bytes.toString('utf8', 20, 20 + size)), buffer: bytes.subarray(28 + size) };
}

/** What three.js reads without a browser: no images, unique names (it binds tracks by name), the buffer inside. */
function withoutSurface({ json, buffer }) {
    for (const kind of ['materials', 'textures', 'images', 'samplers', 'extensionsRequired', 'extensionsUsed']) delete json[kind];
    for (const mesh of json.meshes ?? []) for (const primitive of mesh.primitives) delete primitive.material;
    (json.nodes ?? []).forEach((node, i) => { node.name = `node${i}`; });
    (json.meshes ?? []).forEach((mesh, i) => { mesh.name = `mesh${i}`; });
    if (json.buffers) json.buffers[0].uri = 'data:application/octet-stream;base64,' + buffer.toString('base64');
    return JSON.stringify(json);
}

// Weights stay as they are written; three.js would divide those of the first set by their sum.
THREE.SkinnedMesh.prototype.normalizeSkinWeights = () => {};

/** World-space positions of an object, all sets of influences added up; three.js itself takes the first. */
function positionsOf(object) {
    const { attributes } = object.geometry;
    const positions = new Float64Array(attributes.position.count * 3);
    const vertex = new THREE.Vector3();
    const sets = [];
    if (object.skeleton) {
        sets.push([attributes.skinIndex, attributes.skinWeight]);
        for (let n = 1; attributes[`joints_${n}`]; ++n) sets.push([attributes[`joints_${n}`], attributes[`weights_${n}`]]);
    }
    const isSingular = Math.abs(object.matrixWorld.determinant()) < 1e-30;
    if (object.skeleton && isSingular) object.bindMatrixInverse.identity(); // its node does not move a skinned mesh
    for (let v = 0; v < attributes.position.count; ++v) {
        for (const set of sets.length ? sets : [null]) {
            if (set) [attributes.skinIndex, attributes.skinWeight] = set;
            if (object.isMesh && (object.skeleton || !object.isSkinnedMesh)) object.getVertexPosition(v, vertex);
            else THREE.Mesh.prototype.getVertexPosition.call(object, v, vertex);
            if (!(object.skeleton && isSingular)) vertex.applyMatrix4(object.matrixWorld);
            [vertex.x, vertex.y, vertex.z].forEach((value, i) => { positions[3 * v + i] += value; });
        }
    }
    if (sets.length) [attributes.skinIndex, attributes.skinWeight] = sets[0];
    return positions;
}

function writePly(file, objects) {
    const parts = objects.map((object) => ({ positions: positionsOf(object), indices: object.geometry.index?.array ?? [], isMesh: object.isMesh }));
    const vertices = parts.reduce((sum, part) => sum + part.positions.length / 3, 0);
    const triangles = parts.reduce((sum, part) => sum + (part.isMesh ? part.indices.length / 3 : 0), 0);
    const head = `ply\nformat binary_little_endian 1.0\nelement vertex ${vertices}\nproperty double x\nproperty double y\nproperty double z\n` +
        `element face ${triangles}\nproperty list uchar uint vertex_indices\nend_header\n`;
    const body = Buffer.alloc(vertices * 24 + triangles * 13);
    let at = 0;
    for (const { positions } of parts) for (const value of positions) at = body.writeDoubleLE(value, at);
    let first = 0;
    for (const { positions, indices, isMesh } of parts) {
        for (let i = 0; isMesh && i < indices.length; i += 3) {
            at = body.writeUInt8(3, at);
            for (let corner = 0; corner < 3; ++corner) at = body.writeUInt32LE(first + indices[i + corner], at);
        }
        first += positions.length / 3;
    }
    fs.writeFileSync(file, Buffer.concat([Buffer.from(head, 'latin1'), body]));
}

async function pose(file, bytes, frames) {
    const text = withoutSurface(open(file, bytes));
    const gltf = await new Promise((resolve, reject) => new GLTFLoader().parse(text, '', resolve, reject));
    const objects = [];
    const rest = [];
    gltf.scene.traverse((object) => {
        if (object.isMesh || object.isLine || object.isPoints) objects.push(object);
        rest.push([object, object.position.clone(), object.quaternion.clone(), object.scale.clone(), object.morphTargetInfluences?.slice()]);
    });
    for (const { clip, time, mesh } of frames) {
        for (const [object, position, quaternion, scale, weights] of rest) {
            object.position.copy(position);
            object.quaternion.copy(quaternion);
            object.scale.copy(scale);
            if (weights) object.morphTargetInfluences.splice(0, Infinity, ...weights);
        }
        const mixer = new THREE.AnimationMixer(gltf.scene);
        if (clip >= 0) {
            const action = mixer.clipAction(gltf.animations[clip]);
            action.setLoop(THREE.LoopOnce, 1);
            action.clampWhenFinished = true;
            action.play();
            mixer.setTime(time);
        }
        gltf.scene.updateMatrixWorld(true);
        writePly(mesh, objects);
        mixer.stopAllAction();
        mixer.uncacheRoot(gltf.scene);
    }
}

const results = [];
for (const job of JSON.parse(fs.readFileSync(process.argv[2], 'utf8'))) {
    const bytes = fs.readFileSync(job.file);
    const result = { file: job.file, errors: await validate(job.file, bytes) };
    try {
        await pose(job.file, bytes, job.frames);
    } catch (problem) {
        result.failed = String(problem);
    }
    results.push(result);
}
console.log(JSON.stringify(results));
