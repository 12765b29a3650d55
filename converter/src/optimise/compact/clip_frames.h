#pragma once

#include "optimise/compact/grid.h"
#include "scene/space.h"

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace bendy::converter {

/// The rotation vector of a unit quaternion that is nearest to `near`, at most one turn long.
glm::dvec3 log_near(const glm::dquat& q, const glm::dvec3& near);

/// A clip's joint transforms at the frames of a grid. Refers to the scene.
class ClipFrames {
public:
    ClipFrames(const Scene& scene, const Clip& clip, const Grid& grid);

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] std::size_t joints() const { return rest_.size(); }
    [[nodiscard]] std::size_t frames() const { return frames_; }
    [[nodiscard]] std::span<const Local> rest() const { return rest_; }
    [[nodiscard]] const Local& local(std::size_t frame, std::size_t joint) const {
        return locals_[frame * rest_.size() + joint];
    }
    /// A property as PACK stores it: relative to rest; rotations as rotation vectors without jumps.
    [[nodiscard]] glm::dvec3 relative(std::size_t frame, std::size_t joint, TrackPath path) const;
    /// The joint-to-model transforms of all joints at a frame.
    void place(std::size_t frame, std::span<Affine> out) const;

private:
    const Scene& scene_;
    std::size_t frames_;
    std::vector<Local> rest_;          // per joint
    std::vector<Local> locals_;        // frame by frame
    std::vector<glm::dvec3> vectors_;  // frame by frame: rotations from rest
};

}  // namespace bendy::converter
