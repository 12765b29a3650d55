#include <bendy/edit/edit.h>

#include <charconv>
#include <system_error>

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

Result<std::vector<std::size_t>, Problem> find_named(std::span<const std::string_view> names, std::string_view wanted,
                                                     std::string_view kind) {
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < names.size(); ++k) {
        if (names[k] == wanted) found.push_back(k);
    }
    if (!found.empty()) return found;
    if (wanted.starts_with('#')) {
        std::size_t number = 0;
        const auto [end, fault] = std::from_chars(wanted.data() + 1, wanted.data() + wanted.size(), number);
        if (fault == std::errc() && end == wanted.data() + wanted.size() && number < names.size())
            return std::vector<std::size_t>{number};
    }
    if (wanted.find_first_of("*?") != std::string_view::npos) {
        for (std::size_t k = 0; k < names.size(); ++k) {
            if (matches(wanted, names[k])) found.push_back(k);
        }
        if (!found.empty()) return found;
    }
    return Problem{no_such_name(kind, wanted, names)};
}

}  // namespace bendy::edit
