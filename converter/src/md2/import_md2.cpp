#include <bendy/converter/import_md2.h>

#include "failure.h"
#include "frame_cycles.h"
#include "gltf/budget.h"
#include "gltf/container.h"
#include "gltf/uri.h"
#include "header.h"
#include "without_throwing.h"

#include <glm/geometric.hpp>

#include <array>
#include <unordered_map>
#include <utility>

namespace bendy::converter {
namespace md2 {
namespace {

constexpr float kMetresPerUnit = 1.0f / 32.0f;  ///< a soldier is 56 units high
constexpr float kFrameRate = 10.0f;             ///< frames a second

/// Quake's X is the front, Y the left, Z up; here Z is the front, X the left, Y up. Metres.
glm::vec3 to_metres(const glm::vec3& units) {
    return glm::vec3(units.y, units.z, units.x) * kMetresPerUnit;
}

using Places = std::vector<glm::vec3>;

class Importer {
public:
    Importer(std::span<const std::byte> file, const std::string& name, Report& report)
        : file_(file), header_(read_header(file)), name_(name), report_(report) {
        budget_.add_source(file.size());
    }

    Scene run() {
        scene_.joints.emplace_back().name = name_;
        Mesh mesh;
        mesh.name = name_;
        mesh.joint = 0;
        mesh.parts.emplace_back();
        read_skins(mesh.parts.front());
        read_triangles(mesh);
        // Places, normals, and what a cycle says of every target at each of its frames.
        budget_.take(std::uint64_t{header_.frames} * vertices_.size(), 2 * sizeof(glm::vec3), place_of(40));
        budget_.take(std::uint64_t{header_.frames} * header_.frames, sizeof(float), place_of(40));
        std::vector<std::string> names;
        for (std::uint32_t frame = 0; frame < header_.frames; ++frame) names.push_back(read_frame(frame, mesh));
        scene_.meshes.push_back(std::move(mesh));
        if (header_.frames > 1) add_cycles(names);
        report_.warn("units are taken as 1/32 of a metre");
        report_.warn("normals are computed from the polygons: the file has numbers of a table only");
        return std::move(scene_);
    }

private:
    /// Every skin is a material; the mesh has the first.
    void read_skins(Part& part) {
        for (std::uint32_t skin = 0; skin < header_.skins; ++skin) {
            const std::string path = read_name(file_, header_.skins_at + skin * kSkinSize, kSkinSize);
            Image image;
            image.uri = gltf::uri_of(std::filesystem::path(std::u8string(path.begin(), path.end())));
            Texture texture;
            texture.images.push_back(skin);
            Material material;
            material.name = path;
            material.metallic = 0.0f;
            material.base_colour_texture.texture = skin;
            scene_.images.push_back(std::move(image));
            scene_.textures.push_back(std::move(texture));
            scene_.materials.push_back(std::move(material));
        }
        if (header_.skins > 0) part.material = 0;
        if (header_.skins > 1) report_.warn("further skin kept as a material that nothing uses", {}, header_.skins - 1);
    }

    std::uint32_t read_index(std::size_t at, std::uint32_t end, const char* what) const {
        const std::uint32_t index = read_integer(file_, at, 2);
        if (index >= end) {
            fail(place_of(at), "index " + std::to_string(index) + " of a triangle is out of range: there are " +
                                   std::to_string(end) + ' ' + what);
        }
        return index;
    }

    /// A vertex and a texture coordinate that a corner has together become a vertex of the mesh. Quake's triangles run
    /// clockwise, seen from outside.
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
                mesh.parts.front().indices.push_back(found->second);
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

    /// \return its name
    std::string read_frame(std::uint32_t frame, Mesh& mesh) {
        const std::size_t at = header_.frames_at + std::size_t{frame} * header_.frame_size;
        Places places = read_places(at);
        const Places normals = find_normals(places);
        Places moved;
        Places turned;
        for (const std::uint32_t vertex : vertices_) {
            moved.push_back(places[vertex]);
            turned.push_back(normals[vertex]);
        }
        std::string name = read_name(file_, at + 24, 16);
        if (frame == 0) {
            mesh.positions = std::move(moved);
            mesh.normals = std::move(turned);
            return name;
        }
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            moved[i] -= mesh.positions[i];
            turned[i] -= mesh.normals[i];
        }
        mesh.targets.push_back({name, 0.0f, std::move(moved), std::move(turned), {}});
        return name;
    }

    /// Of every vertex of the file.
    [[nodiscard]] Places read_places(std::size_t at) const {
        glm::vec3 scale;
        glm::vec3 origin;
        for (int axis = 0; axis < 3; ++axis) {
            scale[axis] = read_float(file_, at + 4 * static_cast<std::size_t>(axis));
            origin[axis] = read_float(file_, at + 12 + 4 * static_cast<std::size_t>(axis));
            const double furthest = std::abs(double{scale[axis]}) * 255.0 + std::abs(double{origin[axis]});
            if (furthest > 1e18) fail(place_of(at), "the frame's scale or origin is implausibly large");
        }
        Places places(header_.vertices);
        for (std::size_t vertex = 0; vertex < places.size(); ++vertex) {
            glm::vec3 units;
            for (int axis = 0; axis < 3; ++axis) {
                const std::size_t byte = at + kFrameHeadSize + vertex * kVertexSize + static_cast<std::size_t>(axis);
                units[axis] = static_cast<float>(read_integer(file_, byte, 1)) * scale[axis] + origin[axis];
            }
            places[vertex] = to_metres(units);
        }
        return places;
    }

    /// The mean of the polygons around each vertex, each by its area. What has no polygon, or only thin ones, points
    /// up.
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
            const double length = glm::length(sum);
            normals.push_back(length > 0.0 ? glm::vec3(sum / length) : glm::vec3(0.0f, 1.0f, 0.0f));
        }
        return normals;
    }

    /// In a frame of a cycle its own target has all the weight; the first frame has none.
    void add_cycles(const std::vector<std::string>& names) {
        for (const FrameRun& run : find_runs(names)) {
            Cycle cycle;
            cycle.name = run.name;
            Track track;
            track.path = TrackPath::weights;
            track.target = 0;
            track.components = header_.frames - 1;
            track.values.assign(run.count * track.components, 0.0f);
            for (std::size_t key = 0; key < run.count; ++key) {
                track.times.push_back(static_cast<float>(key) / kFrameRate);
                const std::size_t frame = run.first + key;
                if (frame > 0) track.values[key * track.components + frame - 1] = 1.0f;
            }
            cycle.tracks.push_back(std::move(track));
            scene_.cycles.push_back(std::move(cycle));
        }
    }

    std::span<const std::byte> file_;
    Header header_;
    const std::string& name_;
    Report& report_;
    gltf::Budget budget_;
    Scene scene_;
    std::vector<std::uint32_t> vertices_;  ///< the file's vertex of each of the mesh's
    std::vector<std::uint32_t> corners_;   ///< three vertices of the file for each triangle, in our order
};

}  // namespace
}  // namespace md2

Result<Scene, ImportError> import_md2(std::span<const std::byte> bytes, const std::string& name, Report& report) {
    return without_throwing<Scene>(
        [&]() -> Result<Scene, ImportError> { return md2::Importer(bytes, name, report).run(); });
}

Result<Scene, ImportError> import_md2(const std::filesystem::path& file, Report& report) {
    return without_throwing<Scene>([&]() -> Result<Scene, ImportError> {
        const std::vector<std::byte> bytes = gltf::read_file(file, {});
        const std::u8string stem = file.stem().u8string();
        return import_md2(bytes, std::string(stem.begin(), stem.end()), report);
    });
}

}  // namespace bendy::converter
