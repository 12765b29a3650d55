#include "output_folder.h"

#include "problem.h"

#include <system_error>

namespace bendy::cli {

void require_folder_of(const std::filesystem::path& output) {
    const std::filesystem::path folder = output.parent_path();
    if (folder.empty()) return;
    std::error_code unknown;
    const std::filesystem::file_status status = std::filesystem::status(folder, unknown);
    if (status.type() == std::filesystem::file_type::not_found) {
        fail(output, "there is no folder " + printable(folder.string()) + ": make it first");
    } else if (std::filesystem::exists(status) && !std::filesystem::is_directory(status)) {
        fail(output, printable(folder.string()) + " is a file, not a folder");
    }
}

}  // namespace bendy::cli
