#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/text_form/text_form.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

namespace bendy::test {

inline std::string dumped(Bytes file, const text_form::DumpOptions& options = {}) {
    Result<ChunkTree> tree = read_chunk_tree(file);
    EXPECT_TRUE(tree);
    if (!tree) return {};
    decode_leaves(*tree);
    return text_form::dump(*tree, options);
}

/// The file of a text that has no fault.
inline std::vector<std::byte> assembled(std::string_view text) {
    auto file = text_form::assemble(text);
    if (file) return *std::move(file);
    ADD_FAILURE() << file.error().line << ':' << file.error().column << ": " << file.error().what;
    return {};
}

/// "line:column: what" of a text's fault; empty if it has none.
inline std::string fault_of(std::string_view text) {
    const auto file = text_form::assemble(text);
    if (file) return {};
    return std::to_string(file.error().line) + ':' + std::to_string(file.error().column) + ": " + file.error().what;
}

/// The text with one place of it, which must be there once, replaced.
inline std::string edited(std::string text, std::string_view what, std::string_view by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    if (at == std::string::npos) return text;
    EXPECT_EQ(text.find(what, at + 1), std::string::npos) << what << " is there twice";
    return text.replace(at, what.size(), by);
}

inline void expect_same_bytes(Bytes file) {
    const std::string text = dumped(file);
    const auto again = assembled(text);
    EXPECT_TRUE(std::equal(file.begin(), file.end(), again.begin(), again.end())) << text.substr(0, 2000);
}

}  // namespace bendy::test
