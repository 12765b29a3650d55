#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/text_form/progress.h>

#include <string>

// The text form: a file as JSON that people can read and edit, and that `assemble` turns back into the same bytes.
// spec/text.md describes the form.
namespace bendy::text_form {

struct DumpOptions {
    /// Leaves that are encoded are written as plain ones: shorter text, but it assembles to a file without encodings.
    bool decode = false;
};

/// The text form of a whole file, whatever its chunks hold: what does not have the form of its chunk is written as
/// hexadecimal digits. Sums are not written, so they should have been checked. \param tree after decode_leaves
std::string dump(const ChunkTree& tree, const DumpOptions& options = {}, const Progress& progress = {});

}  // namespace bendy::text_form
