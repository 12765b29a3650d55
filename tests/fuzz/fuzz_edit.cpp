// Surgery: whatever a file holds, it is refused or another valid file comes out.
#include "check.h"

#include <bendy/edit/edit.h>
#include <bendy/format/document.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace bendy;

edit::Edited change(Bytes file, unsigned choice, edit::Log& log) {
    if (choice % 4 == 0) return edit::strip(file, {static_cast<edit::Part>(choice / 4 % 14), ""}, log);
    if (choice % 4 == 1) return edit::extract(file, "#" + std::to_string(choice / 4 % 8), log);
    if (choice % 4 == 2) return edit::merge_clips(file, file, static_cast<edit::SameName>(choice / 4 % 3), log);
    edit::Rename rename;
    rename.kind = static_cast<edit::Named>(choice / 4 % 8);
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
