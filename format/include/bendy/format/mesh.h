#pragma once

#include <bendy/format/error.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

// VECT: a mesh, one leaf chunk per stream.
namespace BENDY_PUBLIC bendy {

/// The smallest value of a component, and the step between its integers.
struct StreamBox {
    float minimum = 0.0f;
    float step = 0.0f;
};

/// The numbers of a stream in place: elements * components, without gaps.
struct StreamView {
    ComponentType type = ComponentType::f32;
    bool normalised = false;
    std::uint32_t components = 0;
    std::uint32_t elements = 0;
    std::uint32_t set = 0;    ///< texture coordinate or colour set
    Bytes data;               ///< elements * components * component_size(type) bytes
    std::uint32_t chunk = 0;  ///< the leaf that holds it
    /// One per component if integers represent minimum + step * integer; otherwise empty.
    std::span<const StreamBox> boxes = {};
    /// True if the first two components are a direction on the octahedron, see decode_octahedral.
    bool is_octahedral = false;
    /// The list that the integers are indices into, for listed normals; all indices are in range. Otherwise empty.
    std::span<const glm::vec3> list = {};

    /// Returns one number: normalised integers become [0, 1] or, signed, [-1, 1], as in glTF; boxed ones become minimum
    /// + step * integer, rounded after each operation; others keep their value.
    [[nodiscard]] float number(std::uint32_t element, std::uint32_t component) const;
    /// Returns one unsigned integer of a stream of type u8, u16 or u32.
    [[nodiscard]] std::uint32_t index(std::uint32_t element, std::uint32_t component) const;
    /// Returns one element of positions, normals or displacements, decoded.
    [[nodiscard]] glm::vec3 vec3(std::uint32_t element) const;
    /// Returns one tangent: xyz and the handedness.
    [[nodiscard]] glm::vec4 vec4(std::uint32_t element) const;
    /// Decodes the first out.size() elements, at most `elements`; faster than one by one.
    void decode(std::span<glm::vec3> out) const;
    void decode(std::span<glm::vec4> out) const;
    /// Decodes the numbers of the first out.size() / components elements, as number() does.
    void decode(std::span<float> out) const;
    /// Returns all numbers in place. The caller must ensure that T matches the stream's type (float for f32, ...).
    template <class T>
    [[nodiscard]] std::span<const T> as() const {
        return view_at<T>(data, 0, std::uint64_t{elements} * components);
    }
    [[nodiscard]] bool empty() const { return elements == 0 || components == 0; }
};

/// Returns the unit vector at a point of the unfolded octahedron (Meyer et al., On Floating-Point Normal Vectors,
/// 2010): x and y in [-1, 1]. Uses only addition, multiplication, division and square root, so the result is the same
/// on every machine.
glm::vec3 decode_octahedral(float x, float y);

/// The joints that a mesh's bones refer to, and their inverse bind matrices (mesh space to joint space at bind time).
struct PaletteView {
    std::span<const std::uint32_t> joints;
    std::span<const glm::mat4> stored;  ///< column-major: one per joint, or a single one from which they are derived
    bool is_derived = false;            ///< from the rest pose: see derive_inverse_bind
    std::vector<glm::mat4> derived;     ///< the derived matrices, one per joint
    std::uint32_t chunk = kNone;        ///< PALT

    [[nodiscard]] std::span<const glm::mat4> inverse_bind() const { return is_derived ? derived : stored; }
};

/// TARG: a morph target. Also a frame of FRMS, which stores a shape of the whole mesh instead of displacements. A
/// stream that is absent is not displaced.
struct MorphTargetView {
    std::uint32_t chunk = 0;  ///< TARG or FRMS
    std::string_view name;
    float rest_weight = 0.0f;
    std::optional<StreamView> vertices;  ///< the affected vertices, ascending; absent: all vertices of the mesh, in
                                         ///< order
    std::optional<StreamView> positions, normals, tangents;  ///< displacements: vec3, one per affected vertex
    /// For a frame, the element of `positions` and `normals` for each of the mesh's vertices; these streams then hold
    /// the positions and normals themselves, not displacements. Absent: not a frame.
    std::optional<StreamView> places;

    [[nodiscard]] bool is_frame() const { return places.has_value(); }
    /// Returns the number of vertices that the target affects in a mesh with `mesh_vertices` vertices; and the k-th of
    /// them.
    [[nodiscard]] std::uint32_t touched(std::uint32_t mesh_vertices) const {
        return vertices ? vertices->elements : mesh_vertices;
    }
    [[nodiscard]] std::uint32_t vertex(std::uint32_t k) const { return vertices ? vertices->index(k, 0) : k; }
    /// Returns the displacement of the k-th vertex at full weight. `stream`: of the target; `rest`: the mesh's stream
    /// of the same kind.
    [[nodiscard]] glm::vec3 displacement(const StreamView& stream, const StreamView& rest, std::uint32_t k) const {
        return is_frame() ? stream.vec3(places->index(k, 0)) - rest.vec3(k) : stream.vec3(k);
    }
};

/// USER: an application-specific attribute.
struct AttributeView {
    std::string_view name;
    StreamView values;
};

struct MeshView {
    std::uint32_t chunk = 0;
    std::string_view name;
    std::uint32_t vertices = 0;
    std::uint32_t joint = kNone;         ///< the joint that carries the mesh
    bool has_info = false;               ///< VINF was read; if not, nothing else of the mesh is
    StreamView positions;                ///< vec3; empty only in a mesh without vertices
    std::optional<StreamView> normals;   ///< vec3
    std::optional<StreamView> tangents;  ///< vec4
    std::vector<StreamView> texture_coords, colours;
    std::vector<AttributeView> attributes;
    std::optional<StreamView> bones, weights;  ///< both or neither; a mesh without them is rigid
    PaletteView palette;
    std::vector<MorphTargetView> targets;  ///< those in TARG, then the frames of FRMS
    std::uint32_t first_frame = 0;         ///< index in `targets` of the first frame
    std::optional<StreamView> indices;     ///< u16 or u32 x 1
    std::string_view extras;
    std::string_view more;  ///< JSON object, or empty

    [[nodiscard]] bool is_rigid() const { return !bones.has_value(); }
    /// Number of shapes that a clip can play: frame 0 is the mesh's own streams, frame k is target first_frame + k - 1.
    [[nodiscard]] std::uint32_t frames() const { return static_cast<std::uint32_t>(targets.size()) - first_frame + 1; }
};

/// The name of the USER whose numbers are those of the vertices in the source (spec/chunks/USER.md).
inline constexpr std::string_view kSourceVertex = "SOURCE_VERTEX";

/// Returns the mesh's vertices in the order of the source: by their numbers there; those with the same number as they
/// are stored. Empty if the mesh has no such numbers, unsigned integers, one for each vertex.
std::vector<std::uint32_t> source_order(const MeshView& mesh);

/// Reads a VECT chunk, except for matrices derived from the rest pose, and makes all checks that memory safety depends
/// on: types, counts, sizes, and every index against the `joints` of the object, the palette and the mesh itself.
/// Faults are added to `faults`; a part with a fault is left out.
MeshView read_mesh(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t joints, Faults& faults);

/// Adds faults of content that do not affect memory safety: numbers that are not finite, weights that are negative or
/// do not sum to 1 within kWeightTolerance.
void check_mesh_values(const ChunkTree& tree, const MeshView& mesh, Faults& faults);

inline constexpr float kWeightTolerance = 1e-5f;

}  // namespace bendy
