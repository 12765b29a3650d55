#include "commands.h"
#include "import_problem.h"
#include "input_bytes.h"
#include "problem.h"

#ifdef BENDY_HAS_VIEWER

#include "tentacle.h"

#include <bendy/converter/convert.h>
#include <bendy/converter/readable_files.h>
#include <bendy/format/diagnostics.h>
#include <bendy/viewer/view.h>
#include <bendy/viewer/viewer_error.h>

#include <memory>
#include <vector>

namespace bendy::cli {
namespace {

struct ViewArguments {
    std::filesystem::path file;
    viewer::ViewOptions view;
};

/// The bytes of a bendy file, or of a glTF file converted to one.
std::vector<std::byte> open_any(const std::filesystem::path& file) {
    const std::string name = file.string();
    Result<InputBytes> input = InputBytes::open(file);
    if (!input) throw viewer::ViewerError(name + ": " + describe(input.error()));
    const bool is_bendy = as_text(input->bytes()).starts_with("HEAD");
    if (is_bendy || !(is_dash(file) || converter::has_readable_extension(file))) return (*std::move(input)).take();
    converter::Report report;
    auto converted = is_dash(file) ? converter::convert((*std::move(input)).take(), "standard input", {}, report)
                                   : converter::convert(file, {}, report);
    if (!converted) throw viewer::ViewerError(name + ": " + describe(converted.error()));
    return *std::move(converted);
}

void run(ViewArguments arguments) {
    viewer::ViewOptions& options = arguments.view;
    options.file = arguments.file;
    options.open = open_any;
    options.tentacle = std::as_bytes(std::span(kTentacle));
    const std::filesystem::path name = arguments.file.empty() ? "tentacle demo" : arguments.file;
    options.warn = [name](const std::string& what) { warn(name, printable(what)); };
    try {
        viewer::view(options);
    } catch (const viewer::ViewerError& problem) {
        std::string what = problem.what();
        // What is wrong with a file begins with its name.
        if (what.starts_with(name.string() + ": ")) what.erase(0, name.string().size() + 2);
        fail(name, printable(what));
    }
}

}  // namespace

void add_view(CLI::App& program) {
    const auto arguments = std::make_shared<ViewArguments>();
    CLI::App* command = program.add_subcommand("view", "Look at a character; without a file, the tentacle demo");
    command->add_option("FILE", arguments->file, "a bendy file, or a .glb or .gltf, which is converted on the fly");
    command->add_flag("-v,--verbose", arguments->view.verbose, "say which OpenGL draws");
    // For tests, see viewer/src/window.h.
    command->add_option("--script", arguments->view.script)->group("");
    command->add_flag("--trace", arguments->view.trace)->group("");
    command->footer("H shows the keys. Drop a .glb or .bendy file on the window to open it.");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::cli

#else

namespace bendy::cli {

void add_view(CLI::App& program) {
    CLI::App* command = program.add_subcommand("view", "Look at a character (this bendy was built without it)");
    command->allow_extras();
    command->callback([] { fail("view", "this bendy was built without the viewer (BENDY_VIEWER=OFF)"); });
}

}  // namespace bendy::cli

#endif
