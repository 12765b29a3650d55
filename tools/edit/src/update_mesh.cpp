#include "kept.h"

#include <bendy/format/records.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

namespace bendy::edit {
namespace {

template <class T>
void store(Buffer& bytes, std::size_t at, const T& value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// Returns the stream's leaf with these elements only.
Buffer with_elements(const ChunkTree& tree, const StreamView& stream, std::span<const std::uint32_t> elements) {
    const Bytes before = tree.payload(stream.chunk);
    const Bytes head = before.first(before.size() - stream.data.size());
    const std::size_t row = std::size_t{stream.components} * component_size(stream.type);
    Buffer payload(head.begin(), head.end());
    payload.reserve(head.size() + elements.size() * row);
    store(payload, offsetof(StreamRecord, elements), static_cast<std::uint32_t>(elements.size()));
    for (const std::uint32_t element : elements) {
        const Bytes bytes = stream.data.subspan(element * row, row);
        payload.insert(payload.end(), bytes.begin(), bytes.end());
    }
    return payload;
}

/// Changes the unsigned integers after the head of a stream's payload: change(k, number).
template <class Change>
void change_integers(Buffer& payload, const StreamView& stream, const Change& change) {
    const std::uint32_t size = component_size(stream.type);
    const std::size_t head = sizeof(StreamRecord);  // integers that refer to things are never boxed
    for (std::size_t at = head, k = 0; at + size <= payload.size(); at += size, ++k) {
        std::uint32_t number = 0;
        std::memcpy(&number, payload.data() + at, size);
        number = change(k, number);
        std::memcpy(payload.data() + at, &number, size);
    }
}

class MeshUpdater {
public:
    MeshUpdater(const ChunkTree& tree, const MeshView& mesh, const Kept::Mesh& kept, const ObjectNumbers& numbers,
                std::span<const std::uint32_t> now, Rewrite& rewrite)
        : tree_(tree), mesh_(mesh), kept_(kept), numbers_(numbers), now_(now), rewrite_(rewrite) {
        for (std::uint32_t v = 0; v < now.size(); ++v) {
            if (now[v] != kNone) kept_vertices_.push_back(v);
        }
    }

    void update(std::span<const IndexRun> runs) {
        update_info();
        update_palette();
        update_targets();
        if (now_.empty()) return;
        for (const auto* stream : {&mesh_.normals, &mesh_.tangents, &mesh_.weights}) cut(*stream);
        cut(mesh_.positions);
        for (const StreamView& stream : mesh_.texture_coords) cut(stream);
        for (const StreamView& stream : mesh_.colours) cut(stream);
        for (const AttributeView& attribute : mesh_.attributes) cut(attribute.values);
        update_indices(runs);
    }

private:
    void cut(const std::optional<StreamView>& stream) {
        if (stream) cut(*stream);
    }
    void cut(const StreamView& stream) {
        if (stream.chunk != 0) rewrite_.replace(stream.chunk, with_elements(tree_, stream, kept_vertices_));
    }

    void update_info() {
        const std::uint32_t chunk = tree_.find(mesh_.chunk, FourCC("VINF"));
        const std::uint32_t vertices =
            now_.empty() ? mesh_.vertices : static_cast<std::uint32_t>(kept_vertices_.size());
        const std::uint32_t joint = mesh_.joint == kNone ? kNone : numbers_.joints[mesh_.joint];
        if (vertices == mesh_.vertices && joint == mesh_.joint) return;
        const Bytes before = tree_.payload(chunk);
        Buffer payload(before.begin(), before.end());
        store(payload, offsetof(MeshRecord, vertices), vertices);
        store(payload, offsetof(MeshRecord, joint), joint);
        rewrite_.replace(chunk, payload);
    }

    /// Removes palette entries without weight in any kept vertex, and updates BONE accordingly.
    void update_palette() {
        if (mesh_.is_rigid()) return;
        const std::span<const std::uint32_t> joints = mesh_.palette.joints;
        std::vector<bool> stays(joints.size(), now_.empty());
        for (const std::uint32_t vertex : kept_vertices_) {
            for (std::uint32_t k = 0; k < mesh_.bones->components; ++k) {
                if (mesh_.weights->number(vertex, k) != 0.0f) stays[mesh_.bones->index(vertex, k)] = true;
            }
        }
        const auto bones = renumbered(stays);
        const bool is_renumbered = std::find(stays.begin(), stays.end(), false) != stays.end();
        const bool has_moved = std::any_of(joints.begin(), joints.end(),
                                           [&](std::uint32_t joint) { return numbers_.joints[joint] != joint; });
        if (is_renumbered || has_moved) put_palette(stays);
        if (now_.empty()) return;
        Buffer payload = with_elements(tree_, *mesh_.bones, kept_vertices_);
        change_integers(payload, *mesh_.bones, [&](std::size_t, std::uint32_t bone) {
            return bones[bone] == kNone ? 0 : bones[bone];  // has zero weight
        });
        rewrite_.replace(mesh_.bones->chunk, payload);
    }

    void put_palette(const std::vector<bool>& stays) {
        const PaletteView& palette = mesh_.palette;
        const std::uint32_t chunk = tree_.find(mesh_.chunk, FourCC("PALT"));
        PaletteRecord record;
        copy_at(tree_.payload(chunk), 0, record);
        record.entries = static_cast<std::uint32_t>(std::count(stays.begin(), stays.end(), true));
        Buffer payload(padded(sizeof record + std::size_t{record.entries} * sizeof(std::uint32_t)));
        store(payload, 0, record);
        std::size_t at = sizeof record;
        for (std::size_t entry = 0; entry < stays.size(); ++entry) {
            if (!stays[entry]) continue;
            store(payload, at, numbers_.joints[palette.joints[entry]]);
            at += sizeof(std::uint32_t);
            if (!palette.is_derived) append(payload, palette.stored[entry]);
        }
        if (palette.is_derived) append(payload, palette.stored.front());
        rewrite_.replace(chunk, payload);
    }

    void update_targets() {
        std::size_t number = 0;
        for (const std::uint32_t chunk : tree_.children(mesh_.chunk)) {
            if (!(tree_[chunk].id == FourCC("TARG"))) continue;
            const std::size_t target = number++;
            if (!kept_.targets[target]) {
                rewrite_.remove(chunk);
            } else if (!now_.empty()) {
                cut_target(mesh_.targets[target]);
            }
        }
        if (mesh_.first_frame == mesh_.targets.size()) return;
        const MorphTargetView& frame = mesh_.targets.back();  // frames are kept or removed together
        if (!kept_.targets.back()) {
            rewrite_.remove(frame.chunk);
        } else if (!now_.empty()) {
            rewrite_.replace(frame.places->chunk, with_elements(tree_, *frame.places, kept_vertices_));
        }
    }

    void cut_target(const MorphTargetView& target) {
        std::vector<std::uint32_t> elements;  // of the target's streams
        if (target.vertices) {
            for (std::uint32_t e = 0; e < target.vertices->elements; ++e) {
                if (now_[target.vertices->index(e, 0)] != kNone) elements.push_back(e);
            }
            Buffer payload = with_elements(tree_, *target.vertices, elements);
            change_integers(payload, *target.vertices, [&](std::size_t, std::uint32_t vertex) { return now_[vertex]; });
            rewrite_.replace(target.vertices->chunk, payload);
        } else {
            elements = kept_vertices_;
        }
        for (const auto* stream : {&target.positions, &target.normals, &target.tangents}) {
            if (*stream) rewrite_.replace((*stream)->chunk, with_elements(tree_, **stream, elements));
        }
    }

    void update_indices(std::span<const IndexRun> runs) {
        if (!mesh_.indices) return;
        std::vector<std::uint32_t> entries;
        for (const IndexRun& run : runs) {
            for (std::uint32_t k = 0; k < run.count; ++k) entries.push_back(run.first + k);
        }
        Buffer payload = with_elements(tree_, *mesh_.indices, entries);
        change_integers(payload, *mesh_.indices, [&](std::size_t, std::uint32_t vertex) { return now_[vertex]; });
        rewrite_.replace(mesh_.indices->chunk, payload);
    }

    const ChunkTree& tree_;
    const MeshView& mesh_;
    const Kept::Mesh& kept_;
    const ObjectNumbers& numbers_;
    std::span<const std::uint32_t> now_;
    std::vector<std::uint32_t> kept_vertices_;
    Rewrite& rewrite_;
};

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

void update_mesh(const ChunkTree& tree, const MeshView& mesh, const Kept::Mesh& kept, const ObjectNumbers& numbers,
                 std::span<const std::uint32_t> vertices, std::span<const IndexRun> index_runs, Rewrite& rewrite) {
    MeshUpdater(tree, mesh, kept, numbers, vertices, rewrite).update(index_runs);
}

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
