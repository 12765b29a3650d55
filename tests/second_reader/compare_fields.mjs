// What `bendy inspect --json` says of a file, held against what the grammar reads.


const camel = (name) => name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());

/** JSON has no NaN and no infinities: it says null. */
function same_number(said, number) {
    return said === null ? !Number.isFinite(number) : said === number;
}

function same_value(said, value, name) {
    if (name === 'generator') return said === (value ?? '').split('\0')[0];
    if (Array.isArray(said)) return said.length === value.length && said.every((one, k) => same_value(one, value[k]));
    if (said !== null && typeof said === 'object') return same_fields(said, value).length === 0;
    return same_number(said, value);
}

/** Names of the fields that differ. */
function same_fields(said, record) {
    return Object.keys(said).filter((name) => record[camel(name)] === undefined || !same_value(said[name], record[camel(name)], name));
}

/** What differs in a leaf. */
function compare_leaf(said, body) {
    if ('text' in said) return said.text === body.value ? [] : ['text'];
    if ('tracks' in said) {
        if (said.tracks.length !== body.tracks.length) return ['number of tracks'];
        return said.tracks.flatMap((track, k) => same_fields(track, body.tracks[k]));
    }
    if ('markers' in said) {
        if (said.markers.length !== body.markers.length) return ['number of markers'];
        return said.markers.flatMap(({ seconds, name }, k) =>
            same_number(seconds, body.markers[k].seconds) && name === body.names[k].value ? [] : [`marker ${k}`]);
    }
    return same_fields(said, { ...body, ...body.record });
}

/** Lines about what differs between inspect's report of a conforming file and our reading. `count` counts fields. */
export function compare_fields(report, file, chunks, count) {
    const lines = [];
    if (report.chunks.length !== chunks.length) return [`${report.chunks.length} chunks, not ${chunks.length}`];
    report.chunks.forEach((said, k) => {
        const chunk = chunks[k];
        const parent = chunk.parent ? chunks.indexOf(chunk.parent) : null;
        const header = { id: chunk.id, offset: chunk.offset, size: chunk.size, container: chunk.is_container, parent };
        for (const [name, value] of Object.entries(header))
            if (said[name] !== value) lines.push(`${chunk.id} at ${chunk.offset}: ${name} is ${said[name]}, not ${value}`);
        if (Number(said.sum) !== chunk.sum) lines.push(`${chunk.id} at ${chunk.offset}: sum`);
        if ((said.codec ?? 0) !== chunk.codec) lines.push(`${chunk.id} at ${chunk.offset}: codec`);
        if (!said.fields || !chunk.meant) return;
        if (said.decoded !== undefined && said.decoded !== file.payload(chunk).length)
            lines.push(`${chunk.id} at ${chunk.offset}: ${said.decoded} bytes decoded`);
        count.fields += Object.keys(said.fields).length;
        for (const name of compare_leaf(said.fields, file.body(chunk))) lines.push(`${chunk.id} at ${chunk.offset}: ${name}`);
    });
    return lines;
}

/** The grammar's own reading of the whole file has the same chunks. */
export function compare_grammar(read, bytes, chunks) {
    let at = 0;
    const visit = (chunk) => {
        const ours = chunks[at++];
        if (!ours || ours.id !== chunk.header.id || ours.size !== chunk.header.size) throw new Error('another chunk');
        if (chunk.padding.some((byte) => byte !== 0)) throw new Error('padding');
        if (ours.meant && !ours.is_container && ours.codec === 0 && !chunk.payload.body) throw new Error('no payload');
        for (const child of chunk.chunks?.list ?? []) visit(child);
    };
    visit(read.file(bytes).head);
    if (at !== chunks.length) throw new Error('more chunks');
}
