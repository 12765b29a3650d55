#include <bendy/converter/file_stamp.h>

#include <system_error>

namespace bendy::converter {

FileStamp stamp_of(const std::filesystem::path& file) {
    std::error_code no_size;
    std::error_code no_time;
    const std::uintmax_t size = std::filesystem::file_size(file, no_size);
    const std::filesystem::file_time_type modified = std::filesystem::last_write_time(file, no_time);
    if (no_size || no_time) return {};
    return {true, size, static_cast<std::int64_t>(modified.time_since_epoch().count())};
}

}  // namespace bendy::converter
