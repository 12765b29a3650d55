#pragma once

#include "parts.h"

#include <bendy/converter/scene.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// KHR_animation_pointer: channels that animate any property, named by a JSON pointer.
namespace bendy::converter::gltf {

/// What a pointer names.
struct PointedProperty {
    enum class Kind : std::uint8_t {
        track,         ///< what an ordinary channel animates: `path` of node `element`
        mesh_weights,  ///< the weights of mesh `element`, which its nodes have unless they have their own
        curve,         ///< anything else: `property`, relative to `target`
        left_out,      ///< `why`, for Losses
    };
    Kind kind = Kind::left_out;
    TrackPath path = TrackPath::translation;
    std::size_t element = 0;
    CurveTarget target_kind = CurveTarget::nothing;
    std::uint32_t target = kNone;
    std::span<const std::uint32_t> further;  ///< other targets with the same property, the reader's
    std::string property;
    std::string why;
};

/// The channel's pointer; null if it has none.
const std::string* pointer_of(const Json& channel);

/// A curve's name: the channel's extras.name, or empty.
std::string curve_name(const Json& channel);

/// The channel without the name that curve_name gives.
Json without_curve_name(const Json& channel);

/// TRS or weights by glTF's name for it.
std::optional<TrackPath> track_path(std::string_view name);

class PointerReader {
public:
    PointerReader(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes);

    /// Fails at `place` on what is no JSON pointer, and where the node, material, ... does not exist.
    [[nodiscard]] PointedProperty read(std::string_view pointer, const std::string& place) const;

    /// The nodes that take their weights from a mesh.
    [[nodiscard]] const std::vector<std::size_t>& nodes_weighted_by(std::size_t mesh) const { return weighted_[mesh]; }

private:
    [[nodiscard]] PointedProperty read_node(std::size_t node, std::string_view property) const;
    [[nodiscard]] PointedProperty read_mesh(std::size_t mesh, std::string_view property) const;

    const Document& document_;
    const Skeleton& skeleton_;
    std::vector<std::vector<std::size_t>> weighted_;  ///< by mesh
    std::vector<std::uint32_t> first_mesh_;           ///< by mesh of the file: the first of the scene's, or kNone
    std::vector<std::vector<std::uint32_t>> camera_joints_;  ///< by camera: those that have it
};

}  // namespace bendy::converter::gltf
