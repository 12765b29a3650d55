#include "reports/convert_options.h"

#include <algorithm>
#include <cstddef>

namespace bendy::tools {

std::string ConvertOption::flag() const {
    std::string flag = "--" + std::string(name);
    std::replace(flag.begin(), flag.end(), '_', '-');
    return flag;
}

std::string ConvertOption::full_help() const {
    constexpr std::string_view kPlace = "{key}";
    std::string text(help);
    if (const std::size_t place = text.find(kPlace); place != std::string::npos)
        text.replace(place, kPlace.size(), kByKey);
    return text;
}

std::string ConvertOption::why_not(std::string_view value) const {
    const std::vector<std::string> choices = words_of(values);
    if (choices.empty() || std::find(choices.begin(), choices.end(), value) != choices.end()) return {};
    std::string text(name);
    for (std::size_t k = 0; k < choices.size(); ++k)
        text += (k == 0 ? " must be " : k + 1 == choices.size() ? " or " : ", ") + choices[k];
    return text;
}

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        words.emplace_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return words;
}

ConvertOption option_named(std::string_view name) {
    ConvertOption found;
    const ConvertChoices choices;
    visit_options(choices, [&](const ConvertOption& option, const auto&) {
        if (option.name == name) found = option;
    });
    return found;
}

}  // namespace bendy::tools
