#include "source_format.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

namespace bendy::converter {

namespace {

/// \param begin  the first four bytes
SourceFormat format_of(std::string_view begin, const std::filesystem::path& file) {
    if (begin == "HEAD") return SourceFormat::bendy;
    if (begin == "xof ") return SourceFormat::x;
    if (begin == "IDP2") return SourceFormat::md2;
    if (begin == "glTF") return SourceFormat::gltf;
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (extension == ".x") return SourceFormat::x;
    if (extension == ".md2") return SourceFormat::md2;
    return SourceFormat::gltf;
}

}  // namespace

SourceFormat find_source_format(const std::filesystem::path& file) {
    std::error_code ignored;
    std::array<char, 4> id{};
    if (std::filesystem::is_regular_file(file, ignored)) {
        std::ifstream stream(file, std::ios::binary);
        stream.read(id.data(), id.size());
    }
    return format_of({id.data(), id.size()}, file);
}

SourceFormat find_source_format(Bytes bytes, const std::filesystem::path& file) {
    return format_of(as_text(bytes).substr(0, 4), file);
}

}  // namespace bendy::converter
