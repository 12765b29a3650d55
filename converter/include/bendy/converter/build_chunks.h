#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <bendy/format/records.h>

#include <cstddef>
#include <string_view>
#include <vector>

namespace bendy::converter {

struct CompactGeometry;

/// How a scene is written. The default is exact, with nothing encoded.
struct BuildOptions {
    /// Store every leaf in whichever encoding makes it smallest, and the joints as one table.
    bool compact = false;
    bool is_draft = false;  ///< with `compact`: leaves are not encoded, for reading the file back at once
    const CompactGeometry* geometry = nullptr;  ///< integers stored instead of the meshes' floats; may be null
};

/// Writes a scene as a file with one object: structure first, then bulk data, embedded images last. Exact: every number
/// of the scene is kept; streams and indices take the narrowest type that holds them without loss. The same scene gives
/// the same bytes. `report` lists everything that the file cannot hold.
/// \param scene      indices in range, numbers finite, rotations unit, as importers leave it
/// \param generator  name and version of the program, at most 32 bytes
std::vector<std::byte> build_chunks(const Scene& scene, std::string_view generator, Report& report,
                                    const BuildOptions& options = {});

/// As above, consuming the scene: its long lists are freed as they are written, so that memory never holds both them
/// and the whole file.
std::vector<std::byte> build_chunks(Scene&& scene, std::string_view generator, Report& report,
                                    const BuildOptions& options = {});

}  // namespace bendy::converter
