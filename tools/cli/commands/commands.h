#pragma once

#include <CLI/App.hpp>

#include <filesystem>
#include <string>
#include <string_view>

/// Converts what the user typed to a path as UTF-8; CLI11 would leave the encoding to the C++ library.
template <>
inline bool CLI::detail::lexical_cast(const std::string& input, std::filesystem::path& output) {
    output = std::u8string(input.begin(), input.end());
    return true;
}

// One function per subcommand: it adds its options to the program, and its work as the callback. If the work fails, it
// throws Failed, which main turns into exit status 1.
namespace bendy::tools {

void add_assemble(CLI::App& program);
void add_bench(CLI::App& program);
void add_convert(CLI::App& program);
void add_diff(CLI::App& program);
void add_dump(CLI::App& program);
void add_edit(CLI::App& program);
void add_export(CLI::App& program);
void add_inspect(CLI::App& program);
void add_pose(CLI::App& program);
void add_render(CLI::App& program);
void add_rig(CLI::App& program);
void add_validate(CLI::App& program);
void add_view(CLI::App& program);

/// Why a program without the viewer does not draw, and which one does.
inline constexpr std::string_view kWithoutViewer =
    "this bendy was built without the viewer (BENDY_VIEWER=OFF); the Debian package and builds from the sources have "
    "it";

}  // namespace bendy::tools
