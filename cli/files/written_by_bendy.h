#pragma once

#include <filesystem>

namespace bendy::cli {

/// Whether a file says of itself that this program wrote it, in any version: a bendy file in its VERS, glTF in
/// asset.generator, an X-file in its second line. False for all other files, and for what cannot be read.
bool was_written_by_bendy(const std::filesystem::path& file);

/// Whether a glTF file has `other`, which is in the same folder, as a buffer; or an X-file names it.
bool refers_to(const std::filesystem::path& file, const std::filesystem::path& other);

}  // namespace bendy::cli
