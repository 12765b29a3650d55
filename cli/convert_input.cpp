#include "convert_input.h"

#include "input_bytes.h"

#include <string>

namespace bendy::cli {

Result<std::vector<std::byte>, converter::ImportError> convert_input(const std::filesystem::path& input,
                                                                     converter::ConvertOptions options,
                                                                     converter::Report& report) {
    const std::filesystem::path name = "standard input";
    if (options.rig && is_dash(*options.rig)) {
        const InputBytes rig = InputBytes::read(*options.rig);
        options.rig_text = std::string(as_text(rig.bytes()));
        options.rig = name;
    }
    if (!is_dash(input)) return converter::convert(input, options, report);
    return converter::convert(InputBytes::read(input).take(), name, options, report);
}

}  // namespace bendy::cli
