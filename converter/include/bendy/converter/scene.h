#pragma once

#include <bendy/format/records.h>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

// The mutable authoring model: importers fill it, passes rework it, build_chunks writes it. Everything here is decoded
// to floats; build_chunks chooses the narrowest exact storage. glTF's conventions: metres, radians, seconds,
// right-handed, Y up, column vectors, column-major matrices, quaternions as x y z w.
namespace bendy::converter {

using bendy::kNone;

/// The axis that is up in a Biovision file, which does not say it.
enum class SourceUp : std::uint8_t {
    found,  ///< Z if the body stands along Z in its clips, otherwise Y
    y,
    z,
};

/// Transform of a joint relative to its parent: M = T * R * U with U upper triangular,
///     U = | scale.x  shear.x  shear.y |
///         |    0     scale.y  shear.z |
///         |    0        0     scale.z |
/// so that every affine matrix can be held, including one with shear or without volume. Shear is zero for an ordinary
/// TRS.
struct Transform {
    glm::vec3 translation{0.0f};
    glm::vec4 rotation{0.0f, 0.0f, 0.0f, 1.0f};  ///< x y z w, unit
    glm::vec3 scale{1.0f};
    glm::vec3 shear{0.0f};
};

struct Joint {
    std::string name;              ///< UTF-8, may be empty or duplicated
    std::uint32_t parent = kNone;  ///< always smaller than the joint's own index; kNone: a root
    Transform rest;
    std::vector<ConstraintRecord> constraints;  ///< at most one of each scope; they pass check_constraint
    std::string extras;                         ///< JSON text or empty
    std::string extensions;  ///< JSON object: the node's extensions that are kept unchanged; or empty
    std::string more;        ///< JSON object: see Scene::more
    bool in_skin = false;    ///< a skin of the source lists it, used or not; not written
};

/// An IK chain. Each joint on the path from record.effector up to record.start may have its own weight.
struct Chain {
    struct Weight {
        std::uint32_t joint = 0;
        float weight = 1.0f;  ///< 0 to 1
    };
    std::string name;
    ChainRecord record;           ///< joints are indices into Scene::joints
    std::vector<Weight> weights;  ///< at most one per joint; a joint without one has weight 1
    std::string extras;           ///< JSON text or empty
};

/// A list of vertex indices with one material; strips, fans and loops are resolved into lists by the importer.
struct Submesh {
    Topology topology = Topology::triangles;
    std::uint32_t material = kNone;      ///< index into Scene::materials
    std::vector<std::uint32_t> indices;  ///< into the mesh's vertices; 3, 2 or 1 per primitive, the source's order
};

/// A vertex stream that has no member of its own in Mesh: texture coordinates, colours, the author's attributes.
struct Stream {
    std::string name;              ///< name of an author's attribute (`_TEMPERATURE`); otherwise empty
    std::uint32_t set = 0;         ///< n of TEXCOORD_n, COLOR_n; sets ascend, gaps are allowed
    std::uint32_t components = 0;  ///< 1 to 16
    std::vector<float> values;     ///< vertex count * components
};

/// Positions on a grid: each is minimum + step * n with integer n, 0 to 65535, per axis, in float arithmetic rounded
/// after each operation.
struct FrameGrid {
    glm::vec3 minimum{0.0f};
    glm::vec3 step{0.0f};
};

/// A morph target: displacements per vertex; an empty vector means that the stream is not displaced.
struct MorphTarget {
    std::string name;
    float rest_weight = 0.0f;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec3> tangents;  ///< xyz only; handedness does not change
    /// True: a complete shape of the mesh, stored as is (FRMS). `positions`, which lie on `grid`, and `normals` are
    /// absolute, not displacements. The rest weight is 0; there are no tangents; either all frames have normals or none
    /// has.
    bool is_frame = false;
    FrameGrid grid = {};
};

/// The joints that the `bones` of a mesh refer to, with their inverse bind matrices (mesh space to joint space at bind
/// time).
struct Palette {
    std::vector<std::uint32_t> joints;    ///< indices into Scene::joints
    std::vector<glm::mat4> inverse_bind;  ///< one per joint
};

/// Vertices that share one set of streams, one palette and one set of targets. Written as a VECT chunk.
struct Mesh {
    std::string name;
    std::uint32_t joint = kNone;         ///< the joint that carries the mesh; moves it if it is rigid
    std::vector<glm::vec3> positions;    ///< in mesh space
    std::vector<glm::vec3> normals;      ///< empty, or one per vertex
    std::vector<glm::vec4> tangents;     ///< empty, or one per vertex: xyz, w = handedness +-1
    std::vector<Stream> texture_coords;  ///< TEXCOORD_0.. (2 components)
    std::vector<Stream> colours;         ///< COLOR_0.. (3 or 4 components)
    std::vector<Stream> attributes;      ///< the author's own, by name
    std::uint32_t influences = 0;        ///< per vertex; 0: rigid
    std::vector<std::uint32_t> bones;    ///< vertex count * influences, into the palette
    std::vector<float> weights;          ///< one per entry of `bones`; sum 1 per vertex, never negative
    Palette palette;
    std::vector<MorphTarget> targets;  ///< frames come last
    /// Each vertex's number in the source, if the order was changed; empty if it was not, or if the source's order is
    /// not kept. Importing a file restores the source's order.
    std::vector<std::uint32_t> source_numbers;
    /// Set if `positions` lie on a grid. They are then stored on it, and normals as indices into a list that all frames
    /// share. The list holds 256; further normals are replaced by the nearest.
    std::optional<FrameGrid> grid;
    std::vector<Submesh> submeshes;
    /// The collapse sequence, if the vertices are in its order: from vertex base on, the vertex that each one collapses
    /// to, always a smaller number; below base the vertex itself. Code that reorders vertices must clear it. Empty:
    /// none.
    std::vector<std::uint32_t> collapse;
    std::vector<std::uint8_t> joined;  ///< one per vertex: 1 if it collapses together with the one before it
    std::uint32_t base = 0;            ///< number of vertices that never collapse
    std::string extras;
    std::string more;  ///< JSON object: see Scene::more
};

/// How far each mesh's collapse sequence may go for a given error.
struct LodLevel {
    float error = 0.0f;                ///< metres, of any point of the surface, in the shapes that were measured
    std::vector<std::uint32_t> alive;  ///< number of vertices left, per mesh
};

struct Track {
    TrackPath path = TrackPath::translation;
    Interpolation interpolation = Interpolation::linear;
    std::uint32_t target = kNone;  ///< joint; for weights: mesh
    std::uint32_t components = 0;  ///< 3, 4, 3, or the mesh's target count
    std::vector<float> times;      ///< seconds, strictly ascending, at least one
    std::vector<float> values;     ///< keys * components; cubic: in-tangent, value, out-tangent per key
};

inline constexpr std::size_t kMostCurveComponents = 4;

/// A named curve of a clip: one to four animated numbers that are neither part of a joint's transform nor a morph
/// target's weight.
struct Curve {
    std::string name;  ///< UTF-8, may be empty
    /// The property's path, relative to the target, in glTF's spelling: "pbrMetallicRoughness/baseColorFactor"; without
    /// a target a JSON pointer. Unique among the curves of a clip with the same target, or empty.
    std::string path;
    CurveTarget kind = CurveTarget::nothing;
    std::uint32_t target = kNone;  ///< joint, material, mesh or texture, as `kind` says
    Interpolation interpolation = Interpolation::linear;
    std::uint32_t components = 1;  ///< 1 to 4
    std::vector<float> times;      ///< seconds, strictly ascending, at least one
    std::vector<float> values;     ///< keys * components; cubic: in-tangent, value, out-tangent per key
};

/// A named time of a clip: a footstep, a hit, a sound.
struct Marker {
    float seconds = 0.0f;  ///< between the clip's first and last key
    std::string name;      ///< UTF-8, may be empty or duplicated
};

/// Start and end of a clip, in seconds on its time line.
struct ClipSpan {
    float start = 0.0f;
    float end = 0.0f;

    /// The time, in seconds, at a fraction of the span, 0 to 1.
    [[nodiscard]] double at(double share) const { return start + share * (double{end} - start); }
    friend bool operator==(const ClipSpan&, const ClipSpan&) = default;
};

/// Consecutive frames of a mesh. Frame 0 is the mesh itself, frame k the k-th of its targets that are frames.
struct Play {
    std::uint32_t mesh = 0;
    std::uint32_t first = 0;
    std::uint32_t frames = 1;  ///< 1 or more; frame k is at Clip::frame_start + k / Clip::frame_rate
    bool closed = false;       ///< the last frame is followed by the first
};

struct Clip {
    std::string name;
    bool loop = false;          ///< repeats; glTF has no such field, the animation's extras may say {"loop": true}
    std::vector<Track> tracks;  ///< at most one per target and path; may be empty
    std::string extras;
    std::vector<std::byte> packed = {};  ///< a PACK payload (packed_clip.h) with tracks that `tracks` lacks, or empty
    std::vector<Marker> markers = {};    ///< times ascend; equal times are allowed
    std::string more = {};               ///< JSON object: see Scene::more
    /// Set if the clip is longer than its keys, or its keys are packed: it holds the first and last pose outside its
    /// keys. Never shorter than the keys.
    std::optional<ClipSpan> stated_span = {};
    std::vector<Play> plays = {};  ///< at most one per mesh, which then has no weights track
    float frame_rate = 0.0f;       ///< frames per second of `plays`; above 0 if there are any
    float frame_start = 0.0f;      ///< start of `plays`, seconds; no key is before it
    std::vector<Curve> curves = {};
};

/// One encoded image, unchanged: embedded bytes, or a reference to a file beside the output.
struct Image {
    std::string name;
    std::string media_type;        ///< image/png, image/jpeg, image/ktx2, image/webp, or the source's own value
    std::vector<std::byte> bytes;  ///< empty when `uri` is kept instead
    std::string uri;
};

/// An image with a sampler. Kept in the source's order: extensions kept as JSON refer to textures by index.
struct Texture {
    std::string name;
    std::vector<std::uint32_t> images;  ///< indices into Scene::images, in order of preference
    Filter mag_filter = Filter::unspecified;
    Filter min_filter = Filter::unspecified;
    Wrap wrap_s = Wrap::repeat;
    Wrap wrap_t = Wrap::repeat;
    std::string extras;
    std::string more;  ///< JSON object: see Scene::more; the first texture of each image also has the image's members
};

/// A material's use of a texture, with KHR_texture_transform (rotation in radians, counter-clockwise).
struct TextureUse {
    std::uint32_t texture = kNone;
    std::uint32_t coords = 0;  ///< set number
    glm::vec2 offset{0.0f};
    float rotation = 0.0f;
    glm::vec2 scale{1.0f};
};

struct Material {
    std::string name;
    std::uint32_t joint =
        kNone;  ///< whose own material it is, if the polygons of no other joint use it; kNone: the file's
    glm::vec4 base_colour{1.0f};
    float metallic = 1.0f;
    float roughness = 1.0f;
    glm::vec3 emissive{0.0f};
    float normal_scale = 1.0f;
    float occlusion_strength = 1.0f;
    float alpha_cutoff = 0.5f;
    AlphaMode alpha_mode = AlphaMode::opaque;
    bool double_sided = false;
    bool unlit = false;
    TextureUse base_colour_texture, metallic_roughness_texture, normal_texture, occlusion_texture, emissive_texture;
    std::string extensions;  ///< JSON object with the extensions that have no field here, verbatim; or empty
    std::string extras;
    std::string more;  ///< JSON object: see Scene::more
};

/// The pose in which the body stands, if that is not the rest pose: STND.
struct StandingPose {
    StandingPoseRecord pose;
    std::vector<StandingRotationRecord> rotations;  ///< ascending by joint
};

struct Scene {
    std::string name;
    std::vector<Joint> joints;      ///< pre-order: parents first, siblings in the source's order
    std::vector<RoleRecord> roles;  ///< what joints are in the body, ascending by joint; each role and place once
    std::optional<StandingPose> standing_pose;
    std::vector<Chain> chains;
    std::vector<Mesh> meshes;
    std::vector<LodLevel> levels;  ///< by error; empty if no mesh has a collapse sequence
    std::vector<Clip> clips;       ///< in the source's order and numbering
    std::vector<Material> materials;
    std::vector<Image> images;
    std::vector<Texture> textures;
    std::string extras;         ///< from the source's scene
    std::string source_extras;  ///< from the source's root
    std::string extensions;     ///< JSON object: the source's root extensions that are kept unchanged; or empty
    std::string asset;          ///< JSON object: glTF's `asset` (copyright, generator, ...) with its extras
    /// JSON object, or empty: further members of the source's scene object, in glTF's structure. A member that is an
    /// index in glTF is an object here, with the members of the element that it refers to (spec/chunks/MORE.md).
    std::string more;
    std::string source_more;   ///< likewise, of the source's root
    bool was_compact = false;  ///< read from a bendy file with an error bound (BNDS)
};

}  // namespace bendy::converter
