#pragma once

#include "names.h"

#include <bendy/converter/export_x.h>

namespace bendy::converter::x_out {

/// Writes every material at the file's top. Images that the scene embeds become files beside it.
void write_materials(const Scene& scene, const Names& names, const std::string& image_stem, Text& text,
                     std::vector<XAsset::File>& images, Report& report);

}  // namespace bendy::converter::x_out
