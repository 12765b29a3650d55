#pragma once

#include <bendy/runtime.h>

#include <ozz/animation/runtime/animation.h>
#include <ozz/animation/runtime/skeleton.h>
#include <ozz/base/maths/simd_math.h>
#include <ozz/base/memory/unique_ptr.h>

#include <cstddef>
#include <cstdint>
#include <vector>

// ozz's side of a character, built from the bendy file as ozz's own tools would build it.
namespace bendy::bench {

struct OzzClip {
    ozz::unique_ptr<ozz::animation::Animation> plain;      ///< all keys of the source, no iframes
    ozz::unique_ptr<ozz::animation::Animation> iframes;    ///< the same, with an iframe each tenth of a second
    ozz::unique_ptr<ozz::animation::Animation> optimised;  ///< by AnimationOptimizer, with the same iframes
};

/// The vertices of a mesh that have one number of influences, as a job of their own.
struct OzzPart {
    std::size_t influences = 1;
    std::vector<std::uint16_t> joints;  ///< entries of the palette
    std::vector<float> weights;         ///< one fewer than influences for each vertex: ozz derives the last
    std::vector<float> positions, normals, tangents;
    std::vector<std::uint32_t> vertices;  ///< of the mesh in the bendy file
    [[nodiscard]] std::size_t size() const { return vertices.size(); }
};

struct OzzMesh {
    std::size_t palette = 0;  ///< into OzzCharacter::palettes
    std::vector<OzzPart> parts;
};

struct OzzPalette {
    std::vector<std::uint32_t> joints;  ///< ozz's numbers
    std::vector<ozz::math::Float4x4> inverse_bind;
};

struct OzzCharacter {
    ozz::unique_ptr<ozz::animation::Skeleton> skeleton;
    std::vector<std::uint32_t> ours_of, theirs_of;  ///< numbers of joints, which ozz sorts in its own order
    std::vector<OzzClip> clips;
    std::vector<OzzPalette> palettes;  ///< meshes whose palettes are the same share one
    std::vector<OzzMesh> meshes;
    [[nodiscard]] std::size_t joints() const { return ours_of.size(); }
    [[nodiscard]] std::size_t soa_joints() const { return static_cast<std::size_t>(skeleton->num_soa_joints()); }
};

/// \param model  of an exact file: the keys of packed clips are not there
OzzCharacter make_ozz(const Model& model);

ozz::math::SimdFloat4 simd_of(const glm::vec3& v);

}  // namespace bendy::bench
