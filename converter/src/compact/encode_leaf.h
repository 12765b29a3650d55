#pragma once

#include <bendy/format/codec.h>

#include <cstdint>
#include <vector>

namespace bendy::converter {

/// What is known of the numbers in a leaf's payload; zeros: nothing.
struct LeafShape {
    std::uint16_t head = 0;    ///< bytes before the rows
    std::uint16_t row = 0;     ///< bytes of a row
    std::uint16_t number = 0;  ///< bytes of a number
    bool is_triangles = false;
    bool is_packed_cycle = false;
    bool sums = false;  ///< rows of u16 that sum to the same number
};

struct EncodedLeaf {
    Codec codec = Codec::raw;
    std::vector<std::byte> bytes;  ///< empty: the payload is smallest as it is
};

/// The smallest of all encodings that fit the shape; as it is, where none saves anything.
EncodedLeaf encode_leaf(Bytes payload, const LeafShape& shape);

}  // namespace bendy::converter
