#include "rewrite.h"

#include "encode_like.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace bendy::edit {
namespace {

void copy_all(const std::map<std::uint32_t, std::vector<Buffer>>& chunks, std::uint32_t number, ChunkWriter& out) {
    const auto found = chunks.find(number);
    if (found == chunks.end()) return;
    for (const Buffer& chunk : found->second) out.copy(chunk);
}

}  // namespace

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
    replace_whole(number, encode_like(tree_, number, payload));
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

}  // namespace bendy::edit
