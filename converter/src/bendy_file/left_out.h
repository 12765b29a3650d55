#pragma once

#include <bendy/converter/report.h>
#include <bendy/format/chunk_reader.h>

namespace bendy::converter {

/// Names the chunks that import_bendy does not read, and records that are longer than this version knows.
void warn_of_left_out(const ChunkTree& tree, Report& report);

}  // namespace bendy::converter
