#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/viewer/render.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

// The viewer window.
namespace bendy::viewer {

struct ViewOptions {
    /// Returns the bytes of a file to show, converted if it is not a bendy file. Throws ViewerError with the reason if
    /// it fails.
    std::function<std::vector<std::byte>(const std::filesystem::path&)> open;
    std::filesystem::path file;    ///< empty: the tentacle demo
    std::filesystem::path root;    ///< see ReadableFolders; may be empty
    Bytes tentacle;                ///< the demo's character, a bendy file
    std::filesystem::path script;  ///< for tests: commands, see window.h; empty: interactive
    bool trace = false;            ///< for tests: prints the state as a JSON object after each key
    std::uint32_t width = 1280;
    std::uint32_t height = 800;
    bool verbose = false;  ///< prints the OpenGL driver
    Warn warn;
};

/// Opens the window and returns when it is closed. Throws ViewerError without a display or OpenGL 3.3, or if
/// the file cannot be shown.
void view(const ViewOptions& options);

}  // namespace bendy::viewer
