#pragma once

#include <bendy/converter/error_bound.h>

#include <array>
#include <filesystem>

namespace bendy::cli {

/// Compares what two bendy files mean and prints what differs by more than the tolerance, and the worst distance met.
/// True if nothing does. Throws Failed where a file is bad, or the tolerance too large to tell anything apart.
bool are_characters_alike(const std::array<std::filesystem::path, 2>& files, const converter::ErrorBound& tolerance,
                          bool as_json);

}  // namespace bendy::cli
