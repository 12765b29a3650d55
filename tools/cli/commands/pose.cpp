#include "commands/commands.h"
#include "commands/frames.h"
#include "commands/model_options.h"
#include "commands/reaching.h"
#include "files/input.h"
#include "files/output.h"
#include "files/progress.h"
#include "pose/posed_object.h"
#include "reports/messages.h"

#include <bendy/runtime.h>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace bendy::tools {
namespace {

struct PoseArguments {
    std::filesystem::path file;
    std::filesystem::path root;
    std::string clip;
    bool has_clip = false;
    float time = 0.0f;
    std::string frames;  // A..B@RATE; empty: one pose
    ReachRequest reach;
    float lod = 1.0f;  // fraction of the triangles
    std::filesystem::path output = "-";
    std::string format;  // empty: chosen by the output's name
};

/// Returns true for a rigid mesh whose joint mirrors it, which reverses the winding of its triangles.
bool is_mirrored(const Model& model, Pose& pose, std::uint32_t mesh) {
    const Mesh& view = model.meshes()[mesh];
    if (!view.is_rigid() || view.vertices == 0) return false;
    const std::uint32_t joint = model.rigid_mover(mesh, 0);
    return joint != kNone && glm::determinant(glm::mat3(pose.model_space()[joint])) < 0.0f;
}

/// Puts vertices and indices into the source's order, if the file has it.
void restore_order(const Mesh& view, PosedMesh& mesh) {
    const std::vector<std::uint32_t> order = source_order(view);
    if (order.empty()) return;
    std::vector<std::uint32_t> number(order.size());
    for (std::uint32_t at = 0; at < order.size(); ++at) number[order[at]] = at;
    for (auto* vectors : {&mesh.positions, &mesh.normals}) {
        if (vectors->empty()) continue;
        const std::vector<glm::vec3> stored = std::exchange(*vectors, {});
        for (const std::uint32_t vertex : order) vectors->push_back(stored[vertex]);
    }
    for (auto* list : {&mesh.triangles, &mesh.lines, &mesh.points}) {
        for (std::uint32_t& index : *list) index = number[index];
    }
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

bool is_finite(std::span<const float> numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](float number) { return std::isfinite(number); });
}

/// Poses one character again and again.
class Poser {
public:
    Poser(const PoseArguments& arguments, const Model& model)
        : arguments_(arguments),
          model_(model),
          clip_(arguments.has_clip ? &find_clip(arguments.clip, arguments.file, model) : nullptr),
          reaching_(arguments.reach, arguments.file, model),
          lod_(level_of(arguments.file, model, arguments.lod)) {}

    /// \param time  on the clip's time line, seconds
    PosedObject pose_at(float time) {
        PosedObject object;
        object.file = arguments_.file.filename().string();
        Pose pose(model_);
        if (clip_ != nullptr) {
            sample_clip(pose, time);
            object.clip = clip_->name.empty() ? arguments_.clip : std::string(clip_->name);
            object.time = time;
            object.curves = sample_curves(*clip_, time);
        }
        object.reaches = reach_chains(pose, time);
        for (const glm::mat4& matrix : pose.model_space()) {
            if (!is_finite({&matrix[0][0], 16})) fail(arguments_.file, "the pose is out of a float's range");
        }
        for (std::size_t joint = 0; joint < model_.joints().size(); ++joint)
            object.joints.push_back({std::string(model_.joints()[joint].name), pose.model_space()[joint]});
        for (std::uint32_t number = 0; number < model_.meshes().size(); ++number)
            object.meshes.push_back(posed_mesh(pose, number));
        add_elements(model_, pose, lod_, object.meshes);
        for (std::uint32_t number = 0; number < model_.meshes().size() && model_.collapse() == nullptr; ++number)
            restore_order(model_.meshes()[number], object.meshes[number]);
        return object;
    }

    /// The clip; with --frames there is one.
    [[nodiscard]] const Clip* clip() const { return clip_; }
    /// From now on, the poses are those frames of the clip.
    void follow_frames(const FrameRange& range) {
        reaching_.follow_frames(*clip_, range, [&](Pose& pose, float time) { sample_clip(pose, time); });
    }
    /// Prints how near each chain came to its target.
    void print_reached() const { reaching_.print(); }

private:
    void sample_clip(Pose& pose, float time) const { (void)sample(pose, clip_, time); }

    /// Applies --reach and its related options to the pose.
    std::vector<PosedReach> reach_chains(Pose& pose, float time) {
        reaching_.apply(pose, time);
        reaching_.count();
        std::vector<PosedReach> reaches;
        for (std::size_t k = 0; k < reaching_.goals().size(); ++k) {
            const ReachGoal& goal = reaching_.goals()[k];
            const Reached& reached = reaching_.results()[k];
            const Chain& chain = *goal.chain;
            const ReachResult result = reached.value_or(ReachResult());
            reaches.push_back(
                {chain.name.empty() ? std::to_string(&chain - model_.chains().data()) : std::string(chain.name),
                 goal.target, result.distance, result.angle, goal.is_aim(), has_reached(reached)});
        }
        return reaches;
    }

    [[nodiscard]] PosedMesh posed_mesh(Pose& pose, std::uint32_t number) const {
        const Mesh& view = model_.meshes()[number];
        PosedMesh mesh;
        mesh.name = view.name;
        mesh.positions.resize(lod_.vertices(number));
        if (view.normals) mesh.normals.resize(lod_.vertices(number));
        (void)skin(pose, {.mesh = number, .lod = &lod_, .out = {.positions = mesh.positions, .normals = mesh.normals}});
        for (const std::vector<glm::vec3>* vectors : {&mesh.positions, &mesh.normals}) {
            if (vectors->empty() || is_finite({&vectors->front().x, 3 * vectors->size()})) continue;
            fail(arguments_.file, "the pose is out of a float's range in mesh " + std::to_string(number));
        }
        return mesh;
    }

    const PoseArguments& arguments_;
    const Model& model_;
    const Clip* clip_;
    Reaching reaching_;
    Lod lod_;
};

/// The frames of --frames, and where each is written; without --frames, one pose.
struct PosedOutput {
    float time = 0.0f;
    std::filesystem::path file;
};

std::vector<PosedOutput> outputs_of(const PoseArguments& arguments, const std::optional<FrameRange>& range) {
    if (!range) return {{arguments.time, arguments.output}};
    std::vector<PosedOutput> all;
    all.reserve(range->count());
    for (std::uint32_t k = 0; k < range->count(); ++k)
        all.push_back({range->time(range->first + k), frame_output(arguments.output, range->first + k)});
    return all;
}

void run(const PoseArguments& arguments) {
    const std::string format = format_of(arguments.format, arguments.output, "obj");
    const auto writer = format == "json" ? write_json : format == "ply" ? write_ply : write_obj;
    check_suffix({"pose", "--output", {".obj", ".ply", ".json"}, false}, arguments.file, arguments.output,
                 arguments.format);
    std::optional<FrameRange> range;
    if (!arguments.frames.empty()) {
        range = read_frame_range(arguments.frames);
        require_numbered(arguments.output);
    }
    const std::vector<PosedOutput> poses = outputs_of(arguments, range);
    Outputs outputs;
    outputs.reads(arguments.file);
    for (const PosedOutput& pose : poses)
        outputs.writes(pose.file, NamedBy::user, format == "ply" ? Content::binary : Content::text);
    require_folder_of(arguments.output);
    const CharacterFile file = open_character(arguments.file, arguments.root, outputs);
    const Model model = read_valid_model(arguments.file, file.bytes());
    Poser poser(arguments, model);
    if (range) warn_outside(arguments.file, *poser.clip(), *range);
    if (range) {
        ProgressBar bar("posing");
        poser.follow_frames(*range);
        for (std::size_t k = 0; k < poses.size(); ++k) {
            outputs.stage(poses[k].file, as_byte_span(writer(poser.pose_at(poses[k].time))));
            bar.show(k + 1, poses.size());
        }
        outputs.replace_staged();
    } else {
        outputs.write(poses.front().file, writer(poser.pose_at(poses.front().time)));
    }
    poser.print_reached();
}

}  // namespace

void add_pose(CLI::App& program) {
    const auto arguments = std::make_shared<PoseArguments>();
    CLI::App* command = program.add_subcommand("pose", "Write the posed, skinned geometry at a time of a clip");
    add_character(*command, arguments->file)->required();
    add_root(*command, arguments->root);
    CLI::Option* clip = add_clip(*command, arguments->clip);
    CLI::Option* time =
        command->add_option("--time", arguments->time, "seconds on the clip's time line; clamped to its ends");
    time->check([](const std::string& text) { return text.empty() ? "must be a finite number" : ""; })
        ->capture_default_str()
        ->needs(clip);
    command
        ->add_option("--frames", arguments->frames,
                     "A..B@RATE: frames A to B of the clip, RATE per second; frame k is at k / RATE seconds. OUT has # "
                     "where the frame's number goes, as in run_####.obj. With --reach, each frame follows from those "
                     "before it, from the clip's start on: no chain jumps")
        ->needs(clip)
        ->excludes(time);
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
        "         bendy pose fox.bendy --clip Run --frames 0..59@30 -o run_####.obj\n"
        "         bendy pose robot.bendy --reach LeftArm=0.3,1.2,0.4 -o reach.obj");
    command->callback([arguments, clip] {
        arguments->has_clip = clip->count() != 0;
        if (!std::isfinite(arguments->time)) throw CLI::ValidationError("--time", "must be a finite number");
        run(*arguments);
    });
}

}  // namespace bendy::tools
