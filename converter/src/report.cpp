#include <bendy/converter/report.h>

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

}  // namespace bendy::converter
