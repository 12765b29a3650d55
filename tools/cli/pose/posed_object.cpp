#include "pose/posed_object.h"

#include "reports/json.h"
#include "reports/messages.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <span>
#include <string_view>

namespace bendy::tools {
namespace {

/// Appends a number in the shortest form that reads back the same.
template <class Number>
void put(std::string& out, Number number) {
    std::array<char, 32> digits;  // NOLINT(*-member-init): to_chars fills it
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    out.append(digits.data(), end);
}

void put_vectors(std::string& out, std::string_view keyword, std::span<const glm::vec3> vectors) {
    for (const glm::vec3& v : vectors) {
        out += keyword;
        for (int c = 0; c < 3; ++c) {
            out += ' ';
            put(out, v[c]);
        }
        out += '\n';
    }
}

/// Writes OBJ elements of `corners` vertices each; `base` is the number of the mesh's first vertex. OBJ counts from 1.
void put_elements(std::string& out, char keyword, std::span<const std::uint32_t> indices, std::size_t corners,
                  std::uint64_t base, bool normals) {
    for (std::size_t at = 0; at + corners <= indices.size(); at += corners) {
        out += keyword;
        for (const std::uint32_t index : indices.subspan(at, corners)) {
            out += ' ';
            put(out, base + index + 1);
            if (normals) {
                out += "//";
                put(out, base + index + 1);
            }
        }
        out += '\n';
    }
}

template <class T>
void put_raw(std::string& out, T value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    out.append(bytes.data(), bytes.size());
}

/// Many JSON readers take -0 for an integer, which has no sign.
void put_json(std::string& out, float number) {
    const bool is_negative_zero = number == 0.0f && std::signbit(number);
    put(out, number);
    if (is_negative_zero) out += ".0";
}
void put_json(std::string& out, std::uint32_t number) {
    put(out, number);
}

template <class Number>
void put_list(std::string& out, std::span<const Number> numbers) {
    out += '[';
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (i != 0) out += ',';
        put_json(out, numbers[i]);
    }
    out += ']';
}

std::span<const float> floats_of(std::span<const glm::vec3> vectors) {
    return vectors.empty() ? std::span<const float>() : std::span<const float>(&vectors[0].x, vectors.size() * 3);
}

std::string as_json(const std::string& text) {
    return json_text(Json(text));
}

/// JSON cannot express infinities.
void put_finite(std::string& out, float number) {
    if (std::isfinite(number)) {
        put_json(out, number);
    } else {
        out += "null";
    }
}

void put_reaches(std::string& out, std::span<const PosedReach> reaches) {
    out += ",\"reaches\":[";
    for (std::size_t i = 0; i < reaches.size(); ++i) {
        const PosedReach& reach = reaches[i];
        out += (i == 0 ? "\n{\"chain\":" : ",\n{\"chain\":") + as_json(reach.chain) + ",\"target\":";
        put_list(out, std::span<const float>(&reach.target.position.x, 3));
        if (reach.target.rotation) {
            const glm::quat& q = *reach.target.rotation;
            const std::array<float, 4> numbers{q.x, q.y, q.z, q.w};
            out += ",\"rotation\":";
            put_list(out, std::span<const float>(numbers));
        }
        out += ",\"distance\":";
        put_finite(out, reach.distance);
        if (reach.target.rotation || reach.is_aim) {
            out += ",\"angle\":";
            put_finite(out, reach.angle);
        }
        out += reach.is_reached ? ",\"reached\":true}" : ",\"reached\":false}";
    }
    out += ']';
}

void put_curves(std::string& out, std::span<const PosedCurve> curves) {
    out += ",\"curves\":[";
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const PosedCurve& curve = curves[i];
        out += (i == 0 ? "\n{\"name\":" : ",\n{\"name\":") + as_json(curve.name) + ",\"path\":" + as_json(curve.path);
        if (!curve.target_kind.empty())
            out += ",\"target\":{" + as_json(curve.target_kind) + ':' + std::to_string(curve.target) + '}';
        out += ",\"value\":[";
        for (std::size_t c = 0; c < curve.value.size(); ++c) {
            if (c != 0) out += ',';
            put_finite(out, curve.value[c]);
        }
        out += "]}";
    }
    out += ']';
}

/// Writes normals for all vertices or for none: OBJ numbers them like the vertices, and PLY has a single vertex layout.
bool have_normals(const PosedObject& object) {
    return std::any_of(object.meshes.begin(), object.meshes.end(),
                       [](const PosedMesh& mesh) { return !mesh.normals.empty(); });
}

std::vector<glm::vec3> normals_or_zeros(const PosedMesh& mesh) {
    return mesh.normals.empty() ? std::vector<glm::vec3>(mesh.positions.size(), glm::vec3(0.0f)) : mesh.normals;
}

/// Escapes text for the end of a line: a backslash there would join the next line to it.
std::string obj_text(std::string_view text) {
    std::string line = escaped(text);
    if (line.ends_with('\\')) line += ' ';
    return line;
}

}  // namespace

std::string write_obj(const PosedObject& object) {
    std::string out = "# " + obj_text(object.file + (object.clip.empty() ? ", rest pose" : ", " + object.clip)) + '\n';
    const bool normals = have_normals(object);
    std::uint64_t base = 0;
    for (const PosedMesh& mesh : object.meshes) {
        out += "o " + obj_text(mesh.name) + '\n';
        put_vectors(out, "v", mesh.positions);
        if (normals) put_vectors(out, "vn", normals_or_zeros(mesh));
        put_elements(out, 'f', mesh.triangles, 3, base, !mesh.normals.empty());
        put_elements(out, 'l', mesh.lines, 2, base, false);
        put_elements(out, 'p', mesh.points, 1, base, false);
        base += mesh.positions.size();
    }
    return out;
}

std::string write_ply(const PosedObject& object) {
    std::uint64_t vertices = 0;
    std::uint64_t faces = 0;
    std::uint64_t edges = 0;
    for (const PosedMesh& mesh : object.meshes) {
        vertices += mesh.positions.size();
        faces += mesh.triangles.size() / 3;
        edges += mesh.lines.size() / 2;
    }
    const bool normals = have_normals(object);
    std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
                      "\nproperty float x\nproperty float y\nproperty float z\n";
    if (normals) out += "property float nx\nproperty float ny\nproperty float nz\n";
    out += "element face " + std::to_string(faces) + "\nproperty list uchar uint vertex_indices\n";
    if (edges != 0) out += "element edge " + std::to_string(edges) + "\nproperty uint vertex1\nproperty uint vertex2\n";
    out += "end_header\n";
    for (const PosedMesh& mesh : object.meshes) {
        const std::vector<glm::vec3> mesh_normals = normals ? normals_or_zeros(mesh) : std::vector<glm::vec3>();
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            for (int c = 0; c < 3; ++c) put_raw(out, mesh.positions[i][c]);
            for (int c = 0; normals && c < 3; ++c) put_raw(out, mesh_normals[i][c]);
        }
    }
    const auto put_all = [&](std::vector<std::uint32_t> PosedMesh::*list, std::size_t corners, bool with_count) {
        std::uint32_t base = 0;
        for (const PosedMesh& mesh : object.meshes) {
            const auto& indices = mesh.*list;
            for (std::size_t at = 0; at + corners <= indices.size(); at += corners) {
                if (with_count) put_raw(out, static_cast<std::uint8_t>(corners));
                for (std::size_t c = 0; c < corners; ++c) put_raw(out, base + indices[at + c]);
            }
            base += static_cast<std::uint32_t>(mesh.positions.size());
        }
    };
    put_all(&PosedMesh::triangles, 3, true);
    if (edges != 0) put_all(&PosedMesh::lines, 2, false);
    return out;
}

std::string write_json(const PosedObject& object) {
    std::string out = "{\"file\":" + as_json(object.file) +
                      ",\"clip\":" + (object.clip.empty() ? "null" : as_json(object.clip)) + ",\"time\":";
    put(out, object.time);
    if (!object.reaches.empty()) put_reaches(out, object.reaches);
    if (!object.curves.empty()) put_curves(out, object.curves);
    out += ",\"joints\":[";
    for (std::size_t i = 0; i < object.joints.size(); ++i) {
        const PosedJoint& joint = object.joints[i];
        out += (i == 0 ? "\n{\"name\":" : ",\n{\"name\":") + as_json(joint.name) + ",\"world\":";
        put_list(out, std::span<const float>(&joint.world[0][0], 16));
        out += '}';
    }
    out += "],\n\"meshes\":[";
    for (std::size_t i = 0; i < object.meshes.size(); ++i) {
        const PosedMesh& mesh = object.meshes[i];
        out += (i == 0 ? "\n{\"name\":" : ",\n{\"name\":") + as_json(mesh.name) + ",\"positions\":";
        put_list(out, floats_of(mesh.positions));
        out += ",\"normals\":";
        put_list(out, floats_of(mesh.normals));
        out += ",\"indices\":";
        put_list(out, std::span<const std::uint32_t>(mesh.triangles));
        out += '}';
    }
    return out + "]}\n";
}

}  // namespace bendy::tools
