#pragma once

#include "near_poses.h"
#include "space.h"

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace bendy::converter {

/// A mesh in two scenes, of which is asked whether any vertex is farther off than so much: answered for most poses
/// without a look at the vertices, by those that hang on the same bones together.
class NearMesh {
public:
    /// Refers to all three, which must outlive it. \param map  see VertexMaps; null: the same places
    NearMesh(const Mesh& exact, const Mesh& decoded, const std::vector<std::uint32_t>* map);

    /// False if no vertex, not displaced by targets, is farther than `metres` from where the exact scene has it,
    /// whatever the poses' doubts stand for.
    bool may_be_farther(const NearPoses& exact, const NearPoses& decoded, double metres);

private:
    struct Vertex {
        std::uint32_t number = 0, there = 0;  // in the exact and in the decoded mesh
    };
    /// Vertices that the same bones move, in either scene.
    struct Group {
        std::vector<std::uint32_t> bones;  // the first: what the others are compared with
        std::vector<double> changes;       // per bone: the largest |w - w'|
        std::vector<Vertex> vertices;
        Box<glm::dvec3> box;  // of their exact places
        double place = 0.0;   // metres in mesh space between the exact and the decoded one, the largest
        double exact_total = 0.0, decoded_total = 0.0,
               total_change = 0.0;  // sums of w, of w', |of w - w'|; the largest
    };
    /// Of a palette entry, in the poses at hand.
    struct Bone {
        Affine exact, decoded;
        double exact_doubt = 0.0, decoded_doubt = 0.0;  // metres, at any vertex
        double stretch = 0.0;                           // at least the largest of `decoded`
    };

    void set_bones(const NearPoses& poses, const std::vector<std::uint32_t>& joints, const std::vector<Affine>& binds,
                   Affine Bone::*place, double Bone::*doubt);
    [[nodiscard]] double bound_of(const Group& group) const;
    [[nodiscard]] bool is_farther(const Vertex& vertex, double metres) const;

    const Mesh& exact_;
    const Mesh& decoded_;
    bool can_tell_ = true;
    std::vector<std::uint32_t> exact_joints_, decoded_joints_;
    std::vector<Affine> exact_binds_, decoded_binds_;
    double reach_ = 0.0;  // of the vertices of both from the origin of mesh space
    std::vector<Group> groups_;
    std::vector<Bone> bones_;
};

}  // namespace bendy::converter
