#include "quake2.h"
#include "scene/failure.h"
#include "scene/source/image_bytes.h"
#include "scene/source/named_files.h"
#include "scene/source/source_file.h"

#include <bendy/converter/import.h>
#include <bendy/format/charconv.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace bendy::converter {
namespace {

/// The header of a Quake II model: 68 bytes, little-endian. Offsets are relative to the file's start.
struct Header {
    std::uint32_t skin_width = 0;  ///< pixels
    std::uint32_t skin_height = 0;
    std::uint32_t frame_size = 0;  ///< bytes of a frame
    std::uint32_t skins = 0;
    std::uint32_t vertices = 0;
    std::uint32_t coords = 0;
    std::uint32_t triangles = 0;
    std::uint32_t commands = 0;  ///< words of a list of strips and fans; redundant
    std::uint32_t frames = 0;
    std::uint32_t skins_at = 0;
    std::uint32_t coords_at = 0;
    std::uint32_t triangles_at = 0;
    std::uint32_t frames_at = 0;
    std::uint32_t commands_at = 0;
    std::uint32_t end = 0;
};

constexpr std::size_t kHeaderSize = 68;
constexpr std::size_t kSkinSize = 64;       ///< a file name, NUL-padded
constexpr std::size_t kCoordSize = 4;       ///< s and t in pixels, 16 bits each
constexpr std::size_t kTriangleSize = 12;   ///< three vertices, three texture coordinates, 16 bits each
constexpr std::size_t kFrameHeadSize = 40;  ///< scale, origin, a name of 16 bytes
constexpr std::size_t kVertexSize = 4;      ///< a byte for each axis, and a normal's number

constexpr std::uint32_t kVersion = 8;

std::string place_of(std::size_t byte) {
    return "byte " + std::to_string(byte);
}

/// A list described by the header.
struct List {
    const char* what;
    std::uint32_t count;
    std::size_t size;      ///< bytes of an element
    std::uint32_t begin;   ///< byte
    std::size_t count_at;  ///< offset of the header's field
    std::size_t begin_at;
};

void check(const List& list, std::size_t file_size) {
    if (list.begin > file_size) {
        fail(place_of(list.begin_at), std::string("offset of ") + list.what + ": " + std::to_string(list.begin) +
                                          " is past the end of the file");
    }
    if (list.count > (file_size - list.begin) / list.size) {
        fail(place_of(list.count_at), "number of " + std::string(list.what) + ": " + std::to_string(list.count) +
                                          " do not fit between byte " + std::to_string(list.begin) +
                                          " and the end of the file");
    }
}

/// Reads a little-endian integer of at most 4 bytes, inside the file.
std::uint32_t read_integer(std::span<const std::byte> file, std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= std::to_integer<std::uint32_t>(file[at + i]) << (8 * i);
    return value;
}

/// Reads a float; fails if it is not finite.
float read_float(std::span<const std::byte> file, std::size_t at) {
    const auto value = bit_cast<float>(read_integer(file, at, 4));
    if (!std::isfinite(value)) fail(place_of(at), "the number is not finite");
    return value;
}

/// Reads text of at most `size` bytes, up to its first NUL, as UTF-8.
std::string read_name(std::span<const std::byte> file, std::size_t at, std::size_t size, Report& report) {
    const std::string_view text(reinterpret_cast<const char*>(file.data()) + at, size);
    return to_utf8(text.substr(0, text.find('\0')), place_of(at), report);
}

/// Reads the header and checks that everything it describes lies in the file. Fails at `byte 40`.
Header read_header(std::span<const std::byte> file) {
    if (file.size() < 4 || read_integer(file, 0, 4) != 0x32504449)  // "IDP2"
        fail(place_of(0), "this is not a Quake II model: it does not begin with 'IDP2'");
    if (file.size() < kHeaderSize)
        fail(place_of(file.size()), "the header is truncated: expected 68 bytes, found " + std::to_string(file.size()));
    if (const std::uint32_t version = read_integer(file, 4, 4); version != kVersion)
        fail(place_of(4), "version " + std::to_string(version) + " is not known, only version 8 (Quake II)");
    Header header;
    const std::array fields{&header.skin_width, &header.skin_height, &header.frame_size, &header.skins,
                            &header.vertices,   &header.coords,      &header.triangles,  &header.commands,
                            &header.frames,     &header.skins_at,    &header.coords_at,  &header.triangles_at,
                            &header.frames_at,  &header.commands_at, &header.end};
    for (std::size_t i = 0; i < fields.size(); ++i) *fields[i] = read_integer(file, 8 + 4 * i, 4);

    if (header.end > file.size()) {
        fail(place_of(64), "the file is truncated: its header says " + std::to_string(header.end) + " bytes, it has " +
                               std::to_string(file.size()));
    }
    const std::uint64_t frame_size = kFrameHeadSize + std::uint64_t{header.vertices} * kVertexSize;
    if (header.frame_size < frame_size) {
        fail(place_of(16), "a frame of " + std::to_string(header.vertices) + " vertices takes " +
                               std::to_string(frame_size) + " bytes, the header says " +
                               std::to_string(header.frame_size));
    }
    for (const List& list : {List{"skins", header.skins, kSkinSize, header.skins_at, 20, 44},
                             List{"texture coordinates", header.coords, kCoordSize, header.coords_at, 28, 48},
                             List{"triangles", header.triangles, kTriangleSize, header.triangles_at, 32, 52},
                             List{"frames", header.frames, header.frame_size, header.frames_at, 40, 56},
                             List{"GL commands", header.commands, 4, header.commands_at, 36, 60}})
        check(list, file.size());
    if (header.frames == 0) fail(place_of(40), "there are no frames");
    if (header.triangles == 0) fail(place_of(32), "there are no triangles");
    if (header.skin_width == 0 || header.skin_height == 0)
        fail(place_of(header.skin_width == 0 ? 8 : 12), "the skin has no size: texture coordinates mean nothing");
    return header;
}

}  // namespace

namespace md2 {
namespace {

constexpr float kMetresPerUnit = 1.0f / 32.0f;  ///< a soldier is 56 units high
constexpr float kFrameRate = 10.0f;             ///< frames per second

/// In Quake X is the front, Y the left, Z up; here Z is the front, X the left, Y up.
glm::vec3 to_our_axes(const glm::vec3& v) {
    return {v.y, v.z, v.x};
}

glm::vec3 to_metres(const glm::vec3& units) {
    return to_our_axes(units) * kMetresPerUnit;
}

using Places = std::vector<glm::vec3>;

class Md2Importer {
public:
    /// \param path  of the file
    Md2Importer(std::span<const std::byte> file, const std::filesystem::path& path, ReadableFolders folders,
                const Md2Options& options, Report& report)
        : file_(file),
          path_(path),
          header_(read_header(file)),
          options_(options),
          report_(report),
          files_(std::move(folders), budget_, report) {
        budget_.add_source(file.size());
        const std::u8string stem = path.stem().u8string();
        name_.assign(stem.begin(), stem.end());
    }

    Scene run() {
        scene_.joints.emplace_back().name = name_;
        Mesh mesh;
        mesh.name = name_;
        mesh.joint = 0;
        mesh.submeshes.emplace_back();
        read_skins(mesh.submeshes.front());
        read_triangles(mesh);
        budget_.take(std::uint64_t{header_.frames} * vertices_.size(), 2 * sizeof(glm::vec3), place_of(40));
        for (const glm::vec3& normal : quake_normals()) table_.push_back(to_our_axes(normal));
        has_normals_ = find_out_about_normals();
        std::vector<std::string> names;
        for (std::uint32_t frame = 0; frame < header_.frames; ++frame) names.push_back(read_frame(frame, mesh));
        scene_.meshes.push_back(std::move(mesh));
        if (header_.frames > 1) add_clips(names);
        report_.warn("units are taken as 1/32 of a metre");
        if (!has_normals_)
            report_.warn("normals are computed from the polygons: the file gives all vertices the same one");
        if (wrong_normals_ != 0)
            report_.warn("number of a normal is past the table's 162, it points up", {}, wrong_normals_);
        return std::move(scene_);
    }

private:
    /// Every skin becomes a material; the mesh uses the first.
    void read_skins(Submesh& submesh) {
        for (std::uint32_t skin = 0; skin < header_.skins; ++skin) {
            const std::size_t at = header_.skins_at + skin * kSkinSize;
            const std::string name = read_name(file_, at, kSkinSize, report_);
            if (skin == 0 && !options_.texture.empty()) {
                add_material(name, given_image());
            } else {
                add_material(name, find_image(name, place_of(at)));
            }
        }
        if (header_.skins == 0 && !options_.texture.empty()) add_material(name_, given_image());
        if (!scene_.materials.empty()) submesh.material = 0;
        if (header_.skins > 1) report_.warn("further skin kept as a material that nothing uses", {}, header_.skins - 1);
    }

    void add_material(const std::string& name, Image image) {
        image.media_type = media_type_of(image.bytes);
        Texture texture;
        texture.images.push_back(static_cast<std::uint32_t>(scene_.images.size()));
        Material material;
        material.name = name;
        material.metallic = 0.0f;
        material.base_colour_texture.texture = static_cast<std::uint32_t>(scene_.textures.size());
        scene_.images.push_back(std::move(image));
        scene_.textures.push_back(std::move(texture));
        scene_.materials.push_back(std::move(material));
    }

    Image find_image(const std::string& name, const std::string& place) {
        Image image;
        if (name.empty()) return image;
        image.uri = files_.find_texture(name);
        if (options_.embed_images) files_.embed(image, place);
        return image;
    }

    /// The image that the user gives in place of the first skin.
    Image given_image() {
        Image image;
        if (options_.embed_images) {
            files_.embed_given(image, options_.texture);
        } else {
            files_.check_given(options_.texture);
            image.uri = uri_between(path_, options_.texture);
        }
        return image;
    }

    std::uint32_t read_index(std::size_t at, std::uint32_t end, const char* what) const {
        const std::uint32_t index = read_integer(file_, at, 2);
        if (index >= end) {
            fail(place_of(at), "index " + std::to_string(index) + " of a triangle is out of range: there are " +
                                   std::to_string(end) + ' ' + what);
        }
        return index;
    }

    /// Each combination of a vertex and a texture coordinate at a corner becomes a vertex of the mesh. Quake's
    /// triangles are clockwise, seen from outside.
    void read_triangles(Mesh& mesh) {
        constexpr std::array<std::size_t, 3> kOrder{0, 2, 1};
        std::unordered_map<std::uint64_t, std::uint32_t> known;
        Stream coords;
        coords.components = 2;
        for (std::uint32_t triangle = 0; triangle < header_.triangles; ++triangle) {
            const std::size_t at = header_.triangles_at + std::size_t{triangle} * kTriangleSize;
            for (const std::size_t corner : kOrder) {
                const std::uint32_t vertex = read_index(at + 2 * corner, header_.vertices, "vertices");
                const std::uint32_t coord = read_index(at + 6 + 2 * corner, header_.coords, "texture coordinates");
                corners_.push_back(vertex);
                const std::uint64_t pair = std::uint64_t{vertex} << 32 | coord;
                const auto [found, is_new] = known.try_emplace(pair, static_cast<std::uint32_t>(vertices_.size()));
                mesh.submeshes.front().indices.push_back(found->second);
                if (!is_new) continue;
                vertices_.push_back(vertex);
                const std::size_t coord_at = header_.coords_at + std::size_t{coord} * kCoordSize;
                coords.values.push_back(read_pixel(coord_at) / static_cast<float>(header_.skin_width));
                coords.values.push_back(read_pixel(coord_at + 2) / static_cast<float>(header_.skin_height));
            }
        }
        mesh.texture_coords.push_back(std::move(coords));
    }

    [[nodiscard]] float read_pixel(std::size_t at) const {
        return static_cast<float>(static_cast<std::int16_t>(read_integer(file_, at, 2)));
    }

    /// The first frame is the mesh, the others become its frames.
    /// \return the frame's name
    std::string read_frame(std::uint32_t frame, Mesh& mesh) {
        const std::size_t at = header_.frames_at + std::size_t{frame} * header_.frame_size;
        const FrameGrid grid = read_grid(at);
        const Places places = read_places(at, grid);
        const Places normals = has_normals_ ? read_normals(at) : find_normals(places);
        Places moved;
        Places turned;
        for (const std::uint32_t vertex : vertices_) {
            moved.push_back(places[vertex]);
            turned.push_back(normals[vertex]);
        }
        std::string name = read_name(file_, at + 24, 16, report_);
        if (frame == 0) {
            mesh.grid = grid;
            mesh.positions = std::move(moved);
            mesh.normals = std::move(turned);
            return name;
        }
        MorphTarget& target = mesh.targets.emplace_back();
        target.name = name;
        target.is_frame = true;
        target.grid = grid;
        target.positions = std::move(moved);
        target.normals = std::move(turned);
        return name;
    }

    /// The grid of a frame's byte coordinates, in metres.
    [[nodiscard]] FrameGrid read_grid(std::size_t at) const {
        glm::vec3 scale;
        glm::vec3 origin;
        for (int axis = 0; axis < 3; ++axis) {
            scale[axis] = read_float(file_, at + 4 * static_cast<std::size_t>(axis));
            origin[axis] = read_float(file_, at + 12 + 4 * static_cast<std::size_t>(axis));
            const double furthest = std::abs(double{scale[axis]}) * 255.0 + std::abs(double{origin[axis]});
            if (furthest > 1e18) fail(place_of(at), "the frame's scale or origin is implausibly large");
        }
        return {to_metres(origin), to_metres(scale)};
    }

    /// The positions of all vertices in a frame.
    [[nodiscard]] Places read_places(std::size_t at, const FrameGrid& grid) const {
        Places places(header_.vertices);
        for (std::size_t vertex = 0; vertex < places.size(); ++vertex) {
            glm::vec3 steps;
            for (int axis = 0; axis < 3; ++axis) {
                const std::size_t byte = at + kFrameHeadSize + vertex * kVertexSize + static_cast<std::size_t>(axis);
                steps[axis] = static_cast<float>(read_integer(file_, byte, 1));
            }
            const glm::vec3 moved = grid.step * to_our_axes(steps);
            places[vertex] = grid.minimum + moved;
        }
        return places;
    }

    [[nodiscard]] std::size_t normal_at(std::uint32_t frame, std::size_t vertex) const {
        return header_.frames_at + std::size_t{frame} * header_.frame_size + kFrameHeadSize + vertex * kVertexSize + 3;
    }

    /// Whether the file's normal numbers are usable: some exporters write the same number everywhere.
    [[nodiscard]] bool find_out_about_normals() const {
        const std::byte first = header_.vertices == 0 ? std::byte{0} : file_[normal_at(0, 0)];
        for (std::uint32_t frame = 0; frame < header_.frames; ++frame) {
            for (std::size_t vertex = 0; vertex < header_.vertices; ++vertex) {
                if (file_[normal_at(frame, vertex)] != first) return true;
            }
        }
        return false;
    }

    /// The normals of all vertices in a frame, looked up in the table.
    [[nodiscard]] Places read_normals(std::size_t at) {
        Places normals(header_.vertices);
        for (std::size_t vertex = 0; vertex < normals.size(); ++vertex) {
            const std::size_t byte = at + kFrameHeadSize + vertex * kVertexSize + 3;
            const std::uint32_t number = read_integer(file_, byte, 1);
            if (number >= kNormals) ++wrong_normals_;
            normals[vertex] = number < kNormals ? table_[number] : glm::vec3(0.0f, 1.0f, 0.0f);
        }
        return normals;
    }

    /// Computes normals: for each vertex the area-weighted mean of its polygons, rounded to the nearest direction of
    /// the table. Vertices without polygons, or with degenerate ones only, point up.
    [[nodiscard]] Places find_normals(const Places& places) const {
        std::vector<glm::dvec3> sums(places.size(), glm::dvec3(0.0));
        for (std::size_t i = 0; i < corners_.size(); i += 3) {
            const glm::dvec3 a(places[corners_[i]]);
            const glm::dvec3 normal =
                glm::cross(glm::dvec3(places[corners_[i + 1]]) - a, glm::dvec3(places[corners_[i + 2]]) - a);
            for (std::size_t corner = 0; corner < 3; ++corner) sums[corners_[i + corner]] += normal;
        }
        Places normals;
        normals.reserve(sums.size());
        for (const glm::dvec3& sum : sums) {
            const auto is_farther = [&](const glm::vec3& x, const glm::vec3& y) {
                return glm::dot(glm::dvec3(x), sum) < glm::dot(glm::dvec3(y), sum);
            };
            normals.push_back(glm::length(sum) > 0.0 ? *std::max_element(table_.begin(), table_.end(), is_farther)
                                                     : glm::vec3(0.0f, 1.0f, 0.0f));
        }
        return normals;
    }

    void add_clips(const std::vector<std::string>& names) {
        for (const FrameRun& run : find_runs(names)) {
            Clip clip;
            clip.name = run.name;
            clip.loop = is_repeated(run.name);
            clip.frame_rate = kFrameRate;
            Play play;
            play.first = static_cast<std::uint32_t>(run.first);
            play.frames = static_cast<std::uint32_t>(run.count);
            play.closed = clip.loop;
            clip.plays.push_back(play);
            scene_.clips.push_back(std::move(clip));
        }
    }

    std::span<const std::byte> file_;
    const std::filesystem::path& path_;
    Header header_;
    std::string name_;  ///< of the file, without its suffix
    const Md2Options& options_;
    Report& report_;
    Budget budget_;
    NamedFiles files_;
    Scene scene_;
    std::vector<std::uint32_t> vertices_;  ///< the file's vertex of each of the mesh's
    std::vector<std::uint32_t> corners_;   ///< three of the file's vertices per triangle, in our order
    Places table_;                         ///< of normals, in our axes
    bool has_normals_ = true;              ///< the file's normal numbers are usable
    std::uint64_t wrong_normals_ = 0;      ///< out-of-range normal numbers
};

}  // namespace
}  // namespace md2

Result<Scene, ImportError> import_md2(std::span<const std::byte> bytes, const std::filesystem::path& file,
                                      const Md2Options& options, Report& report) {
    return without_throwing<Scene>([&]() -> Result<Scene, ImportError> {
        return md2::Md2Importer(bytes, file, folders_of_bytes(file, options.root), options, report).run();
    });
}

Result<Scene, ImportError> import_md2(const std::filesystem::path& file, const Md2Options& options, Report& report) {
    return without_throwing<Scene>([&]() -> Result<Scene, ImportError> {
        const std::vector<std::byte> bytes = read_file(file, {});
        return md2::Md2Importer(bytes, file, ReadableFolders::of(file, options.root), options, report).run();
    });
}

}  // namespace bendy::converter
