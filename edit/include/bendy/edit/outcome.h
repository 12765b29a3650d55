#pragma once

#include <bendy/format/result.h>

#include <cstddef>
#include <string>
#include <vector>

// Changing a bendy file without converting it again. Every operation takes the bytes of a whole file, on a 16-byte
// boundary, checks all of them, and gives the bytes of another file, which has passed bendy::validate. Chunks that are
// not touched keep their bytes, encoded ones too; unknown ones are kept in the same parent and place. A file with an
// unknown chunk that is REQUIRED is refused. The same input gives the same bytes.
namespace bendy::edit {

/// Why there is no result, in a sentence for a person; names in it are as in the file, not escaped.
struct Problem {
    std::string message;
};

/// What an operation tells: what it has done, and what the user should look at. Not escaped.
struct Log {
    std::vector<std::string> done;
    std::vector<std::string> warnings;
};

using Edited = Result<std::vector<std::byte>, Problem>;

}  // namespace bendy::edit
