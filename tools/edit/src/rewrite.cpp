#include "rewrite.h"

#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

namespace bendy::edit {
namespace {

Problem problem_of(const Error& fault, Bytes file) {
    return {describe_with_place(fault, file)};
}

std::optional<Buffer> encoded(Codec codec, Bytes payload, std::uint16_t head, std::uint16_t stride) {
    if (payload.size() <= head) return std::nullopt;
    auto bytes = encode_payload(codec, payload, head, stride);
    if (!bytes || bytes->size() >= payload.size()) return std::nullopt;
    AlignedBytes decoded(payload.size());
    const bool is_lossless = decode_payload(codec, *bytes, decoded.span()) &&
                             std::equal(payload.begin(), payload.end(), decoded.bytes().begin());
    return is_lossless ? bytes : std::nullopt;
}

void copy_all(const std::map<std::uint32_t, std::vector<Buffer>>& chunks, std::uint32_t number, ChunkWriter& out) {
    const auto found = chunks.find(number);
    if (found == chunks.end()) return;
    for (const Buffer& chunk : found->second) out.copy(chunk);
}

VersionRecord counted(VersionRecord version, const Document& document) {
    version.objects = static_cast<std::uint32_t>(document.objects.size());
    version.materials = static_cast<std::uint32_t>(document.materials.size());
    version.textures = static_cast<std::uint32_t>(document.textures.size());
    version.joints = version.meshes = version.clips = 0;
    version.vertices = 0;
    for (const ObjectView& object : document.objects) {
        version.joints += static_cast<std::uint32_t>(object.skeleton.joints.size());
        version.meshes += static_cast<std::uint32_t>(object.meshes.size());
        version.clips += static_cast<std::uint32_t>(object.clips.size());
        for (const MeshView& mesh : object.meshes) version.vertices += mesh.vertices;
    }
    return version;
}

Problem broken(const Error& fault, Bytes file) {
    return {"the result would not be valid: " + describe_with_place(fault, file)};
}

}  // namespace

Result<Source, Problem> open_source(Bytes file) {
    auto tree = read_chunk_tree(file);
    if (!tree) return problem_of(tree.error(), file);
    Source source;
    source.tree = *std::move(tree);
    Faults faults;
    check_sums(source.tree, faults);
    decode_leaves(source.tree);
    source.document = read_document(source.tree, faults);
    if (faults.empty()) check_values(source.tree, source.document, faults);
    if (faults.empty()) return source;
    Problem problem = problem_of(faults.list().front(), file);
    if (faults.count() > 1) problem.message += ", and " + std::to_string(faults.count() - 1) + " more faults";
    return problem;
}

Rewrite::Rewrite(const ChunkTree& tree) : tree_(tree), state_(tree.chunks().size()) {}

void Rewrite::touch(std::uint32_t number) {
    while (state_[number] == State::as_it_was) {
        state_[number] = State::touched;
        number = tree_[number].parent;
    }
}

void Rewrite::remove(std::uint32_t number) {
    assert(number != 0);
    touch(tree_[number].parent);
    state_[number] = State::removed;
}

void Rewrite::replace(std::uint32_t number, Bytes payload) {
    const Bytes before = tree_.payload(number);
    if (std::equal(before.begin(), before.end(), payload.begin(), payload.end())) return;
    const Chunk& chunk = tree_[number];
    CodecHeader header;
    if (chunk.codec() != 0) copy_at(tree_.stored(number), 0, header);
    replace_whole(number, encode_leaf(chunk.id, chunk.flags, static_cast<Codec>(chunk.codec()), header.head,
                                      header.stride, payload));
}

void Rewrite::overwrite(std::uint32_t number, std::size_t at, Bytes bytes) {
    const Bytes before = tree_.payload(number);
    Buffer payload(before.begin(), before.end());
    std::memcpy(payload.data() + at, bytes.data(), std::min(bytes.size(), payload.size() - at));
    replace(number, payload);
}

void Rewrite::replace_whole(std::uint32_t number, Buffer chunk) {
    touch(number);
    replaced_[number] = std::move(chunk);
}

void Rewrite::insert_after(std::uint32_t number, Buffer chunk) {
    touch(tree_[number].parent);
    after_[number].push_back(std::move(chunk));
}

void Rewrite::prepend(std::uint32_t container, Buffer chunk) {
    touch(container);
    prepended_[container].push_back(std::move(chunk));
}

void Rewrite::append(std::uint32_t container, Buffer chunk) {
    touch(container);
    appended_[container].push_back(std::move(chunk));
}

Buffer Rewrite::write(std::uint32_t root) const {
    const auto whole = [&](std::uint32_t number) {
        return tree_.bytes().subspan(tree_[number].offset, kChunkHeaderSize + padded(tree_[number].size));
    };
    assert(tree_[root].is_container() && state_[root] != State::removed);
    if (state_[root] == State::as_it_was) return {whole(root).begin(), whole(root).end()};
    ChunkWriter out;
    out.reserve(whole(root).size());
    std::vector<std::uint32_t> open;
    for (std::uint32_t number = root;;) {
        while (!open.empty() && number == tree_[open.back()].end) {
            const std::uint32_t container = open.back();
            copy_all(appended_, container, out);
            out.end();
            open.pop_back();
            if (!open.empty()) copy_all(after_, container, out);
        }
        if (open.empty() && number != root) break;
        const Chunk& chunk = tree_[number];
        const auto replaced = replaced_.find(number);
        if (state_[number] == State::touched && replaced == replaced_.end()) {
            open.push_back(number);
            out.begin(chunk.id, static_cast<std::uint16_t>(chunk.flags & ~kContainerFlag));
            copy_all(prepended_, number, out);
            ++number;
            continue;
        }
        if (state_[number] == State::as_it_was) out.copy(whole(number));
        if (state_[number] == State::touched) out.copy(replaced->second);
        copy_all(after_, number, out);
        number = chunk.end;
    }
    return std::move(out).finish();
}

Buffer whole_leaf(FourCC id, Bytes payload, std::uint16_t flags) {
    ChunkWriter out;
    out.leaf(id, payload, flags);
    return std::move(out).finish();
}

Buffer encode_leaf(FourCC id, std::uint16_t flags, Codec codec, std::uint16_t head, std::uint16_t stride,
                   Bytes payload) {
    const auto plain = static_cast<std::uint16_t>(flags & ~kCodecMask);
    const auto with = [&](Codec used, const Buffer& bytes) {
        return whole_leaf(id, bytes, static_cast<std::uint16_t>(plain | static_cast<unsigned>(used) << 8));
    };
    if (codec == Codec::raw) return whole_leaf(id, payload, plain);
    if (const auto bytes = encoded(codec, payload, head, stride)) return with(codec, *bytes);
    if (const auto bytes = encoded(Codec::zstd, payload, 0, 0)) return with(Codec::zstd, *bytes);
    return whole_leaf(id, payload, plain);
}

void put_leaf(const ChunkTree& tree, std::uint32_t container, FourCC id, Bytes payload, Rewrite& rewrite) {
    const std::uint32_t chunk = tree.find(container, id);
    if (payload.empty()) {
        if (chunk != kNone) rewrite.remove(chunk);
    } else if (chunk != kNone) {
        rewrite.replace(chunk, payload);
    } else {
        rewrite.append(container, encode_leaf(id, 0, Codec::zstd, 0, sizeof(float), payload));
    }
}

Edited finish(const Rewrite& rewrite) {
    Buffer file = rewrite.write();
    auto tree = read_chunk_tree(file);
    if (!tree) return broken(tree.error(), file);
    decode_leaves(*tree);
    Faults faults;
    const Document document = read_document(*tree, faults);
    if (!faults.empty()) return broken(faults.list().front(), file);
    const VersionRecord version = counted(*document.version, document);
    if (std::memcmp(&version, &*document.version, sizeof version) != 0) {
        Rewrite renewed(*tree);
        renewed.overwrite(tree->find(0, FourCC("VERS")), 0, bytes_of(version));
        file = renewed.write();
    }
    if (const Faults found = validate(file); !found.empty()) return broken(found.list().front(), file);
    return file;
}

}  // namespace bendy::edit
