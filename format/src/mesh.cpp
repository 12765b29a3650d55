#include <bendy/format/mesh.h>

#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

namespace bendy {
namespace {

/// A set of types.
template <class... Types>
constexpr unsigned any_of(Types... types) {
    return ((1u << static_cast<unsigned>(types)) | ...);
}

/// The combinations of types, element widths and interpretations of integers that a kind of stream may have.
struct StreamForm {
    unsigned types;
    std::uint32_t fewest_components;
    std::uint32_t most_components;
    Numbers numbers;
};
using StreamRule = std::span<const StreamForm>;

namespace forms {

using enum ComponentType;
using enum Numbers;

constexpr StreamForm kPositions[] = {{any_of(f32), 3, 3, plain}, {any_of(u8, u16, u32), 3, 3, boxed}};
constexpr StreamForm kShifts[] = {{any_of(f32), 3, 3, plain}, {any_of(u8, i8, u16, i16), 3, 3, boxed}};
constexpr StreamForm kNormals[] = {
    {any_of(f32), 3, 3, plain}, {any_of(i8, i16), 2, 2, normalised}, {any_of(u8), 1, 1, listed}};
constexpr StreamForm kFrameNormals[] = {{any_of(u8), 1, 1, listed}};
constexpr StreamForm kFramePositions[] = {{any_of(u8, u16), 3, 3, plain}};
constexpr StreamForm kPlaces[] = {{any_of(u8, u16, u32), 1, 1, plain}};
constexpr StreamForm kTangents[] = {{any_of(f32), 4, 4, plain}, {any_of(i8, i16), 3, 3, normalised}};
constexpr StreamForm kCoords[] = {
    {any_of(f32), 2, 2, plain}, {any_of(u8, u16), 2, 2, normalised}, {any_of(u8, u16), 2, 2, boxed}};
constexpr StreamForm kColour[] = {
    {any_of(f32), 3, 4, plain}, {any_of(u8, u16), 3, 4, normalised}, {any_of(u8, u16), 3, 4, boxed}};
constexpr StreamForm kBones[] = {{any_of(u8, u16), 1, kMaxInfluences, plain}};
constexpr StreamForm kWeights[] = {{any_of(f32), 1, kMaxInfluences, plain},
                                   {any_of(u8, u16), 1, kMaxInfluences, normalised},
                                   {any_of(u8, u16), 1, kMaxInfluences, boxed}};
constexpr StreamForm kIndices[] = {{any_of(u16, u32), 1, 1, plain}};
constexpr StreamForm kAnything[] = {{any_of(u8, i8, u16, i16, u32, f32), 1, 0xffff, plain},
                                    {any_of(u8, i8, u16, i16), 1, 0xffff, normalised}};

}  // namespace forms

bool takes(StreamRule rule, const StreamRecord& record) {
    return std::any_of(rule.begin(), rule.end(), [&](const StreamForm& form) {
        return (form.types >> record.component_type & 1u) != 0 && record.components >= form.fewest_components &&
               record.components <= form.most_components &&
               record.normalised == static_cast<std::uint8_t>(form.numbers);
    });
}

bool is_one_of(StreamRule rule, StreamRule a, StreamRule b) {
    return rule.data() == a.data() || rule.data() == b.data();
}

/// Returns the number of bytes between a StreamRecord and the integers.
std::uint64_t box_size(const StreamRecord& record) {
    const bool is_boxed = record.normalised == static_cast<std::uint8_t>(Numbers::boxed);
    return is_boxed ? padded(std::uint64_t{record.components} * sizeof(StreamBox)) : 0;
}

/// Simple enough for compilers to vectorise.
template <class T>
std::uint32_t largest_of(const StreamView& stream) {
    T largest = 0;
    for (const T number : stream.as<T>()) largest = std::max(largest, number);
    return largest;
}

/// Returns the largest index of a stream of kBones or kIndices: u8, u16 or u32.
std::uint32_t largest_index(const StreamView& stream) {
    if (stream.type == ComponentType::u8) return largest_of<std::uint8_t>(stream);
    if (stream.type == ComponentType::u16) return largest_of<std::uint16_t>(stream);
    return largest_of<std::uint32_t>(stream);
}

class MeshReader {
public:
    MeshReader(const ChunkTree& tree, Faults& faults) : tree_(tree), faults_(faults) {}

    /// Reads the stream in leaf `number`; returns nothing, and adds a fault, if it does not match `rule` and the
    /// counts.
    std::optional<StreamView> stream(std::uint32_t number, StreamRule rule, std::optional<std::uint32_t> elements) {
        const Chunk& chunk = tree_[number];
        if (chunk.is_container()) return std::nullopt;
        const Result<StreamRecord> record = read_record<StreamRecord>(tree_, number);
        if (!record) return fault(record.error());
        if (!check_enum(record->component_type, kComponentTypes, chunk.offset, faults_)) return std::nullopt;
        if (!check_enum(record->normalised, kNumbers, chunk.offset, faults_)) return std::nullopt;
        check_reserved(std::array{record->reserved}, chunk.offset, faults_);
        const auto type = static_cast<ComponentType>(record->component_type);
        if (!takes(rule, *record)) return fault({ErrorCode::kStreamType, chunk.offset});
        if (record->set != 0 && !is_one_of(rule, forms::kCoords, forms::kColour))
            return fault({ErrorCode::kStreamSet, chunk.offset, record->set});
        if (elements && record->elements != *elements) {
            return fault({ErrorCode::kStreamCount, chunk.offset, record->elements, *elements});
        }
        // 2^32 elements of 2^16 components of 2^2 bytes: no overflow in 64 bits.
        const std::uint64_t size = std::uint64_t{record->elements} * record->components * component_size(type);
        const std::uint64_t before = sizeof(StreamRecord) + box_size(*record);
        const Bytes payload = tree_.payload(number);
        if (payload.size() != before + size)
            return fault({ErrorCode::kRecordSize, chunk.offset, payload.size(), before + size});
        StreamView view{type,
                        record->normalised == static_cast<std::uint8_t>(Numbers::normalised),
                        record->components,
                        record->elements,
                        record->set,
                        payload.subspan(before),
                        number};
        if (before != sizeof(StreamRecord)) {
            view.boxes = view_at<StreamBox>(payload, sizeof(StreamRecord), record->components);
            check_gap(payload.subspan(sizeof(StreamRecord) + view.boxes.size_bytes(),
                                      before - sizeof(StreamRecord) - view.boxes.size_bytes()),
                      chunk.offset);
        }
        view.is_octahedral = view.normalised && is_one_of(rule, forms::kNormals, forms::kTangents);
        if (record->normalised == static_cast<std::uint8_t>(Numbers::listed)) {
            if (is_list_lost_) return std::nullopt;  // already reported
            view.list = list_;
            const std::uint32_t largest = view.empty() ? 0 : largest_of<std::uint8_t>(view);
            if (!view.empty() && largest >= list_.size())
                return fault({ErrorCode::kIndexRange, chunk.offset, largest, list_.size()});
        }
        return view;
    }

    /// Checks that padding inside a payload is zero.
    void check_gap(Bytes gap, std::uint64_t offset) {
        const auto used = std::find_if(gap.begin(), gap.end(), [](std::byte b) { return b != std::byte{0}; });
        if (used != gap.end()) faults_.add({ErrorCode::kReservedField, offset, std::to_integer<std::uint64_t>(*used)});
    }

    /// Reads the only stream with this id among a container's children, if there is one.
    std::optional<StreamView> find(std::uint32_t container, FourCC id, StreamRule rule,
                                   std::optional<std::uint32_t> elements) {
        const std::uint32_t number = tree_.find(container, id);
        return number == kNone ? std::nullopt : stream(number, rule, elements);
    }

    std::optional<StreamView> fault(const Error& error) {
        faults_.add(error);
        return std::nullopt;
    }

    /// Checks that the sets of a kind are different.
    void check_sets(std::span<const StreamView> streams) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> sets;  // with their chunks
        for (const StreamView& stream : streams) sets.emplace_back(stream.set, stream.chunk);
        std::sort(sets.begin(), sets.end());
        for (std::size_t k = 1; k < sets.size(); ++k) {
            if (sets[k].first != sets[k - 1].first) continue;
            faults_.add({ErrorCode::kStreamSet, tree_[sets[k].second].offset, sets[k].first});
        }
    }

    /// Checks that every index of the stream is below `limit`.
    void check_indices(const std::optional<StreamView>& stream, std::uint64_t limit, ErrorCode code) {
        if (!stream) return;
        const std::uint32_t largest = largest_index(*stream);
        if (!stream->empty() && largest >= limit) faults_.add({code, tree_[stream->chunk].offset, largest, limit});
    }

    std::optional<PaletteView> palette(std::uint32_t number, std::uint32_t joints) {
        const Chunk& chunk = tree_[number];
        const Result<PaletteRecord> record = read_record<PaletteRecord>(tree_, number);
        if (!record) {
            faults_.add(record.error());
            return std::nullopt;
        }
        check_reserved(record->reserved, chunk.offset, faults_);
        if (!check_enum(record->derived, 2, chunk.offset, faults_)) return std::nullopt;
        const std::uint32_t matrices = record->derived == 0 ? record->entries : 1;
        const std::uint64_t matrices_at =
            sizeof(PaletteRecord) + padded(std::uint64_t{record->entries} * sizeof(std::uint32_t));
        const std::uint64_t size = matrices_at + std::uint64_t{matrices} * sizeof(glm::mat4);
        const Bytes payload = tree_.payload(number);
        if (size != payload.size()) {
            faults_.add({ErrorCode::kRecordSize, chunk.offset, payload.size(), size});
            return std::nullopt;
        }
        const std::uint64_t joints_end = sizeof(PaletteRecord) + std::uint64_t{record->entries} * sizeof(std::uint32_t);
        check_gap(payload.subspan(joints_end, matrices_at - joints_end), chunk.offset);
        PaletteView palette{view_at<std::uint32_t>(payload, sizeof(PaletteRecord), record->entries),
                            view_at<glm::mat4>(payload, matrices_at, matrices),
                            false,
                            {},
                            number};
        palette.is_derived = record->derived != 0;
        for (const std::uint32_t joint : palette.joints) {
            if (joint < joints) continue;
            faults_.add({ErrorCode::kJointRange, chunk.offset, joint, joints});
            return std::nullopt;
        }
        return palette;
    }

    /// Reads NLST, the list that listed normals are indices into; before these.
    void list_of_normals(std::uint32_t mesh) {
        const std::uint32_t number = tree_.find(mesh, FourCC("NLST"));
        const auto payload = rows(number, sizeof(glm::vec3));
        if (payload) list_ = view_at<glm::vec3>(*payload, 0, payload->size() / sizeof(glm::vec3));
        is_list_lost_ = number != kNone && !payload;
    }

    /// Reads a leaf that consists of rows of `size` bytes.
    std::optional<Bytes> rows(std::uint32_t number, std::uint64_t size) {
        if (number == kNone || tree_[number].is_container()) return std::nullopt;
        if (const auto encoding = tree_.encoding_fault(number)) {
            faults_.add(*encoding);
            return std::nullopt;
        }
        const Bytes payload = tree_.payload(number);
        if (payload.size() % size == 0) return payload;
        faults_.add({ErrorCode::kRecordSize, tree_[number].offset, payload.size(), payload.size() / size * size});
        return std::nullopt;
    }

    /// Reads FRMS: all frames, after the mesh's other targets.
    void frames(std::uint32_t block, MeshView& mesh) {
        const std::uint32_t grid_chunk = tree_.find(block, FourCC("GRID"));
        const auto grid = rows(grid_chunk, kAxes * sizeof(StreamBox));
        for (const FourCC id : {FourCC("INDX"), FourCC("POSI")}) {
            if (tree_.find(block, id) == kNone) faults_.add({ErrorCode::kChunkMissing, tree_[block].offset, id.value});
        }
        const auto places = find(block, FourCC("INDX"), forms::kPlaces, mesh.vertices);
        const auto positions = find(block, FourCC("POSI"), forms::kFramePositions, std::nullopt);
        if (grid && grid->empty()) {
            fault({ErrorCode::kRecordTooShort, tree_[grid_chunk].offset, 0, kAxes * sizeof(StreamBox)});
            return;
        }
        if (!grid || !places || !positions) return;
        const std::uint64_t count = grid->size() / (kAxes * sizeof(StreamBox));
        const std::uint64_t each = positions->elements / count;
        if (positions->elements != each * count) {
            fault({ErrorCode::kStreamCount, tree_[positions->chunk].offset, positions->elements, each * count});
            return;
        }
        const auto normals = find(block, FourCC("NORM"), forms::kFrameNormals, positions->elements);
        if (!normals && tree_.find(block, FourCC("NORM")) != kNone) return;
        const std::size_t faults_before = faults_.count();
        check_indices(places, each, ErrorCode::kIndexRange);
        std::vector<std::string_view> names = frame_names(block, count);
        if (faults_.count() != faults_before) return;
        mesh.targets.reserve(mesh.targets.size() + count);
        const auto boxes = view_at<StreamBox>(*grid, 0, count * kAxes);
        for (std::uint64_t frame = 0; frame < count; ++frame) {
            MorphTargetView& target = mesh.targets.emplace_back();
            target.chunk = block;
            if (!names.empty()) target.name = names[frame];
            target.places = places;
            target.positions = part_of(*positions, frame, each);
            target.positions->boxes = boxes.subspan(frame * kAxes, kAxes);
            if (normals) target.normals = part_of(*normals, frame, each);
        }
    }

    MorphTargetView target(std::uint32_t number, std::uint32_t vertices) {
        MorphTargetView target;
        target.chunk = number;
        target.name = read_text(tree_, number, FourCC("NAME"), faults_);
        target.rest_weight = read_child_record<MorphTargetRecord>(tree_, number, FourCC("TINF"), faults_)
                                 .value_or(MorphTargetRecord{})
                                 .rest_weight;
        std::uint32_t touched = vertices;
        const std::uint32_t index_chunk = tree_.find(number, FourCC("INDX"));
        if (index_chunk != kNone) {
            target.vertices = stream(index_chunk, forms::kIndices, std::nullopt);
            if (!target.vertices) return target;
            touched = target.vertices->elements;
            check_indices(target.vertices, vertices, ErrorCode::kIndexRange);
            for (std::uint32_t e = 1; e < touched; ++e) {
                if (target.vertices->index(e, 0) > target.vertices->index(e - 1, 0)) continue;
                faults_.add({ErrorCode::kTargetOrder, tree_[index_chunk].offset, e});
                break;
            }
        }
        target.positions = find(number, FourCC("POSI"), forms::kShifts, touched);
        target.normals = find(number, FourCC("NORM"), forms::kShifts, touched);
        target.tangents = find(number, FourCC("TANG"), forms::kShifts, touched);
        return target;
    }

private:
    static constexpr std::uint64_t kAxes = 3;

    /// Returns part `number` of a stream that is split into parts of `size` elements.
    static StreamView part_of(const StreamView& stream, std::uint64_t number, std::uint64_t size) {
        StreamView part = stream;
        const std::uint64_t bytes = size * stream.components * component_size(stream.type);
        part.elements = static_cast<std::uint32_t>(size);
        part.data = stream.data.subspan(number * bytes, bytes);
        return part;
    }

    /// Reads FNAM: one name per frame, each followed by a zero. Empty: there is none.
    std::vector<std::string_view> frame_names(std::uint32_t container, std::uint64_t count) {
        std::vector<std::string_view> names;
        const std::uint32_t chunk = tree_.find(container, FourCC("FNAM"));
        if (chunk == kNone || tree_[chunk].is_container()) return names;
        const std::size_t faults_before = faults_.count();
        std::string_view text = read_text(tree_, container, FourCC("FNAM"), faults_);
        if (faults_.count() != faults_before) return names;
        names.reserve(count);
        std::uint64_t named = 0;
        for (std::size_t end = text.find('\0'); end != std::string_view::npos; end = text.find('\0')) {
            if (named++ < count) names.push_back(text.substr(0, end));
            text.remove_prefix(end + 1);
        }
        if (named != count || !text.empty())
            faults_.add({ErrorCode::kCountMismatch, tree_[chunk].offset, named, count});
        return names;
    }

    const ChunkTree& tree_;
    Faults& faults_;
    std::span<const glm::vec3> list_;  // of the mesh's normals
    bool is_list_lost_ = false;        // it exists but cannot be read
};

void check_stream_values(const ChunkTree& tree, const std::optional<StreamView>& stream, Faults& faults) {
    if (!stream) return;
    const std::uint64_t offset = tree[stream->chunk].offset;
    if (stream->type == ComponentType::f32) check_finite(stream->as<float>(), offset, faults);
    const float most_steps = stream->type == ComponentType::u32 ? 4294967296.0f : 65536.0f;
    for (const StreamBox& box : stream->boxes)  // the largest value must be finite, too
        check_finite(std::array{box.minimum, box.step, box.minimum + most_steps * box.step}, offset, faults);
}

/// Checks each row of GRID separately, so that the fault identifies the frame.
void check_frame_boxes(const MorphTargetView& frame, std::uint64_t offset, Faults& faults) {
    for (const StreamBox& box : frame.positions->boxes)
        check_finite(std::array{box.minimum, box.step, box.minimum + 65536.0f * box.step}, offset, faults);
}

}  // namespace

MeshView read_mesh(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t joints, Faults& faults) {
    MeshReader reader(tree, faults);
    MeshView mesh;
    mesh.chunk = chunk;
    mesh.name = read_text(tree, chunk, FourCC("NAME"), faults);
    mesh.extras = read_text(tree, chunk, FourCC("EXTR"), faults);
    mesh.more = read_text(tree, chunk, FourCC("MORE"), faults);
    const std::uint64_t offset = tree[chunk].offset;
    const auto record = read_child_record<MeshRecord>(tree, chunk, FourCC("VINF"), faults);
    if (!record) return mesh;
    mesh.has_info = true;
    mesh.vertices = record->vertices;
    mesh.joint = record->joint;
    if (mesh.joint != kNone && mesh.joint >= joints) {
        faults.add({ErrorCode::kJointRange, offset_of(tree, chunk, FourCC("VINF")), mesh.joint, joints});
        mesh.joint = kNone;
    }

    reader.list_of_normals(chunk);
    for (const std::uint32_t number : tree.children(chunk)) {
        const FourCC id = tree[number].id;
        if (id == FourCC("TEXC")) {
            const auto coords = reader.stream(number, forms::kCoords, mesh.vertices);
            if (coords) mesh.texture_coords.push_back(*coords);
        } else if (id == FourCC("COLR")) {
            const auto colour = reader.stream(number, forms::kColour, mesh.vertices);
            if (colour) mesh.colours.push_back(*colour);
        } else if (id == FourCC("USER")) {
            const auto values = reader.find(number, FourCC("VALS"), forms::kAnything, mesh.vertices);
            if (values) mesh.attributes.push_back({read_text(tree, number, FourCC("NAME"), faults), *values});
        } else if (id == FourCC("TARG")) {
            mesh.targets.push_back(reader.target(number, mesh.vertices));
        }
    }

    mesh.first_frame = static_cast<std::uint32_t>(mesh.targets.size());

    reader.check_sets(mesh.texture_coords);
    reader.check_sets(mesh.colours);

    const auto positions = reader.find(chunk, FourCC("POSI"), forms::kPositions, mesh.vertices);
    if (positions) {
        mesh.positions = *positions;
    } else if (mesh.vertices != 0 && tree.find(chunk, FourCC("POSI")) == kNone) {
        faults.add({ErrorCode::kChunkMissing, offset, FourCC("POSI").value});
    }
    mesh.normals = reader.find(chunk, FourCC("NORM"), forms::kNormals, mesh.vertices);
    if (const std::uint32_t frames = tree.find(chunk, FourCC("FRMS")); frames != kNone && tree[frames].is_container())
        reader.frames(frames, mesh);
    mesh.tangents = reader.find(chunk, FourCC("TANG"), forms::kTangents, mesh.vertices);

    mesh.bones = reader.find(chunk, FourCC("BONE"), forms::kBones, mesh.vertices);
    mesh.weights = reader.find(chunk, FourCC("WGHT"), forms::kWeights, mesh.vertices);
    const std::uint32_t palette_chunk = tree.find(chunk, FourCC("PALT"));
    const bool has_palette = palette_chunk != kNone;
    std::optional<PaletteView> palette;
    if (has_palette && !tree[palette_chunk].is_container()) palette = reader.palette(palette_chunk, joints);
    if (palette) mesh.palette = *palette;
    const bool has_bones = tree.find(chunk, FourCC("BONE")) != kNone;
    const bool has_weights = tree.find(chunk, FourCC("WGHT")) != kNone;
    if (has_bones != has_weights || has_bones != has_palette ||
        (mesh.bones && mesh.weights && mesh.bones->components != mesh.weights->components)) {
        faults.add({ErrorCode::kStreamIncomplete, offset});
        palette.reset();
    }
    if (!mesh.bones || !mesh.weights || !palette) {  // a rigid mesh, or one with a fault
        mesh.bones.reset();
        mesh.weights.reset();
    }
    if (mesh.bones) reader.check_indices(mesh.bones, mesh.palette.joints.size(), ErrorCode::kBoneRange);

    mesh.indices = reader.find(chunk, FourCC("INDX"), forms::kIndices, std::nullopt);
    reader.check_indices(mesh.indices, mesh.vertices, ErrorCode::kIndexRange);
    return mesh;
}

std::vector<std::uint32_t> source_order(const MeshView& mesh) {
    constexpr unsigned kUnsigned = any_of(ComponentType::u8, ComponentType::u16, ComponentType::u32);
    std::vector<std::uint32_t> order;
    for (const auto& [name, numbers] : mesh.attributes) {
        const bool is_plain = !numbers.normalised && (kUnsigned >> static_cast<unsigned>(numbers.type) & 1u) != 0;
        if (name != kSourceVertex || numbers.components != 1 || !is_plain) continue;
        order.resize(mesh.vertices);
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&, &stream = numbers](std::uint32_t a, std::uint32_t b) {
            return stream.index(a, 0) < stream.index(b, 0);
        });
        break;
    }
    return order;
}

void check_mesh_values(const ChunkTree& tree, const MeshView& mesh, Faults& faults) {
    for (const auto& stream : {std::optional(mesh.positions), mesh.normals, mesh.tangents, mesh.weights})
        check_stream_values(tree, stream, faults);
    for (const StreamView& stream : mesh.texture_coords) check_stream_values(tree, stream, faults);
    for (const StreamView& stream : mesh.colours) check_stream_values(tree, stream, faults);
    for (const AttributeView& attribute : mesh.attributes) check_stream_values(tree, attribute.values, faults);
    for (const MorphTargetView& target : mesh.targets) {
        check_finite(std::array{target.rest_weight}, offset_of(tree, target.chunk, FourCC("TINF")), faults);
        if (target.is_frame()) {
            check_frame_boxes(target, offset_of(tree, target.chunk, FourCC("GRID")), faults);
            continue;  // its normals are from NLST, or directions
        }
        for (const auto& stream : {target.positions, target.normals, target.tangents})
            check_stream_values(tree, stream, faults);
    }
    if (const std::uint32_t list = tree.find(mesh.chunk, FourCC("NLST")); list != kNone && !tree[list].is_container()) {
        const Bytes payload = tree.payload(list);
        check_finite(view_at<float>(payload, 0, payload.size() / sizeof(float)), tree[list].offset, faults);
    }
    for (const glm::mat4& matrix : mesh.palette.inverse_bind())
        check_finite(std::span(&matrix[0][0], 16), tree[mesh.palette.chunk].offset, faults);

    if (!mesh.weights) return;
    const StreamView& weights = *mesh.weights;
    for (std::uint32_t vertex = 0; vertex < weights.elements; ++vertex) {
        double sum = 0.0;
        bool is_negative = false;
        for (std::uint32_t k = 0; k < weights.components; ++k) {
            const float weight = weights.number(vertex, k);
            is_negative = is_negative || weight < 0.0f;
            sum += weight;
        }
        if (is_negative) {
            faults.add({ErrorCode::kWeightRange, tree[weights.chunk].offset, vertex});
            return;
        }
        if (!(std::abs(sum - 1.0) <= kWeightTolerance)) {
            faults.add({ErrorCode::kWeightSum, tree[weights.chunk].offset, vertex});
            return;
        }
    }
}

}  // namespace bendy
