#pragma once

#include <string_view>

namespace bendy::cli {

// The page around the data, made of page/ by cmake/embed_page.cmake.
extern const std::string_view kPageBeforeData;
extern const std::string_view kPageAfterData;

}  // namespace bendy::cli
