#include "files/output.h"

#include <sys/stat.h>
#include <unistd.h>

namespace bendy::tools {
namespace {

FileIdentity identity(const struct stat& status) {
    return {static_cast<std::uint64_t>(status.st_dev), static_cast<std::uint64_t>(status.st_ino)};
}

std::optional<FileIdentity> identity_of_stream(int descriptor) {
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return identity(status);
}

}  // namespace

std::optional<FileIdentity> identity_of(const std::filesystem::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return identity(status);
}

std::optional<FileIdentity> identity_of_standard_input() {
    return identity_of_stream(STDIN_FILENO);
}

std::optional<FileIdentity> identity_of_standard_output() {
    return identity_of_stream(STDOUT_FILENO);
}

}  // namespace bendy::tools
