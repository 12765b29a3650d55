#include "keep_only.h"

#include <bendy/format/records.h>

#include <cstring>
#include <span>
#include <utility>

namespace bendy::edit {
namespace {

void pad(Buffer& payload) {
    payload.resize(padded(payload.size()));
}

/// A mesh's part of LODD: its kept vertices, by their original numbers.
struct MeshCollapse {
    const MeshCollapseView* before = nullptr;
    std::uint32_t place = 0;  // index in the rows
    std::span<const std::uint32_t> now;
    std::vector<std::uint32_t> kept_below;  // number of kept vertices below each vertex; empty: all

    [[nodiscard]] std::uint32_t count(std::uint32_t vertices) const {
        return kept_below.empty() ? vertices : kept_below[vertices];
    }
    [[nodiscard]] bool stays(std::uint32_t vertex) const { return now.empty() || now[vertex] != kNone; }
    [[nodiscard]] std::uint32_t number(std::uint32_t vertex) const { return now.empty() ? vertex : now[vertex]; }
};

void put_targets(const MeshCollapse& part, Buffer& payload) {
    const MeshCollapseView& before = *part.before;
    for (std::uint32_t v = before.base; v < before.vertices; ++v) {
        if (!part.stays(v)) continue;
        const std::uint32_t target = part.number(before.target(v));  // it is kept: see extract
        if (before.type == ComponentType::u32) {
            append(payload, target);
        } else {
            append(payload, static_cast<std::uint16_t>(target));
        }
    }
    pad(payload);
    std::vector<std::uint8_t> bits((part.count(before.vertices) - part.count(before.base) + 7) / 8);
    bool run_has_begun = false;  // an earlier vertex of the same run of joined ones is kept
    for (std::uint32_t v = before.base, k = 0; v < before.vertices; ++v) {
        run_has_begun = run_has_begun && before.is_joined(v);
        if (!part.stays(v)) continue;
        if (run_has_begun) bits[k / 8] = static_cast<std::uint8_t>(bits[k / 8] | 1u << (k % 8));
        run_has_begun = true;
        ++k;
    }
    const Bytes bytes = std::as_bytes(std::span(bits));
    payload.insert(payload.end(), bytes.begin(), bytes.end());
    pad(payload);
}

}  // namespace

void update_collapse(const CollapseView& collapse, const Kept::Object& kept, const ObjectNumbers& numbers,
                     Rewrite& rewrite) {
    std::vector<MeshCollapse> parts;
    bool is_changed = false;
    for (std::uint32_t place = 0; place < collapse.meshes.size(); ++place) {
        const MeshCollapseView& before = collapse.meshes[place];
        is_changed = is_changed || numbers.meshes[before.mesh] != before.mesh || !numbers.vertices[before.mesh].empty();
        if (!kept.meshes[before.mesh].stays || !kept.meshes[before.mesh].keeps_levels) {
            is_changed = true;
            continue;
        }
        MeshCollapse part{&before, place, numbers.vertices[before.mesh], {}};
        if (!part.now.empty()) {
            part.kept_below.push_back(0);
            for (const std::uint32_t now : part.now)
                part.kept_below.push_back(part.kept_below.back() + (now == kNone ? 0 : 1));
        }
        parts.push_back(std::move(part));
    }
    if (!is_changed) return;
    if (parts.empty()) return rewrite.remove(collapse.chunk);
    Buffer payload;
    CollapseRecord record;
    record.meshes = static_cast<std::uint32_t>(parts.size());
    record.levels = collapse.levels;
    append(payload, record);
    for (const MeshCollapse& part : parts) {
        MeshCollapseRecord entry;
        entry.mesh = numbers.meshes[part.before->mesh];
        entry.base = part.count(part.before->base);
        entry.target_type = static_cast<std::uint8_t>(part.before->type);
        append(payload, entry);
    }
    for (std::uint32_t level = 0; level < collapse.levels; ++level) {
        append(payload, collapse.error(level));
        for (const MeshCollapse& part : parts) append(payload, part.count(collapse.alive(level, part.place)));
    }
    pad(payload);
    for (const MeshCollapse& part : parts) put_targets(part, payload);
    rewrite.replace(collapse.chunk, payload);
}

}  // namespace bendy::edit
