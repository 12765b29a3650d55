#include <bendy/converter/source_format.h>

#include "scene/source/image_bytes.h"
#include "scene/source/readable_formats.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <system_error>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::array kReadable{
    ReadableFormat{SourceFormat::gltf, "a glTF file", {}, {".gltf"}},
    ReadableFormat{SourceFormat::gltf, "a glTF binary file", "glTF", {".glb", ".vrm", ".vrma"}},
#ifdef BENDY_X_FILES
    ReadableFormat{SourceFormat::x, "a DirectX X-file", "xof ", {".x"}},
#endif
#ifdef BENDY_MD2
    ReadableFormat{SourceFormat::md2, "a Quake II model", "IDP2", {".md2"}},
#endif
#ifdef BENDY_BVH
    ReadableFormat{SourceFormat::bvh, "a BVH file", "HIERARCHY", {".bvh"}},
#endif
    ReadableFormat{SourceFormat::bendy, "a bendy file", "HEAD", {".bendy"}},
};

}  // namespace

std::span<const ReadableFormat> readable_formats() {
    return kReadable;
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
constexpr std::string_view kDownload = "download the model itself; on a page that shows a file, that is the raw file";

constexpr FileKind kFbxFile{"an FBX file", std::nullopt, kFbx};
constexpr FileKind kUsdFile{"a USD file", std::nullopt, kUsd};
constexpr FileKind kBlendFile{"a Blender file", std::nullopt, kBlend};
constexpr FileKind kColladaFile{"a COLLADA file", std::nullopt, kCollada};
constexpr FileKind kPlyFile{"a PLY file", std::nullopt, kMeshOnly};
constexpr FileKind kZipFile{"a ZIP archive", std::nullopt, kArchive};
constexpr FileKind kXFile{"a DirectX X-file", std::nullopt, kBuildWithX};
constexpr FileKind kMd2File{"a Quake II model", std::nullopt, kBuildWithMd2};
constexpr FileKind kObjFile{"an OBJ file", std::nullopt, kMeshOnly};
constexpr FileKind kStlFile{"an STL file", std::nullopt, kMeshOnly};
constexpr FileKind kPicture{"a picture", std::nullopt, "give the model that uses it, which takes its pictures along"};
constexpr FileKind kHtmlPage{"an HTML page", std::nullopt, kDownload};
constexpr FileKind kLfsPointer{"a Git LFS pointer", std::nullopt, "fetch the file that it stands for: git lfs pull"};
constexpr FileKind kAnnexPointer{"a git-annex pointer", std::nullopt,
                                 "fetch the file that it stands for: git annex get"};
constexpr FileKind kXmlFile{"an XML file", std::nullopt, kOtherTool};
constexpr FileKind kRigFile{"a rig file", std::nullopt, "give it with a model: bendy convert MODEL --rig FILE"};
constexpr FileKind kJsonFile{"a JSON file without a member of glTF", std::nullopt, kOtherTool};

constexpr std::size_t kKindBytes = 4096;

struct Recognised {
    std::string_view by;  // what a file begins with, or its name's suffix
    FileKind kind;
};

/// Stand-ins for a file that was never downloaded.
constexpr std::array kStandIns{
    Recognised{"version https://git-lfs.github.com/spec/", kLfsPointer},
    Recognised{"version https://hawser.github.com/spec/", kLfsPointer},  // as Git LFS was called
    Recognised{"/annex/objects/", kAnnexPointer},
    Recognised{"404: Not Found", {"a server's error message", std::nullopt, kDownload}},
};

/// Beginnings of texts in angle brackets, in lower case, after XML's own; the first one that occurs says what it is.
constexpr std::array kMarkups{
    Recognised{"<collada", kColladaFile}, Recognised{"<svg", kPicture},     Recognised{"<!doctype html", kHtmlPage},
    Recognised{"<html", kHtmlPage},       Recognised{"<head", kHtmlPage},   Recognised{"<body", kHtmlPage},
    Recognised{"<title", kHtmlPage},      Recognised{"<script", kHtmlPage},
};

/// Signatures of formats that are not read, at least by some builds.
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
    Recognised{"#?RADIANCE", kPicture},
    Recognised{"8BPS", kPicture},
    Recognised{{"II*\0", 4}, kPicture},
    Recognised{{"MM\0*", 4}, kPicture},
    Recognised{"v/1\1", kPicture},  // OpenEXR
};

/// Signatures of archives. Formats that are archives, such as USDZ, are recognised by their suffixes before.
constexpr std::array kArchives{
    Recognised{"PK\3\4", kZipFile},
    Recognised{"PK\5\6", kZipFile},
    Recognised{"\x1f\x8b", {"a gzip archive", std::nullopt, kArchive}},
    Recognised{"7z\xbc\xaf\x27\x1c", {"a 7z archive", std::nullopt, kArchive}},
    Recognised{"Rar!\x1a\x07", {"a RAR archive", std::nullopt, kArchive}},
    Recognised{{"\xfd\x37zXZ\0", 6}, {"an xz archive", std::nullopt, kArchive}},
    Recognised{"BZh", {"a bzip2 archive", std::nullopt, kArchive}},
    Recognised{"\x28\xb5\x2f\xfd", {"a Zstandard archive", std::nullopt, kArchive}},
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
    Recognised{".obj", kObjFile},
    Recognised{".stl", kStlFile},
    Recognised{".ply", kPlyFile},
    Recognised{".3ds", {"a 3DS file", std::nullopt, kOtherTool}},
    Recognised{".max", {"a 3ds Max file", std::nullopt, kOtherTool}},
    Recognised{".ma", {"a Maya file", std::nullopt, kOtherTool}},
    Recognised{".mb", {"a Maya file", std::nullopt, kOtherTool}},
    Recognised{".c4d", {"a Cinema 4D file", std::nullopt, kOtherTool}},
    Recognised{".zip", kZipFile},
};

FileKind kind_of(const ReadableFormat& row) {
    return {row.name, row.format, {}};
}

/// The text without a byte order mark and leading white space.
std::string_view trimmed(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const std::size_t start = text.find_first_not_of(" \t\r\n");
    return start == std::string_view::npos ? std::string_view() : text.substr(start);
}

/// The format of a file name's suffix; null if there is none.
const ReadableFormat* find_by_suffix(const std::string& extension) {
    for (const ReadableFormat& row : kReadable) {
        if (!extension.empty() &&
            std::find(row.suffixes.begin(), row.suffixes.end(), extension) != row.suffixes.end()) {
            return &row;
        }
    }
    return nullptr;
}

template <std::size_t N>
std::optional<FileKind> find_by_beginning(const std::array<Recognised, N>& table, std::string_view text) {
    const auto found =
        std::find_if(table.begin(), table.end(), [&](const Recognised& each) { return text.starts_with(each.by); });
    return found == table.end() ? std::nullopt : std::optional(found->kind);
}

std::string in_lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return lower;
}

std::string small_extension(const std::filesystem::path& file) {
    return in_lower_case(file.extension().string());
}

FileKind find_kind_of_markup(std::string_view text) {
    const std::string lower = in_lower_case(text);
    std::size_t first = std::string::npos;
    FileKind kind = kXmlFile;
    for (const Recognised& each : kMarkups) {
        const std::size_t at = lower.find(each.by);
        if (at >= first) continue;
        first = at;
        kind = each.kind;
    }
    return kind;
}

/// The names of the members of a JSON text's root, as far as the text goes.
std::set<std::string_view> root_members(std::string_view text) {
    std::set<std::string_view> names;
    std::size_t depth = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] == '{' || text[at] == '[') ++depth;
        if ((text[at] == '}' || text[at] == ']') && --depth == 0) break;
        if (text[at] != '"') continue;
        const std::size_t begin = ++at;
        while (at < text.size() && text[at] != '"') at += text[at] == '\\' ? 2 : 1;
        if (at >= text.size()) break;
        const std::size_t colon = text.find_first_not_of(" \t\r\n", at + 1);
        if (depth == 1 && colon != std::string_view::npos && text[colon] == ':')
            names.insert(text.substr(begin, at - begin));
    }
    return names;
}

FileKind find_kind_of_json(std::string_view text, const std::string& extension) {
    constexpr std::array<std::string_view, 19> kOfGltf{"asset",
                                                       "accessors",
                                                       "animations",
                                                       "buffers",
                                                       "bufferViews",
                                                       "cameras",
                                                       "extensions",
                                                       "extras",
                                                       "images",
                                                       "materials",
                                                       "meshes",
                                                       "nodes",
                                                       "samplers",
                                                       "scene",
                                                       "scenes",
                                                       "skins",
                                                       "extensionsUsed",
                                                       "textures",
                                                       "extensionsRequired"};
    const std::set<std::string_view> members = root_members(text);
    const auto has = [&](std::string_view name) { return members.count(name) != 0; };
    if (has("bendy_rig")) return kRigFile;
    if (has("bendy_text") || has("HEAD")) return {"the text of a bendy file", std::nullopt, {}};
    const bool is_gltf = extension == ".gltf" || std::any_of(kOfGltf.begin(), kOfGltf.end(), has);
    return is_gltf ? kind_of(kReadable.front()) : kJsonFile;
}

/// Recognises texts of meshes, which have no signature, by their lines.
std::optional<FileKind> find_kind_of_mesh_text(std::string_view text) {
    const auto has_line = [&](std::string_view beginning) {
        return text.starts_with(beginning) || text.find('\n' + std::string(beginning)) != std::string_view::npos;
    };
    const bool is_comment = text.starts_with('#');
    constexpr std::array<std::string_view, 5> kOfObj{"mtllib ", "v ", "o ", "g ", "vn "};
    const bool begins = std::any_of(kOfObj.begin(), kOfObj.end(), [&](auto word) { return text.starts_with(word); });
    if ((is_comment || begins) && has_line("v ")) return kObjFile;
    if (text.starts_with("solid") && text.find("facet") != std::string_view::npos) return kStlFile;
    return std::nullopt;
}

std::optional<FileKind> find_kind_of_text(std::string_view text, const std::string& extension) {
    if (text.starts_with('<')) return find_kind_of_markup(text);
    if (text.starts_with('{')) return find_kind_of_json(text, extension);
    if (text.starts_with('[')) return kJsonFile;
    return find_kind_of_mesh_text(text);
}

/// Nothing if the file cannot be read.
std::optional<std::string> read_beginning(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return std::nullopt;
    std::string text(kKindBytes, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text;
}

}  // namespace

std::optional<FileKind> find_stand_in(Bytes bytes) {
    const std::string_view text = trimmed(as_text(bytes).substr(0, kKindBytes));
    if (const auto kind = find_by_beginning(kStandIns, text)) return kind;
    if (text.starts_with('<') && find_kind_of_markup(text).name == kHtmlPage.name) return kHtmlPage;
    return std::nullopt;
}

std::optional<FileKind> find_file_kind(Bytes bytes, const std::filesystem::path& name) {
    const std::string_view text = as_text(bytes).substr(0, kKindBytes);
    for (const ReadableFormat& row : kReadable) {
        if (!row.signature.empty() && text.starts_with(row.signature)) return kind_of(row);
    }
    if (const auto kind = find_stand_in(bytes)) return kind;
    if (const auto kind = find_by_beginning(kBeginnings, text)) return kind;
    if (!media_type_of(bytes).empty()) return kPicture;
    const std::string extension = small_extension(name);
    if (const auto kind = find_kind_of_text(trimmed(text), extension)) return kind;
    for (const Recognised& each : kEndings) {
        if (extension == each.by) return each.kind;
    }
    for (const ImageKind& image : image_kinds()) {
        if (extension == image.suffix) return kPicture;
    }
    return find_by_beginning(kArchives, text);
}

std::optional<FileKind> find_file_kind(const std::filesystem::path& file) {
    const auto beginning = read_beginning(file);
    return beginning ? find_file_kind(as_byte_span(*beginning), file) : std::nullopt;
}

SourceFormat find_source_format(Bytes bytes, const std::filesystem::path& name) {
    if (const auto kind = find_file_kind(bytes, name); kind && kind->format) return *kind->format;
    const ReadableFormat* row = find_by_suffix(small_extension(name));
    return row == nullptr || row->format == SourceFormat::bendy ? SourceFormat::gltf : row->format;
}

std::string list_readable_suffixes() {
    std::string list;
    for (const ReadableFormat& row : kReadable) {
        if (row.format == SourceFormat::bendy) continue;
        for (const std::string_view suffix : row.suffixes) {
            if (!suffix.empty()) list.append(list.empty() ? "" : ", ").append(suffix);
        }
    }
    return list;
}

bool has_readable_suffix(const std::filesystem::path& file) {
    const ReadableFormat* row = find_by_suffix(small_extension(file));
    return row != nullptr && row->format != SourceFormat::bendy;
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
    const auto beginning = read_beginning(file);
    return beginning ? why_not_convertible(as_byte_span(*beginning), file) : std::string();
}

std::string why_not_convertible(Bytes bytes, const std::filesystem::path& name) {
    if (bytes.empty()) return "is empty: copy or download it again";
    const auto kind = find_file_kind(bytes, name);
    return kind && !kind->format ? why_not_bendy(*kind, name) : std::string();
}

std::string why_not_a_rig(Bytes bytes) {
    const auto kind = find_file_kind(bytes, {});
    if (!kind || kind->name == kRigFile.name || kind->name == kJsonFile.name) return {};
    const std::string is_this = "is " + std::string(kind->name) + ", not a rig file";
    return find_stand_in(bytes) ? is_this + ": " + std::string(kind->way_in) : is_this;
}

}  // namespace bendy::converter
