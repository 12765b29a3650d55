#pragma once

#include <bendy/json/json.h>

#include <string>
#include <string_view>

// `asset.generator` of an exported file names bendy, followed by the original generator. An import removes bendy's part
// again, so that an exported file converts to the same chunks. Thus the file always names its last writer:
// docs/decisions/0031.
namespace bendy::converter::gltf {

inline constexpr std::string_view kOurName = "bendy ";
inline constexpr std::string_view kFromSource = " (source: ";
inline constexpr std::string_view kFromUnnamed = " (source unnamed)";

/// \param ours  "bendy " and the version
template <class Json>
void name_generator(Json& asset, std::string_view ours) {
    std::string text(ours);
    if (!asset.contains("generator")) {
        text += kFromUnnamed;
    } else if (asset["generator"].is_string()) {
        text.append(kFromSource).append(asset["generator"].template get<std::string>()).append(")");
    } else {
        return;
    }
    asset["generator"] = text;
}

/// Takes this program's part away, whichever version wrote it, and however many of them one after another.
/// \return true if it wrote the file for a source without an asset, such as an X-file
template <class Json>
bool restore_source_generator(Json& asset) {
    const auto generator = asset.is_object() ? asset.find("generator") : asset.end();
    if (!asset.is_object() || generator == asset.end() || !generator->is_string()) return false;
    const auto text = generator->template get<std::string>();
    std::string_view rest = text;
    const auto is_ours = [](std::string_view name) {
        return name.starts_with(kOurName) && name.size() > kOurName.size() && name[kOurName.size()] >= '0' &&
               name[kOurName.size()] <= '9';
    };
    while (is_ours(rest)) {
        const std::size_t source = rest.find(kFromSource);
        const bool is_alone = rest.find(' ', kOurName.size()) == std::string_view::npos;
        if (is_alone || (source == std::string_view::npos && rest.ends_with(kFromUnnamed))) {
            asset.erase(generator);
            return is_alone;
        }
        if (source == std::string_view::npos || !rest.ends_with(')')) break;
        rest.remove_prefix(source + kFromSource.size());
        rest.remove_suffix(1);
    }
    *generator = std::string(rest);
    return false;
}

}  // namespace bendy::converter::gltf
