#pragma once

#include "files/output.h"

#include <bendy/converter/report.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/file.h>
#include <bendy/format/readable_folders.h>
#include <bendy/format/result.h>
#include <bendy/runtime/model.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

// The files that commands read: their kinds, and what to do about the wrong ones.
namespace bendy::tools {

/// The name of standard input and standard output. A file of this name is written `./-`.
inline bool is_dash(const std::filesystem::path& file) {
    return file == "-";
}

/// The bytes of a file, or of standard input if the name is a dash; aligned to at least 16 bytes.
class InputBytes {
public:
    /// Reads standard input to its end, once per run and at most kMostPiped bytes; beyond that the error is EFBIG.
    static Result<InputBytes> open(const std::filesystem::path& file, Storage storage = Storage::mapped);
    /// The same, but prints the error and throws Failed.
    static InputBytes read(const std::filesystem::path& file);

    [[nodiscard]] Bytes bytes() const { return is_piped_ ? Bytes(piped_) : mapped_.bytes(); }

    /// Moves the bytes to the caller.
    [[nodiscard]] std::vector<std::byte> take() &&;

    /// Keeps an endless pipe from taking all memory. Larger files can be mapped by name.
    static constexpr std::size_t kMostPiped = std::size_t{1} << 30;

private:
    MappedFile mapped_;
    std::vector<std::byte> piped_;
    bool is_piped_ = false;
};

/// Maps a file of any kind, or reads standard input, as all functions here do. Fails if it cannot be read.
InputBytes open_file(const std::filesystem::path& file, Storage storage = Storage::mapped);

/// Maps a file that should be a bendy file. If it is known to be something else, fails and names the command that
/// converts it; an unknown kind is accepted.
InputBytes open_bendy_file(const std::filesystem::path& file, Storage storage = Storage::mapped);

/// Returns the chunks of a file's bytes, or its character. Fails, with the position, if they cannot be read.
ChunkTree read_tree(const std::filesystem::path& file, Bytes bytes);
Model read_model(const std::filesystem::path& file, Bytes bytes);

/// Returns the first fault that `validate` finds. Model does not look for numbers that are not finite and the like,
/// which poses and pictures need.
Result<void> check_whole(Bytes bytes);
/// Returns a file's character after that check. Fails, with the position, if there is a fault.
Model read_valid_model(const std::filesystem::path& file, Bytes bytes);

/// Returns why a file could not be opened.
std::string why_not_opened(const std::filesystem::path& file, const Error& error);
/// Returns a file's kind and the command that converts it to a bendy file; empty if it is a bendy file or unknown.
std::string why_not_bendy(const std::filesystem::path& file, Bytes bytes);

/// The bytes of a bendy file, mapped, or converted from a file of another kind.
class CharacterFile {
public:
    explicit CharacterFile(InputBytes mapped) : mapped_(std::move(mapped)) {}
    explicit CharacterFile(std::vector<std::byte> converted) : converted_(std::move(converted)) {}

    [[nodiscard]] Bytes bytes() const { return converted_.empty() ? mapped_.bytes() : Bytes(converted_); }

private:
    InputBytes mapped_;
    std::vector<std::byte> converted_;
};

/// Returns the folders in which the names in a file, or in standard input, are looked up. \param root  from --root, or
/// empty
ReadableFolders folders_of(const std::filesystem::path& file, const std::filesystem::path& root);

/// Maps a bendy file, or converts a file that `convert` reads. Returns an error instead of printing it. \param root
/// from --root, or empty
Result<CharacterFile, converter::ImportError> read_character(const std::filesystem::path& file,
                                                             const std::filesystem::path& root,
                                                             converter::Report& report,
                                                             Storage storage = Storage::mapped);
/// The same for an open file.
Result<CharacterFile, converter::ImportError> read_character(const std::filesystem::path& file, InputBytes mapped,
                                                             const std::filesystem::path& root,
                                                             converter::Report& report);
/// The same for a name; prints the conversion's messages as `convert` does, and fails if there is an error.
/// \param outputs  is told what was read
CharacterFile open_character(const std::filesystem::path& file, const std::filesystem::path& root, Outputs& outputs,
                             Storage storage = Storage::mapped);

}  // namespace bendy::tools
