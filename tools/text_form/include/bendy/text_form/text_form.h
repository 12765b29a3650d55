#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

// The text form: a file as JSON that people can read and edit, and that `assemble` turns back into the same bytes.
// spec/text.md describes it.
namespace bendy::text_form {

/// Called now and then during long operations: bytes of the input processed so far, and in total.
using Progress = std::function<void(std::uint64_t done, std::uint64_t all)>;

struct DumpOptions {
    /// Writes encoded leaves as plain ones: shorter text, but it assembles to a file without encodings.
    bool decode = false;
};

/// Returns the text form of a whole file, whatever its chunks contain: payloads that do not have the form of their
/// chunk are written as hexadecimal digits. Sums are not written, so check them first.
/// \param tree  after decode_leaves
std::string dump(const ChunkTree& tree, const DumpOptions& options = {}, const Progress& progress = {});

/// An error in a text, and its position.
struct TextFault {
    std::uint64_t line = 1;    ///< counted from 1
    std::uint64_t column = 1;  ///< characters (code points), counted from 1
    std::string what;
};

/// Builds the file that a text form describes, including its sums, or returns the text's first fault. The file is well
/// formed, but its content is not checked: use `validate`. Does not recurse; takes memory in proportion to the text.
/// \param text  UTF-8, with or without a byte-order mark
Result<std::vector<std::byte>, TextFault> assemble(std::string_view text, const Progress& progress = {});

}  // namespace bendy::text_form
