#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/result.h>

#include <filesystem>

namespace bendy::converter {

/// True when the file can be read and starts as bendy files do, whatever its name.
bool is_bendy_file(const std::filesystem::path& file);

/// Reads a bendy file back into a Scene: every stream decoded to floats, sparse targets spread out, fixed frames as
/// timed keys. The file must pass bendy::validate; the first fault is the error. What the Scene cannot hold (unknown
/// chunks, further objects, ...) is named in `report`. Of a file that build_chunks has written from a Scene,
/// build_chunks makes the same bytes again. Throws nothing.
Result<Scene, ImportError> import_bendy(const std::filesystem::path& file, Report& report);

/// The same from memory; `bytes` start on a 16-byte boundary.
Result<Scene, ImportError> import_bendy(Bytes bytes, Report& report);

}  // namespace bendy::converter
