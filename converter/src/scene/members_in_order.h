#pragma once

// Makes clang-tidy treat this as part of the JSON library: copying JSON recurses as deep as it is nested, which
// parse_json_text bounds.
#if defined(__GNUC__)
#pragma GCC system_header
#endif

#include <nlohmann/json.hpp>

#include <utility>

namespace bendy::converter {

/// An object's members in textual order, including duplicates. nlohmann's own ordered_map searches for duplicates on
/// every insertion, which takes quadratic time.
template <class Key, class T, class Less, class Allocator>
struct MembersInOrder : nlohmann::ordered_map<Key, T, Less, Allocator> {
    using nlohmann::ordered_map<Key, T, Less, Allocator>::ordered_map;
    T& operator[](Key key) {
        this->emplace_back(std::move(key), T{});
        return this->back().second;
    }
};

}  // namespace bendy::converter
