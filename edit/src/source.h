#pragma once

#include <bendy/edit/outcome.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/document.h>

namespace bendy::edit {

/// A whole file, checked as by `bendy validate`, and read.
struct Source {
    ChunkTree tree;
    Document document;
};

Result<Source, Problem> open_source(Bytes file);

}  // namespace bendy::edit
