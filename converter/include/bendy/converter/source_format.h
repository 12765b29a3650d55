#pragma once

#include <bendy/format/byte_reader.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace bendy::converter {

/// The formats that `convert` reads.
enum class SourceFormat : std::uint8_t { gltf, bendy, x, md2, bvh };

/// Recognises the format by the first bytes, else by the name. Unrecognised files count as glTF, whose importer reports
/// the error.
SourceFormat find_source_format(Bytes bytes, const std::filesystem::path& name);

/// A kind of file, described for the user.
struct FileKind {
    std::string_view name;               ///< with its article: "a glTF binary file"
    std::optional<SourceFormat> format;  ///< nothing: `convert` does not read it
    std::string_view way_in;  ///< if it is not read: how to get a file that is; empty for the text form of a bendy file
};

/// Recognises the formats that `convert` reads, common formats that it does not read, and files that are not models,
/// such as pictures and web pages: by the first 4 KiB, or else by the name. Nothing if neither matches.
std::optional<FileKind> find_file_kind(Bytes bytes, const std::filesystem::path& name);
/// As above, for a file; nothing if it cannot be read.
std::optional<FileKind> find_file_kind(const std::filesystem::path& file);

/// Recognises a stand-in for a file that was never downloaded: a Git LFS pointer, an HTML page.
std::optional<FileKind> find_stand_in(Bytes bytes);

/// The reason why a path is not a file: it does not exist, or is a folder. Empty otherwise.
std::string why_not_a_file(const std::filesystem::path& file);
/// Quotes an argument of a command that is suggested to the user: in single quotes if the shell needs them.
std::string quoted_for_shell(std::string_view word);

/// Why a file of that kind is not a bendy file, and how to make one from it; empty if it is one.
std::string why_not_bendy(const FileKind& kind, const std::filesystem::path& file);
/// Why `convert` cannot read a file that is missing, a folder, or of an unsupported kind; empty if it may try.
std::string why_not_convertible(const std::filesystem::path& file);
/// As above, for a file's bytes.
std::string why_not_convertible(Bytes bytes, const std::filesystem::path& name);

/// The reason why bytes cannot be a rig file. Empty if they may be one.
std::string why_not_a_rig(Bytes bytes);

/// ".gltf, .glb, ...": the file name suffixes that `convert` reads, without bendy's own; for messages. Files are
/// recognised by content.
std::string list_readable_suffixes();

/// True if the file's name ends in one of them, ignoring case.
bool has_readable_suffix(const std::filesystem::path& file);

/// For tools that take characters in any format: true if the file must be converted, false if it can be opened as a
/// bendy file. `convert` reports errors in files that it cannot read. Unrecognised content is judged by the name.
bool is_converted(Bytes bytes, const std::filesystem::path& name);

}  // namespace bendy::converter
