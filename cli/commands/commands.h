#pragma once

#include <CLI/App.hpp>

#include <filesystem>
#include <string>

/// How CLI11 makes a path of what was typed: as UTF-8. By itself it leaves the encoding to the C++ library.
template <>
inline bool CLI::detail::lexical_cast(const std::string& input, std::filesystem::path& output) {
    output = std::u8string(input.begin(), input.end());
    return true;
}

// One function a subcommand: each adds its options to the program and its work as the callback. Work that fails throws
// Failed; main turns that into exit status 1.
namespace bendy::cli {

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

}  // namespace bendy::cli
