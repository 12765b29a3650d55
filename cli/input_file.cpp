#include "input_file.h"

#include "import_problem.h"
#include "problem.h"
#include "warnings.h"

#include <bendy/converter/convert.h>
#include <bendy/converter/source_format.h>
#include <bendy/format/diagnostics.h>

#include <utility>

namespace bendy::cli {

std::string why_not_opened(const std::filesystem::path& file, const Error& error) {
    const std::string why = is_dash(file) ? std::string() : converter::why_not_a_file(file);
    return why.empty() ? bendy::describe(error) : why;
}

std::string why_not_bendy(const std::filesystem::path& file, Bytes bytes) {
    const auto kind = converter::find_file_kind(bytes, file);
    return kind ? converter::why_not_bendy(*kind, file) : std::string();
}

InputBytes open_file(const std::filesystem::path& file) {
    Result<InputBytes> mapped = InputBytes::open(file);
    if (!mapped) fail(file, why_not_opened(file, mapped.error()));
    return *std::move(mapped);
}

InputBytes open_bendy_file(const std::filesystem::path& file) {
    InputBytes mapped = open_file(file);
    if (const std::string why = why_not_bendy(file, mapped.bytes()); !why.empty()) fail(file, printable(why));
    return mapped;
}

namespace {

Result<std::vector<std::byte>, converter::ImportError> converted_input(const std::filesystem::path& file,
                                                                       InputBytes bytes, converter::Report& report) {
    if (is_dash(file)) return converter::convert(std::move(bytes).take(), "standard input", {}, report);
    bytes = InputBytes();
    return converter::convert(file, {}, report);
}

}  // namespace

Result<CharacterFile, converter::ImportError> read_character(const std::filesystem::path& file,
                                                             converter::Report& report) {
    Result<InputBytes> mapped = InputBytes::open(file);
    if (!mapped) return converter::ImportError{{}, why_not_opened(file, mapped.error())};
    const auto kind = converter::find_file_kind(mapped->bytes(), file);
    const bool is_bendy = kind && kind->format == converter::SourceFormat::bendy;
    // Of what is not known the name decides who says what is wrong with it.
    if (is_bendy || (!kind && !is_dash(file) && !converter::has_readable_suffix(file)))
        return CharacterFile(*std::move(mapped));
    auto converted = converted_input(file, *std::move(mapped), report);
    if (!converted) return converted.error();
    return CharacterFile(*std::move(converted));
}

CharacterFile open_character(const std::filesystem::path& file, Outputs& outputs) {
    converter::Report report;
    auto character = read_character(file, report);
    for (const converter::SourceFile& source : report.sources()) outputs.reads(source.file);
    if (!character) fail(file_of(character.error(), file), describe(character.error()));
    print_warnings(file, report);
    print_proposals(report);
    return *std::move(character);
}

}  // namespace bendy::cli
