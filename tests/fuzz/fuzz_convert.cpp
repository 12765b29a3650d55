// Converts a source of any format with any options: an error, or a valid bendy file that can be played.
#include "check.h"
#include "convert_input.h"
#include "mutators.h"
#include "use_model.h"

#include <bendy/converter/convert.h>
#include <bendy/converter/source_format.h>
#include <bendy/format/document.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

using bendy::converter::SourceFormat;
using bendy::fuzz::ConvertInput;

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const ConvertInput input = ConvertInput::split({data, size});
    const auto* source = reinterpret_cast<const std::byte*>(input.source.data());
    bendy::converter::Report report;
    const auto converted =
        bendy::converter::convert(std::vector(source, source + input.source.size()), "fuzz", input.options(), report);
    if (!converted) return 0;
    bendy::fuzz::check(bendy::validate(*converted).empty(), "what is converted is valid");
    if (const auto model = bendy::Model::from_memory(*converted)) bendy::fuzz::use_model(*model, input.choice());
    return 0;
}

namespace {

/// A part of the input, changed; at most room bytes longer.
std::string changed(std::string_view part, std::size_t room, unsigned seed) {
    std::string made(part);
    made.resize(part.size() + room);
    auto* data = reinterpret_cast<std::uint8_t*>(made.data());
    const bool is_bendy =
        bendy::converter::find_source_format(std::as_bytes(std::span(part)), {}) == SourceFormat::bendy;
    const auto mutate = is_bendy ? bendy::fuzz::mutate_bendy : bendy::fuzz::mutate_gltf;
    made.resize(mutate(data, part.size(), made.size(), seed));
    return made;
}

}  // namespace

/// One of the parts changes: mostly the source, else the rig file or the options.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    const ConvertInput input = ConvertInput::split({data, size});
    std::string source(input.source);
    std::string rig(input.rig);
    std::string tail(input.tail);
    const std::size_t used = source.size() + rig.size() + tail.size();
    const std::size_t room = max_size - std::min(max_size, used);
    bendy::fuzz::Random random(seed);
    const std::size_t part = bendy::fuzz::below(random, 8);
    if (part == 0) {
        tail[bendy::fuzz::below(random, ConvertInput::kOptions)] ^=
            static_cast<char>(1u << bendy::fuzz::below(random, 8));
    } else if (part == 1) {
        rig = changed(rig, room, seed);
    } else {
        source = changed(source, room, seed);
    }
    const std::string made = bendy::fuzz::join(source, rig, tail);
    if (made.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
    std::memcpy(data, made.data(), made.size());
    return made.size();
}
