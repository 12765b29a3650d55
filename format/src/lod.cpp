#include <bendy/format/lod.h>

#include <bendy/format/read_record.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace bendy {
namespace {

/// Splits a payload into its arrays; `at` stays within it.
class Cutter {
public:
    explicit Cutter(Bytes payload, std::uint64_t at) : payload_(payload), at_(at) {}

    [[nodiscard]] std::uint64_t left() const { return payload_.size() - at_; }
    /// Returns the next `size` bytes, which must exist, and advances to the 16-byte boundary after them.
    Bytes take(std::uint64_t size) {
        const Bytes taken = payload_.subspan(at_, size);
        const std::uint64_t next = std::min<std::uint64_t>(padded(at_ + size), payload_.size());
        for (std::uint64_t gap = at_ + size; gap < next; ++gap) gaps_ = gaps_ | payload_[gap];
        at_ = next;
        return taken;
    }
    /// Returns all bytes between the arrays, combined by or.
    [[nodiscard]] std::uint64_t gaps() const { return std::to_integer<std::uint64_t>(gaps_); }

private:
    Bytes payload_;
    std::uint64_t at_;
    std::byte gaps_{0};
};

class CollapseReader {
public:
    CollapseReader(const ChunkTree& tree, std::uint32_t chunk, std::span<const MeshView> meshes, Faults& faults)
        : payload_(tree.payload(chunk)), offset_(tree[chunk].offset), meshes_(meshes), faults_(faults) {
        view_.chunk = chunk;
    }

    std::optional<CollapseView> read(const CollapseRecord& record) {
        check_reserved(record.reserved, offset_, faults_);
        Cutter cutter(payload_, sizeof(CollapseRecord));
        if (record.meshes > cutter.left() / sizeof(MeshCollapseRecord)) {
            return fault({ErrorCode::kRecordSize, offset_, payload_.size(),
                          sizeof(CollapseRecord) + std::uint64_t{record.meshes} * sizeof(MeshCollapseRecord)});
        }
        const auto table =
            view_at<MeshCollapseRecord>(cutter.take(record.meshes * sizeof(MeshCollapseRecord)), 0, record.meshes);
        const std::uint64_t row = (std::uint64_t{1} + record.meshes) * sizeof(std::uint32_t);
        if (record.levels > cutter.left() / row) {
            return fault({ErrorCode::kRecordSize, offset_, payload_.size(), payload_.size() - cutter.left() + row});
        }
        view_.levels = record.levels;
        view_.rows = cutter.take(record.levels * row);
        for (const MeshCollapseRecord& mesh : table) check_reserved(mesh.reserved, offset_, faults_);
        const bool sizes_are_known =
            std::all_of(meshes_.begin(), meshes_.end(), [](const MeshView& mesh) { return mesh.has_info; });
        if (!sizes_are_known) return std::nullopt;  // a fault was added for it
        view_.meshes.reserve(record.meshes);
        for (const MeshCollapseRecord& mesh : table) {
            if (!read_mesh(mesh)) return std::nullopt;
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

    bool read_mesh(const MeshCollapseRecord& record) {
        if (record.mesh >= meshes_.size()) {
            faults_.add({ErrorCode::kMeshRange, offset_, record.mesh, meshes_.size()});
            return false;
        }
        if (!view_.meshes.empty() && record.mesh <= view_.meshes.back().mesh) {
            faults_.add({ErrorCode::kCollapseMesh, offset_, record.mesh, view_.meshes.back().mesh});
            return false;
        }
        const std::uint32_t vertices = meshes_[record.mesh].vertices;
        if (record.base > vertices) {
            faults_.add({ErrorCode::kIndexRange, offset_, record.base, vertices});
            return false;
        }
        const auto type = static_cast<ComponentType>(record.target_type);
        if (type != ComponentType::u16 && type != ComponentType::u32) {
            faults_.add({ErrorCode::kStreamType, offset_});
            return false;
        }
        view_.meshes.push_back({record.mesh, record.base, vertices, type, {}, {}});
        return true;
    }

    bool read_targets(Cutter& cutter) {
        std::uint64_t needed = 0;  // fewer than 2^32 meshes, all different, of 2^32 vertices of 5 bytes: no overflow
        for (const MeshCollapseView& mesh : view_.meshes) {
            const std::uint64_t count = mesh.vertices - mesh.base;
            needed += collapse_targets_size(count, mesh.type) + collapse_bits_size(count);
        }
        if (needed != cutter.left()) {
            faults_.add({ErrorCode::kRecordSize, offset_, payload_.size(), payload_.size() - cutter.left() + needed});
            return false;
        }
        for (MeshCollapseView& mesh : view_.meshes) {
            const std::uint64_t count = mesh.vertices - mesh.base;
            mesh.targets = cutter.take(count * component_size(mesh.type));
            mesh.joined = cutter.take((count + 7) / 8);
            if (!check_mesh(mesh)) return false;
        }
        if (cutter.gaps() != 0) {
            faults_.add({ErrorCode::kReservedField, offset_, cutter.gaps()});
            return false;
        }
        return true;
    }

    bool check_mesh(const MeshCollapseView& mesh) {
        for (std::uint32_t vertex = mesh.base; vertex < mesh.vertices; ++vertex) {
            if (mesh.target(vertex) < vertex) continue;
            faults_.add({ErrorCode::kCollapseTarget, offset_, vertex, mesh.target(vertex)});
            return false;
        }
        const std::uint32_t count = mesh.vertices - mesh.base;
        const bool first_is_joined = count != 0 && mesh.is_joined(mesh.base);
        const auto spare = count % 8 == 0 ? 0u : std::to_integer<unsigned>(mesh.joined.back()) >> (count % 8);
        if (!first_is_joined && spare == 0) return true;
        faults_.add({ErrorCode::kReservedField, offset_, first_is_joined ? 1 : spare});
        return false;
    }

    bool check_levels() {
        for (std::uint32_t level = 0; level < view_.levels; ++level) {
            const float before = level == 0 ? 0.0f : view_.error(level - 1);
            bool follows = std::isfinite(view_.error(level)) && view_.error(level) >= before;
            for (std::uint32_t place = 0; place < view_.meshes.size(); ++place) {
                const std::uint32_t most = level == 0 ? view_.meshes[place].vertices : view_.alive(level - 1, place);
                const std::uint32_t alive = view_.alive(level, place);
                follows = follows && alive <= most && alive >= view_.meshes[place].base;
            }
            if (follows) continue;
            faults_.add({ErrorCode::kCollapseLevel, offset_, level});
            return false;
        }
        return true;
    }

    Bytes payload_;
    std::uint64_t offset_;
    std::span<const MeshView> meshes_;
    Faults& faults_;
    CollapseView view_;
};

}  // namespace

std::uint32_t MeshCollapseView::target(std::uint32_t vertex) const {
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

bool MeshCollapseView::is_joined(std::uint32_t vertex) const {
    assert(vertex >= base && vertex < vertices);
    const std::uint32_t bit = vertex - base;
    return (std::to_integer<unsigned>(joined[bit / 8]) >> (bit % 8) & 1u) != 0;
}

float CollapseView::error(std::uint32_t level) const {
    assert(level < levels);
    float number = 0.0f;
    copy_at(rows, level * (std::uint64_t{1} + meshes.size()) * sizeof number, number);
    return number;
}

std::uint32_t CollapseView::alive(std::uint32_t level, std::uint32_t place) const {
    assert(level < levels && place < meshes.size());
    std::uint32_t number = 0;
    copy_at(rows, (level * (std::uint64_t{1} + meshes.size()) + 1 + place) * sizeof number, number);
    return number;
}

std::optional<CollapseView> read_collapse(const ChunkTree& tree, std::uint32_t object, std::span<const MeshView> meshes,
                                          Faults& faults) {
    const std::uint32_t chunk = tree.find(object, FourCC("LODD"));
    if (chunk == kNone || tree[chunk].is_container()) return std::nullopt;
    const Result<CollapseRecord> record = read_record<CollapseRecord>(tree, chunk);
    if (!record) {
        faults.add(record.error());
        return std::nullopt;
    }
    return CollapseReader(tree, chunk, meshes, faults).read(*record);
}

}  // namespace bendy
