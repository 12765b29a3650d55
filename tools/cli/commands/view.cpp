#include "commands/commands.h"
#include "files/input.h"
#include "reports/messages.h"

#ifdef BENDY_HAS_VIEWER

#include "commands/model_options.h"
#include "tentacle.h"

#include <bendy/format/diagnostics.h>
#include <bendy/viewer/view.h>

#include <memory>
#include <vector>

namespace bendy::tools {
namespace {

struct ViewArguments {
    std::filesystem::path file;
    viewer::ViewOptions view;
};

/// Returns the bytes of a bendy file, or of a file of another kind after conversion.
std::vector<std::byte> open_any(const std::filesystem::path& file, const std::filesystem::path& root) {
    converter::Report report;
    const auto character = read_character(file, root, report, Storage::copied);
    if (!character)
        throw viewer::ViewerError(file_of(character.error(), file).string() + ": " + describe(character.error()));
    if (const auto checked = check_whole(character->bytes()); !checked)
        throw viewer::ViewerError(file.string() + ": " + describe_with_place(checked.error(), character->bytes()));
    print_warnings(file, report);
    return {character->bytes().begin(), character->bytes().end()};
}

void run(ViewArguments arguments) {
    viewer::ViewOptions& options = arguments.view;
    options.file = arguments.file;
    options.open = [root = options.root](const std::filesystem::path& path) { return open_any(path, root); };
    options.tentacle = std::as_bytes(std::span(kTentacle));
    const std::filesystem::path name = arguments.file.empty() ? "tentacle demo" : arguments.file;
    options.warn = [name](const std::string& what) { warn(name, printable(what)); };
    try {
        viewer::view(options);
    } catch (const viewer::ViewerError& problem) {
        std::string what = problem.what();
        // The message may already begin with the file's name, which fail() adds.
        if (what.starts_with(name.string() + ": ")) what.erase(0, name.string().size() + 2);
        fail(name, printable(what));
    }
}

}  // namespace

void add_view(CLI::App& program) {
    const auto arguments = std::make_shared<ViewArguments>();
    CLI::App* command = program.add_subcommand("view", "Look at a character; without a file, the tentacle demo");
    add_character(*command, arguments->file);
    add_root(*command, arguments->view.root);
    command->add_flag("-v,--verbose", arguments->view.verbose, "print the OpenGL driver in use");
    // For tests, see tools/viewer/src/window.h.
    command->add_option("--script", arguments->view.script)->group("");
    command->add_flag("--trace", arguments->view.trace)->group("");
    command->footer("H shows the keys. Drop a .glb or .bendy file on the window to open it.");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::tools

#else

namespace bendy::tools {

void add_view(CLI::App& program) {
    CLI::App* command = program.add_subcommand("view", "Look at a character (this bendy was built without it)");
    command->allow_extras();
    command->callback([] { fail("view", kWithoutViewer); });
}

}  // namespace bendy::tools

#endif
