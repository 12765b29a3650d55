#include <bendy/converter/report.h>

#include <system_error>
#include <utility>

namespace bendy::converter {

void Report::warn(std::string message, std::string place, std::uint64_t count) {
    const auto [known, is_new] = place_of_.try_emplace(message, warnings_.size());
    if (!is_new) {
        warnings_[known->second].count += count;
        return;
    }
    warnings_.push_back({std::move(message), std::move(place), count});
}

void Report::add_source(const std::filesystem::path& file) {
    if (known_sources_.insert(file).second) sources_.push_back({file, stamp_of(file)});
}

FileStamp stamp_of(const std::filesystem::path& file) {
    std::error_code no_size;
    std::error_code no_time;
    const std::uintmax_t size = std::filesystem::file_size(file, no_size);
    const std::filesystem::file_time_type modified = std::filesystem::last_write_time(file, no_time);
    if (no_size || no_time) return {};
    return {true, size, static_cast<std::int64_t>(modified.time_since_epoch().count())};
}

}  // namespace bendy::converter
