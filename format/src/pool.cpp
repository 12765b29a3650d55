#include <bendy/format/pool.h>

#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <cassert>
#include <initializer_list>
#include <utility>

namespace bendy {
namespace {

template <class T>
T load(Bytes data, std::uint64_t at) {
    T value{};
    copy_at(data, at * sizeof(T), value);
    return value;
}

/// The types and element widths that a kind of stream may have.
struct StreamRule {
    std::initializer_list<ComponentType> types;
    std::uint32_t fewest_components;
    std::uint32_t most_components;
};

const StreamRule kVec3{{ComponentType::f32}, 3, 3};
const StreamRule kVec4{{ComponentType::f32}, 4, 4};
const StreamRule kCoords{{ComponentType::f32, ComponentType::u8, ComponentType::u16}, 2, 2};
const StreamRule kColour{{ComponentType::f32, ComponentType::u8, ComponentType::u16}, 3, 4};
const StreamRule kBones{{ComponentType::u8, ComponentType::u16}, 1, kMaxInfluences};
const StreamRule kWeights{{ComponentType::f32, ComponentType::u8, ComponentType::u16}, 1, kMaxInfluences};
const StreamRule kIndices{{ComponentType::u16, ComponentType::u32}, 1, 1};
const StreamRule kAnything{{ComponentType::u8, ComponentType::i8, ComponentType::u16, ComponentType::i16,
                            ComponentType::u32, ComponentType::f32},
                           1,
                           0xffff};

/// Integer streams that stand for numbers are normalised; bones and indices are not; floats cannot be.
bool normalisation_fits(const StreamRecord& record, const StreamRule& rule) {
    const auto type = static_cast<ComponentType>(record.component_type);
    const bool may_be =
        type != ComponentType::f32 && type != ComponentType::u32 && &rule != &kBones && &rule != &kIndices;
    const bool must_be = may_be && &rule != &kAnything;
    return record.normalised == 1 ? may_be : !must_be;
}

class PoolReader {
public:
    PoolReader(const ChunkTree& tree, Faults& faults) : tree_(tree), faults_(faults) {}

    /// The stream in leaf `number`; nothing, and a fault, if it is not as `rule` and the counts have it.
    std::optional<StreamView> stream(std::uint32_t number, const StreamRule& rule,
                                     std::optional<std::uint32_t> elements) {
        const Chunk& chunk = tree_[number];
        if (chunk.is_container()) return std::nullopt;
        const Result<StreamRecord> record = read_record<StreamRecord>(tree_, number);
        if (!record) return fault(record.error());
        if (!check_enum(record->component_type, kComponentTypes, chunk.offset, faults_)) return std::nullopt;
        if (!check_enum(record->normalised, 2, chunk.offset, faults_)) return std::nullopt;
        check_reserved(std::array{record->reserved}, chunk.offset, faults_);
        const auto type = static_cast<ComponentType>(record->component_type);
        if (std::find(rule.types.begin(), rule.types.end(), type) == rule.types.end() ||
            record->components < rule.fewest_components || record->components > rule.most_components ||
            !normalisation_fits(*record, rule)) {
            return fault({ErrorCode::kStreamType, chunk.offset});
        }
        if (record->set != 0 && &rule != &kCoords && &rule != &kColour)
            return fault({ErrorCode::kStreamSet, chunk.offset, record->set});
        if (elements && record->elements != *elements) {
            return fault({ErrorCode::kStreamCount, chunk.offset, record->elements, *elements});
        }
        // 2^32 elements of 2^16 components of 2^2 bytes: no overflow in 64 bits.
        const std::uint64_t size = std::uint64_t{record->elements} * record->components * component_size(type);
        const Bytes data = tree_.payload(number).subspan(sizeof(StreamRecord));
        if (data.size() != size)
            return fault(
                {ErrorCode::kRecordSize, chunk.offset, tree_.payload(number).size(), size + sizeof(StreamRecord)});
        return StreamView{type,  record->normalised != 0, record->components, record->elements, record->set, data,
                          number};
    }

    /// The one stream with this id among a container's children, if it is there.
    std::optional<StreamView> find(std::uint32_t container, FourCC id, const StreamRule& rule,
                                   std::optional<std::uint32_t> elements) {
        const std::uint32_t number = tree_.find(container, id);
        return number == kNone ? std::nullopt : stream(number, rule, elements);
    }

    std::optional<StreamView> fault(const Error& error) {
        faults_.add(error);
        return std::nullopt;
    }

    /// The sets of a kind must differ.
    void check_sets(std::span<const StreamView> streams) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> sets;  // with their chunks
        for (const StreamView& stream : streams) sets.emplace_back(stream.set, stream.chunk);
        std::sort(sets.begin(), sets.end());
        for (std::size_t k = 1; k < sets.size(); ++k) {
            if (sets[k].first != sets[k - 1].first) continue;
            faults_.add({ErrorCode::kStreamSet, tree_[sets[k].second].offset, sets[k].first});
        }
    }

    /// Every index of the stream must be below `limit`.
    void check_indices(const std::optional<StreamView>& stream, std::uint64_t limit, ErrorCode code) {
        if (!stream) return;
        std::uint32_t largest = 0;
        for (std::uint32_t e = 0; e < stream->elements; ++e) {
            for (std::uint32_t c = 0; c < stream->components; ++c) largest = std::max(largest, stream->index(e, c));
        }
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
        const std::uint64_t matrices_at =
            sizeof(PaletteRecord) + padded(std::uint64_t{record->entries} * sizeof(std::uint32_t));
        const std::uint64_t size = matrices_at + std::uint64_t{record->entries} * sizeof(glm::mat4);
        const Bytes payload = tree_.payload(number);
        if (size != payload.size()) {
            faults_.add({ErrorCode::kRecordSize, chunk.offset, payload.size(), size});
            return std::nullopt;
        }
        const std::uint64_t joints_end = sizeof(PaletteRecord) + std::uint64_t{record->entries} * sizeof(std::uint32_t);
        for (const std::byte gap : payload.subspan(joints_end, matrices_at - joints_end)) {
            if (gap == std::byte{0}) continue;
            faults_.add({ErrorCode::kReservedField, chunk.offset, std::to_integer<std::uint64_t>(gap)});
            break;
        }
        PaletteView palette{view_at<std::uint32_t>(payload, sizeof(PaletteRecord), record->entries),
                            view_at<glm::mat4>(payload, matrices_at, record->entries)};
        for (const std::uint32_t joint : palette.joints) {
            if (joint < joints) continue;
            faults_.add({ErrorCode::kJointRange, chunk.offset, joint, joints});
            return std::nullopt;
        }
        return palette;
    }

    TargetView target(std::uint32_t number, std::uint32_t vertices) {
        TargetView target;
        target.name = read_text(tree_, number, FourCC("NAME"), faults_);
        target.rest_weight = read_child_record<TargetRecord>(tree_, number, FourCC("TINF"), faults_)
                                 .value_or(TargetRecord{})
                                 .rest_weight;
        std::uint32_t touched = vertices;
        const std::uint32_t index_chunk = tree_.find(number, FourCC("INDX"));
        if (index_chunk != kNone) {
            target.vertices = stream(index_chunk, kIndices, std::nullopt);
            if (!target.vertices) return target;
            touched = target.vertices->elements;
            check_indices(target.vertices, vertices, ErrorCode::kIndexRange);
            for (std::uint32_t e = 1; e < touched; ++e) {
                if (target.vertices->index(e, 0) > target.vertices->index(e - 1, 0)) continue;
                faults_.add({ErrorCode::kTargetOrder, tree_[index_chunk].offset, e});
                break;
            }
        }
        target.positions = find(number, FourCC("POSI"), kVec3, touched);
        target.normals = find(number, FourCC("NORM"), kVec3, touched);
        target.tangents = find(number, FourCC("TANG"), kVec3, touched);
        return target;
    }

private:
    const ChunkTree& tree_;
    Faults& faults_;
};

void check_stream_values(const ChunkTree& tree, const std::optional<StreamView>& stream, Faults& faults) {
    if (stream && stream->type == ComponentType::f32)
        check_finite(stream->as<float>(), tree[stream->chunk].offset, faults);
}

}  // namespace

float StreamView::number(std::uint32_t element, std::uint32_t component) const {
    assert(element < elements && component < components);
    const std::uint64_t at = std::uint64_t{element} * components + component;
    const auto scaled = [this](auto value, float largest) {
        const auto number = static_cast<float>(value);
        return normalised ? std::max(number / largest, -1.0f) : number;
    };
    switch (type) {
        case ComponentType::u8:
            return scaled(load<std::uint8_t>(data, at), 255.0f);
        case ComponentType::i8:
            return scaled(load<std::int8_t>(data, at), 127.0f);
        case ComponentType::u16:
            return scaled(load<std::uint16_t>(data, at), 65535.0f);
        case ComponentType::i16:
            return scaled(load<std::int16_t>(data, at), 32767.0f);
        case ComponentType::u32:
            return static_cast<float>(load<std::uint32_t>(data, at));
        case ComponentType::f32:
            return load<float>(data, at);
    }
    return 0.0f;
}

std::uint32_t StreamView::index(std::uint32_t element, std::uint32_t component) const {
    assert(element < elements && component < components);
    const std::uint64_t at = std::uint64_t{element} * components + component;
    switch (type) {
        case ComponentType::u8:
            return load<std::uint8_t>(data, at);
        case ComponentType::u16:
            return load<std::uint16_t>(data, at);
        case ComponentType::u32:
            return load<std::uint32_t>(data, at);
        default:
            return 0;
    }
}

PoolView read_pool(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t joints, Faults& faults) {
    PoolReader reader(tree, faults);
    PoolView pool;
    pool.chunk = chunk;
    pool.name = read_text(tree, chunk, FourCC("NAME"), faults);
    pool.extras = read_text(tree, chunk, FourCC("EXTR"), faults);
    const std::uint64_t offset = tree[chunk].offset;
    const auto record = read_child_record<PoolRecord>(tree, chunk, FourCC("VINF"), faults);
    if (!record) return pool;
    pool.vertices = record->vertices;
    pool.joint = record->joint;
    if (pool.joint != kNone && pool.joint >= joints) {
        faults.add({ErrorCode::kJointRange, offset_of(tree, chunk, FourCC("VINF")), pool.joint, joints});
        pool.joint = kNone;
    }

    for (const std::uint32_t number : tree.children(chunk)) {
        const FourCC id = tree[number].id;
        if (id == FourCC("TEXC")) {
            const auto coords = reader.stream(number, kCoords, pool.vertices);
            if (coords) pool.texture_coords.push_back(*coords);
        } else if (id == FourCC("COLR")) {
            const auto colour = reader.stream(number, kColour, pool.vertices);
            if (colour) pool.colours.push_back(*colour);
        } else if (id == FourCC("USER")) {
            const auto values = reader.find(number, FourCC("VALS"), kAnything, pool.vertices);
            if (values) pool.attributes.push_back({read_text(tree, number, FourCC("NAME"), faults), *values});
        } else if (id == FourCC("TARG")) {
            pool.targets.push_back(reader.target(number, pool.vertices));
        }
    }

    reader.check_sets(pool.texture_coords);
    reader.check_sets(pool.colours);

    const auto positions = reader.find(chunk, FourCC("POSI"), kVec3, pool.vertices);
    if (positions) {
        pool.positions = *positions;
    } else if (pool.vertices != 0 && tree.find(chunk, FourCC("POSI")) == kNone) {
        faults.add({ErrorCode::kChunkMissing, offset, FourCC("POSI").value});
    }
    pool.normals = reader.find(chunk, FourCC("NORM"), kVec3, pool.vertices);
    pool.tangents = reader.find(chunk, FourCC("TANG"), kVec4, pool.vertices);

    pool.bones = reader.find(chunk, FourCC("BONE"), kBones, pool.vertices);
    pool.weights = reader.find(chunk, FourCC("WGHT"), kWeights, pool.vertices);
    const std::uint32_t palette_chunk = tree.find(chunk, FourCC("PALT"));
    const bool has_palette = palette_chunk != kNone;
    std::optional<PaletteView> palette;
    if (has_palette && !tree[palette_chunk].is_container()) palette = reader.palette(palette_chunk, joints);
    if (palette) pool.palette = *palette;
    const bool has_bones = tree.find(chunk, FourCC("BONE")) != kNone;
    const bool has_weights = tree.find(chunk, FourCC("WGHT")) != kNone;
    if (has_bones != has_weights || has_bones != has_palette ||
        (pool.bones && pool.weights && pool.bones->components != pool.weights->components)) {
        faults.add({ErrorCode::kStreamIncomplete, offset});
        palette.reset();
    }
    if (!pool.bones || !pool.weights || !palette) {  // a rigid pool, or one with a fault
        pool.bones.reset();
        pool.weights.reset();
    }
    if (pool.bones) reader.check_indices(pool.bones, pool.palette.joints.size(), ErrorCode::kBoneRange);

    pool.indices = reader.find(chunk, FourCC("INDX"), kIndices, std::nullopt);
    reader.check_indices(pool.indices, pool.vertices, ErrorCode::kIndexRange);
    return pool;
}

void check_pool_values(const ChunkTree& tree, const PoolView& pool, Faults& faults) {
    const std::uint64_t offset = tree[pool.chunk].offset;
    for (const auto& stream : {std::optional(pool.positions), pool.normals, pool.tangents, pool.weights})
        check_stream_values(tree, stream, faults);
    for (const StreamView& stream : pool.texture_coords) check_stream_values(tree, stream, faults);
    for (const StreamView& stream : pool.colours) check_stream_values(tree, stream, faults);
    for (const AttributeView& attribute : pool.attributes) check_stream_values(tree, attribute.values, faults);
    for (const TargetView& target : pool.targets) {
        check_finite(std::array{target.rest_weight}, offset, faults);
        for (const auto& stream : {target.positions, target.normals, target.tangents})
            check_stream_values(tree, stream, faults);
    }
    for (const glm::mat4& matrix : pool.palette.inverse_bind)
        check_finite(std::span(&matrix[0][0], 16), offset, faults);

    if (!pool.weights) return;
    const StreamView& weights = *pool.weights;
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
