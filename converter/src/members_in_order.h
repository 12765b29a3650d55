#pragma once

// To clang-tidy this is the library's own header, which it goes with: copies of JSON recurse, as deep as it is nested,
// and parse_json_text bounds that.
#if defined(__GNUC__)
#pragma GCC system_header
#endif

#include <nlohmann/json.hpp>

#include <utility>

namespace bendy::converter {

/// An object's members in the order of the text, doubled ones included. nlohmann's own ordered_map looks for doubles at
/// every member that it adds, which takes quadratic time.
template <class Key, class T, class Less, class Allocator>
struct MembersInOrder : nlohmann::ordered_map<Key, T, Less, Allocator> {
    using nlohmann::ordered_map<Key, T, Less, Allocator>::ordered_map;
    T& operator[](Key key) {
        this->emplace_back(std::move(key), T{});
        return this->back().second;
    }
};

}  // namespace bendy::converter
