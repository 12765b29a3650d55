#include "too_deep.h"

#include <bendy/extensions/pointed_lists.h>
#include <bendy/format/charconv.h>
#include <bendy/json/json.h>

#include <algorithm>
#include <system_error>

namespace bendy::extensions {
namespace {

constexpr std::string_view kRoot = "/extensions/";

std::string unescaped(std::string_view token) {
    std::string text;
    for (std::size_t i = 0; i < token.size(); ++i) {
        const bool is_escape = token[i] == '~' && i + 1 < token.size() && (token[i + 1] == '0' || token[i + 1] == '1');
        text += !is_escape ? token[i] : token[i + 1] == '0' ? '~' : '/';
        i += is_escape ? 1 : 0;
    }
    return text;
}

std::optional<std::uint32_t> index_of(std::string_view token, std::size_t count) {
    std::uint32_t index = 0;
    const char* const end = token.data() + token.size();
    const auto [stop, problem] = from_chars(token.data(), end, index);
    const bool is_index = problem == std::errc() && stop == end && (token.size() == 1 || token.front() != '0');
    return is_index && index < count ? std::optional(index) : std::nullopt;
}

/// The value that a token leads to; null: there is none.
const Json* step(const Json& from, std::string_view token) {
    if (from.is_array()) {
        const auto index = index_of(token, from.size());
        return index ? &from[*index] : nullptr;
    }
    const auto member = from.is_object() ? from.find(unescaped(token)) : from.end();
    return from.is_object() && member != from.end() ? &*member : nullptr;
}

/// Calls visit(value, token, rest), where the token leads from the value and the rest follows it, until it returns
/// false, a token leads nowhere, or the last one has been visited.
template <class Visit>
void walk(const Json& extensions, std::string_view pointer, const Visit& visit) {
    if (!pointer.starts_with(kRoot)) return;
    const Json* value = &extensions;
    for (std::string_view rest = pointer.substr(kRoot.size()); value != nullptr;) {
        const std::size_t end = std::min(rest.find('/'), rest.size());
        const std::string_view token = rest.substr(0, end);
        const bool is_last = end == rest.size();
        if (!visit(*value, token, rest.substr(end)) || is_last) return;
        value = step(*value, token);
        rest.remove_prefix(end + 1);
    }
}

}  // namespace

struct PointedLists::Parsed {
    Json json = Json::object();
};

PointedLists::PointedLists(std::string_view json) : parsed_(std::make_unique<Parsed>()) {
    if (is_too_deep(json)) return;
    Json parsed = Json::parse(json).value_or(Json());
    if (parsed.is_object()) parsed_->json = std::move(parsed);
}

PointedLists::PointedLists(PointedLists&&) noexcept = default;
PointedLists::~PointedLists() = default;

bool PointedLists::has(std::string_view pointer) const {
    bool is_there = false;
    walk(parsed_->json, pointer, [&](const Json& value, std::string_view token, std::string_view rest) {
        is_there = rest.empty() && (value.is_object() || step(value, token) != nullptr);
        return true;
    });
    return is_there;
}

const NamedList& PointedLists::list(std::string_view pointer) {
    const auto known = lists_.find(pointer);
    if (known != lists_.end()) return known->second;
    NamedList& made = lists_.try_emplace(std::string(pointer)).first->second;
    walk(parsed_->json, pointer, [&](const Json& value, std::string_view token, std::string_view rest) {
        const Json* const list = rest.empty() ? step(value, token) : nullptr;
        if (list == nullptr || !list->is_array()) return true;
        for (const Json& element : *list) {
            const auto name = element.is_object() ? element.find("name") : element.end();
            const bool has_name = element.is_object() && name != element.end() && name->is_string();
            made.names.push_back(has_name ? name->text() : std::string());
        }
        return true;
    });
    for (std::uint32_t k = 0; k < made.names.size(); ++k) {
        if (!made.names[k].empty()) made.first.try_emplace(made.names[k], k);
    }
    return made;
}

std::optional<std::string> PointedLists::with_elements(std::string_view pointer, const NewElement& now) const {
    std::string made(pointer.substr(0, std::min(pointer.size(), kRoot.size())));
    bool is_there = true;
    std::size_t done = made.size();
    walk(parsed_->json, pointer, [&](const Json& value, std::string_view token, std::string_view rest) {
        const auto at = static_cast<std::size_t>(token.data() - pointer.data());
        const auto index = value.is_array() ? index_of(token, value.size()) : std::nullopt;
        if (index) {
            const auto to = now(pointer.substr(0, at - 1), std::string_view(made).substr(0, made.size() - 1), *index);
            is_there = to.has_value();
            if (!is_there) return false;
            made += std::to_string(*to);
        } else {
            made += token;
        }
        if (!rest.empty()) made += '/';
        done = pointer.size() - rest.size() + (rest.empty() ? 0 : 1);
        return true;
    });
    if (!is_there) return std::nullopt;
    return made + std::string(pointer.substr(done));
}

}  // namespace bendy::extensions
