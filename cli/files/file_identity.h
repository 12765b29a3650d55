#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

namespace bendy::cli {

/// What tells whether two names, hard links and symbolic links included, are one file.
using FileIdentity = std::pair<std::uint64_t, std::uint64_t>;

/// Of the file that a name leads to; nothing where there is none.
std::optional<FileIdentity> identity_of(const std::filesystem::path& file);

/// Of the file that standard input is read from, or standard output goes to; nothing for a pipe, a terminal or a
/// device.
std::optional<FileIdentity> identity_of_standard_input();
std::optional<FileIdentity> identity_of_standard_output();

}  // namespace bendy::cli
