#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/result.h>

#include <filesystem>
#include <span>
#include <string>

namespace bendy::converter {

/// Reads a Quake II model and fills a Scene: the first frame is the mesh, every other one a target of its own shape
/// (Target::is_frame) with the frame's name, and frames that are numbered on (stand01, stand02, ...) are a clip of 10
/// frames a second; which clips repeat, their names say. Z up becomes Y up, the front +Z; 32 units are a metre. Normals
/// are the table's that the file's numbers mean, the skins' names are kept as URIs. Errors name the byte. Throws
/// nothing; every number in the result is finite and every index in range.
Result<Scene, ImportError> import_md2(const std::filesystem::path& file, Report& report);

/// The same of a file's bytes. \param name  of the one joint
Result<Scene, ImportError> import_md2(std::span<const std::byte> bytes, const std::string& name, Report& report);

}  // namespace bendy::converter
