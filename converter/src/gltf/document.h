#pragma once

#include "buffers.h"
#include "check_json.h"
#include "source/budget.h"
#include "tinygltf.h"

#include <bendy/converter/report.h>

#include <filesystem>

namespace bendy::converter::gltf {

/// A source file, opened and checked: what all parts of the importer read from. The structure comes from `model`;
/// extensions, extras, images and the indices of primitives from `json`, where elements have the same numbers.
struct Document {
    std::filesystem::path file;
    const Json& json;
    const tinygltf::Model& model;
    Buffers& buffers;
    Budget& budget;
    Report& report;
};

}  // namespace bendy::converter::gltf
