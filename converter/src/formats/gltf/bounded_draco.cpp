#include "bounded_draco.h"

#include <draco/attributes/geometry_attribute.h>
#include <draco/compression/attributes/points_sequencer.h>
#include <draco/compression/attributes/sequential_attribute_decoders_controller.h>
#include <draco/compression/attributes/sequential_integer_attribute_decoder.h>
#include <draco/compression/attributes/sequential_quantization_attribute_decoder.h>
#include <draco/compression/config/compression_shared.h>
#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <utility>

namespace bendy::converter::gltf {
namespace {

using Scheme = draco::PredictionSchemeTypedDecoderInterface<std::int32_t>;

/// Limits shared by the parts of a decoder.
struct Bounds {
    std::uint64_t values = 0;  ///< maximum over all attributes
    std::int64_t corners = 0;  ///< of the mesh
    bool is_exceeded = false;  ///< a limit was exceeded
};

/// Returns `holds`; if false, notes that a limit was exceeded.
bool check(Bounds& bounds, bool holds) {
    bounds.is_exceeded = bounds.is_exceeded || !holds;
    return holds;
}

/// Wraps a prediction scheme for texture coordinates. Its data begins with the number of orientations, at most one per
/// corner, which Draco 1.5.5 does not check: two billion of them take seven seconds.
class BoundedScheme : public Scheme {
public:
    BoundedScheme(std::unique_ptr<Scheme> scheme, Bounds& bounds) : scheme_(std::move(scheme)), bounds_(bounds) {}

    bool DecodePredictionData(draco::DecoderBuffer* buffer) override {
        draco::DecoderBuffer ahead = *buffer;
        std::uint32_t orientations = 0;
        const bool is_portable = GetPredictionMethod() == draco::MESH_PREDICTION_TEX_COORDS_PORTABLE;
        const bool is_read = is_portable ? ahead.Decode(&orientations) : draco::DecodeVarint(&orientations, &ahead);
        return is_read && check(bounds_, orientations <= bounds_.corners) && scheme_->DecodePredictionData(buffer);
    }
    bool ComputeOriginalValues(const std::int32_t* corrections, std::int32_t* values, int size, int components,
                               const draco::PointIndex* points) override {
        return scheme_->ComputeOriginalValues(corrections, values, size, components, points);
    }
    [[nodiscard]] draco::PredictionSchemeMethod GetPredictionMethod() const override {
        return scheme_->GetPredictionMethod();
    }
    [[nodiscard]] const draco::PointAttribute* GetAttribute() const override { return scheme_->GetAttribute(); }
    [[nodiscard]] bool IsInitialized() const override { return scheme_->IsInitialized(); }
    [[nodiscard]] int GetNumParentAttributes() const override { return scheme_->GetNumParentAttributes(); }
    [[nodiscard]] draco::GeometryAttribute::Type GetParentAttributeType(int i) const override {
        return scheme_->GetParentAttributeType(i);
    }
    bool SetParentAttribute(const draco::PointAttribute* attribute) override {
        return scheme_->SetParentAttribute(attribute);
    }
    bool AreCorrectionsPositive() override { return scheme_->AreCorrectionsPositive(); }
    [[nodiscard]] draco::PredictionSchemeTransformType GetTransformType() const override {
        return scheme_->GetTransformType();
    }

private:
    std::unique_ptr<Scheme> scheme_;
    Bounds& bounds_;
};

/// One of Draco's integer decoders, with bounded prediction schemes.
template <class Decoder>
class BoundedDecoder : public Decoder {
public:
    explicit BoundedDecoder(Bounds& bounds) : bounds_(bounds) {}

protected:
    std::unique_ptr<Scheme> CreateIntPredictionScheme(draco::PredictionSchemeMethod method,
                                                      draco::PredictionSchemeTransformType transform) override {
        std::unique_ptr<Scheme> scheme = Decoder::CreateIntPredictionScheme(method, transform);
        if (scheme == nullptr) return scheme;
        const draco::PredictionSchemeMethod made = scheme->GetPredictionMethod();
        if (made != draco::MESH_PREDICTION_TEX_COORDS_PORTABLE && made != draco::MESH_PREDICTION_TEX_COORDS_DEPRECATED)
            return scheme;
        return std::make_unique<BoundedScheme>(std::move(scheme), bounds_);
    }

private:
    Bounds& bounds_;
};

class BoundedController : public draco::SequentialAttributeDecodersController {
public:
    BoundedController(std::unique_ptr<draco::PointsSequencer> sequencer, Bounds& bounds)
        : SequentialAttributeDecodersController(std::move(sequencer)), bounds_(bounds) {}

protected:
    std::unique_ptr<draco::SequentialAttributeDecoder> CreateSequentialDecoder(std::uint8_t type) override {
        switch (type) {
            case draco::SEQUENTIAL_ATTRIBUTE_ENCODER_INTEGER:
                return std::make_unique<BoundedDecoder<draco::SequentialIntegerAttributeDecoder>>(bounds_);
            case draco::SEQUENTIAL_ATTRIBUTE_ENCODER_QUANTIZATION:
                return std::make_unique<BoundedDecoder<draco::SequentialQuantizationAttributeDecoder>>(bounds_);
            default:
                return SequentialAttributeDecodersController::CreateSequentialDecoder(type);
        }
    }

private:
    Bounds& bounds_;
};

using Sequencer = std::unique_ptr<draco::PointsSequencer>;
Sequencer& sequencer_of(draco::SequentialAttributeDecodersController& controller);

/// Gives sequencer_of access to a private member: explicit instantiation of templates bypasses access checks. Draco
/// creates the controller and the sequencer together, and offers no other way to replace only one.
template <Sequencer draco::SequentialAttributeDecodersController::*member>
struct SequencerOf {
    friend Sequencer& sequencer_of(draco::SequentialAttributeDecodersController& controller) {
        return controller.*member;
    }
};
template struct SequencerOf<&draco::SequentialAttributeDecodersController::sequencer_>;

std::uint64_t values_of(const draco::PointCloud& points) {
    std::uint64_t components = 0;
    for (std::int32_t i = 0; i < points.num_attributes(); ++i) components += points.attribute(i)->num_components();
    return components * points.num_points();
}

class BoundedEdgebreaker : public draco::MeshEdgebreakerDecoder {
public:
    explicit BoundedEdgebreaker(Bounds& bounds) : bounds_(bounds) {}

protected:
    bool CreateAttributesDecoder(std::int32_t number) override {
        if (!MeshEdgebreakerDecoder::CreateAttributesDecoder(number)) return false;
        // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): this decoder made it, and the interface hides that
        auto& made = const_cast<draco::AttributesDecoderInterface&>(*attributes_decoder(number));
        Sequencer sequencer = std::move(sequencer_of(static_cast<draco::SequentialAttributeDecodersController&>(made)));
        bounds_.corners = std::int64_t{3} * mesh()->num_faces();
        return SetAttributesDecoder(number, std::make_unique<BoundedController>(std::move(sequencer), bounds_));
    }
    bool DecodeAllAttributes() override {
        return check(bounds_, values_of(*point_cloud()) <= bounds_.values) &&
               MeshEdgebreakerDecoder::DecodeAllAttributes();
    }

private:
    Bounds& bounds_;
};

class BoundedSequential : public draco::MeshSequentialDecoder {
public:
    explicit BoundedSequential(Bounds& bounds) : bounds_(bounds) {}

protected:
    bool DecodeAllAttributes() override {
        return check(bounds_, values_of(*point_cloud()) <= bounds_.values) &&
               MeshSequentialDecoder::DecodeAllAttributes();
    }

private:
    Bounds& bounds_;
};

}  // namespace

draco::StatusOr<std::unique_ptr<draco::Mesh>> decode_draco_mesh(std::span<const std::byte> data, std::uint8_t method,
                                                                std::uint64_t most_values) {
    draco::DecoderOptions options;
    for (int type = 0; type < draco::GeometryAttribute::NAMED_ATTRIBUTES_COUNT; ++type)
        options.SetAttributeBool(static_cast<draco::GeometryAttribute::Type>(type), "skip_attribute_transform", true);
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(data.data()), data.size());
    auto mesh = std::make_unique<draco::Mesh>();
    Bounds bounds;
    bounds.values = most_values;
    const draco::Status status = method == draco::MESH_EDGEBREAKER_ENCODING
                                     ? BoundedEdgebreaker(bounds).Decode(options, &buffer, mesh.get())
                                     : BoundedSequential(bounds).Decode(options, &buffer, mesh.get());
    if (bounds.is_exceeded)
        return draco::Status(draco::Status::DRACO_ERROR, "a count goes beyond what the data describes");
    if (!status.ok()) return status;
    return mesh;
}

}  // namespace bendy::converter::gltf
