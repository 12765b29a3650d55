#include <bendy/edit/edit.h>

#include <optional>
#include <utility>

namespace bendy::edit {

bool matches(std::string_view pattern, std::string_view name) {
    std::size_t p = 0;
    std::size_t n = 0;
    std::size_t star = std::string_view::npos;
    std::size_t resume = 0;
    while (n < name.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            resume = n;
        } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
            ++p;
            ++n;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            n = ++resume;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*') ++p;
    return p == pattern.size();
}

std::optional<std::string> renamed(const std::pair<std::string, std::string>& pair, std::string_view name) {
    const auto& [before, after] = pair;
    const std::size_t star = before.find('*');
    if (name == before || star == std::string::npos) return name == before ? std::optional(after) : std::nullopt;
    const std::string_view head = std::string_view(before).substr(0, star);
    const std::string_view tail = std::string_view(before).substr(star + 1);
    if (name.size() < head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail))
        return std::nullopt;
    const std::string_view middle = name.substr(head.size(), name.size() - head.size() - tail.size());
    const std::size_t place = after.find('*');
    if (place == std::string::npos) return after;
    return after.substr(0, place) + std::string(middle) + after.substr(place + 1);
}

Result<std::vector<std::size_t>, Problem> find_named(std::span<const std::string_view> names, std::string_view wanted,
                                                     std::string_view kind) {
    auto found = find_all_by_key(names, wanted, kind);
    if (found) return *std::move(found);
    if (!wanted.starts_with('=') && wanted.find_first_of("*?") != std::string_view::npos) {
        std::vector<std::size_t> matching;
        for (std::size_t k = 0; k < names.size(); ++k) {
            if (matches(wanted, names[k])) matching.push_back(k);
        }
        if (!matching.empty()) return matching;
    }
    return Problem{found.error().message};
}

}  // namespace bendy::edit
