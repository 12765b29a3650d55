#include "formats/x/conventions.h"
#include "parts.h"
#include "scene/failure.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace bendy::converter::x_out {
namespace {

class MeshExporter {
public:
    MeshExporter(const Scene& scene, std::uint32_t number, const Names& names, MaterialExporter& materials, Text& text,
                 Report& report)
        : mesh_(scene.meshes[number]),
          number_(number),
          place_(at("meshes", number)),
          names_(names),
          materials_(materials),
          text_(text),
          report_(report) {
        for (const Submesh& submesh : mesh_.submeshes) {
            if (submesh.topology == Topology::triangles) {
                triangles_ += submesh.indices.size() / 3;
            } else if (!submesh.indices.empty()) {
                report_.warn("lines and points left out: X-files have triangles only", place_);
            }
        }
    }

    void write() {
        if (triangles_ == 0) {
            report_.warn("a mesh without triangles is left out", place_);
            return;
        }
        report_losses();
        text_.open("Mesh", names_.meshes[number_]);
        write_vectors(at_rest(mesh_.positions, &MorphTarget::positions));
        write_faces();
        if (!mesh_.normals.empty()) {
            text_.open("MeshNormals");
            write_vectors(at_rest(mesh_.normals, &MorphTarget::normals));
            write_faces();
            text_.close();
        }
        write_coords();
        write_colours();
        write_materials();
        if (mesh_.influences != 0) write_skin();
        write_name(names_.meshes[number_], mesh_.name, text_);
        text_.close();
    }

private:
    /// Adds the targets' rest weights, as the character looks without animation.
    std::vector<glm::vec3> at_rest(std::vector<glm::vec3> vectors,
                                   std::vector<glm::vec3> MorphTarget::*displacements) const {
        for (const MorphTarget& target : mesh_.targets) {
            const std::vector<glm::vec3>& moves = target.*displacements;
            if (target.rest_weight == 0.0f || moves.empty()) continue;
            for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] += target.rest_weight * moves[i];
        }
        return vectors;
    }

    void write_vectors(std::vector<glm::vec3> vectors) {
        for (glm::vec3& vector : vectors) vector = x::mirrored(vector);
        text_.line(std::to_string(vectors.size()) + ';');
        text_.vectors(vectors);
    }

    template <class Each>
    void for_each_triangle(Each each) const {
        for (const Submesh& submesh : mesh_.submeshes) {
            if (submesh.topology != Topology::triangles) continue;
            for (std::size_t i = 0; i + 2 < submesh.indices.size(); i += 3) each(submesh, submesh.indices.data() + i);
        }
    }

    /// Mirroring turns triangles inside out, so their corners are reversed.
    void write_faces() {
        text_.line(std::to_string(triangles_) + ';');
        std::uint64_t left = triangles_;
        for_each_triangle([&](const Submesh& /*part*/, const std::uint32_t* corners) {
            text_.begin_line();
            text_.add("3;").add(std::uint64_t{corners[0]}).add(",").add(std::uint64_t{corners[2]}).add(",");
            text_.add(std::uint64_t{corners[1]}).add(--left == 0 ? ";;" : ";,");
            text_.end_line();
        });
    }

    /// The stream that X-files can hold: the first set, if it has a suitable component count.
    static const Stream* first_set(const std::vector<Stream>& streams) {
        return streams.empty() || streams.front().set != 0 ? nullptr : &streams.front();
    }

    void write_coords() {
        const Stream* stream = first_set(mesh_.texture_coords);
        if (stream == nullptr || stream->components != 2) return;
        text_.open("MeshTextureCoords");
        std::vector<glm::vec2> coords(mesh_.positions.size());
        for (std::size_t i = 0; i < coords.size(); ++i) coords[i] = {stream->values[2 * i], stream->values[2 * i + 1]};
        text_.line(std::to_string(coords.size()) + ';');
        text_.vectors(coords);
        text_.close();
    }

    void write_colours() {
        const Stream* stream = first_set(mesh_.colours);
        if (stream == nullptr || stream->components < 3 || stream->components > 4) return;
        text_.open("MeshVertexColors");
        text_.line(std::to_string(mesh_.positions.size()) + ';');
        for (std::size_t i = 0; i < mesh_.positions.size(); ++i) {
            glm::vec4 colour(1.0f);
            for (std::uint32_t k = 0; k < stream->components; ++k)
                colour[static_cast<int>(k)] = stream->values[i * stream->components + k];
            text_.begin_line();
            text_.add(std::uint64_t{i})
                .add(";")
                .add_vector(x::to_display(colour))
                .add(i + 1 < mesh_.positions.size() ? ";," : ";;");
            text_.end_line();
        }
        text_.close();
    }

    void write_materials() {
        std::vector<std::uint32_t> slots;  // materials
        std::unordered_map<std::uint32_t, std::size_t> slot_of;
        for (const Submesh& submesh : mesh_.submeshes) {
            const bool counts = submesh.topology == Topology::triangles && !submesh.indices.empty();
            if (counts && slot_of.try_emplace(submesh.material, slots.size()).second) slots.push_back(submesh.material);
        }
        if (slots.size() == 1 && slots.front() == kNone) return;
        text_.open("MeshMaterialList");
        text_.line(std::to_string(slots.size()) + ';');
        text_.line(std::to_string(triangles_) + ';');
        std::uint64_t left = triangles_;
        for (const Submesh& submesh : mesh_.submeshes) {
            if (submesh.topology != Topology::triangles || submesh.indices.empty()) continue;
            const std::string slot = std::to_string(slot_of.at(submesh.material));
            for (std::size_t i = 0; i < submesh.indices.size() / 3; ++i) text_.line(slot + (--left == 0 ? ";" : ","));
        }
        for (const std::uint32_t material : slots) {
            if (material != kNone) {
                materials_.write_entry(material);
                continue;
            }
            report_.warn("polygons without a material get a white one", place_);
            text_.open("Material", names_.no_material);
            for (const char* line : {"1.0;1.0;1.0;1.0;;", "0.0;", "0.0;0.0;0.0;;", "0.0;0.0;0.0;;"}) text_.line(line);
            text_.close();
        }
        text_.close();
    }

    /// The vertices of each bone, concatenated.
    struct Bones {
        std::vector<std::size_t> begin;  ///< start of each bone's entries, and the end of the last
        std::vector<std::pair<std::uint32_t, float>> entries;
    };

    [[nodiscard]] Bones sort_by_bone() const {
        Bones bones;
        bones.begin.assign(mesh_.palette.joints.size() + 1, 0);
        for (std::size_t i = 0; i < mesh_.bones.size(); ++i) {
            if (mesh_.weights[i] > 0.0f) ++bones.begin[mesh_.bones[i] + 1];
        }
        for (std::size_t bone = 1; bone < bones.begin.size(); ++bone) bones.begin[bone] += bones.begin[bone - 1];
        bones.entries.resize(bones.begin.back());
        std::vector<std::size_t> next(bones.begin.begin(), bones.begin.end() - 1);
        for (std::size_t i = 0; i < mesh_.bones.size(); ++i) {
            if (mesh_.weights[i] > 0.0f) {
                bones.entries[next[mesh_.bones[i]]++] = {static_cast<std::uint32_t>(i / mesh_.influences),
                                                         mesh_.weights[i]};
            }
        }
        return bones;
    }

    void write_skin() {
        const Bones bones = sort_by_bone();
        const std::size_t count = mesh_.palette.joints.size();
        std::size_t used = 0;
        for (std::size_t bone = 0; bone < count; ++bone) used += bones.begin[bone + 1] > bones.begin[bone] ? 1 : 0;
        text_.open("XSkinMeshHeader");
        text_.line(std::to_string(most_of_vertex()) + ';');
        text_.line(std::to_string(most_of_face()) + ';');
        text_.line(std::to_string(used) + ';');
        text_.close();
        for (std::size_t bone = 0; bone < count; ++bone) {
            if (bones.begin[bone + 1] > bones.begin[bone]) write_bone(bones, bone);
        }
    }

    void write_bone(const Bones& bones, std::size_t bone) {
        const std::size_t first = bones.begin[bone];
        const std::size_t last = bones.begin[bone + 1];
        text_.open("SkinWeights");
        text_.line('"' + names_.joints[mesh_.palette.joints[bone]] + "\";");
        text_.line(std::to_string(last - first) + ';');
        for (std::size_t i = first; i < last; ++i)
            text_.line(std::to_string(bones.entries[i].first) + (i + 1 < last ? "," : ";"));
        for (std::size_t i = first; i < last; ++i) {
            text_.begin_line();
            text_.add(bones.entries[i].second).add(i + 1 < last ? "," : ";");
            text_.end_line();
        }
        std::array<double, 16> exact{};
        std::copy_n(glm::value_ptr(mesh_.palette.inverse_bind[bone]), exact.size(), exact.begin());
        exact = x::mirrored(exact);
        std::array<float, 16> offset{};
        std::transform(exact.begin(), exact.end(), offset.begin(), [](double n) { return static_cast<float>(n); });
        text_.matrix(offset);
        text_.close();
    }

    [[nodiscard]] std::size_t most_of_vertex() const {
        std::size_t most = 0;
        for (std::size_t first = 0; first < mesh_.weights.size(); first += mesh_.influences) {
            std::size_t count = 0;
            for (std::size_t i = 0; i < mesh_.influences; ++i) count += mesh_.weights[first + i] > 0.0f ? 1 : 0;
            most = std::max(most, count);
        }
        return most;
    }

    [[nodiscard]] std::size_t most_of_face() const {
        std::size_t most = 0;
        std::vector<std::uint32_t> bones;
        for_each_triangle([&](const Submesh& /*part*/, const std::uint32_t* corners) {
            bones.clear();
            for (int corner = 0; corner < 3; ++corner) {
                const std::size_t first = std::size_t{corners[corner]} * mesh_.influences;
                for (std::size_t i = first; i < first + mesh_.influences; ++i) {
                    if (mesh_.weights[i] > 0.0f) bones.push_back(mesh_.bones[i]);
                }
            }
            std::sort(bones.begin(), bones.end());
            const auto unique = std::unique(bones.begin(), bones.end());
            most = std::max(most, static_cast<std::size_t>(unique - bones.begin()));
        });
        return most;
    }

    void report_losses() {
        const auto lose = [&](std::size_t count, const char* what) {
            if (count != 0) report_.warn(std::string(what) + " left out: X-files have no place for it", place_, count);
        };
        lose(mesh_.targets.size(), "morph target");
        lose(mesh_.tangents.empty() ? 0 : 1, "tangents of a mesh");
        const auto further = [](const std::vector<Stream>& streams) {
            return streams.size() - (first_set(streams) == nullptr ? 0 : 1);
        };
        lose(further(mesh_.texture_coords), "further set of texture coordinates");
        lose(further(mesh_.colours), "further set of vertex colours");
        lose(mesh_.attributes.size(), "an author's attribute");
        lose(mesh_.extras.empty() && mesh_.more.empty() ? 0 : 1, "extras of a mesh");
    }

    const Mesh& mesh_;
    std::uint32_t number_;
    std::string place_;
    const Names& names_;
    MaterialExporter& materials_;
    Text& text_;
    Report& report_;
    std::uint64_t triangles_ = 0;
};

}  // namespace

void write_mesh(const Scene& scene, std::uint32_t number, const Names& names, MaterialExporter& materials, Text& text,
                Report& report) {
    MeshExporter(scene, number, names, materials, text, report).write();
}

}  // namespace bendy::converter::x_out
