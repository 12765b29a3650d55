#include "input_file.h"

#include "import_problem.h"
#include "problem.h"
#include "warnings.h"

#include <bendy/converter/convert.h>
#include <bendy/converter/readable_files.h>
#include <bendy/converter/source_format.h>
#include <bendy/format/diagnostics.h>

#include <utility>

namespace bendy::cli {

std::string why_not_opened(const std::filesystem::path& file, const Error& error) {
    const std::string why = converter::why_not_a_file(file);
    return why.empty() ? bendy::describe(error) : why;
}

std::string why_not_bendy(const std::filesystem::path& file, Bytes bytes) {
    const auto kind = converter::find_file_kind(bytes, file);
    return kind ? converter::why_not_bendy(*kind, file) : std::string();
}

MappedFile open_file(const std::filesystem::path& file) {
    Result<MappedFile> mapped = MappedFile::open(file);
    if (!mapped) fail(file, why_not_opened(file, mapped.error()));
    return *std::move(mapped);
}

MappedFile open_bendy_file(const std::filesystem::path& file) {
    MappedFile mapped = open_file(file);
    if (const std::string why = why_not_bendy(file, mapped.bytes()); !why.empty()) fail(file, printable(why));
    return mapped;
}

Result<CharacterFile, converter::ImportError> read_character(const std::filesystem::path& file,
                                                             converter::Report& report) {
    Result<MappedFile> mapped = MappedFile::open(file);
    if (!mapped) return converter::ImportError{{}, why_not_opened(file, mapped.error())};
    const auto kind = converter::find_file_kind(mapped->bytes(), file);
    const bool is_bendy = kind && kind->format == converter::SourceFormat::bendy;
    // Of what is not known the name decides who says what is wrong with it.
    if (is_bendy || (!kind && !converter::has_readable_extension(file))) return CharacterFile(*std::move(mapped));
    *mapped = MappedFile();
    auto converted = converter::convert(file, {}, report);
    if (!converted) return converted.error();
    return CharacterFile(*std::move(converted));
}

CharacterFile open_character(const std::filesystem::path& file) {
    converter::Report report;
    auto character = read_character(file, report);
    if (!character) fail(file_of(character.error(), file), describe(character.error()));
    print_warnings(file, report);
    print_proposals(report);
    return *std::move(character);
}

}  // namespace bendy::cli
