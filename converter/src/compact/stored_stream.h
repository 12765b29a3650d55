#pragma once

#include <bendy/format/pool.h>
#include <bendy/format/records.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bendy::converter {

/// A stream's integers as they will lie in the file.
struct StoredStream {
    ComponentType type = ComponentType::u8;
    Numbers numbers = Numbers::boxed;
    std::uint32_t components = 0;
    std::vector<StreamBox> boxes;  ///< one per component if numbers are boxed, else none
    std::vector<std::byte> bytes;  ///< elements * components integers
    bool is_octahedral = false;

    [[nodiscard]] std::size_t row() const { return std::size_t{components} * component_size(type); }
    /// As a reader sees it.
    [[nodiscard]] StreamView view() const {
        StreamView view;
        view.type = type;
        view.normalised = numbers == Numbers::normalised;
        view.components = components;
        view.elements = static_cast<std::uint32_t>(bytes.size() / row());
        view.data = bytes;
        view.boxes = boxes;
        view.is_octahedral = is_octahedral;
        return view;
    }
};

}  // namespace bendy::converter
