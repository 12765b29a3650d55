#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/viewer/render.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

// The window.
namespace bendy::viewer {

struct ViewOptions {
    /// Gives the bytes of a file that shall be shown, converted if it is none of ours. Throws ViewerError with the
    /// reason if it cannot.
    std::function<std::vector<std::byte>(const std::filesystem::path&)> open;
    std::filesystem::path file;    ///< empty: the tentacle demo
    Bytes tentacle;                ///< the demo's character, a bendy file
    std::filesystem::path script;  ///< for tests: keys to press, see window.h; empty: a person does
    bool trace = false;            ///< for tests: prints the state, a JSON object a line, after each key
    std::uint32_t width = 1280;
    std::uint32_t height = 800;
    bool verbose = false;  ///< says which OpenGL draws
    Warn warn;
};

/// Opens the window and stays until it is closed. Throws ViewerError if there is no display, no OpenGL 3.3, or nothing
/// to show.
void view(const ViewOptions& options);

}  // namespace bendy::viewer
