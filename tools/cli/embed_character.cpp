// A build tool: embed_character IN.glb OUT.h NAME converts a character and writes its bytes as a C++ array.
#include <bendy/converter/convert.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <cstdio>
#include <span>
#include <string>

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fputs("usage: embed_character IN.glb OUT.h NAME\n", stderr);
        return 2;
    }
    bendy::converter::Report report;
    const auto bytes = bendy::converter::convert(argv[1], {}, report);
    if (!bytes) {
        std::fprintf(stderr, "%s: %s\n", argv[1], bytes.error().message.c_str());
        return 1;
    }
    std::string text = "#pragma once\n\ninline constexpr unsigned char " + std::string(argv[3]) + "[] = {";
    constexpr std::size_t kPerLine = 32;
    for (std::size_t at = 0; at < bytes->size(); ++at)
        text += (at % kPerLine == 0 ? "\n" : "") + std::to_string(std::to_integer<unsigned>((*bytes)[at])) + ',';
    text += "\n};\n";
    const auto written = bendy::write_file(argv[2], std::as_bytes(std::span(text)));
    if (!written) std::fprintf(stderr, "%s: %s\n", argv[2], bendy::describe(written.error()).c_str());
    return written ? 0 : 1;
}
