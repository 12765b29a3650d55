#include <bendy/converter/compact_report.h>
#include <bendy/format/chunk_reader.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace bendy::converter {
namespace {

struct KindOfChunk {
    FourCC id;
    std::string_view kind;
};
/// A chunk is of the first of these that it or one of its containers is, nearest first.
constexpr std::array kKinds{KindOfChunk{FourCC("SKIN"), "skeleton"}, KindOfChunk{FourCC("JNTS"), "skeleton"},
                            KindOfChunk{FourCC("JNAM"), "skeleton"}, KindOfChunk{FourCC("IKCH"), "skeleton"},
                            KindOfChunk{FourCC("PALT"), "PALT"},     KindOfChunk{FourCC("POSI"), "POSI"},
                            KindOfChunk{FourCC("NORM"), "NORM"},     KindOfChunk{FourCC("TANG"), "TANG"},
                            KindOfChunk{FourCC("TEXC"), "TEXC"},     KindOfChunk{FourCC("COLR"), "COLR"},
                            KindOfChunk{FourCC("BONE"), "BONE"},     KindOfChunk{FourCC("WGHT"), "WGHT"},
                            KindOfChunk{FourCC("INDX"), "indices"},  KindOfChunk{FourCC("TARG"), "targets"},
                            KindOfChunk{FourCC("FRMS"), "frames"},   KindOfChunk{FourCC("NLST"), "NORM"},
                            KindOfChunk{FourCC("CYCL"), "cycles"},   KindOfChunk{FourCC("TEXT"), "textures"},
                            KindOfChunk{FourCC("HEAD"), "other"}};

}  // namespace

std::vector<ByteCount> count_bytes(Bytes file) {
    std::vector<ByteCount> counts;
    std::array<std::size_t, kKinds.size()> place{};
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
        const auto known = std::find_if(counts.begin(), counts.end(),
                                        [&](const ByteCount& count) { return count.kind == kKinds[k].kind; });
        place[k] = static_cast<std::size_t>(known - counts.begin());
        if (known == counts.end()) counts.push_back({std::string(kKinds[k].kind), 0});
    }
    const auto tree = read_chunk_tree(file);
    if (!tree) return counts;
    std::vector<std::size_t> kind_of(tree->chunks().size(), counts.size() - 1);
    for (std::uint32_t number = 0; number < kind_of.size(); ++number) {
        const Chunk& chunk = (*tree)[number];
        const auto known =
            std::find_if(kKinds.begin(), kKinds.end(), [&](const KindOfChunk& k) { return k.id == chunk.id; });
        const std::string_view above = number == 0 ? std::string_view() : counts[kind_of[chunk.parent]].kind;
        const bool in_target = above == "targets" || above == "frames";
        if (known != kKinds.end() && !in_target) {
            kind_of[number] = place[static_cast<std::size_t>(known - kKinds.begin())];
        } else if (number != 0) {
            kind_of[number] = kind_of[chunk.parent];
        }
        counts[kind_of[number]].bytes += kChunkHeaderSize + (chunk.is_container() ? 0 : padded(chunk.size));
    }
    return counts;
}

}  // namespace bendy::converter
