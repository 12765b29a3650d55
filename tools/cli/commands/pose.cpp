#include "commands/commands.h"
#include "commands/model_options.h"
#include "files/input.h"
#include "files/output.h"
#include "reports/json.h"
#include "reports/messages.h"

#include <bendy/runtime.h>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace bendy::tools {
namespace {

struct PoseArguments {
    std::filesystem::path file;
    std::filesystem::path root;
    std::string clip;
    bool has_clip = false;
    float time = 0.0f;
    ReachRequest reach;
    float lod = 1.0f;  // fraction of the triangles
    std::filesystem::path output = "-";
    std::string format;  // empty: chosen by the output's name
};

/// A mesh's posed vertices and its primitives.
struct PosedMesh {
    std::string name;
    std::vector<glm::vec3> positions;                     ///< model space
    std::vector<glm::vec3> normals;                       ///< one per vertex, or none
    std::vector<std::uint32_t> triangles, lines, points;  ///< 3, 2 and 1 vertices each
};

struct PosedJoint {
    std::string name;
    glm::mat4 world{1.0f};
};

/// An IK target, and the distance that remained.
struct PosedReach {
    std::string chain;  ///< its name, or its number
    ReachTarget target;
    float distance = 0.0f;  ///< metres that remained
    float angle = 0.0f;     ///< radians that remained, if the target has a rotation; always for an aim
    bool is_aim = false;
    bool is_reached = false;
};

/// A named curve of the clip, and its value.
struct PosedCurve {
    std::string name, path;
    std::string target_kind;  ///< joint, material, mesh or texture; empty: no target
    std::uint32_t target = 0;
    std::vector<float> value;
};

struct PosedObject {
    std::string file;
    std::string clip;  ///< empty: the rest pose
    float time = 0.0f;
    std::vector<PosedReach> reaches;  ///< empty: no chain had a target
    std::vector<PosedCurve> curves;   ///< empty: the clip has no curves
    std::vector<PosedJoint> joints;
    std::vector<PosedMesh> meshes;
};

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

template <class Number>
void put_list(std::string& out, std::span<const Number> numbers) {
    out += '[';
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (i != 0) out += ',';
        put(out, numbers[i]);
    }
    out += ']';
}

std::span<const float> floats_of(std::span<const glm::vec3> vectors) {
    return vectors.empty() ? std::span<const float>() : std::span<const float>(&vectors[0].x, vectors.size() * 3);
}

std::string as_json(const std::string& text) {
    return json_text(nlohmann::json(text));
}

/// JSON cannot express infinities.
void put_finite(std::string& out, float number) {
    if (std::isfinite(number)) {
        put(out, number);
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

/// Wavefront OBJ: an `o` group per mesh; numbers in the shortest form that reads back to the same float.
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

/// PLY, binary little-endian: vertices with normals, faces; edges if there are any.
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

/// {"file", "clip", "time", "joints": [{"name", "world"}], "meshes": [{"name", "positions", "normals", "indices"}]}. If
/// chains had targets, "reaches": [{"chain", "target", "distance", "reached"}] follows "time", with "rotation" if the
/// target has one, and "angle" then and for an aim. If the clip has curves, "curves": [{"name", "path", "value"}] comes
/// before "joints", with "target": {KIND: number} if the curve has one.
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

/// Returns true for a rigid mesh whose joint mirrors it, which reverses the winding of its triangles.
bool is_mirrored(const Model& model, Pose& pose, std::uint32_t mesh) {
    const Mesh& view = model.meshes()[mesh];
    if (!view.is_rigid() || view.vertices == 0) return false;
    const std::uint32_t joint = model.rigid_mover(mesh, 0);
    return joint != kNone && glm::determinant(glm::mat3(pose.model_space()[joint])) < 0.0f;
}

void add_elements(const Model& model, Pose& pose, const Lod& lod, std::vector<PosedMesh>& meshes) {
    for (const Submesh& submesh : lod.submeshes()) {
        PosedMesh& mesh = meshes[submesh.mesh];
        std::vector<std::uint32_t>& list = submesh.topology == Topology::triangles ? mesh.triangles
                                           : submesh.topology == Topology::lines   ? mesh.lines
                                                                                   : mesh.points;
        const std::size_t start = list.size();
        const auto indices = lod.indices(submesh.mesh).subspan(submesh.first, submesh.count);
        list.insert(list.end(), indices.begin(), indices.end());
        if (submesh.topology != Topology::triangles || !is_mirrored(model, pose, submesh.mesh)) continue;
        for (std::size_t at = start; at + 3 <= list.size(); at += 3) std::swap(list[at + 1], list[at + 2]);
    }
}

/// Applies --reach and its related options to the pose; prints how near each chain came.
std::vector<PosedReach> reach_chains(const PoseArguments& arguments, Pose& pose) {
    const std::vector<ReachGoal> goals = find_goals(arguments.reach, arguments.file, pose.model());
    const std::vector<Reached> results = reach_goals(arguments.reach, goals, pose);
    ReachTally tally;
    tally.add(goals, results, arguments.time);
    tally.print(arguments.file, pose.model(), goals);
    std::vector<PosedReach> reaches;
    for (std::size_t k = 0; k < goals.size(); ++k) {
        const Chain& chain = *goals[k].chain;
        const ReachResult result = results[k].value_or(ReachResult());
        reaches.push_back({chain.name.empty() ? std::to_string(chain.number) : std::string(chain.name), goals[k].target,
                           result.distance, result.angle, goals[k].is_aim, has_reached(results[k])});
    }
    return reaches;
}

std::vector<PosedCurve> sample_curves(const Clip& clip, float seconds) {
    std::vector<PosedCurve> curves;
    for (const Curve& curve : clip.curves) {
        PosedCurve& posed = curves.emplace_back();
        posed.name = curve.name;
        posed.path = curve.path;
        if (curve.kind != CurveTarget::nothing)
            posed.target_kind = kValueNames<CurveTarget>.at(static_cast<std::size_t>(curve.kind));
        posed.target = curve.target;
        posed.value.resize(curve.components);
        (void)sample_curve(curve, seconds, posed.value);  // the time is finite, and there is room
    }
    return curves;
}

PosedObject pose_object(const PoseArguments& arguments, const Model& model) {
    PosedObject object;
    object.file = arguments.file.filename().string();
    Pose pose(model);
    if (arguments.has_clip) {
        const Clip& clip = find_clip(arguments.clip, arguments.file, model);
        (void)sample(pose, &clip, arguments.time);
        object.clip = clip.name.empty() ? arguments.clip : std::string(clip.name);
        object.time = arguments.time;
        object.curves = sample_curves(clip, arguments.time);
    }
    object.reaches = reach_chains(arguments, pose);
    const Lod lod = level_of(arguments.file, model, arguments.lod);
    for (std::size_t joint = 0; joint < model.joints().size(); ++joint) {
        object.joints.push_back({std::string(model.joints()[joint].name), pose.model_space()[joint]});
    }
    for (std::uint32_t number = 0; number < model.meshes().size(); ++number) {
        const Mesh& view = model.meshes()[number];
        PosedMesh& mesh = object.meshes.emplace_back();
        mesh.name = view.name;
        mesh.positions.resize(lod.vertices(number));
        if (view.normals) mesh.normals.resize(lod.vertices(number));
        (void)skin(pose, {.mesh = number, .lod = &lod, .out = {.positions = mesh.positions, .normals = mesh.normals}});
        const bool all_finite = std::all_of(mesh.positions.begin(), mesh.positions.end(), [](const glm::vec3& p) {
            return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
        });
        if (!all_finite) fail(arguments.file, "the pose is out of a float's range in mesh " + std::to_string(number));
    }
    add_elements(model, pose, lod, object.meshes);
    return object;
}

void run(const PoseArguments& arguments) {
    const std::string format = format_of(arguments.format, arguments.output, "obj");
    const auto writer = format == "json" ? write_json : format == "ply" ? write_ply : write_obj;
    Outputs outputs;
    outputs.reads(arguments.file);
    outputs.writes(arguments.output, NamedBy::user, format == "ply" ? Content::binary : Content::text);
    check_suffix({"pose", "--output", {".obj", ".ply", ".json"}, false}, arguments.file, arguments.output,
                 arguments.format);
    require_folder_of(arguments.output);
    const CharacterFile file = open_character(arguments.file, arguments.root, outputs);
    outputs.write(arguments.output, writer(pose_object(arguments, read_model(arguments.file, file.bytes()))));
}

}  // namespace

void add_pose(CLI::App& program) {
    const auto arguments = std::make_shared<PoseArguments>();
    CLI::App* command = program.add_subcommand("pose", "Write the posed, skinned geometry at a time of a clip");
    add_character(*command, arguments->file)->required();
    add_root(*command, arguments->root);
    CLI::Option* clip = add_clip(*command, arguments->clip);
    command->add_option("--time", arguments->time, "seconds on the clip's time line; clamped to its ends")
        ->check([](const std::string& text) { return text.empty() ? "must be a finite number" : ""; })
        ->capture_default_str()
        ->needs(clip);
    add_reach(*command, arguments->reach);
    add_lod(*command, arguments->lod);
    command->add_option("-o,--output", arguments->output,
                        "OUT.obj, OUT.ply or OUT.json; standard output if not given, or for -");
    add_format(*command, arguments->format, {"obj", "ply", "json"});
    command->footer(
        "OUT.json holds file, clip and time; joints: name and world, the matrix in model space, column by column; "
        "meshes: name, positions, normals and indices of triangles. After --reach also reaches, one for each target: "
        "chain, target, distance (metres left), reached; with an orientation also rotation, and with it or for an aim "
        "angle (radians left). "
        "Where the clip has named curves also curves: name, path, target (kind and number), value.\n"
        "Example: bendy pose fox.bendy --clip Run --time 0.35 -o run.obj\n"
        "         bendy pose robot.bendy --reach LeftArm=0.3,1.2,0.4 -o reach.obj");
    command->callback([arguments, clip] {
        arguments->has_clip = clip->count() != 0;
        if (!std::isfinite(arguments->time)) throw CLI::ValidationError("--time", "must be a finite number");
        run(*arguments);
    });
}

}  // namespace bendy::tools
