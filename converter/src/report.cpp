#include <bendy/converter/report.h>

#include <algorithm>
#include <utility>

namespace bendy::converter {

void Report::warn(std::string message, std::string place, std::uint64_t count) {
    const auto same = std::find_if(warnings_.begin(), warnings_.end(),
                                   [&](const Warning& warning) { return warning.message == message; });
    if (same != warnings_.end()) {
        same->count += count;
        return;
    }
    warnings_.push_back({std::move(message), std::move(place), count});
}

}  // namespace bendy::converter
