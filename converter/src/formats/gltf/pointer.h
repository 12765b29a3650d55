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

// KHR_animation_pointer: channels that animate any property, addressed by a JSON pointer.
namespace bendy::converter::gltf {

/// The property that a pointer addresses.
struct PointedProperty {
    enum class Kind : std::uint8_t {
        track,         ///< like an ordinary channel: `path` of node `element`
        mesh_weights,  ///< weights of mesh `element`, which its nodes use unless they have their own
        curve,         ///< anything else: `property`, relative to `target`
        left_out,      ///< dropped: `why`, for Losses
    };
    Kind kind = Kind::left_out;
    TrackPath path = TrackPath::translation;
    std::size_t element = 0;
    CurveTarget target_kind = CurveTarget::nothing;
    std::uint32_t target = kNone;
    std::span<const std::uint32_t> further;  ///< further targets of the same property; in the reader's memory
    std::string property;
    std::string why;
};

/// The channel's pointer; null if it has none.
const std::string* pointer_of(const Json& channel);

/// A curve's name: the channel's extras.name, or empty.
std::string curve_name(const Json& channel);

/// The channel without the name that curve_name returns.
Json without_curve_name(const Json& channel);

/// The path (TRS or weights) with this glTF name.
std::optional<TrackPath> track_path(std::string_view name);

class PointerReader {
public:
    PointerReader(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes);

    /// Fails at `place` if the text is not a JSON pointer, or the node, material, ... does not exist.
    [[nodiscard]] PointedProperty read(std::string_view pointer, const std::string& place) const;

    /// The nodes that take their weights from a mesh.
    [[nodiscard]] const std::vector<std::size_t>& nodes_weighted_by(std::size_t mesh) const { return weighted_[mesh]; }

private:
    [[nodiscard]] PointedProperty read_node(std::size_t node, std::string_view property) const;
    [[nodiscard]] PointedProperty read_mesh(std::size_t mesh, std::string_view property) const;

    const Document& document_;
    const Skeleton& skeleton_;
    std::vector<std::vector<std::size_t>> weighted_;  ///< by mesh
    std::vector<std::uint32_t> first_mesh_;           ///< by mesh of the file: the first one in the scene, or kNone
    std::vector<std::vector<std::uint32_t>> camera_joints_;  ///< by camera: the joints that use it
};

}  // namespace bendy::converter::gltf
