#include <bendy/format/names.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <system_error>
#include <utility>
#include <vector>

namespace bendy {
namespace {

constexpr std::size_t kLongest = 64;  // names that are compared letter by letter

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::string lowered(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), lower);
    return out;
}

/// Returns the number of letters to insert, delete or change (Levenshtein distance); both at most kLongest long.
std::size_t distance(std::string_view a, std::string_view b) {
    std::array<std::size_t, kLongest + 1> row{};
    for (std::size_t k = 0; k <= b.size(); ++k) row[k] = k;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t k = 0; k < b.size(); ++k) {
            const std::size_t changed = diagonal + (a[i] == b[k] ? 0 : 1);
            diagonal = row[k + 1];
            row[k + 1] = std::min({changed, row[k] + 1, row[k + 1] + 1});
        }
    }
    return row[b.size()];
}

/// Returns how different two names are; above kLongest: not similar.
std::size_t unlikeness(const std::string& wanted, const std::string& name) {
    const bool holds = name.find(wanted) != std::string::npos || wanted.find(name) != std::string::npos;
    const std::size_t longer = std::max(name.size(), wanted.size());
    const std::size_t steps = distance(wanted, name);
    if (steps * 2 <= longer) return steps;
    if (holds && std::min(name.size(), wanted.size()) >= 3) return longer / 2 + 1;
    return kLongest + 1;
}

std::optional<std::size_t> read_number(std::string_view digits) {
    std::size_t number = 0;
    const char* const end = digits.data() + digits.size();
    const auto [stop, fault] = std::from_chars(digits.data(), end, number);
    return fault == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

KeyProblem ambiguous_key(std::string_view kind, std::string_view text) {
    const std::string shown(text);
    const std::string thing(kind);
    return {thing + " \"" + shown + "\" is ambiguous: =" + shown + " is the " + thing + " with this name, #" + shown +
                " the " + thing + " with this number",
            true};
}

/// Explains a text that refers to nothing.
KeyProblem no_such_thing(std::string_view kind, std::string_view text, const ThingKey& key,
                         std::span<const std::string_view> names) {
    if (key.name) return {no_such_name(kind, *key.name, names)};
    if (std::find(names.begin(), names.end(), text) == names.end()) return {no_such_name(kind, text, names)};
    const std::string shown(text);
    return {"there is no " + std::string(kind) + " with the number " + shown.substr(1) + "; =" + shown + " is the " +
            std::string(kind) + " called \"" + shown + '"'};
}

}  // namespace

ThingKey read_key(std::string_view text) {
    if (text.starts_with('=')) return {text.substr(1), std::nullopt};
    if (text.starts_with('#')) {
        const auto number = read_number(text.substr(1));
        return number ? ThingKey{std::nullopt, number} : ThingKey{text, std::nullopt};
    }
    return {text, read_number(text)};
}

Result<std::vector<std::size_t>, KeyProblem> find_all_by_key(std::span<const std::string_view> names,
                                                             std::string_view text, std::string_view kind) {
    const ThingKey key = read_key(text);
    std::vector<std::size_t> found;
    for (std::size_t k = 0; key.name && k < names.size(); ++k) {
        if (names[k] == *key.name) found.push_back(k);
    }
    if (!key.number || *key.number >= names.size()) {
        if (found.empty()) return no_such_thing(kind, text, key, names);
        return found;
    }
    std::vector<std::size_t> numbered{*key.number};
    if (!found.empty() && found != numbered) return ambiguous_key(kind, text);
    return numbered;
}

Result<std::size_t, KeyProblem> find_by_key(std::span<const std::string_view> names, std::string_view text,
                                            std::string_view kind) {
    const ThingKey key = read_key(text);
    const auto named = key.name ? std::find(names.begin(), names.end(), *key.name) : names.end();
    const auto first = static_cast<std::size_t>(named - names.begin());
    if (!key.number || *key.number >= names.size()) {
        if (named == names.end()) return no_such_thing(kind, text, key, names);
        return first;
    }
    if (named != names.end() && first != *key.number) return ambiguous_key(kind, text);
    return *key.number;
}

std::string_view nearest_name(std::span<const std::string_view> names, std::string_view wanted) {
    if (wanted.empty()) return {};
    const std::string asked = lowered(wanted);
    const auto differs_in_case = [&](std::string_view name) {
        return name.size() == asked.size() && lowered(name) == asked;
    };
    const auto same = std::find_if(names.begin(), names.end(), differs_in_case);
    if (same != names.end()) return *same;
    if (wanted.size() > kLongest) return {};
    std::string_view nearest;
    std::size_t best = kLongest + 1;
    for (const std::string_view name : names) {
        if (name.empty() || name.size() > kLongest) continue;
        const std::size_t found = unlikeness(asked, lowered(name));
        if (found >= best) continue;
        best = found;
        nearest = name;
    }
    return nearest;
}

std::string list_names(std::span<const std::string_view> names, std::span<const std::size_t> numbers,
                       std::size_t most) {
    std::string list;
    const std::size_t shown = std::min(numbers.size(), numbers.size() == most + 1 ? most + 1 : most);
    for (std::size_t k = 0; k < shown; ++k) {
        const std::string_view name = names[numbers[k]];
        if (k != 0) list += k + 1 == numbers.size() ? " and " : ", ";
        list += name.empty() ? '#' + std::to_string(numbers[k]) : '"' + std::string(name) + '"';
    }
    if (shown < numbers.size()) list += " and " + std::to_string(numbers.size() - shown) + " more";
    return list;
}

std::string did_you_mean(std::span<const std::string_view> names, std::string_view wanted) {
    const std::string_view nearest = nearest_name(names, wanted);
    return nearest.empty() ? std::string() : "; did you mean \"" + std::string(nearest) + "\"?";
}

std::string no_such_name(std::string_view kind, std::string_view wanted, std::span<const std::string_view> names) {
    constexpr std::size_t kFew = 8;
    const std::string suggestion = did_you_mean(names, wanted);
    std::string message = "there is no " + std::string(kind) + " \"" + std::string(wanted) + '"' + suggestion;
    if (names.empty()) return message + "; there are none";
    if (!suggestion.empty() && names.size() > kFew) return message;
    std::vector<std::size_t> all(names.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return message + (suggestion.empty() ? "; there " : " There ") + (all.size() == 1 ? "is " : "are ") +
           list_names(names, all);
}

std::string in_quotes(std::string_view name) {
    return '"' + std::string(name) + '"';
}

std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
    std::string text = std::to_string(count).append(1, ' ').append(count == 1 || many.empty() ? one : many);
    return count == 1 || !many.empty() ? text : text + 's';
}

}  // namespace bendy
