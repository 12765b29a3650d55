#pragma once

#include <bendy/format/byte_reader.h>

#include <cstdint>
#include <filesystem>

namespace bendy::converter {

/// What can be converted.
enum class SourceFormat : std::uint8_t { gltf, bendy, x, md2 };

/// Told by the file's first bytes; where these say nothing, by its name. What is neither counts as glTF, whose importer
/// says what is wrong.
SourceFormat find_source_format(const std::filesystem::path& file);
/// The same of a file's bytes.
SourceFormat find_source_format(Bytes bytes, const std::filesystem::path& file);

}  // namespace bendy::converter
