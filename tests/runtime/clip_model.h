#pragma once

#include "runtime/build_model.h"

#include <cstdint>
#include <string>
#include <vector>

// Clips for models that tests build: ModelSpec::more takes them.
namespace bendy::test {

/// Linear keys.
struct TrackSpec {
    TrackPath path = TrackPath::translation;
    std::uint32_t target = 0;
    std::uint16_t components = 3;
    std::vector<float> times;
    std::vector<float> values;
};

struct ClipSpec {
    std::string name;
    float start = 0.0f, end = 1.0f;
    bool loop = false;
    std::vector<TrackSpec> tracks = {};
};

inline Node clip_node(const ClipSpec& spec) {
    ClipRecord info;
    info.start = spec.start;
    info.end = spec.end;
    info.loop = spec.loop ? 1 : 0;
    std::vector<TrackRecord> records;
    std::vector<float> times;
    std::vector<float> values;
    for (const TrackSpec& made : spec.tracks) {
        records.push_back(track(made.target, made.path, Interpolation::linear, made.components,
                                static_cast<std::uint32_t>(made.times.size()), static_cast<std::uint32_t>(times.size()),
                                values.size()));
        times.insert(times.end(), made.times.begin(), made.times.end());
        values.insert(values.end(), made.values.begin(), made.values.end());
    }
    return make_container(
        FourCC("CYCL"),
        {make_leaf(FourCC("NAME"), std::as_bytes(std::span(spec.name))), make_leaf(FourCC("CINF"), bytes_of(info)),
         make_leaf(FourCC("TRAK"), bytes_of_all(records)), make_leaf(FourCC("TIME"), bytes_of_all(times)),
         make_leaf(FourCC("KEYV"), bytes_of_all(values))});
}

}  // namespace bendy::test
