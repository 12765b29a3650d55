#include "scene/source/importers.h"

#include <bendy/converter/import.h>
#include <bendy/format/byte_reader.h>

#include <algorithm>
#include <cassert>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

namespace bendy::converter {
namespace {

using Buffer = std::vector<std::byte>;
using Path = std::filesystem::path;
using Imported = Result<Scene, ImportError>;

Imported from_gltf(Buffer bytes, const Path& file, const ConvertOptions& options, Report& report) {
    return import_gltf(std::move(bytes), file, options.gltf, report);
}

Imported from_bendy(Buffer bytes, const Path& /*file*/, const ConvertOptions& /*options*/, Report& report) {
    return import_bendy(Bytes(bytes), report);
}

#ifdef BENDY_X_FILES
Imported from_x(Buffer bytes, const Path& file, const ConvertOptions& options, Report& report) {
    return import_x(as_text(bytes), file, {options.gltf.embed_images, options.gltf.root, options.ticks_per_second},
                    report);
}
#endif

#ifdef BENDY_MD2
Imported from_md2(Buffer bytes, const Path& file, const ConvertOptions& options, Report& report) {
    return import_md2(bytes, file, {options.gltf.embed_images, options.gltf.root, options.texture}, report);
}
#endif

#ifdef BENDY_BVH
Imported from_bvh(Buffer bytes, const Path& file, const ConvertOptions& options, Report& report) {
    return import_bvh(as_text(bytes), file, {options.unit}, report);
}
#endif

constexpr std::array kImporters{
    Importer{.format = SourceFormat::gltf,
             .name = "a glTF file",
             .signature = {},
             .suffixes = {".gltf"},
             .takes_scene = true,
             .import = from_gltf},
    Importer{.format = SourceFormat::gltf,
             .name = "a glTF binary file",
             .signature = "glTF",
             .suffixes = {".glb", ".vrm", ".vrma"},
             .takes_scene = true,
             .import = from_gltf},
#ifdef BENDY_X_FILES
    Importer{.format = SourceFormat::x,
             .name = "a DirectX X-file",
             .signature = "xof ",
             .suffixes = {".x"},
             .takes_ticks = true,
             .import = from_x},
#endif
#ifdef BENDY_MD2
    Importer{.format = SourceFormat::md2,
             .name = "a Quake II model",
             .signature = "IDP2",
             .suffixes = {".md2"},
             .takes_texture = true,
             .import = from_md2},
#endif
#ifdef BENDY_BVH
    Importer{.format = SourceFormat::bvh,
             .name = "a BVH file",
             .signature = "HIERARCHY",
             .suffixes = {".bvh"},
             .takes_unit = true,
             .import = from_bvh},
#endif
    Importer{.format = SourceFormat::bendy,
             .name = "a bendy file",
             .signature = "HEAD",
             .suffixes = {".bendy"},
             .import = from_bendy},
};

}  // namespace

std::span<const Importer> importers() {
    return kImporters;
}

const Importer& importer_of(SourceFormat format) {
    const auto found = std::find_if(kImporters.begin(), kImporters.end(),
                                    [&](const Importer& importer) { return importer.format == format; });
    assert(found != kImporters.end());
    return *found;
}

namespace {

constexpr std::string_view kBlender =
    "export it as glTF 2.0 from Blender (File > Import, then File > Export > glTF 2.0)";
constexpr std::string_view kMeshOnly =
    "it holds a mesh without a skeleton; bind it to one in Blender, and export that (File > Export > glTF 2.0)";
constexpr std::string_view kFbx =
    "export it as glTF 2.0 from Blender (File > Import > FBX, then File > Export > glTF 2.0), or convert it with "
    "FBX2glTF";
constexpr std::string_view kUsd =
    "export it as glTF 2.0 from Blender (File > Import > Universal Scene Description, then File > Export > glTF 2.0)";
constexpr std::string_view kBlend = "open it in Blender and export it (File > Export > glTF 2.0)";
constexpr std::string_view kCollada =
    "export it as glTF 2.0 from Blender 4 (File > Import > Collada, then File > Export > glTF 2.0), or convert it with "
    "COLLADA2GLTF";
constexpr std::string_view kOtherTool = "export it as glTF 2.0 from the program that made it";
constexpr std::string_view kBuildWithX = "build it with BENDY_X_FILES=ON";
constexpr std::string_view kBuildWithMd2 = "build it with BENDY_MD2=ON";
constexpr std::string_view kBuildWithBvh = "build it with BENDY_BVH=ON";
constexpr std::string_view kArchive = "unpack it, and convert the model that is in it";

constexpr FileKind kFbxFile{"an FBX file", std::nullopt, kFbx};
constexpr FileKind kUsdFile{"a USD file", std::nullopt, kUsd};
constexpr FileKind kBlendFile{"a Blender file", std::nullopt, kBlend};
constexpr FileKind kColladaFile{"a COLLADA file", std::nullopt, kCollada};
constexpr FileKind kPlyFile{"a PLY file", std::nullopt, kMeshOnly};
constexpr FileKind kZipFile{"a ZIP archive", std::nullopt, kArchive};
constexpr FileKind kXFile{"a DirectX X-file", std::nullopt, kBuildWithX};
constexpr FileKind kMd2File{"a Quake II model", std::nullopt, kBuildWithMd2};

constexpr std::size_t kKindBytes = 4096;

struct Recognised {
    std::string_view by;  // what a file begins with, or its name's suffix
    FileKind kind;
};

/// Signatures of formats without an importer, at least in some builds. USDZ is a ZIP archive: its suffix takes
/// precedence.
constexpr std::array kBeginnings{
    Recognised{"xof ", kXFile},
    Recognised{"IDP2", kMd2File},
    Recognised{"Kaydara FBX Binary", kFbxFile},
    Recognised{"; FBX ", kFbxFile},
    Recognised{"PXR-USDC", kUsdFile},
    Recognised{"#usda ", kUsdFile},
    Recognised{"BLENDER", kBlendFile},
    Recognised{"IDPO", {"a Quake model (MDL)", std::nullopt, kBlender}},
    Recognised{"IDP3", {"a Quake III model (MD3)", std::nullopt, kBlender}},
    Recognised{"MD5Version", {"a Doom 3 file (MD5)", std::nullopt, kBlender}},
    Recognised{"IDST", {"a Half-Life model (MDL)", std::nullopt, kBlender}},
    Recognised{"HIERARCHY", {"a BVH file", std::nullopt, kBuildWithBvh}},
    Recognised{"ply\n", kPlyFile},
    Recognised{"ply\r", kPlyFile},
};

/// Suffixes of formats that have no signature, or may be compressed.
constexpr std::array kEndings{
    Recognised{".fbx", kFbxFile},
    Recognised{".usd", kUsdFile},
    Recognised{".usda", kUsdFile},
    Recognised{".usdc", kUsdFile},
    Recognised{".usdz", kUsdFile},
    Recognised{".blend", kBlendFile},
    Recognised{".dae", kColladaFile},
    Recognised{".obj", {"an OBJ file", std::nullopt, kMeshOnly}},
    Recognised{".stl", {"an STL file", std::nullopt, kMeshOnly}},
    Recognised{".ply", kPlyFile},
    Recognised{".3ds", {"a 3DS file", std::nullopt, kOtherTool}},
    Recognised{".max", {"a 3ds Max file", std::nullopt, kOtherTool}},
    Recognised{".ma", {"a Maya file", std::nullopt, kOtherTool}},
    Recognised{".mb", {"a Maya file", std::nullopt, kOtherTool}},
    Recognised{".c4d", {"a Cinema 4D file", std::nullopt, kOtherTool}},
    Recognised{".zip", kZipFile},
};

FileKind kind_of(const Importer& importer) {
    return {importer.name, importer.format, {}};
}

std::string small_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return extension;
}

/// The text without a byte order mark and leading white space.
std::string_view trimmed(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const std::size_t start = text.find_first_not_of(" \t\r\n");
    return start == std::string_view::npos ? std::string_view() : text.substr(start);
}

/// The importer for a file name's suffix; null if there is none.
const Importer* find_by_suffix(const std::string& extension) {
    for (const Importer& importer : importers()) {
        if (!extension.empty() &&
            std::find(importer.suffixes.begin(), importer.suffixes.end(), extension) != importer.suffixes.end()) {
            return &importer;
        }
    }
    return nullptr;
}

std::optional<FileKind> find_kind_of_text(std::string_view text, const std::string& extension) {
    if (text.starts_with('<') && text.find("<COLLADA") != std::string_view::npos) return kColladaFile;
    if (!text.starts_with('{')) return std::nullopt;
    if (text.find("\"bendy_text\"") != std::string_view::npos)
        return FileKind{"the text of a bendy file", std::nullopt, {}};
    if (extension == ".gltf" || text.find("\"asset\"") != std::string_view::npos)
        return kind_of(importer_of(SourceFormat::gltf));
    return std::nullopt;
}

std::string read_beginning(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return {};
    std::ifstream stream(file, std::ios::binary);
    std::string text(kKindBytes, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text;
}

}  // namespace

std::optional<FileKind> find_file_kind(Bytes bytes, const std::filesystem::path& name) {
    const std::string_view text = as_text(bytes).substr(0, kKindBytes);
    for (const Importer& importer : importers()) {
        if (!importer.signature.empty() && text.starts_with(importer.signature)) return kind_of(importer);
    }
    for (const Recognised& each : kBeginnings) {
        if (text.starts_with(each.by)) return each.kind;
    }
    const std::string extension = small_extension(name);
    if (const auto kind = find_kind_of_text(trimmed(text), extension)) return kind;
    for (const Recognised& each : kEndings) {
        if (extension == each.by) return each.kind;
    }
    if (text.starts_with("PK\3\4")) return kZipFile;
    return std::nullopt;
}

std::optional<FileKind> find_file_kind(const std::filesystem::path& file) {
    const std::string beginning = read_beginning(file);
    return find_file_kind(as_byte_span(beginning), file);
}

SourceFormat find_source_format(Bytes bytes, const std::filesystem::path& name) {
    if (const auto kind = find_file_kind(bytes, name); kind && kind->format) return *kind->format;
    const Importer* importer = find_by_suffix(small_extension(name));
    return importer == nullptr || importer->format == SourceFormat::bendy ? SourceFormat::gltf : importer->format;
}

std::string list_readable_suffixes() {
    std::string list;
    for (const Importer& importer : importers()) {
        if (importer.format == SourceFormat::bendy) continue;
        for (const std::string_view suffix : importer.suffixes) {
            if (!suffix.empty()) list.append(list.empty() ? "" : ", ").append(suffix);
        }
    }
    return list;
}

bool has_readable_suffix(const std::filesystem::path& file) {
    const Importer* importer = find_by_suffix(small_extension(file));
    return importer != nullptr && importer->format != SourceFormat::bendy;
}

bool is_converted(Bytes bytes, const std::filesystem::path& name) {
    const auto kind = find_file_kind(bytes, name);
    return kind ? kind->format != SourceFormat::bendy : has_readable_suffix(name);
}

std::string why_not_a_file(const std::filesystem::path& file) {
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(file, ignored);
    if (status.type() == std::filesystem::file_type::not_found) return "there is no such file";
    return std::filesystem::is_directory(status) ? "is a folder, not a file" : "";
}

std::string quoted_for_shell(std::string_view word) {
    constexpr std::string_view kPlain = "._-/+:,@%";
    const bool is_plain = !word.empty() && std::all_of(word.begin(), word.end(), [&](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               static_cast<unsigned char>(c) >= 0x80 || kPlain.find(c) != std::string_view::npos;
    });
    if (is_plain) return std::string(word);
    std::string text = "'";
    for (const char c : word) {
        if (c == '\'') {
            text += "'\\''";
        } else {
            text += c;
        }
    }
    return text + '\'';
}

std::string why_not_bendy(const FileKind& kind, const std::filesystem::path& file) {
    if (kind.format == SourceFormat::bendy) return {};
    const std::string is_this = "is " + std::string(kind.name);
    if (kind.format)
        return is_this + ", not a bendy file; convert it first: bendy convert " + quoted_for_shell(file.string());
    if (kind.way_in.empty())
        return is_this + "; make a bendy file of it first: bendy assemble " + quoted_for_shell(file.string());
    return is_this + ", which bendy does not read: " + std::string(kind.way_in);
}

std::string why_not_convertible(const std::filesystem::path& file) {
    if (std::string why = why_not_a_file(file); !why.empty()) return why;
    const auto kind = find_file_kind(file);
    return kind && !kind->format ? why_not_bendy(*kind, file) : std::string();
}

std::string why_not_convertible(Bytes bytes, const std::filesystem::path& name) {
    const auto kind = find_file_kind(bytes, name);
    return kind && !kind->format ? why_not_bendy(*kind, name) : std::string();
}

}  // namespace bendy::converter
