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

// Files that commands read: what they are, and what to do about those that are something else.
namespace bendy::cli {

/// The name that means standard input, or standard output. A file that is called so is `./-`.
inline bool is_dash(const std::filesystem::path& file) {
    return file == "-";
}

/// The bytes of a file, or of standard input if its name is a dash; on a 16-byte boundary, at least.
class InputBytes {
public:
    /// Standard input is read to its end, once in a run and at most kMostPiped bytes: the error is EFBIG past them.
    static Result<InputBytes> open(const std::filesystem::path& file, Storage storage = Storage::mapped);
    /// The same; what cannot be read is printed, and Failed thrown.
    static InputBytes read(const std::filesystem::path& file);

    [[nodiscard]] Bytes bytes() const { return is_piped_ ? Bytes(piped_) : mapped_.bytes(); }

    /// The bytes as the caller's own.
    [[nodiscard]] std::vector<std::byte> take() &&;

    /// A pipe that does not end shall not take all memory. Larger files are mapped, by their name.
    static constexpr std::size_t kMostPiped = std::size_t{1} << 30;

private:
    MappedFile mapped_;
    std::vector<std::byte> piped_;
    bool is_piped_ = false;
};

/// Maps a file of any kind, or reads standard input; as all functions here. Fails if it cannot be read.
InputBytes open_file(const std::filesystem::path& file, Storage storage = Storage::mapped);

/// Maps a file that is to be a bendy file. Fails, with the command that makes one of it, if it is known to be something
/// else; what is not known at all goes through.
InputBytes open_bendy_file(const std::filesystem::path& file, Storage storage = Storage::mapped);

/// The chunks of a file's bytes, or its character. Fails, with the place, if they cannot be read.
ChunkTree read_tree(const std::filesystem::path& file, Bytes bytes);
Model read_model(const std::filesystem::path& file, Bytes bytes);

/// What is wrong with a file that could not be opened.
std::string why_not_opened(const std::filesystem::path& file, const Error& error);
/// What a file is, and the command that makes a bendy file of it; empty if it is one or is not known.
std::string why_not_bendy(const std::filesystem::path& file, Bytes bytes);

/// The bytes of a bendy file, mapped, or made from a file of another kind.
class CharacterFile {
public:
    explicit CharacterFile(InputBytes mapped) : mapped_(std::move(mapped)) {}
    explicit CharacterFile(std::vector<std::byte> converted) : converted_(std::move(converted)) {}

    [[nodiscard]] Bytes bytes() const { return converted_.empty() ? mapped_.bytes() : Bytes(converted_); }

private:
    InputBytes mapped_;
    std::vector<std::byte> converted_;
};

/// The folders in which the names in a file, or in standard input, are looked for. \param root  of --root, or empty
ReadableFolders folders_of(const std::filesystem::path& file, const std::filesystem::path& root);

/// Maps a bendy file, or converts what `convert` reads. What is wrong comes as an error. \param root  of --root, or
/// empty
Result<CharacterFile, converter::ImportError> read_character(const std::filesystem::path& file,
                                                             const std::filesystem::path& root,
                                                             converter::Report& report,
                                                             Storage storage = Storage::mapped);
/// The same of a file that is open already.
Result<CharacterFile, converter::ImportError> read_character(const std::filesystem::path& file, InputBytes mapped,
                                                             const std::filesystem::path& root,
                                                             converter::Report& report);
/// The same of a name; prints what the conversion has to say, as `convert` does, and fails if something is wrong.
/// \param outputs  learns what was read
CharacterFile open_character(const std::filesystem::path& file, const std::filesystem::path& root, Outputs& outputs,
                             Storage storage = Storage::mapped);

}  // namespace bendy::cli
