#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/result.h>

#include <filesystem>
#include <string_view>

namespace bendy::converter {

/// Reads a DirectX X-file, text or plain binary, and fills a Scene: frames become joints, SkinWeights influences,
/// AnimationSets cycles, and our own templates (spec/xfile.md) constraints and IK chains. The left-handed space is
/// mirrored along Z, numbers are taken for metres. Errors come with `line 3, column 7`, or the byte in binary files.
/// What the Scene cannot hold is named in `report`. Throws nothing; every number in the result is finite and every
/// index in range. \param embed_images  false: images stay in their files and are referred to by URI
Result<Scene, ImportError> import_x(const std::filesystem::path& file, bool embed_images, Report& report);

/// The same of a file's bytes. \param file  beside which images are looked for
Result<Scene, ImportError> import_x(std::string_view bytes, const std::filesystem::path& file, bool embed_images,
                                    Report& report);

}  // namespace bendy::converter
