#pragma once

#include <bendy/runtime.h>

#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace bendy::bench {

struct Body {
    std::string path;
    Model model;
};

/// Opens files; leaves out, with a line on stderr, those whose clips cannot be retargeted.
/// \return nothing, after a line on stderr, if a file cannot be opened
inline std::optional<std::vector<Body>> open_bodies(std::span<const char* const> paths) {
    std::vector<Body> bodies;
    for (const char* path : paths) {
        const auto model = Model::open(path);
        if (!model) {
            std::fprintf(stderr, "%s: cannot be opened\n", path);
            return std::nullopt;
        }
        if (const auto own = Retarget::make(*model, *model); !own) {
            std::fprintf(stderr, "%s: %s\n", path, error_text(own.error()).c_str());
            continue;
        }
        bodies.push_back({path, *model});
    }
    return bodies;
}

}  // namespace bendy::bench
