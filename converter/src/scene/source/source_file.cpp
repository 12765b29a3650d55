#include "scene/source/source_file.h"

#include "scene/failure.h"

#include <bendy/converter/source_format.h>
#include <bendy/format/text.h>

#include <utf8cpp/utf8.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

namespace bendy::converter {
namespace {

std::optional<unsigned> hex_digit(char c) {
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
    if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a' + 10);
    if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A' + 10);
    return std::nullopt;
}

constexpr std::array<std::uint8_t, 256> make_base64_table() {
    std::array<std::uint8_t, 256> table{};
    for (auto& entry : table) entry = 255;
    for (std::uint8_t i = 0; i < 26; ++i) {
        table[static_cast<std::size_t>('A' + i)] = i;
        table[static_cast<std::size_t>('a' + i)] = static_cast<std::uint8_t>(26 + i);
    }
    for (std::uint8_t i = 0; i < 10; ++i) table['0' + std::size_t{i}] = static_cast<std::uint8_t>(52 + i);
    table['+'] = table['-'] = 62;  // also accept the URL-safe alphabet
    table['/'] = table['_'] = 63;
    return table;
}

std::vector<std::byte> decode_base64(std::string_view text, const std::string& place) {
    static constexpr auto kTable = make_base64_table();
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    unsigned count = 0;  // number of valid bits
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::uint8_t value = kTable[static_cast<unsigned char>(text[i])];
        if (value == 255) {
            if (text[i] == ' ' || text[i] == '\n' || text[i] == '\r' || text[i] == '\t') continue;
            fail(place,
                 "data URI: character " + std::to_string(i) + " of the base64 text is not in the base64 alphabet");
        }
        bits = (bits << 6 | value) & 0xffffffu;
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<std::byte>(bits >> count & 0xffu));
        }
    }
    return bytes;
}

bool ends_with_base64(std::string_view header) {
    constexpr std::string_view kMark = ";base64";
    if (header.size() < kMark.size()) return false;
    const std::string_view end = header.substr(header.size() - kMark.size());
    return std::equal(kMark.begin(), kMark.end(), end.begin(),
                      [](char mark, char c) { return (c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c) == mark; });
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    auto canonical = std::filesystem::weakly_canonical(std::filesystem::absolute(folder, error), error);
    return error ? folder.lexically_normal() : canonical;
}

/// Appends a byte as %20, for example.
void append_encoded(std::string& uri, unsigned char byte) {
    constexpr std::string_view kHex = "0123456789ABCDEF";
    uri.append({'%', kHex[byte >> 4], kHex[byte & 15]});
}

/// Fails with "cannot read file 'a.bin': Too many open files".
/// \param number  the system's error code; 0: unknown
[[noreturn]] void fail_to_read(const std::string& place, const std::filesystem::path& file, int number) {
    const std::string why = number == 0 ? std::string() : ": " + std::generic_category().message(number);
    fail(place, "cannot read file " + quote(file.filename().string()) + why);
}

}  // namespace

std::vector<std::byte> read_file(const std::filesystem::path& file, const std::string& place, std::uint64_t limit) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::none) fail_to_read(place, file, error.value());
    if (!std::filesystem::exists(status)) fail(place, "file not found: " + quote(file.filename().string()));
    // Reading a device or a pipe behind a relative URI might never end.
    if (!std::filesystem::is_regular_file(status))
        fail(place, "not a regular file: " + quote(file.filename().string()));
    const std::uint64_t size = std::filesystem::file_size(file, error);
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (error || !stream) fail_to_read(place, file, error ? error.value() : errno);
    std::vector<std::byte> bytes(static_cast<std::size_t>(std::min(size, limit)));
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (static_cast<std::size_t>(stream.gcount()) != bytes.size()) fail_to_read(place, file, errno);
    return bytes;
}

std::optional<std::string> percent_decode(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded += text[i];
            continue;
        }
        if (text.size() - i < 3) return std::nullopt;
        const auto high = hex_digit(text[i + 1]);
        const auto low = hex_digit(text[i + 2]);
        if (!high || !low) return std::nullopt;
        decoded += static_cast<char>(*high * 16 + *low);
        i += 2;
    }
    return decoded;
}

DataUri decode_data_uri(std::string_view uri, const std::string& place) {
    uri.remove_prefix(uri.find(':') + 1);
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) fail(place, "data URI without a comma");
    const std::string_view header = uri.substr(0, comma);
    uri.remove_prefix(comma + 1);

    DataUri data;
    data.media_type = header.substr(0, header.find(';'));
    std::optional<std::string> decoded;
    if (uri.find('%') != std::string_view::npos || !ends_with_base64(header)) {
        decoded = percent_decode(uri);
        if (!decoded) fail(place, "data URI: '%' without two hexadecimal digits");
        uri = *decoded;
    }
    if (ends_with_base64(header)) {
        data.bytes = decode_base64(uri, place);
    } else {
        const auto* first = reinterpret_cast<const std::byte*>(uri.data());
        data.bytes.assign(first, first + uri.size());
    }
    return data;
}

ReadableFolders folders_of_bytes(const std::filesystem::path& name, const std::filesystem::path& root) {
    return name.has_parent_path() ? ReadableFolders::of(name, root) : ReadableFolders(root);
}

std::string why_outside(const ReadableFolders& folders, std::string_view uri) {
    if (folders.start().empty())
        return "the source has no folder in which to look for " + quote(uri) + ": --root FOLDER gives it one";
    return quote(uri) + " is outside the source's folder: --root FOLDER allows a folder that it is in";
}

std::string without_controls(std::string_view uri, const std::string& place, Report& report) {
    std::string encoded;
    std::string_view rest = uri;
    for (std::size_t at = find_control(rest); at != std::string_view::npos; at = find_control(rest)) {
        encoded += rest.substr(0, at);
        // Beyond ASCII, control characters take two bytes.
        const std::size_t size = static_cast<unsigned char>(rest[at]) < 0x80 ? 1 : 2;
        for (const char byte : rest.substr(at, size)) append_encoded(encoded, static_cast<unsigned char>(byte));
        rest.remove_prefix(at + size);
    }
    encoded += rest;
    if (encoded != uri) report.warn("control characters of a URI are percent-encoded: " + quote(encoded), place);
    return encoded;
}

std::string uri_of(const std::filesystem::path& path) {
    constexpr std::string_view kPlain = "-._~/";
    std::string uri;
    for (const char8_t letter : path.generic_u8string()) {
        const auto code = static_cast<unsigned char>(letter);
        const auto is_between = [code](char first, char last) { return code >= first && code <= last; };
        const bool is_plain = is_between('a', 'z') || is_between('A', 'Z') || is_between('0', '9') ||
                              kPlain.find(static_cast<char>(code)) != std::string_view::npos;
        if (is_plain) {
            uri += static_cast<char>(code);
        } else {
            append_encoded(uri, code);
        }
    }
    return uri;
}

std::string uri_between(const std::filesystem::path& from, const std::filesystem::path& file) {
    const std::filesystem::path target = folder_of(file) / file.filename();
    const std::filesystem::path relative = target.lexically_relative(folder_of(from));
    if (!relative.empty()) return uri_of(relative);
    return "file:///" + target.root_name().generic_string() + uri_of(target.root_directory() / target.relative_path());
}

std::string to_utf8(std::string_view text) {
    if (is_utf8(text)) return std::string(text);
    std::string converted;
    for (const char c : text) utf8::unchecked::append(static_cast<unsigned char>(c), std::back_inserter(converted));
    return converted;
}

std::string to_utf8(std::string_view text, const std::string& place, Report& report) {
    if (!is_utf8(text)) report.warn("a name is not UTF-8: its bytes are taken for Latin-1", place);
    return to_utf8(text);
}

void move_links(Scene& scene, const std::filesystem::path& from, const std::filesystem::path& to,
                const ReadableFolders& folders, Report& report) {
    const std::filesystem::path source = folder_of(from);
    const std::filesystem::path folder = folder_of(to);
    const ReadableFolders shown = ReadableFolders::of(to);
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
        Image& image = scene.images[i];
        if (!image.bytes.empty() || image.uri.empty()) continue;
        const std::string place = at("images", i);
        const auto file = linked_file(image.uri, from.parent_path());
        if (!file) continue;  // http, for example
        std::error_code ignored;
        const auto found = folders.find(image.uri);
        if (found && !std::filesystem::exists(*found, ignored))
            report.warn("linked image does not exist: " + quote(image.uri), place);
        const bool has_scheme = image.uri.find(':') < image.uri.find_first_of("/\\");
        const bool is_relative = !has_scheme && !linked_file(image.uri, {})->has_root_path();
        const bool has_backslash = image.uri.find('\\') != std::string::npos;  // invalid in a URI
        if ((source != folder || has_backslash) && is_relative) image.uri = uri_between(to, found ? *found : *file);
        if (!shown.find(image.uri)) {
            report.warn("link to an image leads out of the output's folder, where the viewer does not follow it: " +
                            quote(image.uri),
                        place);
        }
    }
}

}  // namespace bendy::converter
