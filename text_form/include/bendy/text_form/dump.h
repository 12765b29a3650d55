#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/text_form/progress.h>

#include <string>

// The text form: a file as JSON that people can read and edit, and that `assemble` turns back into the same bytes.
// spec/text.md describes it.
namespace bendy::text_form {

struct DumpOptions {
    /// Writes encoded leaves as plain ones: shorter text, but it assembles to a file without encodings.
    bool decode = false;
};

/// Returns the text form of a whole file, whatever its chunks contain: payloads that do not have the form of their
/// chunk are written as hexadecimal digits. Sums are not written, so check them first.
/// \param tree  after decode_leaves
std::string dump(const ChunkTree& tree, const DumpOptions& options = {}, const Progress& progress = {});

}  // namespace bendy::text_form
