#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/leaf_parts.h>

#include <nlohmann/json.hpp>

#include <string>

// What a leaf holds by leaf_parts.def and records.def, for chunks of every kind.
namespace bendy::cli {

/// Fields of the record, texts and names by name, and the records of a leaf that is nothing but records. Long arrays of
/// numbers are left out. Empty for a leaf without these.
nlohmann::ordered_json leaf_fields(const LeafLayout& leaf, Bytes payload);

/// The same in a line: values of enumerations by their names, what numbers refer to, texts.
std::string leaf_text(const LeafLayout& leaf, Bytes payload);

}  // namespace bendy::cli
