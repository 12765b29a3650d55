#pragma once

#include "clip_keys.h"
#include "sides.h"

#include <bendy/edit/edit.h>
#include <bendy/extensions/pointed_lists.h>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/quaternion_double.hpp>
#include <glm/ext/vector_double3.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::edit {

/// Mirrors the clips of an object left to right, about the plane of symmetry that its paired joints have at rest.
///
/// A joint turns as its counterpart did, mirrored: with the model-space rotations G of the rest pose and r the half
/// turn about the plane's normal, c = G⁻¹ r G' leads from a joint's axes to those of its counterpart, and a local
/// rotation q becomes (c of the parent)⁻¹ q c. In a symmetric skeleton c only swaps signs, and nothing is rounded.
/// Translations and scales are mirrored about those of the rest pose in the same axes.
///
/// A curve goes to the joint, mesh, material or texture of the other side, and so do the sides that its path and name
/// tell, so that they agree.
class Mirror {
public:
    /// \param document, object  must outlive this
    static Result<Mirror, Problem> of(const Document& document, const ObjectView& object);

    /// A problem for a clip that plays stored frames.
    Result<void, Problem> change(ClipKeys& clip, Log& log);

private:
    /// How the values of a joint become those of its counterpart.
    struct Map {
        glm::dquat before{1.0, 0.0, 0.0, 0.0}, after{1.0, 0.0, 0.0, 0.0};
        glm::dmat3 move{1.0};   ///< translation: move * t + shift
        glm::dvec3 shift{0.0};  ///< metres
        glm::dmat3 scale{1.0};  ///< scale * s + scale_shift
        glm::dvec3 scale_shift{0.0};
    };

    Mirror(const Document& document, const ObjectView& object);

    Result<void, Problem> measure();
    void make_maps();
    void pair_meshes();
    /// The joints of VRM expressions, and for each that of the expression on the other side. kNone: there is none, and
    /// its curve and track stay.
    using Expressions = std::map<std::uint32_t, std::uint32_t>;
    [[nodiscard]] Expressions pair_expressions(const ClipKeys& clip) const;
    void change_track(ClipTrack& track, const Expressions& expressions) const;
    void change_weights(ClipTrack& track) const;
    void change_curves(ClipKeys& clip, const Expressions& expressions, Log& log);
    [[nodiscard]] std::optional<std::uint32_t> target_there(const ClipCurve& curve,
                                                            const Expressions& expressions) const;
    [[nodiscard]] std::string path_there(const ClipCurve& curve);
    void warn(const ClipKeys& clip, const Expressions& expressions, Log& log) const;

    const ObjectView* object_;
    JointSides sides_;
    std::vector<glm::dquat> rotations_;  // of the joints at rest, in model space
    std::vector<glm::dvec3> positions_;
    glm::dvec3 normal_{1.0, 0.0, 0.0};   // of the plane of symmetry, from right to left
    double offset_ = 0.0;                // of the plane along the normal
    double size_ = 0.0;                  // largest distance between two paired joints, or of one from the plane
    std::vector<Map> maps_;              // by joint
    std::vector<std::uint32_t> meshes_;  // the mesh on the other side
    std::vector<std::vector<std::uint32_t>> targets_;  // by mesh: the target in the mesh on the other side
    std::vector<std::uint32_t> materials_, textures_;  // those on the other side
    extensions::PointedLists lists_;                   // of HEAD's extensions
    std::map<std::string, std::vector<std::uint32_t>, std::less<>>
        elements_;  // of these lists: those on the other side
};

}  // namespace bendy::edit
