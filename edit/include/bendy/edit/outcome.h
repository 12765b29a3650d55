#pragma once

#include <bendy/format/result.h>

#include <cstddef>
#include <string>
#include <vector>

// Changes to a bendy file that need no new conversion. Every operation takes the bytes of a whole file, starting on a
// 16-byte boundary, checks all of them, and returns the bytes of another file, which has passed bendy::validate. Chunks
// that are not affected keep their bytes, even if encoded; unknown chunks are kept in the same parent and position. A
// file with an unknown chunk that is REQUIRED is refused. The same input gives the same bytes.
namespace bendy::edit {

/// Why there is no result, as a sentence for the user; names in it are as in the file, not escaped.
struct Problem {
    std::string message;
};

/// What an operation reports: what it has done, and what the user should look at. Not escaped.
struct Log {
    std::vector<std::string> done;
    std::vector<std::string> warnings;
};

using Edited = Result<std::vector<std::byte>, Problem>;

}  // namespace bendy::edit
