// As much of `bendy convert` as check_hashes.py calls, so that a build of the converter alone will do:
//   bendy_convert_only convert -q IN -o OUT [--compact] [--lod] [--keep-order] [--auto-rig]
//     [--max-error BOUND] [--rig FILE]
#include <bendy/converter/convert.h>
#include <bendy/format/file.h>

#include <cstdio>
#include <string_view>

int main(int argc, char** argv) {
    using namespace bendy;
    if (argc < 6) return 2;
    converter::ConvertOptions options;
    for (int i = 6; i < argc; ++i) {
        const std::string_view option = argv[i];
        if (option == "--compact") {
            options.compact = converter::ErrorBound();
        } else if (option == "--lod") {
            options.lod = true;
        } else if (option == "--keep-order") {
            options.keep_order = true;
        } else if (option == "--auto-rig") {
            options.auto_rig = true;
        } else if (option == "--max-error" && i + 1 < argc) {
            const auto bound = converter::parse_error_bound(argv[++i]);
            if (!bound) return 2;
            options.compact = *bound;
        } else if (option == "--rig" && i + 1 < argc) {
            options.rig = argv[++i];
        } else {
            std::fprintf(stderr, "no option %s\n", argv[i]);
            return 2;
        }
    }
    converter::Report unheard;
    const auto bytes = converter::convert(argv[3], options, unheard);
    return bytes && write_file(argv[5], *bytes) ? 0 : 1;
}
