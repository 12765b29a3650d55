#pragma once

#include <bendy/converter/scene.h>

namespace bendy::converter {

/// A joint's rest transform as the file has it.
inline RestRecord to_record(const Transform& rest) {
    RestRecord record;
    for (int c = 0; c < 4; ++c) record.rotation[static_cast<std::size_t>(c)] = rest.rotation[c];
    for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(c);
        record.translation[at] = rest.translation[c];
        record.scale[at] = rest.scale[c];
        record.shear[at] = rest.shear[c];
    }
    return record;
}

}  // namespace bendy::converter
