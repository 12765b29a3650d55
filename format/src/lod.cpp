#include <bendy/format/lod.h>

#include <bendy/format/read_record.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace bendy {
namespace {

/// Cuts a payload into its arrays; `at` stays within it.
class Cutter {
public:
    explicit Cutter(Bytes payload, std::uint64_t at) : payload_(payload), at_(at) {}

    [[nodiscard]] std::uint64_t left() const { return payload_.size() - at_; }
    /// The next `size` bytes, which must be there; and moves on to the 16-byte boundary after them.
    Bytes take(std::uint64_t size) {
        const Bytes taken = payload_.subspan(at_, size);
        const std::uint64_t next = std::min<std::uint64_t>(padded(at_ + size), payload_.size());
        for (std::uint64_t gap = at_ + size; gap < next; ++gap) gaps_ = gaps_ | payload_[gap];
        at_ = next;
        return taken;
    }
    /// All bytes between the arrays, or-ed.
    [[nodiscard]] std::uint64_t gaps() const { return std::to_integer<std::uint64_t>(gaps_); }

private:
    Bytes payload_;
    std::uint64_t at_;
    std::byte gaps_{0};
};

class CollapseReader {
public:
    CollapseReader(const ChunkTree& tree, std::uint32_t chunk, std::span<const PoolView> pools, Faults& faults)
        : payload_(tree.payload(chunk)), offset_(tree[chunk].offset), pools_(pools), faults_(faults) {
        view_.chunk = chunk;
    }

    std::optional<CollapseView> read(const CollapseRecord& record) {
        check_reserved(record.reserved, offset_, faults_);
        Cutter cutter(payload_, sizeof(CollapseRecord));
        if (record.pools > cutter.left() / sizeof(PoolCollapseRecord)) {
            return fault({ErrorCode::kRecordSize, offset_, payload_.size(),
                          sizeof(CollapseRecord) + std::uint64_t{record.pools} * sizeof(PoolCollapseRecord)});
        }
        const auto table =
            view_at<PoolCollapseRecord>(cutter.take(record.pools * sizeof(PoolCollapseRecord)), 0, record.pools);
        const std::uint64_t row = (std::uint64_t{1} + record.pools) * sizeof(std::uint32_t);
        if (record.levels > cutter.left() / row) {
            return fault({ErrorCode::kRecordSize, offset_, payload_.size(), payload_.size() - cutter.left() + row});
        }
        view_.levels = record.levels;
        view_.rows = cutter.take(record.levels * row);
        for (const PoolCollapseRecord& pool : table) check_reserved(pool.reserved, offset_, faults_);
        const bool sizes_are_known =
            std::all_of(pools_.begin(), pools_.end(), [](const PoolView& pool) { return pool.has_info; });
        if (!sizes_are_known) return std::nullopt;  // a fault has said so
        view_.pools.reserve(record.pools);
        for (const PoolCollapseRecord& pool : table) {
            if (!read_pool(pool)) return std::nullopt;
        }
        if (!read_targets(cutter)) return std::nullopt;
        if (!check_levels()) return std::nullopt;
        return std::move(view_);
    }

private:
    std::nullopt_t fault(const Error& error) {
        faults_.add(error);
        return std::nullopt;
    }

    bool read_pool(const PoolCollapseRecord& record) {
        if (record.pool >= pools_.size()) {
            faults_.add({ErrorCode::kPoolRange, offset_, record.pool, pools_.size()});
            return false;
        }
        if (!view_.pools.empty() && record.pool <= view_.pools.back().pool) {
            faults_.add({ErrorCode::kCollapsePool, offset_, record.pool, view_.pools.back().pool});
            return false;
        }
        const std::uint32_t vertices = pools_[record.pool].vertices;
        if (record.base > vertices) {
            faults_.add({ErrorCode::kIndexRange, offset_, record.base, vertices});
            return false;
        }
        const auto type = static_cast<ComponentType>(record.target_type);
        if (type != ComponentType::u16 && type != ComponentType::u32) {
            faults_.add({ErrorCode::kStreamType, offset_});
            return false;
        }
        view_.pools.push_back({record.pool, record.base, vertices, type, {}, {}});
        return true;
    }

    bool read_targets(Cutter& cutter) {
        std::uint64_t needed = 0;  // fewer than 2^32 pools, all different, of 2^32 vertices of 5 bytes: no overflow
        for (const PoolCollapseView& pool : view_.pools) {
            const std::uint64_t count = pool.vertices - pool.base;
            needed += collapse_targets_size(count, pool.type) + collapse_bits_size(count);
        }
        if (needed != cutter.left()) {
            faults_.add({ErrorCode::kRecordSize, offset_, payload_.size(), payload_.size() - cutter.left() + needed});
            return false;
        }
        for (PoolCollapseView& pool : view_.pools) {
            const std::uint64_t count = pool.vertices - pool.base;
            pool.targets = cutter.take(count * component_size(pool.type));
            pool.joined = cutter.take((count + 7) / 8);
            if (!check_pool(pool)) return false;
        }
        if (cutter.gaps() != 0) {
            faults_.add({ErrorCode::kReservedField, offset_, cutter.gaps()});
            return false;
        }
        return true;
    }

    bool check_pool(const PoolCollapseView& pool) {
        for (std::uint32_t vertex = pool.base; vertex < pool.vertices; ++vertex) {
            if (pool.target(vertex) < vertex) continue;
            faults_.add({ErrorCode::kCollapseTarget, offset_, vertex, pool.target(vertex)});
            return false;
        }
        const std::uint32_t count = pool.vertices - pool.base;
        const bool first_is_joined = count != 0 && pool.is_joined(pool.base);
        const auto spare = count % 8 == 0 ? 0u : std::to_integer<unsigned>(pool.joined.back()) >> (count % 8);
        if (!first_is_joined && spare == 0) return true;
        faults_.add({ErrorCode::kReservedField, offset_, first_is_joined ? 1 : spare});
        return false;
    }

    bool check_levels() {
        for (std::uint32_t level = 0; level < view_.levels; ++level) {
            const float before = level == 0 ? 0.0f : view_.error(level - 1);
            bool follows = std::isfinite(view_.error(level)) && view_.error(level) >= before;
            for (std::uint32_t place = 0; place < view_.pools.size(); ++place) {
                const std::uint32_t most = level == 0 ? view_.pools[place].vertices : view_.alive(level - 1, place);
                const std::uint32_t alive = view_.alive(level, place);
                follows = follows && alive <= most && alive >= view_.pools[place].base;
            }
            if (follows) continue;
            faults_.add({ErrorCode::kCollapseLevel, offset_, level});
            return false;
        }
        return true;
    }

    Bytes payload_;
    std::uint64_t offset_;
    std::span<const PoolView> pools_;
    Faults& faults_;
    CollapseView view_;
};

}  // namespace

std::uint32_t PoolCollapseView::target(std::uint32_t vertex) const {
    assert(vertex >= base && vertex < vertices);
    const std::uint64_t at = std::uint64_t{vertex} - base;
    if (type == ComponentType::u32) {
        std::uint32_t number = 0;
        copy_at(targets, at * sizeof number, number);
        return number;
    }
    std::uint16_t number = 0;
    copy_at(targets, at * sizeof number, number);
    return number;
}

bool PoolCollapseView::is_joined(std::uint32_t vertex) const {
    assert(vertex >= base && vertex < vertices);
    const std::uint32_t bit = vertex - base;
    return (std::to_integer<unsigned>(joined[bit / 8]) >> (bit % 8) & 1u) != 0;
}

float CollapseView::error(std::uint32_t level) const {
    assert(level < levels);
    float number = 0.0f;
    copy_at(rows, level * (std::uint64_t{1} + pools.size()) * sizeof number, number);
    return number;
}

std::uint32_t CollapseView::alive(std::uint32_t level, std::uint32_t place) const {
    assert(level < levels && place < pools.size());
    std::uint32_t number = 0;
    copy_at(rows, (level * (std::uint64_t{1} + pools.size()) + 1 + place) * sizeof number, number);
    return number;
}

std::optional<CollapseView> read_collapse(const ChunkTree& tree, std::uint32_t object, std::span<const PoolView> pools,
                                          Faults& faults) {
    const std::uint32_t chunk = tree.find(object, FourCC("LODD"));
    if (chunk == kNone || tree[chunk].is_container()) return std::nullopt;
    const Result<CollapseRecord> record = read_record<CollapseRecord>(tree, chunk);
    if (!record) {
        faults.add(record.error());
        return std::nullopt;
    }
    return CollapseReader(tree, chunk, pools, faults).read(*record);
}

}  // namespace bendy
