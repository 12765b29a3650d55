#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <string_view>

namespace bendy::converter {

/// Takes apart what build_chunks writes into HEAD's EXTR, {"asset": ..., "extras": ...}: the values' text as it stands.
/// Other JSON is kept whole as the source's extras.
void read_source_facts(std::string_view text, Scene& scene, Report& report);

}  // namespace bendy::converter
