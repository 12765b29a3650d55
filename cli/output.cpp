#include "output.h"

#include "console.h"
#include "input_bytes.h"
#include "problem.h"
#include "written_by_bendy.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <cassert>
#include <iostream>
#include <span>
#include <system_error>

namespace bendy::cli {
namespace {

namespace fs = std::filesystem;

/// Where a file is or will be, links followed, also one that leads to what is not there yet.
fs::path resolved(fs::path file) {
    constexpr int kMostLinks = 40;
    std::error_code error;
    for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(file, error)); ++i) {
        const fs::path target = fs::read_symlink(file, error);
        if (error) break;
        file = file.parent_path() / target;
    }
    fs::path canonical = fs::weakly_canonical(fs::absolute(file), error);
    return error ? fs::absolute(file).lexically_normal() : canonical;
}

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
}

/// A device or a pipe takes what is written; nothing is lost there.
bool holds_bytes(const fs::path& file) {
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    return fs::exists(status) && (fs::is_regular_file(status) || fs::is_directory(status));
}

constexpr const char* kForeign = "is there, and bendy did not write it: --force replaces it, -o writes elsewhere";

}  // namespace

void Outputs::reads(const fs::path& input) {
    const auto identity = is_dash(input) ? identity_of_standard_input() : identity_of(input);
    if (identity) inputs_.try_emplace(*identity, input);
}

const fs::path* Outputs::input_at(const fs::path& output) const {
    const auto identity = is_dash(output) ? identity_of_standard_output() : identity_of(output);
    if (!identity) return nullptr;
    const auto found = inputs_.find(*identity);
    return found == inputs_.end() ? nullptr : &found->second;
}

std::string Outputs::claim(const fs::path& output, NamedBy named) {
    if (const fs::path* input = input_at(output)) {
        return "is an input as well as an output" +
               (*input == output ? std::string() : ", it is " + shown_name(*input)) + ": give another name";
    }
    if (is_dash(output))
        return outputs_.insert(output).second ? "" : "cannot take two outputs: write one of them to a file";
    if (holds_bytes(output) || !is_there(output)) {
        bool is_new = resolved_.insert(resolved(output)).second;
        if (const auto identity = identity_of(output)) is_new = replaced_.insert(*identity).second && is_new;
        if (!is_new) return "would be written twice: give each output a name of its own";
    }
    if (named == NamedBy::program && !force_ && is_there(output) && !was_written_by_bendy(output)) return kForeign;
    outputs_.insert(output);
    return {};
}

void Outputs::fail_if(const std::string& problem, const fs::path& output) const {
    if (!problem.empty()) fail(output_name(output), problem);
}

void Outputs::writes(const fs::path& output, NamedBy named, Content content) {
    fail_if(claim(output, named), output);
    if (is_dash(output) && content == Content::binary && is_terminal(Stream::output))
        fail(output_name(output), "is a terminal, and the result is binary: give -o FILE, or a pipe");
}

void Outputs::writes_beside(const fs::path& output, const fs::path& beside) {
    fail_if(claim(output, NamedBy::user), output);
    if (!force_ && is_there(output) && !(was_written_by_bendy(beside) && refers_to(beside, output)))
        fail(output_name(output), kForeign);
}

void Outputs::write(const fs::path& output, Bytes bytes) const {
    assert(outputs_.contains(output));
    for (const fs::path& claimed : outputs_) {
        if (const fs::path* input = input_at(claimed))
            fail(output_name(claimed), "is an input as well as an output: " + shown_name(*input) + " was read");
    }
    if (is_dash(output)) {
        const auto text = as_text(bytes);
        std::cout.write(text.data(), static_cast<std::streamsize>(text.size()));
        return;
    }
    if (const auto written = write_file(output, bytes); !written) fail(output, describe(written.error()));
}

void Outputs::write(const fs::path& output, std::string_view text) const {
    write(output, as_byte_span(text));
}

std::string output_name(const fs::path& output) {
    return is_dash(output) ? "standard output" : output.string();
}

std::ostream& summary_stream(const fs::path& output) {
    return is_dash(output) ? std::cerr : std::cout;
}

}  // namespace bendy::cli
