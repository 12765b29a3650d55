#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <bendy/format/records.h>

#include <cstddef>
#include <string_view>
#include <vector>

namespace bendy::converter {

struct CompactGeometry;

/// How a scene is written. As it stands: exact, nothing encoded.
struct BuildOptions {
    /// Every leaf in the encoding that makes it smallest, joints as one table.
    bool compact = false;
    const CompactGeometry* geometry = nullptr;  ///< integers that take the place of the meshes' numbers; may be absent
};

/// Writes a scene as a file with one object: structure first, bulk after it, embedded images last. Exact: every number
/// of the scene is kept; streams and indices take the narrowest type that holds them without loss. The same scene gives
/// the same bytes. What has no place in the file is named in `report`. \param scene      indices in range, numbers
/// finite, rotations unit: as importers leave it \param generator  name and version of the program, at most 32 bytes
std::vector<std::byte> build_chunks(const Scene& scene, std::string_view generator, Report& report,
                                    const BuildOptions& options = {});

/// The same of a scene that is not needed any more: its long lists are given up on the way, and memory does not hold
/// both them and the file.
std::vector<std::byte> build_chunks(Scene&& scene, std::string_view generator, Report& report,
                                    const BuildOptions& options = {});

}  // namespace bendy::converter
