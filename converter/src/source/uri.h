#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter {

/// Nothing if a `%` is not followed by two hexadecimal digits.
std::optional<std::string> percent_decode(std::string_view text);

bool is_data_uri(std::string_view uri);

struct DataUri {
    std::string media_type;  ///< without parameters, may be empty
    std::vector<std::byte> bytes;
};

/// RFC 2397, base64 or percent-encoded. Fails at `place`.
DataUri decode_data_uri(std::string_view uri, const std::string& place);

/// The file that a relative URI means, beside `source`. `..` is allowed (exporters write it); absolute paths and
/// schemes are not: fails at `place`.
std::filesystem::path resolve_uri(const std::string& uri, const std::filesystem::path& source,
                                  const std::string& place);

/// A relative path as a URI: percent-encoded where it must be.
std::string uri_of(const std::filesystem::path& path);

}  // namespace bendy::converter
