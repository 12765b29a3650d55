#pragma once

#include <bendy/converter/report.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <functional>
#include <string_view>
#include <utility>

namespace bendy::converter {

/// An object's members in the order of the text, doubled ones included. nlohmann's own ordered_map looks for doubles at
/// every member that it adds, which takes quadratic time.
template <class Key, class T, class Less, class Allocator>
struct MembersInOrder : nlohmann::ordered_map<Key, T, Less, Allocator> {
    using Base = nlohmann::ordered_map<Key, T, Less, Allocator>;
    using Base::Base;
    T& operator[](Key key) {
        this->emplace_back(std::move(key), T{});
        return this->back().second;
    }
};

using Json = nlohmann::json;
using OrderedJson = nlohmann::basic_json<MembersInOrder>;

/// Parses JSON text, Value being Json or OrderedJson. A byte order mark is skipped; half a surrogate pair is replaced
/// by U+FFFD, with a warning. Fails, with an empty place, with line and column on what is no JSON or no UTF-8, on
/// numbers past a double's range, and on nesting deeper than 128 levels.
template <class Value>
Value parse_json_text(std::string_view text, Report& report);

}  // namespace bendy::converter
