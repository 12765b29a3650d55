// Rules of VERS, BNDS, textures and materials.

import { all_finite, all_zero, is_utf8, kNone } from './numbers.mjs';

const kSignature = [0x42, 0x45, 0x4e, 0x44, 0x59, 0x0d, 0x0a, 0x1a];

/** What VERS says of itself; its counts come last. */
export function check_version(file) {
    const chunk = file.child(file.head, 'VERS');
    const record = file.record(chunk, 'VersionRecord', 48, 80);
    if (!record) return;
    if (!kSignature.every((byte, k) => record.signature[k] === byte)) file.add('SIGNATURE', chunk);
    if (record.major !== 0) file.add('UNSUPPORTED_VERSION', chunk);
    if (record.reserved !== 0) file.add('RESERVED_FIELD', chunk);
    const generator = file.payload(chunk).subarray(48, 80);
    const text = generator.subarray(0, generator.includes(0) ? generator.indexOf(0) : generator.length);
    if (!is_utf8(text)) file.add('NOT_UTF8', chunk);
    if (!all_zero(generator.subarray(text.length))) file.add('RESERVED_FIELD', chunk);
}

/** The counts of VERS, against what the other checks have counted. */
export function check_counts(file) {
    const chunk = file.child(file.head, 'VERS');
    const record = file.peek(chunk, 'VersionRecord', 48, 80);
    if (!record) return;
    for (const [field, count] of Object.entries(file.counts))
        if (record[field] !== count) file.add('COUNT_MISMATCH', chunk);
}

export function check_bound(file) {
    const chunk = file.child(file.head, 'BNDS');
    const record = file.record(chunk, 'BoundRecord', 12);
    if (record && !all_finite([record.maxError, record.measuredError, record.height])) file.add('NOT_FINITE', chunk);
}

const is_image = (chunk) => chunk.meant && ['IMAG', 'LINK', 'SAME'].includes(chunk.id);

export function check_textures(file) {
    const textures = file.children(file.head, 'TEXT');
    file.counts.textures = textures.length;
    for (const texture of textures) {
        const chunk = file.child(texture, 'SAMP');
        const record = file.record(chunk, 'SamplerRecord', 4);
        if (record && (record.magFilter > 2 || record.minFilter > 6 || record.wrapS > 2 || record.wrapT > 2))
            file.add('ENUM_RANGE', chunk);
        for (const image of file.children(texture, 'IMAG')) {
            const what = file.record(image, 'ImageRecord', 16);
            if (!what) continue;
            if (what.media > 5) file.add('ENUM_RANGE', image);
            if (!all_zero(what.reserved)) file.add('RESERVED_FIELD', image);
        }
        for (const link of file.children(texture, 'LINK')) {
            const uri = file.payload(link);
            if (uri && is_utf8(uri) && /\p{Control}/u.test(new TextDecoder().decode(uri))) file.add('LINK_CONTROL', link);
        }
        for (const same of file.children(texture, 'SAME')) {
            const what = file.record(same, 'SameRecord', 8);
            if (!what) continue;
            if (what.texture >= textures.length) {
                file.add('TEXTURE_RANGE', same);
                continue;
            }
            const meant = textures[what.texture].children.filter(is_image)[what.image];
            if (!meant || meant.id === 'SAME') file.add('INDEX_RANGE', same);
        }
    }
}

export function check_material(file, material) {
    file.counts.materials += 1;
    const chunk = file.child(material, 'SURF');
    const record = file.record(chunk, 'SurfaceRecord', 224);
    if (!record) return;
    const uses = ['baseColour', 'metallicRoughness', 'normal', 'occlusion', 'emissive'].map((use) => record[use + 'Texture']);
    if (record.alphaMode > 2 || record.doubleSided > 1 || record.unlit > 1) file.add('ENUM_RANGE', chunk);
    const numbers = [...record.baseColour, ...record.emissive, record.metallic, record.roughness, record.normalScale,
        record.occlusionStrength, record.alphaCutoff, ...uses.flatMap((use) => [...use.offset, ...use.scale, use.rotation])];
    if (!all_finite(numbers)) file.add('NOT_FINITE', chunk);
    if (!all_zero(record.reserved) || uses.some((use) => use.reserved !== 0)) file.add('RESERVED_FIELD', chunk);
    for (const use of uses)
        if (use.texture !== kNone && use.texture >= file.counts.textures) file.add('TEXTURE_RANGE', chunk);
}

/** NAME, EXTR, EXTN, MORE and LINK, wherever they stand. */
export function check_texts(file) {
    for (const chunk of file.chunks) {
        if (!chunk.meant || !['NAME', 'EXTR', 'EXTN', 'MORE', 'LINK'].includes(chunk.id)) continue;
        const payload = file.payload(chunk);
        if (payload && !is_utf8(payload)) file.add('NOT_UTF8', chunk);
    }
}
