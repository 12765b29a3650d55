#pragma once

#include "text.h"

#include <bendy/converter/scene.h>

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace bendy::converter::x_out {

/// The identifiers by which the file's objects refer to one another: letters, digits and underscores, each once.
class Names {
public:
    explicit Names(const Scene& scene);

    std::vector<std::string> joints;
    std::vector<std::string> meshes;
    std::vector<std::string> materials;
    std::vector<std::string> cycles;
    std::string no_material;  ///< of what is drawn without one

private:
    /// \param kind  what a thing without a name is called
    std::string make(std::string_view name, const char* kind, std::size_t number);

    std::unordered_map<std::string, std::uint32_t> times_;  ///< how often an identifier was wanted
};

/// BendyName, where an identifier is not what the thing is called.
void write_name(std::string_view identifier, std::string_view name, Text& text);

}  // namespace bendy::converter::x_out
