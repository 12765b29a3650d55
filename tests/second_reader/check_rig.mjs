// Rules of joints, constraints and IK chains: constraints.md and the pages of REST, LIMT, PULL, KINF, JNTS, JNAM,
// ROLE, STND.

import { all_finite, all_zero, is_unit, is_utf8, kNone, kUnitTolerance } from './numbers.mjs';
import { check_material } from './check_file.mjs';

const kMostJoints = 65000;
/** Half a turn, as limits have it: the f32 nearest to pi. */
const kHalfTurn = Math.fround(Math.PI);
const kTurn = 2 * kHalfTurn;

/** The joints of an object in pre-order: { chunk, parent }. */
function number_joints(file, object) {
    const joints = [];
    const open = file.children(object, 'SKIN').reverse().map((chunk) => ({ chunk, parent: kNone }));
    while (open.length > 0) {
        const joint = open.pop();
        joint.number = joints.length;
        joints.push(joint);
        for (const child of file.children(joint.chunk, 'SKIN').reverse()) open.push({ chunk: child, parent: joint.number });
    }
    return joints;
}

export function check_rest(file, chunk, rest) {
    const others = [...rest.translation, ...rest.scale, ...(rest.shear ?? [])];
    if (!all_finite(others)) file.add('NOT_FINITE', chunk);
    if (!is_unit(rest.rotation)) file.add('ROTATION_NOT_UNIT', chunk);
}

/** True if a value of `angle` plus whole turns lies in the range; a range of a turn or more is free. */
function on_circle(angle, low, high) {
    if (low === -Infinity || high === Infinity) return true;
    const turns = Math.ceil((low - angle) / kTurn);
    return angle + turns * kTurn <= high;
}

function rest_is_legal(limit) {
    const { model, rotationMin: low, rotationMax: high } = limit;
    for (let axis = 0; axis < 3; ++axis)
        if (!(limit.translationMin[axis] <= 0 && limit.translationMax[axis] >= 0)) return false;
    if (model >= 2 && model <= 4) return on_circle(0, low[0], high[0]);
    if (model === 5) return [0, kHalfTurn].some((form) => low.every((least, axis) => on_circle(form, least, high[axis])));
    return true;
}

/** The rotation axes whose ranges the model reads. */
const kAxesRead = { 0: [], 1: [], 2: [0], 3: [0, 1, 2], 4: [0, 1, 2], 5: [0, 1, 2], 6: [] };

/** Minima are not above maxima, and none is NaN. */
function check_order(limit, add) {
    const axes = limit.model === 6 ? [] : kAxesRead[limit.model];
    let good = true;
    for (let axis = 0; axis < 3; ++axis) {
        const turns = axes.includes(axis) && limit.rotationMin[axis] > limit.rotationMax[axis];
        if (!turns && !(limit.translationMin[axis] > limit.translationMax[axis])) continue;
        add('LIMIT_ORDER');
        good = false;
    }
    return good && ![...limit.rotationMin, ...limit.rotationMax, ...limit.translationMin, ...limit.translationMax].some(Number.isNaN);
}

function check_constraint(file, chunk, limit) {
    const ranges = [...limit.rotationMin, ...limit.rotationMax, ...limit.translationMin, ...limit.translationMax];
    let good = true;
    const add = (code) => {
        good = false;
        file.add(code, chunk);
    };
    if (limit.model > 6 || limit.eulerOrder > 5 || limit.scope > 2 || limit.flags > 7) {
        add('ENUM_RANGE');
        return;
    }
    if (ranges.some(Number.isNaN) || !all_finite([limit.softZone, ...limit.preferred])) add('NOT_FINITE');
    if (limit.softZone < 0) add('BELOW_ZERO');
    if (!is_unit(limit.frame)) add('ROTATION_NOT_UNIT');
    for (const stiffness of limit.stiffness) if (!(stiffness >= 0 && stiffness <= 1)) add('FRACTION_RANGE');
    if (!check_order(limit, add)) return;
    for (let axis = 0; axis < 6; ++axis) {
        const is_move = axis >= 3;
        if (!is_move && !kAxesRead[limit.model].includes(axis)) continue;
        const low = (is_move ? limit.translationMin : limit.rotationMin)[axis % 3];
        const high = (is_move ? limit.translationMax : limit.rotationMax)[axis % 3];
        const is_swing = !is_move && axis > 0 && (limit.model === 3 || limit.model === 4);
        if (low === Infinity || high === -Infinity) add('LIMIT_RANGE');
        else if (is_swing && !(low <= 0 && high >= 0)) add('LIMIT_RANGE');
    }
    if (limit.model === 6 && limit.rotationMax[0] < 0) add('LIMIT_RANGE');
    if (good && (limit.flags & 4) === 0 && !rest_is_legal(limit)) add('REST_OUTSIDE');
}

function check_constraints_of(file, pivot) {
    const scopes = new Set();
    for (const chunk of file.children(pivot, 'LIMT')) {
        const limit = file.record(chunk, 'ConstraintRecord', 96);
        if (!limit) continue;
        check_constraint(file, chunk, limit);
        if (scopes.has(limit.scope)) file.add('CONSTRAINT_REPEATED', chunk);
        scopes.add(limit.scope);
    }
}

function check_chain_weights(file, joint, pivot, chains) {
    const seen = new Set();
    for (const chunk of file.children(pivot, 'PULL')) {
        const pull = file.record(chunk, 'ChainWeightRecord', 8);
        if (!pull) continue;
        if (!(pull.weight >= 0 && pull.weight <= 1)) file.add('FRACTION_RANGE', chunk);
        if (chains.includes(null)) continue;  // nothing is held against what cannot be read
        if (pull.chain >= chains.length) {
            file.add('CHAIN_RANGE', chunk);
            continue;
        }
        if (seen.has(pull.chain)) file.add('CHAIN_WEIGHT_REPEATED', chunk);
        seen.add(pull.chain);
        const links = chains[pull.chain];
        if (!links.has(joint.number)) file.add('CHAIN_WEIGHT_PATH', chunk);
    }
}

/** Numbers of the joints from the effector up to the start; null if the chain is faulty. */
function check_chain(file, chain, joints) {
    const chunk = file.child(chain, 'KINF');
    const record = file.record(chunk, 'ChainRecord', 92);
    if (!record) return null;
    if (record.solver > 6 || record.flags > 3) file.add('ENUM_RANGE', chunk);
    if (!all_zero(record.reserved)) file.add('RESERVED_FIELD', chunk);
    if (!all_finite([record.tolerance, ...record.poleVector, record.poleAngle, ...record.tipOffset, record.stretch]))
        file.add('NOT_FINITE', chunk);
    for (const number of [record.tolerance, record.stretch]) if (number < 0) file.add('BELOW_ZERO', chunk);
    for (const share of [record.positionWeight, record.rotationWeight, record.influence, record.compress])
        if (!(share >= 0 && share <= 1)) file.add('FRACTION_RANGE', chunk);
    if (!is_unit(record.tipRotation)) file.add('ROTATION_NOT_UNIT', chunk);
    let good = true;
    for (const joint of [record.start, record.effector])
        if (joint >= joints.length) {
            file.add('JOINT_RANGE', chunk);
            good = false;
        }
    for (const joint of [record.target, record.pole])
        if (joint !== kNone && joint >= joints.length) {
            file.add('JOINT_RANGE', chunk);
            good = false;
        }
    if (!good) return null;
    const links = new Set();
    for (let at = record.effector; at !== kNone; at = joints[at].parent) {
        links.add(at);
        if (at === record.start) return links;
    }
    file.add('CHAIN_PATH', chunk);
    return null;
}

/** Rest transforms and submeshes of JNTS, or null. */
function check_joint_table(file, object, joints) {
    const chunk = file.child(object, 'JNTS');
    const record = file.record(chunk, 'JointsRecord', 16);
    if (!record) return null;
    if (record.reserved.some((word) => word !== 0)) file.add('RESERVED_FIELD', chunk);
    if (file.payload(chunk).length !== 16 + 52 * record.joints + 24 * record.submeshes) {
        file.add('RECORD_SIZE', chunk);
        return null;
    }
    if (record.joints !== joints.length) {
        file.add('COUNT_MISMATCH', chunk);
        return null;
    }
    const table = file.body(chunk);
    joints.forEach((joint, k) => {
        const pivot = file.child(joint.chunk, 'PIVO');
        if (!pivot || !file.has(pivot, 'REST')) check_rest(file, chunk, table.rests[k]);
    });
    return { chunk, table };
}

function check_names(file, object, joints) {
    const chunk = file.child(object, 'JNAM');
    const payload = file.payload(chunk);
    if (!payload) return;
    if (!is_utf8(payload)) file.add('NOT_UTF8', chunk);
    const zeros = payload.reduce((count, byte) => count + (byte === 0), 0);
    if (zeros !== joints.length || (payload.length > 0 && payload[payload.length - 1] !== 0)) file.add('COUNT_MISMATCH', chunk);
}

/** ROLE.md. */
const kLastBone = 55;
const kLastRole = 64;

function check_roles(file, object, joints) {
    const chunk = file.child(object, 'ROLE');
    const payload = file.payload(chunk);
    if (!payload) return;
    if (payload.length % 8 !== 0) {
        file.add('RECORD_SIZE', chunk);
        return;
    }
    const { roles } = file.body(chunk);
    const codes = roles.map(({ joint, role, place }) => {
        if (role < 1 || role > kLastRole) return 'ENUM_RANGE';
        if (joint >= joints.length) return 'JOINT_RANGE';
        return role <= kLastBone && place !== 0 ? 'ROLE_PLACE' : null;
    });
    for (const code of codes) if (code) file.add(code, chunk);
    if (codes.some((code) => code)) return;
    if (roles.some(({ joint }, k) => k > 0 && joint <= roles[k - 1].joint)) file.add('JOINT_ORDER', chunk);
    if (new Set(roles.map(({ role, place }) => `${role} ${place}`)).size < roles.length) file.add('ROLE_REPEATED', chunk);
}

/** STND.md. */
const kLastEvidence = 4;
const kPoseBytes = 32;
const kRotationBytes = 16;

function check_standing_pose(file, object, joints) {
    const chunk = file.child(object, 'STND');
    const pose = file.record(chunk, 'StandingPoseRecord', kPoseBytes);
    if (!pose) return;
    const payload = file.payload(chunk);
    if ((payload.length - kPoseBytes) % kRotationBytes !== 0) file.add('RECORD_SIZE', chunk);
    if (pose.evidence > kLastEvidence) file.add('ENUM_RANGE', chunk);
    if (!all_zero(pose.reserved)) file.add('RESERVED_FIELD', chunk);
    if (!is_unit(pose.axes)) file.add('ROTATION_NOT_UNIT', chunk);
    if (!all_finite([pose.ground, pose.height])) file.add('NOT_FINITE', chunk);
    if (pose.height < 0) file.add('BELOW_ZERO', chunk);
    let before = -1;
    for (let at = kPoseBytes; at + kRotationBytes <= payload.length; at += kRotationBytes) {
        const { joint, rotation } = file.read.record('StandingRotationRecord', payload.subarray(at, at + kRotationBytes));
        if (joint >= joints.length) file.add('JOINT_RANGE', chunk);
        if (joint <= before) file.add('JOINT_ORDER', chunk);
        const [x, y, z] = rotation;
        if (!(x * x + y * y + z * z <= 1 + 2 * kUnitTolerance)) file.add('ROTATION_NOT_UNIT', chunk);
        before = joint;
    }
}

/** Everything about an object's joints but their polygons. Gives { joints, table }. */
export function check_rig(file, object) {
    const joints = number_joints(file, object);
    file.counts.joints += joints.length;
    if (joints.length > kMostJoints) file.add('TOO_MANY_JOINTS', object);
    const has_table = file.has(object, 'JNTS');
    const table = check_joint_table(file, object, joints);
    check_names(file, object, joints);
    check_roles(file, object, joints);
    check_standing_pose(file, object, joints);
    const chains = file.children(object, 'IKCH').map((chain) => check_chain(file, chain, joints));
    for (const joint of joints) {
        const pivot = file.child(joint.chunk, 'PIVO');
        if (!pivot) {
            if (!has_table && !file.has(joint.chunk, 'PIVO')) file.add('CHUNK_MISSING', joint.chunk);
        } else {
            const chunk = file.child(pivot, 'REST');
            if (!has_table && !file.has(pivot, 'REST')) file.add('CHUNK_MISSING', pivot);
            const rest = file.record(chunk, 'RestRecord', 40, 52);
            if (rest) check_rest(file, chunk, rest);
            check_constraints_of(file, pivot);
            check_chain_weights(file, joint, pivot, chains);
        }
        for (const chunk of file.children(joint.chunk, 'MATE')) check_material(file, chunk);
    }
    return { joints, table };
}
