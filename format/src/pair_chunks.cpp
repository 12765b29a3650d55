#include <bendy/format/pair_chunks.h>

#include <bendy/format/records.h>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <tuple>

namespace bendy {
namespace {

/// Returns the key that identifies a chunk among its siblings of the same id; empty: none.
std::string_view key_of(const ChunkTree& tree, std::uint32_t number) {
    const Chunk& chunk = tree[number];
    if (chunk.is_container()) {
        const std::uint32_t name = tree.find(number, FourCC("NAME"));
        return name == kNone || tree[name].is_container() ? std::string_view() : as_text(tree.payload(name));
    }
    const auto field = [&](std::size_t offset, std::size_t size) {
        const Bytes payload = tree.payload(number);
        return payload.size() < offset + size ? std::string_view() : as_text(payload.subspan(offset, size));
    };
    if (chunk.id == FourCC("TEXC") || chunk.id == FourCC("COLR")) return field(offsetof(StreamRecord, set), 4);
    if (chunk.id == FourCC("LIMT")) return field(offsetof(ConstraintRecord, scope), 1);
    if (chunk.id == FourCC("PULL")) return field(offsetof(ChainWeightRecord, chain), 4);
    return {};
}

struct Sibling {
    std::uint32_t number = 0;
    std::uint32_t id = 0;
    std::string_view key;
    std::uint32_t sum = 0;
    std::uint64_t size = 0;
    std::uint32_t partner = kNone;

    [[nodiscard]] auto by_key() const { return std::tie(id, key); }
    [[nodiscard]] auto by_sum() const { return std::tie(id, sum, size); }
    [[nodiscard]] auto by_id() const { return std::tie(id); }
};

std::vector<Sibling> siblings_of(const ChunkTree& tree, std::uint32_t container) {
    std::vector<Sibling> siblings;
    for (const std::uint32_t number : tree.children(container)) {
        const Chunk& chunk = tree[number];
        siblings.push_back({number, chunk.id.value, key_of(tree, number), chunk.sum, chunk.size, kNone});
    }
    return siblings;
}

std::vector<Sibling*> unpaired(std::vector<Sibling>& siblings) {
    std::vector<Sibling*> list;
    for (Sibling& sibling : siblings) {
        if (sibling.partner == kNone) list.push_back(&sibling);
    }
    return list;
}

/// Pairs the unpaired siblings that have the same key, `key(sibling)`; those with equal keys in order, or, with `only`,
/// none of them.
template <class Key>
void pair_by(const Key& key, bool only, std::vector<Sibling>& a, std::vector<Sibling>& b) {
    std::vector<Sibling*> list_a = unpaired(a);
    std::vector<Sibling*> list_b = unpaired(b);
    const auto less = [&](const Sibling* x, const Sibling* y) { return key(*x) < key(*y); };
    std::stable_sort(list_a.begin(), list_a.end(), less);
    std::stable_sort(list_b.begin(), list_b.end(), less);
    auto there = list_b.begin();
    for (auto here = list_a.begin(); here != list_a.end();) {
        const auto here_end = std::upper_bound(here, list_a.end(), *here, less);
        there = std::lower_bound(there, list_b.end(), *here, less);
        const auto there_end = std::upper_bound(there, list_b.end(), *here, less);
        const bool are_only = here_end - here == 1 && there_end - there == 1;
        if (!only || (are_only && !(*here)->key.empty())) {
            for (; here != here_end && there != there_end; ++here, ++there) {
                (*here)->partner = (*there)->number;
                (*there)->partner = (*here)->number;
            }
        }
        here = here_end;
        there = there_end;
    }
}

}  // namespace

bool have_equal_sums(const ChunkTree& a, std::uint32_t a_chunk, const ChunkTree& b, std::uint32_t b_chunk) {
    const Chunk& one = a[a_chunk];
    const Chunk& other = b[b_chunk];
    return one.id == other.id && one.sum == other.sum && one.size == other.size && one.flags == other.flags;
}

std::vector<ChunkPair> pair_children(const ChunkTree& a, std::uint32_t a_container, const ChunkTree& b,
                                     std::uint32_t b_container) {
    std::vector<Sibling> here = siblings_of(a, a_container);
    std::vector<Sibling> there = siblings_of(b, b_container);
    pair_by([](const Sibling& s) { return s.by_key(); }, true, here, there);
    pair_by([](const Sibling& s) { return s.by_sum(); }, false, here, there);
    pair_by([](const Sibling& s) { return s.by_id(); }, false, here, there);
    std::vector<ChunkPair> pairs;
    pairs.reserve(here.size());
    for (const Sibling& sibling : here) pairs.push_back({sibling.number, sibling.partner});
    for (const Sibling& sibling : there) {
        if (sibling.partner == kNone) pairs.push_back({kNone, sibling.number});
    }
    return pairs;
}

}  // namespace bendy
