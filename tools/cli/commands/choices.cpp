#include "choices.h"

#include <bendy/format/names.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace bendy::tools {

std::string enumerate(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t k = 0; k < words.size(); ++k) {
        if (k != 0) text += k + 1 == words.size() ? " and " : ", ";
        text += words[k];
    }
    return text;
}

std::string suggest(const std::vector<std::string>& words, const std::string& typed) {
    return did_you_mean(std::vector<std::string_view>(words.begin(), words.end()), typed);
}

CLI::Validator one_of(const std::vector<std::string>& words) {
    const auto check = [words](const std::string& typed) {
        if (std::find(words.begin(), words.end(), typed) != words.end()) return std::string();
        const std::string suggestion = suggest(words, typed);
        return '"' + typed + "\" is not a choice" + (suggestion.empty() ? "; " : suggestion + ' ') + "choose one of " +
               enumerate(words);
    };
    return {check, CLI::detail::generate_set(words)};
}

}  // namespace bendy::tools
