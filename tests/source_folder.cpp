#include "source_folder.h"

namespace bendy {

std::filesystem::path source_folder() {
    return BENDY_SOURCE_DIR;
}

}  // namespace bendy
