#include "commands/commands.h"
#include "commands/model_options.h"
#include "commands/reach_request.h"
#include "files/input.h"
#include "files/mesh_writer.h"
#include "files/output.h"
#include "terminal/problem.h"

#include <bendy/runtime.h>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace bendy::cli {
namespace {

struct PoseArguments {
    std::filesystem::path file;
    std::string clip;
    bool has_clip = false;
    float time = 0.0f;
    ReachRequest reach;
    float lod = 1.0f;  // share of the triangles
    std::filesystem::path output = "-";
    std::string format;  // empty: as the output's name says
};

/// True for a rigid mesh whose joint mirrors it: its triangles then turn their backs.
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

/// What --reach and its companions do to the pose; says how near each chain came.
std::vector<PosedReach> reach_chains(const PoseArguments& arguments, Pose& pose) {
    const std::vector<ReachGoal> goals = find_goals(arguments.reach, arguments.file, pose.model());
    const std::vector<Reached> results = reach_goals(arguments.reach, goals, pose);
    ReachTally tally;
    tally.add(results, arguments.time);
    tally.print(arguments.file, pose.model(), goals);
    std::vector<PosedReach> reaches;
    for (std::size_t k = 0; k < goals.size(); ++k) {
        const Chain& chain = *goals[k].chain;
        const ReachResult result = results[k].value_or(ReachResult());
        reaches.push_back({chain.name.empty() ? std::to_string(chain.number) : std::string(chain.name), goals[k].target,
                           result.distance, result.angle, has_reached(results[k])});
    }
    return reaches;
}

std::vector<PosedCurve> sample_curves(const Clip& clip, float seconds) {
    constexpr std::array kKinds{"", "joint", "material", "mesh", "texture"};
    static_assert(kKinds.size() == kCurveTargets);
    std::vector<PosedCurve> curves;
    for (const Curve& curve : clip.curves) {
        PosedCurve& posed = curves.emplace_back();
        posed.name = curve.name;
        posed.path = curve.path;
        posed.target_kind = kKinds.at(static_cast<std::size_t>(curve.kind));
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

/// Of the output: what --format says, or its name does.
std::string format_of(const PoseArguments& arguments) {
    if (!arguments.format.empty()) return arguments.format;
    const std::string suffix = suffix_of(arguments.output);
    return is_dash(arguments.output) || suffix.empty() ? "obj" : suffix.substr(1);
}

void run(const PoseArguments& arguments) {
    const std::string format = format_of(arguments);
    const auto writer = format == "json" ? write_json : format == "ply" ? write_ply : write_obj;
    Outputs outputs;
    outputs.reads(arguments.file);
    outputs.writes(arguments.output, NamedBy::user, format == "ply" ? Content::binary : Content::text);
    check_format({"pose", "--output", {".obj", ".ply", ".json"}, false}, arguments.format, arguments.file,
                 arguments.output);
    require_folder_of(arguments.output);
    const CharacterFile file = open_character(arguments.file, outputs);
    const Result<Model> model = Model::from_memory(file.bytes());
    if (!model) fail(arguments.file, model.error(), file.bytes());

    const std::string text = writer(pose_object(arguments, *model));
    outputs.write(arguments.output, text);
}

}  // namespace

void add_pose(CLI::App& program) {
    const auto arguments = std::make_shared<PoseArguments>();
    CLI::App* command = program.add_subcommand("pose", "Write the posed, skinned geometry at a time of a clip");
    command
        ->add_option("FILE", arguments->file,
                     "a bendy file, or one that `bendy convert` reads, which is converted on the fly")
        ->required();
    CLI::Option* clip =
        command->add_option("--clip", arguments->clip, "the clip, by number or name; the rest pose if not given");
    command->add_option("--time", arguments->time, "seconds on the clip's time line; clamped to its ends")
        ->check([](const std::string& text) { return text.empty() ? "must be a finite number" : ""; })
        ->capture_default_str()
        ->needs(clip);
    add_reach(*command, arguments->reach);
    add_lod(*command, arguments->lod);
    command->add_option("-o,--output", arguments->output,
                        "OUT.obj, OUT.ply or OUT.json; standard output if not given, or for -");
    command
        ->add_option("--format", arguments->format,
                     "the format, if the output's name does not determine it; obj by default on standard output")
        ->check(CLI::IsMember({"obj", "ply", "json"}));
    command->footer(
        "OUT.json holds file, clip and time; joints: name and world, the matrix in model space, column by column; "
        "meshes: name, positions, normals and indices of triangles. After --reach also reaches, one for each target: "
        "chain, target, distance (metres left), reached; with an orientation also rotation and angle (radians left). "
        "Where the clip has named curves also curves: name, path, target (kind and number), value.\n"
        "Example: bendy pose fox.bendy --clip Run --time 0.35 -o run.obj\n"
        "         bendy pose robot.bendy --reach LeftArm=0.3,1.2,0.4 -o reach.obj");
    command->callback([arguments, clip] {
        arguments->has_clip = clip->count() != 0;
        if (!std::isfinite(arguments->time)) throw CLI::ValidationError("--time", "must be a finite number");
        run(*arguments);
    });
}

}  // namespace bendy::cli
