#include <bendy/converter/compare_characters.h>
#include <bendy/format/charconv.h>
#include <bendy/format/trig.h>

#include "optimise/collapse/find_shapes.h"
#include "optimise/compare/compare_curves.h"
#include "optimise/compare/match.h"
#include "optimise/measure_error.h"
#include "scene/evaluate.h"
#include "scene/frame_shapes.h"
#include "scene/space.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace bendy::converter {
namespace {

using Kind = CharacterDifference::Kind;

constexpr std::size_t kMostListed = 1'000;
constexpr std::size_t kMostPolygons = 10;  // maximum per mesh that the report names
constexpr double kShell = 0.03;            // of the height: distance of the test points on a joint's axes
constexpr float kSameTime = 1e-3f;         // seconds

template <class Things>
std::vector<std::string> names_of(const Things& things) {
    std::vector<std::string> names;
    names.reserve(things.size());
    for (const auto& thing : things) names.push_back(thing.name);
    return names;
}

std::string text_of(double number) {
    std::array<char, 32> digits{};
    const auto end = to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(number)).ptr;
    return {digits.data(), end};
}

std::string text_of(const glm::vec3& place) {
    return text_of(place.x) + ' ' + text_of(place.y) + ' ' + text_of(place.z);
}

/// The listed vertices of a mesh, in order, with all data that positions need.
Mesh gather(const Mesh& mesh, std::span<const MatchedPolygons::Corner> corners,
            std::uint32_t MatchedPolygons::Corner::*vertex) {
    Mesh gathered;
    gathered.name = mesh.name;
    gathered.joint = mesh.joint;
    gathered.influences = mesh.influences;
    gathered.palette = mesh.palette;
    for (const MorphTarget& target : mesh.targets)
        gathered.targets.push_back({{}, target.rest_weight, {}, {}, {}, target.is_frame, target.grid});
    for (const MatchedPolygons::Corner& corner : corners) {
        const std::uint32_t from = corner.*vertex;
        gathered.positions.push_back(mesh.positions[from]);
        for (std::size_t k = 0; k < mesh.influences; ++k) {
            gathered.bones.push_back(mesh.bones[from * std::size_t{mesh.influences} + k]);
            gathered.weights.push_back(mesh.weights[from * std::size_t{mesh.influences} + k]);
        }
        for (std::size_t target = 0; target < mesh.targets.size(); ++target) {
            const auto& moves = mesh.targets[target].positions;
            if (!moves.empty()) gathered.targets[target].positions.push_back(moves[from]);
        }
    }
    return gathered;
}

/// The mesh with the frames and displacements of another one with the same number of targets: the weights of either's
/// clips then have the same effect.
Mesh with_frames_of(const Mesh& other, Mesh mesh) {
    for (std::size_t number = 0; number < mesh.targets.size(); ++number) {
        MorphTarget& target = mesh.targets[number];
        if (target.is_frame == other.targets[number].is_frame) continue;
        if (target.is_frame) {
            target.positions = shifts_of(target, target.positions, mesh.positions);
        } else {
            target.positions.resize(mesh.positions.size(), glm::vec3(0.0f));
            for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
                target.positions[vertex] += mesh.positions[vertex];
        }
        target.is_frame = !target.is_frame;
    }
    return mesh;
}

class Comparison {
public:
    Comparison(const Scene& a, const Scene& b, const ErrorBound& tolerance) : a_(a), source_b_(b) {
        height_ = height_at_rest(a);
        result_.tolerance = tolerance.is_share ? tolerance.value * height_ : tolerance.value;
    }

    CharacterComparison run(const std::function<void(double)>& progress) {
        if (!pair_joints()) return std::move(result_);
        result_.worst = 0.0;
        pair_meshes();
        compare_materials();
        pair_clips();
        compare_rests();
        constexpr double kMatched = 0.2;  // share of the whole work
        compare_meshes();
        if (progress) progress(kMatched);
        if (result_.gave_up) return std::move(result_);
        measure_rest();
        measure_targets();
        for (std::uint32_t clip = 0; clip < a_clips_.size(); ++clip) {
            const double done = static_cast<double>(clip) / static_cast<double>(a_clips_.size());
            const double step = (1.0 - kMatched) / static_cast<double>(a_clips_.size());
            measure_clip(clip, [&](double share) {
                if (progress) progress(kMatched + done * (1.0 - kMatched) + share * step);
            });
        }
        return std::move(result_);
    }

private:
    void add(Kind kind, std::string place, std::string what = {}, double metres = 0.0) {
        if (result_.differences.size() == kMostListed) {
            ++result_.left_out;
        } else {
            result_.differences.push_back({kind, std::move(place), std::move(what), metres});
        }
    }

    /// Notes a distance: updates the worst one, and reports it if above the tolerance. Returns whether it is above.
    bool add_distance(double metres, const std::string& place) {
        if (metres > result_.worst) {
            result_.worst = metres;
            result_.worst_place = place;
        }
        if (metres <= result_.tolerance) return false;
        add(Kind::distance, place, {}, metres);
        return true;
    }

    template <class A, class B>
    void add_lone(const std::string& kind, const MatchedNames& names, const A& a, const B& b) {
        for (std::uint32_t number = 0; number < names.b_of.size(); ++number) {
            if (names.b_of[number] == kNone) add(Kind::only_in_a, kind + quoted_name(a[number].name, number));
        }
        for (std::uint32_t number = 0; number < names.a_of.size(); ++number) {
            if (names.a_of[number] == kNone) add(Kind::only_in_b, kind + quoted_name(b[number].name, number));
        }
    }

    // --- matching; B in A's numbering

    /// False if the skeletons differ: nothing else can be compared then.
    bool pair_joints() {
        joints_ = match_joints(a_.joints, source_b_.joints);
        add_lone("joint ", joints_, a_.joints, source_b_.joints);
        if (!result_.differences.empty()) return false;
        for (const Joint& joint : a_.joints) {
            const auto number = static_cast<std::uint32_t>(b_.joints.size());
            b_.joints.push_back(source_b_.joints[joints_.b_of[number]]);
            b_.joints.back().parent = joint.parent;
        }
        return true;
    }

    [[nodiscard]] Mesh renumbered(Mesh mesh) const {
        if (mesh.joint != kNone) mesh.joint = joints_.a_of[mesh.joint];
        for (std::uint32_t& joint : mesh.palette.joints) joint = joints_.a_of[joint];
        return mesh;
    }

    void pair_meshes() {
        meshes_ = match_names(names_of(a_.meshes), names_of(source_b_.meshes));
        const MatchedNames by_name = meshes_;
        match_the_rest(meshes_);
        add_lone("mesh ", meshes_, a_.meshes, source_b_.meshes);
        for (std::uint32_t number = 0; number < a_.meshes.size(); ++number) {
            const std::uint32_t other = meshes_.b_of[number];
            if (other == kNone) continue;
            const Mesh& a = a_.meshes[number];
            const Mesh& b = source_b_.meshes[other];
            const std::string place = "mesh " + quoted_name(a.name, number);
            if (by_name.b_of[number] == kNone)
                add(Kind::value, place, "name: " + quoted_name(a.name, number) + " -> " + quoted_name(b.name, other));
            if (a.targets.size() != b.targets.size()) {
                add(Kind::value, place,
                    "morph targets: " + std::to_string(a.targets.size()) + " -> " + std::to_string(b.targets.size()));
                continue;
            }
            for (std::uint32_t target = 0; target < a.targets.size(); ++target) {
                if (a.targets[target].name == b.targets[target].name) continue;
                add(Kind::value, place,
                    "morph target " + quoted_name(a.targets[target].name, target) + " -> " +
                        quoted_name(b.targets[target].name, target));
            }
            numbers_.push_back(number);
            b_.meshes.push_back(renumbered(b));
        }
    }

    void pair_clips() {
        const MatchedNames clips = match_names(names_of(a_.clips), names_of(source_b_.clips));
        add_lone("clip ", clips, a_.clips, source_b_.clips);
        for (std::uint32_t number = 0; number < a_.clips.size(); ++number) {
            if (clips.b_of[number] == kNone) continue;
            const Clip& a = a_.clips[number];
            const Clip& b = source_b_.clips[clips.b_of[number]];
            compare_frames(a, b, "clip " + quoted_name(a.name, number));
            clip_numbers_.push_back(number);
            Clip& here = a_clips_.emplace_back(a);
            Clip& there = b_clips_.emplace_back(b);
            keep_tracks(here, [&](std::uint32_t& mesh) {
                const auto kept = std::find(numbers_.begin(), numbers_.end(), mesh);
                mesh = static_cast<std::uint32_t>(kept - numbers_.begin());
                return kept != numbers_.end();
            });
            keep_tracks(there, [&](std::uint32_t& mesh) {
                const auto kept = std::find(numbers_.begin(), numbers_.end(), meshes_.a_of[mesh]);
                mesh = static_cast<std::uint32_t>(kept - numbers_.begin());
                return kept != numbers_.end();
            });
            for (Track& track : there.tracks) {
                if (track.path != TrackPath::weights) track.target = joints_.a_of[track.target];
            }
        }
    }

    /// Drops weight tracks of meshes that are not compared.
    /// \param is_kept  also renumbers the track's target
    template <class IsKept>
    static void keep_tracks(Clip& clip, IsKept is_kept) {
        std::erase_if(clip.tracks,
                      [&](Track& track) { return track.path == TrackPath::weights && !is_kept(track.target); });
        std::erase_if(clip.plays, [&](Play& play) { return !is_kept(play.mesh); });
    }

    void compare_frames(const Clip& a, const Clip& b, const std::string& place) {
        const ClipSpan here = span_of(a);
        const ClipSpan there = span_of(b);
        if (!(std::abs(here.start - there.start) <= kSameTime && std::abs(here.end - there.end) <= kSameTime)) {
            add(Kind::value, place,
                text_of(here.start) + " to " + text_of(here.end) + " s -> " + text_of(there.start) + " to " +
                    text_of(there.end) + " s");
        }
        if (a.loop != b.loop) add(Kind::value, place, a.loop ? "repeats -> does not" : "does not repeat -> does");
        compare_markers(a, b, place);
        const CurveTargets targets{joints_.a_of, material_of_, meshes_.a_of};
        for (CurveDifference& difference : compare_curves(a_, a, source_b_, b, targets))
            add(difference.kind, place + ", " + difference.curve, std::move(difference.what));
    }

    void compare_markers(const Clip& a, const Clip& b, const std::string& place) {
        const auto text = [](const Marker& marker) {
            return '"' + marker.name + "\" at " + text_of(marker.seconds) + " s";
        };
        if (a.markers.size() != b.markers.size()) {
            add(Kind::value, place,
                "markers: " + std::to_string(a.markers.size()) + " -> " + std::to_string(b.markers.size()));
            return;
        }
        for (std::size_t k = 0; k < a.markers.size(); ++k) {
            const Marker& here = a.markers[k];
            const Marker& there = b.markers[k];
            if (here.name == there.name && std::abs(here.seconds - there.seconds) <= kSameTime) continue;
            add(Kind::value, place, "marker " + std::to_string(k) + ": " + text(here) + " -> " + text(there));
        }
    }

    // --- materials

    void compare_materials() {
        MatchedNames materials = match_names(names_of(a_.materials), names_of(source_b_.materials));
        match_the_rest(materials);
        add_lone("material ", materials, a_.materials, source_b_.materials);
        material_of_ = materials.a_of;
        for (std::uint32_t number = 0; number < a_.materials.size(); ++number) {
            if (materials.b_of[number] == kNone) continue;
            const Material& b = source_b_.materials[materials.b_of[number]];
            const std::string place = "material " + quoted_name(a_.materials[number].name, number);
            if (a_.materials[number].name != b.name)
                add(Kind::value, place, "name: -> " + quoted_name(b.name, materials.b_of[number]));
            compare_material(a_.materials[number], b, place);
        }
    }

    void compare_material(const Material& a, const Material& b, const std::string& place) {
        const auto say = [&](const char* field) { add(Kind::value, place, std::string(field) + " differs"); };
        if (a.base_colour != b.base_colour) say("base colour");
        if (a.metallic != b.metallic || a.roughness != b.roughness) say("metallic or roughness");
        if (a.emissive != b.emissive) say("emissive");
        if (a.alpha_mode != b.alpha_mode || a.alpha_cutoff != b.alpha_cutoff) say("alpha");
        if (a.double_sided != b.double_sided || a.unlit != b.unlit) say("double-sided or unlit");
        if (a.normal_scale != b.normal_scale || a.occlusion_strength != b.occlusion_strength)
            say("normal scale or occlusion strength");
        if (!is_same_use(a.base_colour_texture, b.base_colour_texture)) say("base colour texture");
        if (!is_same_use(a.metallic_roughness_texture, b.metallic_roughness_texture)) say("metallic-roughness texture");
        if (!is_same_use(a.normal_texture, b.normal_texture)) say("normal texture");
        if (!is_same_use(a.occlusion_texture, b.occlusion_texture)) say("occlusion texture");
        if (!is_same_use(a.emissive_texture, b.emissive_texture)) say("emissive texture");
        if (a.extensions != b.extensions) say("extensions");
    }

    [[nodiscard]] bool is_same_use(const TextureUse& a, const TextureUse& b) const {
        if ((a.texture == kNone) != (b.texture == kNone)) return false;
        if (a.texture == kNone) return true;
        if (a.coords != b.coords || a.offset != b.offset || a.rotation != b.rotation || a.scale != b.scale)
            return false;
        const Texture& here = a_.textures[a.texture];
        const Texture& there = source_b_.textures[b.texture];
        return here.mag_filter == there.mag_filter && here.min_filter == there.min_filter &&
               here.wrap_s == there.wrap_s && here.wrap_t == there.wrap_t &&
               std::equal(here.images.begin(), here.images.end(), there.images.begin(), there.images.end(),
                          [&](std::uint32_t x, std::uint32_t y) {
                              const Image& image = a_.images[x];
                              const Image& other = source_b_.images[y];
                              return image.bytes == other.bytes && image.uri == other.uri;
                          });
    }

    // --- the rest pose

    /// Compares each joint relative to its parent: its origin, and points at 3 % of the height along its axes.
    void compare_rests() {
        EvaluatedPose rest;
        evaluate_rest(a_, rest);
        for (std::uint32_t number = 0; number < a_.joints.size(); ++number) {
            const Transform& here = a_.joints[number].rest;
            const Transform& there = b_.joints[number].rest;
            const Affine a = to_affine(local_of(here), here.shear);
            const Affine b = to_affine(local_of(there), there.shear);
            const std::uint32_t parent = a_.joints[number].parent;
            const glm::dmat3 above(parent == kNone ? glm::dmat4(1.0) : rest.joints[parent]);
            const double scale = trig::cube_root(std::abs(glm::determinant(glm::dmat3(rest.joints[number]))));
            constexpr double kFlat = 1e-6;  // scale below which points stay at the joint's origin
            const double reach = kShell * height_ / std::max(scale, kFlat);
            double apart = glm::length(above * (a.origin - b.origin));
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 point(0.0);
                point[axis] = reach;
                apart = std::max(apart, glm::length(above * (a(point) - b(point))));
            }
            if (apart > 0.0) add_distance(apart, "joint " + quoted_name(a_.joints[number].name, number) + ", at rest");
        }
    }

    // --- polygons

    void compare_meshes() {
        // Puts both on A's skeleton and in A's clips, so that joint errors do not count as skin errors.
        Scene a;
        Scene b;
        a.joints = b.joints = a_.joints;
        for (const std::uint32_t number : numbers_) a.meshes.push_back(a_.meshes[number]);
        for (std::size_t mesh = 0; mesh < a.meshes.size(); ++mesh)
            b.meshes.push_back(with_frames_of(a.meshes[mesh], b_.meshes[mesh]));
        a.clips = b.clips = a_clips_;
        const std::vector<std::vector<Shape>> shapes_a = find_shapes(a);
        const std::vector<std::vector<Shape>> shapes_b = find_shapes(b);
        for (std::size_t mesh = 0; mesh < a.meshes.size(); ++mesh) {
            const std::string place = "mesh " + quoted_name(a.meshes[mesh].name, numbers_[mesh]);
            const Looks looks(a.meshes[mesh], b_.meshes[mesh]);
            const MatchedPolygons matched = match_polygons(a.meshes[mesh], b_.meshes[mesh], shapes_a[mesh],
                                                           shapes_b[mesh], material_of_, looks, result_.tolerance);
            result_.gave_up = result_.gave_up || matched.gave_up;
            if (result_.gave_up) return;
            add_polygons(Kind::only_in_a, matched.only_in_a, place, shapes_a[mesh][0]);
            add_polygons(Kind::only_in_b, matched.only_in_b, place, shapes_b[mesh][0]);
            compare_looks(looks, matched.corners, place);
            a_meshes_.push_back(gather(a.meshes[mesh], matched.corners, &MatchedPolygons::Corner::a));
            b_meshes_.push_back(gather(b_.meshes[mesh], matched.corners, &MatchedPolygons::Corner::b));
            corners_.push_back(matched.corners);
        }
    }

    void add_polygons(Kind kind, std::span<const Polygon> polygons, const std::string& place, const Shape& shape) {
        for (const Polygon& polygon : polygons.first(std::min(polygons.size(), kMostPolygons))) {
            constexpr std::array kNames{"point", "line", "triangle"};
            std::string text = place;
            text.append(", ").append(kNames[polygon.corners - 1]);
            for (std::uint32_t k = 0; k < polygon.corners; ++k)
                text.append(" ").append(std::to_string(polygon.vertices[k]));
            if (polygon.material < a_.materials.size())
                text.append(" of material ").append(quoted_name(a_.materials[polygon.material].name, polygon.material));
            add(kind, text + " at " + text_of(shape[polygon.vertices[0]]));
        }
        if (polygons.size() > kMostPolygons) {
            add(kind, place, "further polygons: " + std::to_string(polygons.size() - kMostPolygons));
        }
    }

    void compare_looks(const Looks& looks, std::span<const MatchedPolygons::Corner> corners, const std::string& place) {
        const std::string before = place + ", ";
        for (const std::string& name : looks.only_in_a()) add(Kind::only_in_a, before + name);
        for (const std::string& name : looks.only_in_b()) add(Kind::only_in_b, before + name);
        for (const Looks::Paired& stream : looks.streams()) {
            const std::string unit = stream.kind == Looks::Kind::numbers ? "" : "degrees";
            LookDifference look{before + stream.name, 0.0, stream.allowed, unit};
            std::uint32_t vertex = 0;
            for (const MatchedPolygons::Corner& corner : corners) {
                const double apart = Looks::apart(stream, corner.a, corner.b);
                if (!(apart > look.apart)) continue;
                look.apart = apart;
                vertex = corner.a;
            }
            if (look.apart > look.allowed) {
                add(Kind::value, look.place,
                    "up to " + text_of(look.apart) + (unit.empty() ? "" : ' ' + unit) + " apart, at vertex " +
                        std::to_string(vertex) + "; allowed is " + text_of(look.allowed));
            }
            result_.looks.push_back(std::move(look));
        }
    }

    // --- distances

    [[nodiscard]] MeasuredError measure(const Clip* a, const Clip* b, const std::function<void(double)>& progress) {
        Scene here;
        Scene there;
        here.joints = a_.joints;
        there.joints = b_.joints;
        std::swap(here.meshes, a_meshes_);
        std::swap(there.meshes, b_meshes_);
        if (a != nullptr) {
            here.clips.push_back(*a);
            there.clips.push_back(*b);
        }
        const MeasuredError error = measure_error(here, there, {.progress = progress});
        std::swap(here.meshes, a_meshes_);
        std::swap(there.meshes, b_meshes_);
        return error;
    }

    /// Converts numbers to A's.
    [[nodiscard]] std::string place_in_a(MeasuredError error, std::uint32_t clip) const {
        if (error.mesh != kNone) {
            error.vertex = corners_[error.mesh][error.vertex].a;
            error.mesh = numbers_[error.mesh];
        }
        if (error.clip != kNone) error.clip = clip;
        return place_of(a_, error);
    }

    void measure_rest() {
        const MeasuredError error = measure(nullptr, nullptr, {});
        add_distance(error.metres, place_in_a(error, kNone));
    }

    /// Reports only what is worse than at rest.
    void measure_clip(std::uint32_t clip, const std::function<void(double)>& progress) {
        const MeasuredError error = measure(&a_clips_[clip], &b_clips_[clip], progress);
        if (error.clip != kNone) add_distance(error.metres, place_in_a(error, clip_numbers_[clip]));
    }

    void measure_targets() {
        EvaluatedPose here;
        EvaluatedPose there;
        Scene a;
        Scene b;
        a.joints = a_.joints;
        b.joints = b_.joints;
        evaluate_rest(a, here);
        evaluate_rest(b, there);
        for (std::uint32_t mesh = 0; mesh < a_meshes_.size(); ++mesh) {
            for (std::uint32_t target = 0; target < a_meshes_[mesh].targets.size(); ++target)
                measure_target(mesh, target, here, there);
        }
    }

    void measure_target(std::uint32_t mesh, std::uint32_t target, const EvaluatedPose& here,
                        const EvaluatedPose& there) {
        std::vector<double> weights(a_meshes_[mesh].targets.size(), 0.0);
        weights[target] = 1.0;
        const std::vector<glm::dvec3> a = evaluate_vertices(a_meshes_[mesh], weights, here.joints);
        const std::vector<glm::dvec3> b = evaluate_vertices(b_meshes_[mesh], weights, there.joints);
        MeasuredError error;
        for (std::uint32_t vertex = 0; vertex < a.size(); ++vertex) {
            const double apart = glm::distance(a[vertex], b[vertex]);
            if (apart <= error.metres) continue;
            error.metres = std::isnan(apart) ? INFINITY : apart;
            error.mesh = mesh;
            error.vertex = vertex;
        }
        if (error.mesh == kNone) return;
        const std::string& name = a_.meshes[numbers_[mesh]].targets[target].name;
        add_distance(error.metres, place_in_a(error, kNone) + " with target " + quoted_name(name, target));
    }

    const Scene& a_;
    const Scene& source_b_;
    double height_ = 0.0;
    CharacterComparison result_;

    MatchedNames joints_, meshes_;
    std::vector<std::uint32_t> material_of_;
    Scene b_;                             // matched joints and meshes, in A's numbering
    std::vector<std::uint32_t> numbers_;  // A's meshes that have a match
    std::vector<std::uint32_t> clip_numbers_;
    std::vector<Clip> a_clips_, b_clips_;
    std::vector<Mesh> a_meshes_, b_meshes_;  // one vertex per pair of corners
    std::vector<std::vector<MatchedPolygons::Corner>> corners_;
};

}  // namespace

CharacterComparison compare_characters(const Scene& a, const Scene& b, const ErrorBound& tolerance,
                                       const std::function<void(double)>& progress) {
    return Comparison(a, b, tolerance).run(progress);
}

}  // namespace bendy::converter
