#include "format/edit_file.h"
#include "mutators.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace {

using namespace bendy;
using fuzz::below;
using fuzz::Random;
using test::Buffer;
using test::Node;

constexpr std::array<std::uint64_t, 20> kAwkward{0,
                                                 1,
                                                 2,
                                                 3,
                                                 4,
                                                 15,
                                                 16,
                                                 17,
                                                 0x7f,
                                                 0x80,
                                                 0xff,
                                                 0xffff,
                                                 0x1'0000,
                                                 0x7fff'ffff,
                                                 0x8000'0000,
                                                 0xffff'ffff,
                                                 0x7f80'0000 /* infinity */,
                                                 0x7fc0'0000 /* NaN */,
                                                 0x3f80'0000 /* 1 */,
                                                 0x8000'0000'0000'0000};

void list(Node& node, std::vector<Node*>& all) {
    all.push_back(&node);
    for (Node& child : node.children) list(child, all);
}

std::vector<Node*> all_of(Node& root) {
    std::vector<Node*> all;
    list(root, all);
    return all;
}

void mutate_payload(Buffer& payload, std::size_t room, Random& random) {
    const std::size_t most = payload.size() + std::min<std::size_t>(room, random() % 4 == 0 ? 64 : 0);
    if (most == 0) return;
    const std::size_t before = payload.size();
    payload.resize(most);
    payload.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(payload.data()), before, most));
}

/// A number on its own boundary, near the start more often than not: that is where records are.
void set_number(Buffer& payload, Random& random) {
    const std::size_t width = std::size_t{1} << below(random, 4);
    if (payload.size() < width) return;
    const std::size_t places = payload.size() / width;
    const std::size_t at =
        below(random, random() % 4 == 0 ? places : std::min<std::size_t>(places, 128 / width)) * width;
    std::uint64_t number = 0;
    std::memcpy(&number, payload.data() + at, width);
    switch (random() % 4) {
        case 0:
            ++number;
            break;
        case 1:
            --number;
            break;
        default:
            number = kAwkward[below(random, kAwkward.size())];
    }
    std::memcpy(payload.data() + at, &number, width);
}

void change(Node& root, std::size_t room, Random& random) {
    const auto nodes = all_of(root);
    Node& node = *nodes[below(random, nodes.size())];
    if (!node.is_container()) {
        if (random() % 32 == 0) node.flags ^= static_cast<std::uint16_t>(1u << (8 + random() % 3));  // another codec
        if (random() % 2 == 0) return mutate_payload(node.payload, room, random);
        return set_number(node.payload, random);
    }
    auto& children = node.children;
    if (children.empty()) return;
    const std::size_t at = below(random, children.size());
    const std::size_t to = below(random, children.size());
    switch (random() % 5) {
        case 0:
            children.erase(children.begin() + static_cast<std::ptrdiff_t>(at));
            break;
        case 1:
            children.insert(children.begin() + static_cast<std::ptrdiff_t>(to), Node(children[at]));
            break;
        case 2:
            std::swap(children[at], children[to]);
            break;
        case 3: {  // somewhere else in the tree
            Node moved = children[at];
            Node& parent = *nodes[below(random, nodes.size())];
            if (parent.is_container()) parent.children.push_back(std::move(moved));
            break;
        }
        default:
            children[at].id = nodes[below(random, nodes.size())]->id;
    }
}

std::size_t put(const Buffer& file, std::span<std::uint8_t> out) {
    if (file.size() > out.size()) return 0;
    std::memcpy(out.data(), file.data(), file.size());
    return file.size();
}

Buffer aligned(const std::uint8_t* data, std::size_t size) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    return {bytes, bytes + size};
}

}  // namespace

namespace bendy::fuzz {

std::size_t mutate_bendy(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed) {
    Random random(seed);
    const Buffer before = aligned(data, size);
    if (random() % 8 != 0 && read_chunk_tree(before)) {
        Node root = test::to_node(before);
        for (auto changes = 1 + random() % 3; changes > 0; --changes)
            change(root, max_size - std::min(max_size, size), random);
        if (const std::size_t made = put(test::to_file(root), {data, max_size}); made != 0) return made;
    }
    size = LLVMFuzzerMutate(data, size, max_size);
    Buffer file = aligned(data, size);
    if (random() % 8 != 0 && test::resum(file)) return put(file, {data, max_size});
    return size;
}

std::size_t cross_bendy(const std::uint8_t* a, std::size_t a_size, const std::uint8_t* b, std::size_t b_size,
                        std::uint8_t* out, std::size_t max_size, unsigned seed) {
    Random random(seed);
    const Buffer first = aligned(a, a_size);
    const Buffer second = aligned(b, b_size);
    if (!read_chunk_tree(first) || !read_chunk_tree(second)) return 0;
    Node to = test::to_node(first);
    Node from = test::to_node(second);
    const auto sources = all_of(from);
    const Node& source = *sources[below(random, sources.size())];
    auto places = all_of(to);
    std::erase_if(places, [&](const Node* node) { return node->id != source.id; });
    if (places.empty()) return 0;
    *places[below(random, places.size())] = source;
    return put(test::to_file(to), {out, max_size});
}

}  // namespace bendy::fuzz
