#include "bendy_file/source_facts.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

using Member = std::pair<std::string_view, std::string_view>;  // key and value, as they stand in the text

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

/// The members of an object. `text` is valid JSON that starts with a brace.
std::vector<Member> members_of(std::string_view text) {
    std::vector<Member> members;
    std::size_t depth = 0;
    std::size_t start = 1;  // of the key or the value that we are in
    std::string_view name;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            in_string = c != '"';
            continue;
        }
        const bool ends_value = depth == 1 && (c == ',' || c == '}');
        if (ends_value && !name.empty()) members.emplace_back(name, trimmed(text.substr(start, i - start)));
        if (ends_value) {
            name = {};
            start = i + 1;
        }
        if (depth == 1 && c == ':') {
            name = trimmed(text.substr(start, i - start));
            start = i + 1;
        }
        in_string = c == '"';
        if (c == '{' || c == '[') ++depth;
        if (c == '}' || c == ']') --depth;
    }
    return members;
}

}  // namespace

void read_source_facts(std::string_view text, Scene& scene, Report& report) {
    if (text.empty()) return;
    const std::string_view json = trimmed(text);
    if (!nlohmann::json::accept(json.begin(), json.end()))
        return report.warn("the file's own data is no JSON, it is left out", "HEAD/EXTR");
    std::vector<Member> members;
    if (json.front() == '{') members = members_of(json);
    const auto is_fact = [](const Member& member) {
        return member.first == R"("asset")" || member.first == R"("extras")";
    };
    const bool are_facts = !members.empty() && members.size() <= 2 &&
                           std::all_of(members.begin(), members.end(), is_fact) &&
                           members.front().first <= members.back().first &&
                           (members.size() == 1 || members.front().first != members.back().first);
    if (!are_facts) {
        scene.source_extras = json;
        return report.warn("the file's own data is kept as the member \"extras\" of what is written", "HEAD/EXTR");
    }
    for (const auto& [name, value] : members) (name == R"("asset")" ? scene.asset : scene.source_extras) = value;
}

}  // namespace bendy::converter
