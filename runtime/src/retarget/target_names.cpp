#include "target_names.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace bendy {
namespace {

/// ARKit's names without left and right.
constexpr std::string_view kArkit[] = {"browdown",        "browinnerup",
                                       "browouterup",     "cheekpuff",
                                       "cheeksquint",     "eyeblink",
                                       "eyelookdown",     "eyelookin",
                                       "eyelookout",      "eyelookup",
                                       "eyesquint",       "eyewide",
                                       "jawforward",      "jaw",
                                       "jawopen",         "mouthclose",
                                       "mouthdimple",     "mouthfrown",
                                       "mouthfunnel",     "mouth",
                                       "mouthlowerdown",  "mouthpress",
                                       "mouthpucker",     "mouthrolllower",
                                       "mouthrollupper",  "mouthshruglower",
                                       "mouthshrugupper", "mouthsmile",
                                       "mouthstretch",    "mouthupperup",
                                       "nosesneer",       "tongueout"};

constexpr std::string_view kSeparators = " _-.:|";

/// Lower case without separators; left and right at the end are one letter.
std::string plain(std::string_view name) {
    std::string key;
    for (const char letter : name) {
        if (kSeparators.find(letter) == std::string_view::npos)
            key += letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    }
    if (key.ends_with("left")) key.resize(key.size() - 3);
    if (key.ends_with("right")) key.resize(key.size() - 4);
    return key;
}

bool is_arkit(std::string_view key) {
    const auto is_name = [](std::string_view base) {
        return std::find(std::begin(kArkit), std::end(kArkit), base) != std::end(kArkit);
    };
    if (is_name(key)) return true;
    return (key.ends_with('l') || key.ends_with('r')) && is_name(key.substr(0, key.size() - 1));
}

}  // namespace

std::string target_key(std::string_view name) {
    for (std::size_t at = name.find_first_of(kSeparators); at != std::string_view::npos;
         at = name.find_first_of(kSeparators, at + 1)) {
        std::string key = plain(name.substr(at + 1));
        if (is_arkit(key)) return key;
    }
    return plain(name);
}

}  // namespace bendy
