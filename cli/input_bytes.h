#pragma once

#include <bendy/format/file.h>

#include <filesystem>
#include <vector>

namespace bendy::cli {

/// The name that means standard input, or standard output. A file that is called so is `./-`.
inline bool is_dash(const std::filesystem::path& file) {
    return file == "-";
}

/// The bytes of a file, or of standard input if its name is a dash; on a 16-byte boundary, at least.
class InputBytes {
public:
    /// Standard input is read to its end, once in a run and at most kMostPiped bytes: the error is EFBIG past them.
    static Result<InputBytes> open(const std::filesystem::path& file);
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

}  // namespace bendy::cli
