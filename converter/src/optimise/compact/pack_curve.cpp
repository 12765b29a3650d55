#include "optimise/compact/pack_curve.h"

#include "optimise/compact/leaf_writer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bendy::converter {
namespace {

constexpr double kMostSteps = 0.51;  // of error

/// The size of the payload in memory plus its size in the file.
std::uint64_t curve_cost(Bytes payload) {
    constexpr LeafShape kFloats{0, 0, sizeof(float), false};
    const EncodedLeaf encoded = encode_leaf(payload, kFloats);
    return payload.size() + (encoded.codec == Codec::raw ? payload.size() : encoded.bytes.size());
}

std::vector<float> curve_box(const Curve& curve) {
    std::vector<float> box(curve.values.begin(), curve.values.begin() + curve.components);
    box.insert(box.end(), curve.values.begin(), curve.values.begin() + curve.components);
    for (std::size_t i = curve.components; i < curve.values.size(); ++i) {
        float& low = box[i % curve.components];
        float& high = box[curve.components + i % curve.components];
        low = std::min(low, curve.values[i]);
        high = std::max(high, curve.values[i]);
    }
    return box;
}

bool is_whole_number(float value) {
    return value == std::floor(value);
}

}  // namespace

CurveView view_of(const Curve& curve) {
    CurveView view;
    view.name = curve.name;
    view.path = curve.path;
    view.kind = curve.kind;
    view.target = curve.target;
    view.components = curve.components;
    view.interpolation = curve.interpolation;
    view.keys = static_cast<std::uint32_t>(curve.times.size());
    view.times = curve.times;
    view.values = curve.values;
    return view;
}

CurveView PackedCurve::view(const Curve& curve) const {
    CurveView packed = view_of(curve);
    packed.values = {};
    packed.packed = values;
    packed.box = box;
    packed.max_error = max_error;
    return packed;
}

std::optional<PackedCurve> pack_curve(const Curve& curve) {
    if (curve.interpolation == Interpolation::cubic) return std::nullopt;
    PackedCurve packed;
    packed.box = curve_box(curve);
    packed.values.reserve(curve.values.size());
    const auto range_of = [&](std::size_t index) {
        const std::size_t component = index % curve.components;
        return double{packed.box[curve.components + component]} - packed.box[component];
    };
    for (std::size_t i = 0; i < curve.values.size(); ++i) {
        const double range = range_of(i);
        const double share = range > 0.0 ? (double{curve.values[i]} - packed.box[i % curve.components]) / range : 0.0;
        packed.values.push_back(static_cast<std::uint16_t>(std::lround(share * kPackedCurveSteps)));
    }
    const CurveView view = packed.view(curve);
    double largest = 0.0;
    for (std::size_t i = 0; i < curve.values.size(); ++i) {
        const double error = std::abs(double{view.value(i)} - curve.values[i]);
        if (error > kMostSteps * range_of(i) / kPackedCurveSteps) return std::nullopt;
        largest = std::max(largest, error);
        if (error > 0.0) packed.share = std::max(packed.share, error / range_of(i));
    }
    if (largest > 0.0 && std::all_of(curve.values.begin(), curve.values.end(), is_whole_number)) return std::nullopt;
    packed.max_error = static_cast<float>(largest);
    if (double{packed.max_error} < largest) packed.max_error = std::nextafter(packed.max_error, INFINITY);
    if (curve_cost(write_curve(packed.view(curve))) >= curve_cost(write_curve(view_of(curve)))) return std::nullopt;
    return packed;
}

}  // namespace bendy::converter
