#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <filesystem>

namespace bendy::converter {

/// Makes the links to images, which are relative to the folder of `from`, relative to that of `to`: percent-encoded,
/// with forward slashes; as a file URI where no relative path leads there (another drive). Between files of one folder
/// links stay as they are, as do those with a scheme and absolute ones. Warns of links to files that do not exist, and
/// of those that lead out of the folder, which the viewer does not follow.
void move_links(Scene& scene, const std::filesystem::path& from, const std::filesystem::path& to, Report& report);

}  // namespace bendy::converter
