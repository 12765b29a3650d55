#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// One function per input format: bytes in, a Scene out.

namespace bendy::converter {

struct GltfOptions {
    /// Scene to import: its name or its index in decimal digits; empty: the file's default scene, else the first, else
    /// all root nodes.
    std::optional<std::string> scene;
    /// false: images that the source keeps in separate files stay there and are referred to by URI.
    bool embed_images = true;
    /// Another folder whose files may be read, besides the source's own folder and its subfolders; see ReadableFolders.
    /// A source without a folder has only this one, and relative names start there.
    std::filesystem::path root;
    /// Make every instance of EXT_mesh_gpu_instancing a joint with meshes of its own. If false, the instances are kept
    /// as data, and a node draws its mesh once.
    bool instances = false;
};

/// Reads a .gltf or .glb file (recognised by content) and the files that it refers to, checks everything, and fills a
/// Scene. `report` lists what the Scene cannot hold. Throws nothing; every number in the result is finite and every
/// index in range.
Result<Scene, ImportError> import_gltf(const std::filesystem::path& file, const GltfOptions& options, Report& report);

/// As above, from the file's bytes.
/// \param file  other files are looked for in its folder; a name without a folder: the bytes have none
Result<Scene, ImportError> import_gltf(std::vector<std::byte> bytes, const std::filesystem::path& file,
                                       const GltfOptions& options, Report& report);

struct XOptions {
    bool embed_images = true;         ///< false: images stay in their files and are referred to by URI
    std::filesystem::path root = {};  ///< as GltfOptions::root
    /// Ticks per second of the key times, above 0: overrides the file's value. 0: the file's AnimTicksPerSecond, or
    /// 4,800 with a note in the report if there is none.
    double ticks_per_second = 0.0;
};

/// Reads a DirectX X-file, text or binary, compressed or not, and fills a Scene: frames become joints, SkinWeights
/// influences, AnimationSets clips, and our own templates (spec/xfile.md) constraints and IK chains. The left-handed
/// space is mirrored along Z; units are taken to be metres. Errors give `line 3, column 7`, or the byte in binary
/// files. `report` lists what the Scene cannot hold. Throws nothing; every number in the result is finite and every
/// index in range. Line numbers of a compressed file refer to the decompressed text.
Result<Scene, ImportError> import_x(const std::filesystem::path& file, const XOptions& options, Report& report);

/// As above, from the file's bytes.
/// \param file  images are looked for in its folder; a name without a folder: the bytes have none
Result<Scene, ImportError> import_x(std::string_view bytes, const std::filesystem::path& file, const XOptions& options,
                                    Report& report);

struct Md2Options {
    bool embed_images = true;         ///< false: images stay in their files and are referred to by URI
    std::filesystem::path root = {};  ///< as GltfOptions::root
    /// Image file for the mesh, anywhere on disk; replaces the first skin that the file names, if any. Empty: the
    /// file's own.
    std::filesystem::path texture = {};
};

/// Reads a Quake II model and fills a Scene: the first frame is the mesh, every other frame a target that holds a whole
/// shape (MorphTarget::is_frame) and has the frame's name. Frames with consecutive numbers (stand01, stand02, ...) form
/// a clip at 10 frames per second; the clip's name decides whether it repeats. Z up becomes Y up, the front +Z; 32
/// units are a metre. Normals are looked up in Quake's table by number, and every skin is a material. Errors name the
/// byte. Throws nothing; every number in the result is finite and every index in range.
Result<Scene, ImportError> import_md2(const std::filesystem::path& file, const Md2Options& options, Report& report);

/// As above, from the file's bytes.
/// \param file  names the single joint; images are looked for in its folder; a name without a folder: the bytes have
///              none
Result<Scene, ImportError> import_md2(std::span<const std::byte> bytes, const std::filesystem::path& file,
                                      const Md2Options& options, Report& report);

struct BvhOptions {
    /// Length of the file's unit, metres, above 0. 0: a centimetre, with a note in the report: files do not say it.
    double unit = 0.0;
};

/// Reads a Biovision file (BVH) and fills a Scene: joints, also the ends without motion, at rest at their offsets, and
/// a clip with the file's name and a key for each frame, if there are any. A joint's position channels replace its
/// offset; its rotations apply in the order of its channels. Y is up. Errors give the line. Throws nothing; every
/// number in the result is finite and every index in range.
/// \param file  names the clip
Result<Scene, ImportError> import_bvh(std::string_view text, const std::filesystem::path& file,
                                      const BvhOptions& options, Report& report);

/// True if the file can be read and has a bendy file's signature, whatever its name.
bool is_bendy_file(const std::filesystem::path& file);

/// Reads a bendy file back into a Scene: every stream decoded to floats, sparse targets expanded, fixed frames as timed
/// keys. The file must pass bendy::validate; the first fault is the error. `report` lists what the Scene cannot hold
/// (unknown chunks, further objects, ...). build_chunks turns the Scene of a file that it wrote into the same bytes
/// again. Throws nothing.
Result<Scene, ImportError> import_bendy(const std::filesystem::path& file, Report& report);

/// The parts of a mesh that import_bendy reads.
enum class MeshParts : std::uint8_t {
    all,
    motion,  ///< positions, bones, weights and targets: no normals, tangents, other attributes, or polygons
};

/// As above, from memory; `bytes` must be 16-byte aligned.
Result<Scene, ImportError> import_bendy(Bytes bytes, Report& report, MeshParts parts = MeshParts::all);

}  // namespace bendy::converter
