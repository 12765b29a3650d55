#include "convert/build_meshes.h"

#include "scene/stored_numbers.h"

#include <bendy/format/charconv.h>
#include <bendy/format/mesh.h>
#include <bendy/format/records.h>

#include <array>
#include <optional>
#include <vector>

namespace bendy::converter {
namespace {

LeafShape stream_shape(std::size_t head, std::size_t number, std::size_t components, bool is_triangles) {
    const std::size_t row = number * components;
    const bool fits = row <= 256;
    return {static_cast<std::uint16_t>(head), static_cast<std::uint16_t>(fits ? row : 0),
            static_cast<std::uint16_t>(number), is_triangles};
}

void put_stream(LeafWriter& out, FourCC id, const StoredNumbers& numbers, std::uint32_t components,
                std::uint32_t elements, std::uint32_t set = 0) {
    StreamRecord record;
    record.component_type = static_cast<std::uint8_t>(numbers.type);
    record.normalised = numbers.normalised ? 1 : 0;
    record.components = static_cast<std::uint16_t>(components);
    record.elements = elements;
    record.set = set;
    out.leaf(id, std::array{bytes_of(record), Bytes(numbers.bytes)},
             stream_shape(sizeof record, component_size(numbers.type), components, id == FourCC("INDX")));
}

/// Writes a stream of integers that encode the mesh's numbers. `elements` selects some; empty: all.
void put_stored(LeafWriter& out, FourCC id, const StoredStream& stream, std::span<const std::uint32_t> elements = {},
                std::uint32_t set = 0) {
    StreamRecord record;
    record.component_type = static_cast<std::uint8_t>(stream.type);
    record.normalised = static_cast<std::uint8_t>(stream.numbers);
    record.components = static_cast<std::uint16_t>(stream.components);
    record.elements =
        static_cast<std::uint32_t>(elements.empty() ? stream.bytes.size() / stream.row() : elements.size());
    record.set = set;
    std::vector<std::byte> picked;
    for (const std::uint32_t element : elements) {
        const auto first = stream.bytes.begin() + static_cast<std::ptrdiff_t>(element * stream.row());
        picked.insert(picked.end(), first, first + static_cast<std::ptrdiff_t>(stream.row()));
    }
    const Bytes boxes = std::as_bytes(std::span(stream.boxes));
    const std::array<std::byte, kChunkAlignment> zeros{};
    const Bytes gap = Bytes(zeros).first(padded(boxes.size()) - boxes.size());
    LeafShape shape =
        stream_shape(sizeof record + boxes.size() + gap.size(), component_size(stream.type), stream.components, false);
    shape.sums = id == FourCC("WGHT") && stream.type == ComponentType::u16;
    out.leaf(id, std::array{bytes_of(record), boxes, gap, Bytes(elements.empty() ? stream.bytes : picked)}, shape);
}

/// Writes a stream of float vectors unchanged.
template <class Vector>
void put_vectors(LeafWriter& out, FourCC id, std::span<const Vector> vectors) {
    if (vectors.empty()) return;
    StreamRecord record;
    record.component_type = static_cast<std::uint8_t>(ComponentType::f32);
    record.components = static_cast<std::uint16_t>(Vector::length());
    record.elements = static_cast<std::uint32_t>(vectors.size());
    out.leaf(id, std::array{bytes_of(record), std::as_bytes(vectors)},
             stream_shape(sizeof record, sizeof(float), record.components, false));
}

bool is_touched(const MorphTarget& target, std::size_t vertex) {
    const auto moves = [&](const std::vector<glm::vec3>& stream) {
        return !stream.empty() && stream[vertex] != glm::vec3(0.0f);
    };
    return moves(target.positions) || moves(target.normals) || moves(target.tangents);
}

std::vector<glm::vec3> pick(const std::vector<glm::vec3>& stream, std::span<const std::uint32_t> vertices) {
    std::vector<glm::vec3> picked;
    if (stream.empty()) return picked;
    picked.reserve(vertices.size());
    for (const std::uint32_t vertex : vertices) picked.push_back(stream[vertex]);
    return picked;
}

/// Stores only the touched vertices if that is smaller.
void put_target(LeafWriter& out, const MorphTarget& target, const CompactTarget& compact, std::uint32_t vertices) {
    std::vector<std::uint32_t> touched;
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
        if (is_touched(target, vertex)) touched.push_back(vertex);
    }
    const auto present = static_cast<std::uint64_t>(!target.positions.empty()) +
                         static_cast<std::uint64_t>(!target.normals.empty()) +
                         static_cast<std::uint64_t>(!target.tangents.empty());
    const std::uint64_t dense = vertices * present * sizeof(glm::vec3);
    const StoredNumbers indices = smallest_exact_indices(touched, vertices, false);
    const std::uint64_t sparse =
        kChunkHeaderSize + sizeof(StreamRecord) + indices.bytes.size() + touched.size() * present * sizeof(glm::vec3);

    out.begin(FourCC("TARG"));
    put_text(out, FourCC("NAME"), target.name);
    out.leaf(FourCC("TINF"), bytes_of(MorphTargetRecord{target.rest_weight}));
    if (present != 0 && !touched.empty()) {
        const bool is_sparse = sparse < dense;
        if (is_sparse) put_stream(out, FourCC("INDX"), indices, 1, static_cast<std::uint32_t>(touched.size()));
        const auto put = [&](FourCC id, const std::vector<glm::vec3>& stream,
                             const std::optional<StoredStream>& stored) {
            if (stored) {
                put_stored(out, id, *stored,
                           is_sparse ? std::span<const std::uint32_t>(touched) : std::span<const std::uint32_t>());
                return;
            }
            const std::vector<glm::vec3> picked = is_sparse ? pick(stream, touched) : std::vector<glm::vec3>();
            put_vectors(out, id, std::span<const glm::vec3>(is_sparse ? picked : stream));
        };
        put(FourCC("POSI"), target.positions, compact.positions);
        put(FourCC("NORM"), target.normals, compact.normals);
        put(FourCC("TANG"), target.tangents, compact.tangents);
    }
    out.end();
}

/// `base`: if set, the matrices follow from it and the rest pose, and are not written.
void put_palette(LeafWriter& out, const Palette& palette, const std::optional<glm::mat4>& base) {
    PaletteRecord record;
    record.derived = base ? 1 : 0;
    record.entries = static_cast<std::uint32_t>(palette.joints.size());
    const auto joints = std::as_bytes(std::span(palette.joints));
    const std::array<std::byte, kChunkAlignment> zeros{};
    const auto gap = std::span(zeros).first(padded(joints.size()) - joints.size());
    const Bytes matrices = base ? bytes_of(*base) : Bytes(std::as_bytes(std::span(palette.inverse_bind)));
    out.leaf(FourCC("PALT"), std::array{bytes_of(record), Bytes(joints), Bytes(gap), matrices},
             LeafShape{0, 0, sizeof(float), false});
}

template <class Vector>
void put_either(LeafWriter& out, FourCC id, const std::optional<StoredStream>& stored,
                const std::vector<Vector>& vectors) {
    if (stored) {
        put_stored(out, id, *stored);
    } else {
        put_vectors(out, id, std::span<const Vector>(vectors));
    }
}

void put_sets(LeafWriter& out, FourCC id, std::span<const Stream> streams,
              std::span<const std::optional<StoredStream>> stored, std::uint32_t vertices) {
    for (std::size_t k = 0; k < streams.size(); ++k) {
        const Stream& stream = streams[k];
        if (k < stored.size() && stored[k]) {
            put_stored(out, id, *stored[k], {}, stream.set);
        } else {
            put_stream(out, id, smallest_exact_fractions(stream.values), stream.components, vertices, stream.set);
        }
    }
}

void put_frames(LeafWriter& out, const StoredFrames& frames) {
    out.begin(FourCC("FRMS"));
    put_text(out, FourCC("FNAM"), frames.names);
    out.leaf(FourCC("GRID"), std::as_bytes(std::span(frames.grid)), LeafShape{0, 0, sizeof(float), false});
    put_stream(out, FourCC("INDX"), smallest_exact_indices(frames.places, frames.place_count, true), 1,
               static_cast<std::uint32_t>(frames.places.size()));
    put_stored(out, FourCC("POSI"), frames.positions);
    if (frames.normals) put_stored(out, FourCC("NORM"), *frames.normals);
    out.end();
}

/// Appends an array of LODD, padded to a 16-byte boundary.
void append_padded(std::vector<std::byte>& bytes, Bytes array) {
    bytes.insert(bytes.end(), array.begin(), array.end());
    bytes.resize(padded(bytes.size()));
}

}  // namespace

void put_mesh(LeafWriter& out, const Mesh& mesh, std::span<const std::uint32_t> indices, const CompactMesh& compact) {
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    out.begin(FourCC("VECT"));
    put_text(out, FourCC("NAME"), mesh.name);
    out.leaf(FourCC("VINF"), bytes_of(MeshRecord{vertices, mesh.joint}));
    put_text(out, FourCC("EXTR"), mesh.extras);
    put_text(out, FourCC("MORE"), mesh.more);
    if (mesh.influences != 0) put_palette(out, mesh.palette, compact.bind_base);
    const StoredShapes shapes = store_shapes(mesh);
    if (!shapes.list.empty())
        out.leaf(FourCC("NLST"), std::as_bytes(std::span(shapes.list)), LeafShape{0, 0, sizeof(float), false});
    put_either<glm::vec3>(out, FourCC("POSI"), shapes.positions ? shapes.positions : compact.positions, mesh.positions);
    put_either<glm::vec3>(out, FourCC("NORM"), shapes.normals ? shapes.normals : compact.normals, mesh.normals);
    put_either<glm::vec4>(out, FourCC("TANG"), compact.tangents, mesh.tangents);
    put_sets(out, FourCC("TEXC"), mesh.texture_coords, compact.texture_coords, vertices);
    put_sets(out, FourCC("COLR"), mesh.colours, compact.colours, vertices);
    for (const Stream& stream : mesh.attributes) {
        out.begin(FourCC("USER"));
        put_text(out, FourCC("NAME"), stream.name);
        put_stream(out, FourCC("VALS"), {ComponentType::f32, false, std::as_bytes(std::span(stream.values))},
                   stream.components, vertices);
        out.end();
    }
    if (!mesh.source_numbers.empty()) {
        out.begin(FourCC("USER"));
        put_text(out, FourCC("NAME"), std::string(kSourceVertex));
        put_stream(out, FourCC("VALS"), smallest_exact_indices(mesh.source_numbers, vertices, true), 1, vertices);
        out.end();
    }
    if (mesh.influences != 0) {
        put_stream(out, FourCC("BONE"), smallest_exact_indices(mesh.bones, mesh.palette.joints.size(), true),
                   mesh.influences, vertices);
        if (compact.weights) {
            put_stored(out, FourCC("WGHT"), *compact.weights);
        } else {
            put_stream(out, FourCC("WGHT"), smallest_exact_fractions(mesh.weights), mesh.influences, vertices);
        }
    }
    if (!indices.empty()) {
        put_stream(out, FourCC("INDX"), smallest_exact_indices(indices, vertices, false), 1,
                   static_cast<std::uint32_t>(indices.size()));
    }
    for (std::size_t k = 0; k < mesh.targets.size(); ++k) {
        if (mesh.targets[k].is_frame) break;
        put_target(out, mesh.targets[k], k < compact.targets.size() ? compact.targets[k] : CompactTarget(), vertices);
    }
    if (shapes.frames) put_frames(out, *shapes.frames);
    out.end();
}

void put_collapse(LeafWriter& out, const Scene& scene) {
    std::vector<std::uint32_t> meshes;
    for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        if (!scene.meshes[mesh].collapse.empty()) meshes.push_back(mesh);
    }
    if (meshes.empty()) return;
    std::vector<std::byte> payload;
    CollapseRecord record;
    record.meshes = static_cast<std::uint32_t>(meshes.size());
    record.levels = static_cast<std::uint32_t>(scene.levels.size());
    append_padded(payload, bytes_of(record));
    for (const std::uint32_t number : meshes) {
        const Mesh& mesh = scene.meshes[number];
        MeshCollapseRecord entry;
        entry.mesh = number;
        entry.base = mesh.base;
        entry.target_type = static_cast<std::uint8_t>(smallest_exact_indices({}, mesh.collapse.size(), false).type);
        append_padded(payload, bytes_of(entry));
    }
    std::vector<std::uint32_t> rows;
    for (const LodLevel& level : scene.levels) {
        rows.push_back(bit_cast<std::uint32_t>(level.error));
        for (const std::uint32_t number : meshes) rows.push_back(level.alive[number]);
    }
    append_padded(payload, std::as_bytes(std::span(rows)));
    for (const std::uint32_t number : meshes) {
        const Mesh& mesh = scene.meshes[number];
        append_padded(
            payload,
            smallest_exact_indices(std::span(mesh.collapse).subspan(mesh.base), mesh.collapse.size(), false).bytes);
        std::vector<std::byte> bits((mesh.collapse.size() - mesh.base + 7) / 8);
        for (std::size_t k = 0; k < mesh.collapse.size() - mesh.base; ++k) {
            if (mesh.joined[mesh.base + k] != 0) bits[k / 8] |= std::byte{1} << (k % 8);
        }
        append_padded(payload, bits);
    }
    out.leaf(FourCC("LODD"), payload, LeafShape{0, 0, sizeof(std::uint16_t), false});
}

}  // namespace bendy::converter
