#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// One function for each format that is read: bytes in, a Scene out.

namespace bendy::converter {

struct GltfOptions {
    /// Scene to take: its name or its index in decimal digits; empty: the file's default scene, else the first, else
    /// all root nodes.
    std::optional<std::string> scene;
    /// false: images that the source keeps in files of their own stay there and are referred to by URI.
    bool embed_images = true;
    /// A folder whose files may be read too; else only those in the source's own folder and below it are, see
    /// ReadableFolders. A source without a folder has only this one, and its names start there.
    std::filesystem::path root;
    /// Make a joint, with meshes of its own, of every instance of EXT_mesh_gpu_instancing. Else their numbers are kept
    /// as data, and a node draws its mesh once.
    bool instances = false;
};

/// Reads a .gltf or .glb file (told apart by content) with the files that it refers to, checks all of it, and fills a
/// Scene. What the Scene cannot hold is named in `report`. Throws nothing; every number in the result is finite and
/// every index in range.
Result<Scene, ImportError> import_gltf(const std::filesystem::path& file, const GltfOptions& options, Report& report);

/// The same of a file's bytes. \param file  beside which other files are looked for; a name without a folder: the bytes
/// have none
Result<Scene, ImportError> import_gltf(std::vector<std::byte> bytes, const std::filesystem::path& file,
                                       const GltfOptions& options, Report& report);

struct XOptions {
    bool embed_images = true;         ///< false: images stay in their files and are referred to by URI
    std::filesystem::path root = {};  ///< as GltfOptions::root
    /// Ticks per second of the key times, above 0: goes before what the file says. 0: the file's AnimTicksPerSecond, or
    /// 4,800 where it has none, which is named in the report.
    double ticks_per_second = 0.0;
};

/// Reads a DirectX X-file, text or binary, compressed or not, and fills a Scene: frames become joints, SkinWeights
/// influences, AnimationSets clips, and our own templates (spec/xfile.md) constraints and IK chains. The left-handed
/// space is mirrored along Z, numbers are taken for metres. Errors come with `line 3, column 7`, or the byte in binary
/// files. What the Scene cannot hold is named in `report`. Throws nothing; every number in the result is finite and
/// every index in range. The lines of a compressed file are those of the text in it.
Result<Scene, ImportError> import_x(const std::filesystem::path& file, const XOptions& options, Report& report);

/// The same of a file's bytes. \param file  beside which images are looked for; a name without a folder: the bytes have
/// none
Result<Scene, ImportError> import_x(std::string_view bytes, const std::filesystem::path& file, const XOptions& options,
                                    Report& report);

struct Md2Options {
    bool embed_images = true;         ///< false: images stay in their files and are referred to by URI
    std::filesystem::path root = {};  ///< as GltfOptions::root
    /// The image of the mesh, wherever it is, in place of the first skin that the file names, or of none. Empty: the
    /// file's own.
    std::filesystem::path texture = {};
};

/// Reads a Quake II model and fills a Scene: the first frame is the mesh, every other one a target of its own shape
/// (MorphTarget::is_frame) with the frame's name, and frames that are numbered on (stand01, stand02, ...) are a clip of
/// 10 frames a second; which clips repeat, their names say. Z up becomes Y up, the front +Z; 32 units are a metre.
/// Normals are the table's that the file's numbers mean, and every skin is a material. Errors name the byte. Throws
/// nothing; every number in the result is finite and every index in range.
Result<Scene, ImportError> import_md2(const std::filesystem::path& file, const Md2Options& options, Report& report);

/// The same of a file's bytes. \param file  whose name the one joint has, and beside which images are looked for; a
/// name without a folder: the bytes have none
Result<Scene, ImportError> import_md2(std::span<const std::byte> bytes, const std::filesystem::path& file,
                                      const Md2Options& options, Report& report);

/// True when the file can be read and starts as bendy files do, whatever its name.
bool is_bendy_file(const std::filesystem::path& file);

/// Reads a bendy file back into a Scene: every stream decoded to floats, sparse targets spread out, fixed frames as
/// timed keys. The file must pass bendy::validate; the first fault is the error. What the Scene cannot hold (unknown
/// chunks, further objects, ...) is named in `report`. Of a file that build_chunks has written from a Scene,
/// build_chunks makes the same bytes again. Throws nothing.
Result<Scene, ImportError> import_bendy(const std::filesystem::path& file, Report& report);

/// The same from memory; `bytes` start on a 16-byte boundary.
Result<Scene, ImportError> import_bendy(Bytes bytes, Report& report);

}  // namespace bendy::converter
