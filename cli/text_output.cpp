#include "text_output.h"

#include "problem.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <iostream>

namespace bendy::cli {

void write_text(const std::filesystem::path& output, std::string_view text) {
    if (output.empty()) {
        std::cout << text;
    } else if (const auto written = write_file(output, as_byte_span(text)); !written) {
        fail(output, describe(written.error()));
    }
}

}  // namespace bendy::cli
