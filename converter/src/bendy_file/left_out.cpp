#include "bendy_file/left_out.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/records.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

namespace bendy::converter {
namespace {

/// What the importer makes something of. A list of its own: a chunk that a later version knows is named as left out
/// until somebody reads it here.
constexpr std::array kRead{
    FourCC("HEAD"), FourCC("VERS"), FourCC("TEXT"), FourCC("SAMP"), FourCC("IMAG"), FourCC("LINK"), FourCC("SAME"),
    FourCC("MATE"), FourCC("SURF"), FourCC("EXTN"), FourCC("OBJE"), FourCC("NAME"), FourCC("EXTR"), FourCC("SKIN"),
    FourCC("PIVO"), FourCC("REST"), FourCC("LIMT"), FourCC("PULL"), FourCC("POLY"), FourCC("IKCH"), FourCC("KINF"),
    FourCC("VECT"), FourCC("VINF"), FourCC("PALT"), FourCC("TARG"), FourCC("TINF"), FourCC("POSI"), FourCC("NORM"),
    FourCC("TANG"), FourCC("TEXC"), FourCC("COLR"), FourCC("BONE"), FourCC("WGHT"), FourCC("USER"), FourCC("VALS"),
    FourCC("INDX"), FourCC("CYCL"), FourCC("CINF"), FourCC("TRAK"), FourCC("TIME"), FourCC("KEYV"), FourCC("PACK"),
    FourCC("LODD"), FourCC("BNDS"), FourCC("JNTS"), FourCC("JNAM"), FourCC("MARK"), FourCC("MORE"), FourCC("FRMS"),
    FourCC("FNAM"), FourCC("GRID"), FourCC("NLST"), FourCC("PLAY")};

/// Bytes that are read of a leaf which is one record; 0: of another kind.
std::uint64_t record_size(FourCC id) {
    constexpr std::array<std::pair<FourCC, std::uint64_t>, 11> kSizes{{{FourCC("VERS"), sizeof(VersionRecord)},
                                                                       {FourCC("SAMP"), sizeof(SamplerRecord)},
                                                                       {FourCC("SAME"), sizeof(SameRecord)},
                                                                       {FourCC("SURF"), sizeof(SurfaceRecord)},
                                                                       {FourCC("REST"), sizeof(RestRecord)},
                                                                       {FourCC("LIMT"), sizeof(LimitRecord)},
                                                                       {FourCC("PULL"), sizeof(PullRecord)},
                                                                       {FourCC("KINF"), sizeof(ChainRecord)},
                                                                       {FourCC("VINF"), sizeof(PoolRecord)},
                                                                       {FourCC("TINF"), sizeof(TargetRecord)},
                                                                       {FourCC("CINF"), sizeof(CycleRecord)}}};
    for (const auto& [known, size] : kSizes) {
        if (known == id) return size;
    }
    return 0;
}

struct LeftOut {
    std::uint32_t first = 0;  // chunk number
    std::uint64_t count = 0;
};

}  // namespace

void warn_of_left_out(const ChunkTree& tree, Report& report) {
    constexpr std::size_t kNamed = 50;  // ids; a hostile file may have a million
    std::map<std::uint32_t, LeftOut> unread;
    std::map<std::uint32_t, LeftOut> longer;
    for (std::uint32_t number = 0; number < tree.chunks().size();) {
        const Chunk& chunk = tree[number];
        const bool is_read = std::find(kRead.begin(), kRead.end(), chunk.id) != kRead.end();
        const std::uint64_t size = record_size(chunk.id);
        if (!is_read || (size != 0 && !chunk.is_container() && tree.payload(number).size() > size)) {
            const auto [place, is_new] = (is_read ? longer : unread).try_emplace(chunk.id.value, LeftOut{number, 0});
            ++place->second.count;
        }
        number = is_read ? number + 1 : chunk.end;
    }
    const auto name = [&](const std::map<std::uint32_t, LeftOut>& list, const std::string& what) {
        std::size_t named = 0;
        for (const auto& [id, found] : list) {
            if (named++ < kNamed) {
                const std::string path = chunk_path(tree.bytes(), tree[found.first].offset);
                report.warn(what + FourCC(id).letters().data(), path, found.count);
            } else {
                report.warn(what + "other kinds", {}, found.count);
            }
        }
    };
    name(unread, "chunk that is not read is left out: ");
    name(longer, "fields of a later version are left out: ");
}

}  // namespace bendy::converter
