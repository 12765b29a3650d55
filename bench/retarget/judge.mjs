// Judges retargeted clips by three.js's forward kinematics of glTF files, with no code of Bendy's.
//   node judge.mjs JOBS.json
// Jobs: [{ "source": glTF, "roles": export of the source, "clip": its name, "full", "free", "back": exports of the retargeted
// clip: as usual, without limits and planting, and put back on the source's rig without both, "stands": { "from", "to": a file
// whose skins are bound to the pose in which the source's or the target's body stands, or null if that stands at rest } }]. Prints for each job a line
// of JSON: the figures that Sums below explains, or { "failed": why }.

import fs from 'node:fs';
import * as THREE from 'three';
import { angleBetween, loadRig, violationOf } from './rig.mjs';

const kRate = 60; // frames a second
const kDegrees = 180 / Math.PI;
// Contacts as the judge finds them: an ankle on the ground is at most so much above its rest, and so slow.
const kLow = 0.04; // leg lengths
const kSlow = 0.3; // leg lengths a second
// A leg whose ankle or toes are lower than that, or were so shortly before, may be moved by the ground.
const kGround = 0.16; // leg lengths
const kShortly = 0.1; // seconds
const kActs = 0.002; // radians outside a limit without which nobody can tell that it acts

/** Adds up numbers. */
class Sum {
    total = 0;
    squares = 0;
    most = 0;
    count = 0;
    at = null; // where the largest is
    add(number, at) {
        this.total += number;
        this.squares += number * number;
        this.count += 1;
        if (number > this.most) [this.most, this.at] = [number, at];
    }
    toJSON() {
        return { total: this.total, squares: this.squares, most: this.most, count: this.count, at: this.at };
    }
}

/** The rotation by the smallest angle from one unit vector to another. */
const swing = (from, to) => new THREE.Quaternion().setFromUnitVectors(from, to);

/** The frames of a clip as the judge needs them. */
function play(rig, name) {
    const clip = rig.clip(name);
    const frames = [];
    for (let k = 0; k === 0 || k / kRate < clip.duration; ++k) frames.push(rig.at(clip, k / kRate));
    return frames;
}

function twistOff(from, to, axis, align) {
    const off = from.clone().invert().multiply(to).multiply(align.clone().invert());
    return 2 * Math.abs(Math.atan2(off.x * axis.x + off.y * axis.y + off.z * axis.z, off.w));
}

function judge(source, target, frames) {
    const sums = {};
    const sum = (name) => (sums[name] ??= new Sum());
    const count = Math.min(...Object.values(frames).map((list) => list.length));
    const leg = { source: source.leg, target: target.leg };
    const limbs = source.limbs.map(({ bones, foot }, n) => ({ from: bones, to: target.limbs[n].bones, foot, bend: { source: 0, target: 0 } }));
    for (let k = 0; k < count; ++k) {
        const [from, free, full, back] = [frames.source[k], frames.free[k], frames.full[k], frames.back[k]];
        const seconds = k / kRate;
        // Limits that the unlimited pose violates are those that have to act.
        const outside = new Map(target.limited.map((node) => [node, violationOf(node, free.local(node))]));
        sum('limited').add([...outside.values()].some((angle) => angle > kActs) ? 1 : 0);
        for (const node of target.limited) sum('violated').add(violationOf(node, full.local(node)), `${node.label} ${seconds.toFixed(2)}`);
        for (const limb of limbs) {
            const isHeld = limb.to.some((bone) => target.above(bone).some((node) => outside.get(node) > kActs)); // feet may be beside legs
            if (limb.foot?.some((bone) => source.has(bone) && from.place(bone).y - source.rest.place(bone).y < kGround * leg.source)) limb.low = seconds;
            const isFree = !isHeld && !(seconds - limb.low < kShortly);
            sum('untouched').add(isFree ? 1 : 0);
            limb.to.slice(1, limb.from.length).forEach((end, n) => { // one may have its foot earlier
                const [bone, own, ownEnd] = [limb.to[n], limb.from[n], limb.from[n + 1]];
                const restWay = { source: source.rest.way(own, ownEnd), target: target.rest.way(bone, end) };
                const align = swing(restWay.target, restWay.source);
                const label = `${bone} ${seconds.toFixed(2)}`;
                for (const [kind, to] of [['free', free], ['full', full]]) {
                    const direction = from.way(own, ownEnd).angleTo(to.way(bone, end)) * kDegrees;
                    const twist = twistOff(from.turn(own), to.turn(bone), restWay.source, align) * kDegrees;
                    sum(`${kind}Direction`).add(direction, label);
                    sum(`${kind}Twist`).add(Math.min(twist, 360 - twist), label);
                    if (kind === 'full' && isFree) {
                        sum('untouchedDirection').add(direction, label);
                        sum('untouchedTwist').add(Math.min(twist, 360 - twist), label);
                    }
                }
                if (isFree) sum('returned').add(angleBetween(from.turn(own), back.turn(own)) * kDegrees, label);
            });
            const end = limb.to.at(-1);
            sum(limb.foot ? 'footMissed' : 'handMissed').add((100 * full.place(end).distanceTo(free.place(end))) / leg.target, `${end} ${seconds.toFixed(2)}`);
            if (limb.foot) {
                const foot = limb.from.at(-1);
                const now = { from: from.place(foot).divideScalar(leg.source), to: full.place(end).divideScalar(leg.target) };
                const height = now.from.y - source.rest.place(foot).y / leg.source;
                const flat = (a, b) => Math.hypot(a.x - b.x, a.z - b.z);
                const slide = limb.last && flat(now.from, limb.last.from);
                if (height < kLow && slide * kRate < kSlow) {
                    const label = `${end} ${seconds.toFixed(2)}`;
                    sum('sourceSlide').add(100 * slide, label);
                    sum('slide').add(100 * flat(now.to, limb.last.to), label);
                    sum('height').add(100 * Math.abs(now.to.y - target.rest.place(end).y / leg.target - height), label);
                }
                limb.last = now;
            }
            const { bend } = limb; // of a knee or elbow
            const now = { from: from.local(source.node(limb.from[1])), to: full.local(target.node(limb.to[1])) };
            if (bend.last) {
                bend.source = Math.max(bend.source, angleBetween(now.from, bend.last.from) * kDegrees);
                const step = angleBetween(now.to, bend.last.to) * kDegrees;
                if (step > bend.target) [bend.target, bend.at] = [step, seconds];
            }
            bend.last = now;
        }
    }
    const source_most = Math.max(1, ...limbs.map(({ bend }) => bend.source));
    for (const { to, bend } of limbs) sum('flip').add(bend.target / source_most, `${to[1]} ${bend.at?.toFixed(2)}`);
    return sums;
}

const rigs = new Map();
async function open(file, roles, stands) {
    const key = `${file} ${roles}`;
    if (!rigs.has(key)) rigs.set(key, await loadRig(file, roles, stands));
    return rigs.get(key);
}

for (const job of JSON.parse(fs.readFileSync(process.argv[2], 'utf8'))) {
    let line;
    try {
        const { from, to } = job.stands;
        const source = await open(job.source, job.roles, from);
        const own = job.roles === job.source ? source : await open(job.roles, job.roles, from);
        const load = (file, stands) => loadRig(file, file, stands);
        const [full, free, back] = [await load(job.full, to), await load(job.free, to), await load(job.back, from)];
        const frames = { source: play(source, job.clip), full: play(full, job.clip), free: play(free, job.clip), back: play(back, job.clip) };
        line = { seconds: frames.source.length / kRate, source_is_original: source !== own, ...judge(source, full, frames) };
    } catch (problem) {
        line = { failed: String(problem.stack ?? problem) };
    }
    console.log(JSON.stringify(line));
}
