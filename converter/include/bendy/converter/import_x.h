#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/result.h>

#include <filesystem>
#include <string_view>

namespace bendy::converter {

struct XOptions {
    bool embed_images = true;  ///< false: images stay in their files and are referred to by URI
    /// Ticks per second of the key times, above 0: goes before what the file says. 0: the file's AnimTicksPerSecond, or
    /// 4,800 where it has none, which is named in the report.
    double ticks_per_second = 0.0;
};

/// Reads a DirectX X-file, text or binary, compressed or not, and fills a Scene: frames become joints, SkinWeights
/// influences, AnimationSets cycles, and our own templates (spec/xfile.md) constraints and IK chains. The left-handed
/// space is mirrored along Z, numbers are taken for metres. Errors come with `line 3, column 7`, or the byte in binary
/// files. What the Scene cannot hold is named in `report`. Throws nothing; every number in the result is finite and
/// every index in range. The lines of a compressed file are those of the text in it.
Result<Scene, ImportError> import_x(const std::filesystem::path& file, const XOptions& options, Report& report);

/// The same of a file's bytes. \param file  beside which images are looked for
Result<Scene, ImportError> import_x(std::string_view bytes, const std::filesystem::path& file, const XOptions& options,
                                    Report& report);

}  // namespace bendy::converter
