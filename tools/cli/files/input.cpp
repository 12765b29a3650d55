#include "files/input.h"

#include "reports/messages.h"

#include <bendy/converter/convert.h>
#include <bendy/converter/source_format.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <new>
#include <utility>

namespace bendy::tools {
namespace {

Error cannot_read(int number) {
    return {ErrorCode::kCannotRead, 0, static_cast<std::uint64_t>(number)};
}

Result<std::vector<std::byte>> read_standard_input() {
    static bool was_read = false;
    if (std::exchange(was_read, true)) fail("-", "can be read only once: give one of the files by name");
    std::vector<std::byte> bytes;
    std::size_t size = 0;
    constexpr std::size_t kFirst = std::size_t{1} << 16;
    while (true) {
        // One byte past the limit distinguishes a longer file from one of exactly that size.
        if (size == bytes.size()) bytes.resize(std::clamp<std::size_t>(2 * size, kFirst, InputBytes::kMostPiped + 1));
        const std::size_t got = std::fread(bytes.data() + size, 1, bytes.size() - size, stdin);
        size += got;
        if (size > InputBytes::kMostPiped) return cannot_read(EFBIG);
        if (std::ferror(stdin) != 0) return cannot_read(errno);
        if (got == 0) break;
    }
    bytes.resize(size);
    return bytes;
}

Result<std::vector<std::byte>, converter::ImportError> converted_input(const std::filesystem::path& file,
                                                                       const std::filesystem::path& root,
                                                                       InputBytes bytes, converter::Report& report) {
    converter::ConvertOptions options;
    options.gltf.root = root;
    if (is_dash(file)) return converter::convert(std::move(bytes).take(), "standard input", options, report);
    bytes = InputBytes();
    return converter::convert(file, options, report);
}

}  // namespace

Result<InputBytes> InputBytes::open(const std::filesystem::path& file, Storage storage) {
    InputBytes input;
    if (!is_dash(file)) {
        Result<MappedFile> mapped = storage == Storage::copied ? MappedFile::read(file) : MappedFile::open(file);
        if (!mapped) return mapped.error();
        input.mapped_ = *std::move(mapped);
        return input;
    }
    try {
        auto piped = read_standard_input();
        if (!piped) return piped.error();
        input.piped_ = *std::move(piped);
    } catch (const std::bad_alloc&) {
        return cannot_read(ENOMEM);
    }
    input.is_piped_ = true;
    return input;
}

InputBytes InputBytes::read(const std::filesystem::path& file) {
    Result<InputBytes> input = open(file);
    if (!input) fail(file, describe(input.error()));
    return *std::move(input);
}

std::vector<std::byte> InputBytes::take() && {
    if (is_piped_) return std::move(piped_);
    return {mapped_.bytes().begin(), mapped_.bytes().end()};
}

std::string why_not_opened(const std::filesystem::path& file, const Error& error) {
    const std::string why = is_dash(file) ? std::string() : converter::why_not_a_file(file);
    return why.empty() ? bendy::describe(error) : why;
}

std::string why_not_bendy(const std::filesystem::path& file, Bytes bytes) {
    const auto kind = converter::find_file_kind(bytes, file);
    return kind ? converter::why_not_bendy(*kind, file) : std::string();
}

InputBytes open_file(const std::filesystem::path& file, Storage storage) {
    Result<InputBytes> mapped = InputBytes::open(file, storage);
    if (!mapped) fail(file, why_not_opened(file, mapped.error()));
    return *std::move(mapped);
}

InputBytes open_bendy_file(const std::filesystem::path& file, Storage storage) {
    InputBytes mapped = open_file(file, storage);
    if (const std::string why = why_not_bendy(file, mapped.bytes()); !why.empty()) fail(file, printable(why));
    return mapped;
}

ChunkTree read_tree(const std::filesystem::path& file, Bytes bytes) {
    Result<ChunkTree> tree = read_chunk_tree(bytes);
    if (!tree) fail(file, tree.error(), bytes);
    return *std::move(tree);
}

Model read_model(const std::filesystem::path& file, Bytes bytes) {
    Result<Model> model = Model::from_memory(bytes);
    if (!model) fail(file, model.error(), bytes);
    return *std::move(model);
}

Result<void> check_whole(Bytes bytes) {
    const Faults faults = validate(bytes);
    if (!faults.empty()) return faults.list().front();
    return {};
}

Model read_valid_model(const std::filesystem::path& file, Bytes bytes) {
    if (const auto checked = check_whole(bytes); !checked) fail(file, checked.error(), bytes);
    return read_model(file, bytes);
}

ReadableFolders folders_of(const std::filesystem::path& file, const std::filesystem::path& root) {
    return is_dash(file) ? ReadableFolders(root) : ReadableFolders::of(file, root);
}

Result<CharacterFile, converter::ImportError> read_character(const std::filesystem::path& file,
                                                             const std::filesystem::path& root,
                                                             converter::Report& report, Storage storage) {
    Result<InputBytes> mapped = InputBytes::open(file, storage);
    if (!mapped) return converter::ImportError{{}, why_not_opened(file, mapped.error())};
    return read_character(file, *std::move(mapped), root, report);
}

Result<CharacterFile, converter::ImportError> read_character(const std::filesystem::path& file, InputBytes mapped,
                                                             const std::filesystem::path& root,
                                                             converter::Report& report) {
    if (!converter::is_converted(mapped.bytes(), file)) return CharacterFile(std::move(mapped));
    auto converted = converted_input(file, root, std::move(mapped), report);
    if (!converted) return converted.error();
    return CharacterFile(*std::move(converted));
}

CharacterFile open_character(const std::filesystem::path& file, const std::filesystem::path& root, Outputs& outputs,
                             Storage storage) {
    converter::Report report;
    auto character = read_character(file, root, report, storage);
    for (const converter::SourceFile& source : report.sources()) outputs.reads(source.file);
    if (!character) fail(file_of(character.error(), file), describe(character.error()));
    print_warnings(file, report);
    return *std::move(character);
}

}  // namespace bendy::tools
