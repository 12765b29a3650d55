// What `bendy dump --decode` says of a file, every number of it, held against what the grammar reads.

import { kTexts } from './tree_rules.mjs';

const snake = (name) => name.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`);
const plain = (value) => (value instanceof Uint8Array ? Array.from(value) : value);

/** A record's fields by the names of the specification. */
function fields_of(record) {
    const fields = {};
    for (const [name, value] of Object.entries(record)) {
        if (name.startsWith('_') || name.startsWith('reserved') || value === undefined) continue;
        const is_record = typeof value === 'object' && !Array.isArray(value) && !(value instanceof Uint8Array);
        fields[snake(name)] = is_record ? fields_of(value) : plain(value);
    }
    return fields;
}

function bits_to_bytes(bits) {
    const bytes = new Array(Math.ceil(bits.length / 8)).fill(0);
    bits.forEach((bit, k) => (bytes[k >> 3] |= Number(bit) << (k & 7)));
    return bytes;
}

/** The numbers of a segment's frames as they lie, those without bits left out. */
function numbers_of(segment, tracks) {
    const widths = [];
    segment.lists.forEach(({ widths: all }, k) => {
        const count = tracks[2 * k + 1];
        const each = count === 0 ? 0 : all.length / count;
        for (let t = 0; t < count; t += 8)
            for (let n = 0; n < each; ++n)
                for (let i = t; i < Math.min(t + 8, count); ++i) widths.push(all[n * count + i].bits);
    });
    return segment.frames.flatMap((bytes) => {
        let at = 0;
        return widths.filter((width) => width > 0).map((width) => {
            let number = 0;
            for (let bit = 0; bit < width; ++bit, ++at) number |= ((bytes[at >> 3] >> (at & 7)) & 1) << bit;
            return number;
        });
    });
}

function packed(body) {
    const out = fields_of(body.record);
    const tracks = body.masks.map((mask) => mask.tracks);
    const put = (name, list) => list.length > 0 && (out[name] = list);
    body.masks.forEach((mask, list) => {
        const bits = mask.bytes.flatMap(({ bits: byte }) => Array.from({ length: 8 }, (_, k) => (byte >> k) & 1));
        put(`joints_${list}`, bits.flatMap((bit, joint) => (bit ? [joint] : [])));
        put(`steps_${list}`, body.steps[list].bytes);
        if (list % 2 === 0) put(`bases_${list}`, body.constantBases[list / 2].bases);
    });
    put('times', body.times ?? []);
    put('starts', body.starts ?? []);
    body.segments.forEach((segment, s) => {
        segment.lists.forEach((list, k) => {
            put(`widths_${s}_${2 * k + 1}`, list.widths.map((width) => width.bits));
            put(`bases_${s}_${2 * k + 1}`, list.bases.bases);
        });
        put(`frames_${s}`, numbers_of(segment, tracks));
    });
    return out;
}

function collapse(body, chunk) {
    const out = { ...fields_of(body.record), collapses: body.meshes.map(fields_of) };
    out.table = body.levels.flatMap((level) => [level.error, ...level.alive]);
    chunk.collapses.forEach(({ targets, joined }, k) => {
        out[`targets_${k}`] = targets;
        out[`joined_${k}`] = bits_to_bytes(joined);
    });
    return out;
}

/** What a later version has put behind the fields that are known. */
function more_of(body) {
    const bytes = body._io.isEof() ? [] : body._io.readBytesFull();
    return bytes.length > 0 ? { more: Buffer.from(bytes).toString('hex') } : {};
}

const is_object = (value) => typeof value === 'object' && !(value instanceof Uint8Array);

/** The parts of a leaf by their names, its record's fields among them. */
function parts_of(body) {
    const out = {};
    for (const [name, value] of Object.entries(body)) {
        if (name.startsWith('_') || name.endsWith('Zeros') || value === undefined) continue;
        if (name === 'record') Object.assign(out, fields_of(value));
        else if (value instanceof Uint8Array) out[name] = Buffer.from(value).toString('hex');
        else out[snake(name)] = Array.isArray(value) && value.some(is_object) ? value.map(fields_of) : value;
    }
    return out;
}

/** All that a leaf holds, in the form of the text form. */
function text_form_of(chunk, body) {
    if (kTexts.has(chunk.id)) return body.value;
    switch (chunk.id) {
        case 'LODD': return collapse(body, chunk);
        case 'PACK': return packed(body);
        case 'MARK': return { markers: body.markers.map(({ seconds }, k) => ({ seconds, name: body.names[k].value })) };
        default:
    }
    return body.constructor.name.endsWith('Record') ? { ...fields_of(body), ...more_of(body) } : parts_of(body);
}

const kInfinite = { inf: Infinity, '-inf': -Infinity };

/** True if the text form's value is ours. It writes floats in the fewest digits that give the f32 back. */
function is_same(said, ours, name, count) {
    if (typeof ours === 'number') {
        count.numbers += 1;
        if (typeof said === 'string') return said.startsWith('nan') || said.startsWith('-nan') ? Number.isNaN(ours) : kInfinite[said] === ours;
        return Object.is(said, ours) || Object.is(Math.fround(said), ours);
    }
    if (name === 'generator') return said === ours.split('\0')[0];
    if (typeof ours === 'string') return (Array.isArray(said) ? said.join('') : said) === ours;
    if (Array.isArray(ours)) return Array.isArray(said) && said.length === ours.length && ours.every((one, k) => is_same(said[k], one, name, count));
    return different(said, ours, count).length === 0;
}

/** Names of what differs; a list that is empty may be left out. */
function different(said, ours, count) {
    const names = new Set([...Object.keys(said), ...Object.keys(ours)]);
    return [...names].filter((name) => {
        if (ours[name] === undefined) return said[name].length !== 0;
        if (said[name] === undefined) return ours[name].length !== 0;
        return !is_same(said[name], ours[name], name, count);
    });
}

/** Lines about what differs between the text form of a conforming file and our reading. `count.numbers` counts numbers. */
export function compare_text_form(text_form, file, chunks, count) {
    const lines = [];
    const visit = (said, chunk) => {
        const where = `${chunk.id} at ${chunk.offset}`;
        const value = said[chunk.id];
        if (value === undefined) lines.push(`${where} is ${Object.keys(said)[0]} in the text_form`);
        else if (chunk.is_container) {
            if (value.length !== chunk.children.length) lines.push(`${where}: ${value.length} chunks in the text_form`);
            else chunk.children.forEach((child, k) => visit(value[k], child));
        } else if (chunk.meant) {
            const ours = text_form_of(chunk, file.body(chunk));
            if (typeof ours === 'string' && value !== ours) lines.push(`${where}: the text`);
            if (typeof ours === 'object') for (const name of different(value, ours, count)) lines.push(`${where}: ${name}`);
        }
    };
    visit(text_form, chunks[0]);
    return lines;
}
