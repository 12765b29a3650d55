#pragma once

#include <nlohmann/json.hpp>

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace bendy::conformance {

/// Offset, code and path.
using Fault = std::tuple<std::uint64_t, std::string, std::string>;

/// One case of a manifest: a file, and the report that a reader has to give.
struct Case {
    std::string name;              ///< FAMILY/NAME
    std::vector<std::byte> bytes;  ///< aligned as `operator new` aligns, which readers require
    bool valid = false;
    std::set<Fault> faults;
};

inline std::vector<std::byte> from_hex(std::string_view text) {
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 2);
    for (std::size_t at = 0; at + 1 < text.size(); at += 2) {
        unsigned value = 0;
        const auto [end, error] = std::from_chars(text.data() + at, text.data() + at + 2, value, 16);
        if (error != std::errc() || end != text.data() + at + 2)
            throw std::runtime_error("expected hexadecimal digits");
        bytes.push_back(static_cast<std::byte>(value));
    }
    return bytes;
}

/// The cases of all manifests in `folder` (tests/conformance), in a stable order. Throws if a manifest cannot be read.
inline std::vector<Case> read_cases(const std::filesystem::path& folder) {
    std::set<std::filesystem::path> manifests;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".json") manifests.insert(entry.path());
    std::vector<Case> cases;
    for (const auto& path : manifests) {
        std::ifstream stream(path);
        const nlohmann::json manifest = nlohmann::json::parse(stream);
        const auto& family = manifest.at("family").get_ref<const std::string&>();
        for (const auto& entry : manifest.at("cases")) {
            Case one;
            one.name = family + '/' + entry.at("name").get_ref<const std::string&>();
            one.bytes = from_hex(entry.at("bytes").get_ref<const std::string&>());
            one.valid = entry.at("valid").get<bool>();
            for (const auto& fault : entry.at("faults"))
                one.faults.emplace(fault.at("offset"), fault.at("code"), fault.at("path"));
            cases.push_back(std::move(one));
        }
    }
    return cases;
}

}  // namespace bendy::conformance
