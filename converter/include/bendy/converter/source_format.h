#pragma once

#include <bendy/format/byte_reader.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace bendy::converter {

/// What can be converted.
enum class SourceFormat : std::uint8_t { gltf, bendy, x, md2 };

/// Told by the first bytes; where these say nothing, by the name. What is neither counts as glTF, whose importer says
/// what is wrong.
SourceFormat find_source_format(Bytes bytes, const std::filesystem::path& name);

/// What a file is, in words for its user.
struct FileKind {
    std::string_view name;               ///< with its article: "a glTF binary file"
    std::optional<SourceFormat> format;  ///< nothing: `convert` does not read it
    std::string_view way_in;             ///< then: how to get a file that it reads; empty for the text of a bendy file
};

/// Recognises what `convert` reads, and common formats that it does not read: by the first 4 KiB, or else by the name.
/// Nothing if neither says anything.
std::optional<FileKind> find_file_kind(Bytes bytes, const std::filesystem::path& name);
/// The same of a file; nothing if it cannot be read.
std::optional<FileKind> find_file_kind(const std::filesystem::path& file);

/// "there is no such file", or "is a folder, not a file"; empty for everything else.
std::string why_not_a_file(const std::filesystem::path& file);
/// A word of a command that is suggested to the user, as a shell reads it: in single quotes if need be.
std::string quoted_for_shell(std::string_view word);

/// Why a file of that kind is no bendy file, and what makes one of it; empty if it is one.
std::string why_not_bendy(const FileKind& kind, const std::filesystem::path& file);
/// Why `convert` cannot read a file that is missing, a folder, or of a kind that it does not read; empty if it may try.
std::string why_not_convertible(const std::filesystem::path& file);
/// The same of a file's bytes.
std::string why_not_convertible(Bytes bytes, const std::filesystem::path& name);

/// ".gltf, .glb, ...": what the names of files that `convert` reads end in, bendy files apart; for messages. What a
/// file is, its content tells.
std::string list_readable_suffixes();

/// True if the file's name ends in one of them, in capitals or not.
bool has_readable_suffix(const std::filesystem::path& file);

/// True if what takes characters of any kind converts the file, and false if it opens it as a bendy file. `convert`
/// says what is wrong with files that it does not read. Of what is not known the name decides.
bool is_converted(Bytes bytes, const std::filesystem::path& name);

}  // namespace bendy::converter
