#pragma once

#include <nlohmann/json.hpp>

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

template <class Json>
void restore_source_generator(Json& asset) {
    if (!asset.is_object() || !asset.contains("generator") || !asset["generator"].is_string()) return;
    const auto text = asset["generator"].template get<std::string>();
    if (!text.starts_with(kOurName)) return;
    const std::size_t version_end = text.find(' ', kOurName.size());
    if (version_end == std::string::npos) return;
    const std::string_view rest = std::string_view(text).substr(version_end);
    if (rest == kFromUnnamed) {
        asset.erase("generator");
    } else if (rest.starts_with(kFromSource) && rest.ends_with(')')) {
        asset["generator"] = std::string(rest.substr(kFromSource.size(), rest.size() - kFromSource.size() - 1));
    }
}

}  // namespace bendy::converter::gltf
