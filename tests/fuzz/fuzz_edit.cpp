// Surgery: whatever a file holds, it is refused or another valid file comes out.
#include "check.h"

#include <bendy/edit/clips.h>
#include <bendy/edit/edit.h>
#include <bendy/format/document.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace bendy;

edit::Edited change_clip(Bytes file, unsigned choice, edit::Log& log) {
    constexpr std::array<std::string_view, 8> kTexts{"#0", "*=copy*", "*=0.1..0.5", "*@20",
                                                     "*",  "*=0.1",   "*=#1..#0",   "*@0.1"};
    const edit::ClipWord& word = edit::clip_words()[choice % kTexts.size()];
    const std::string text(kTexts.at(choice % kTexts.size()));
    const auto change = edit::parse_clip_change(word.word, std::span(&text, 1));
    fuzz::check(change.has_value(), "the text has the shape that its word wants");
    if (choice / kTexts.size() % 8 == 7) return edit::limit_influences(file, 1 + choice % 3, log);
    return edit::change_clips(file, *change, log);
}

edit::Edited change(Bytes file, unsigned choice, edit::Log& log) {
    if (choice % 5 == 4) return change_clip(file, choice / 5, log);
    if (choice % 5 == 0) return edit::strip(file, {static_cast<edit::Part>(choice / 5 % 14), ""}, log);
    if (choice % 5 == 1) return edit::extract(file, "#" + std::to_string(choice / 5 % 8), log);
    if (choice % 5 == 2) return edit::add_clips(file, file, static_cast<edit::SameName>(choice / 5 % 3), log);
    edit::Rename rename;
    rename.kind = static_cast<edit::Named>(choice / 5 % 8);
    rename.names = {{"*a*", "b*"}, {"*", "x*"}};
    rename.all_must_match = false;
    return edit::rename(file, rename, log);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 16) return 0;
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    const std::vector<std::byte> file(bytes, bytes + size);
    edit::Log log;
    const auto edited =
        change(file, static_cast<unsigned>(size / 16) + data[4], log);  // its size, and a byte of its sum
    if (edited) {
        fuzz::check(validate(*edited).empty(), "what comes out is valid");
    } else {
        fuzz::check(!edited.error().message.empty(), "what is refused is refused for a reason");
    }
    return 0;
}
