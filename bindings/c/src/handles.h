#pragma once

#include <bendy.h>
#include <bendy/format/codec.h>
#include <bendy/format/file.h>
#include <bendy/runtime/binding.h>
#include <bendy/runtime/body_reach.h>
#include <bendy/runtime/bounds.h>
#include <bendy/runtime/crossfade.h>
#include <bendy/runtime/crowd.h>
#include <bendy/runtime/lod.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/palette_matrix.h>
#include <bendy/runtime/playback.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/reach_state.h>
#include <bendy/runtime/retarget.h>
#include <bendy/runtime/root_motion.h>
#include <bendy/runtime/transform.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

// The objects behind the handles. All handles of one model share the Character, which is freed with the last of them.
namespace bendy::capi {

struct CurveNames {
    std::string name, path;
};

/// JSON of a clip, mesh, material or texture.
struct Json {
    std::string extras, more;
};

/// Names and other texts in C's form: zero-terminated.
struct Names {
    std::string model, model_extras, file_extras;
    std::vector<std::string> joints, clips, chains, targets, meshes, materials, textures;
    std::vector<std::vector<CurveNames>> curves;       ///< per clip
    std::vector<std::vector<std::string>> markers;     ///< per clip
    std::vector<std::vector<std::string>> attributes;  ///< per mesh
    std::vector<std::vector<std::string>> uris;        ///< per texture, one for each image
    std::vector<std::string> joint_extras, chain_extras;
    std::vector<std::string> material_extensions;
    std::vector<Json> clip_json, mesh_json, material_json, texture_json;
};

/// The bytes of a file, from one of three sources.
struct Source {
    MappedFile file;
    AlignedBytes copy;
    Bytes bytes;  ///< of one of the above, or the caller's
};

struct Character {
    Source source;
    Model model;
    Names names;
    std::vector<std::uint32_t> target_meshes;  ///< the mesh of each target of the model

    Character(Source from, Model loaded);
};

}  // namespace bendy::capi

struct bendy_model {
    std::shared_ptr<const bendy::capi::Character> character;

    [[nodiscard]] const bendy::Model& get() const { return character->model; }
};

struct bendy_pose {
    explicit bendy_pose(std::shared_ptr<const bendy::capi::Character> of)
        : character(std::move(of)), pose(character->model) {}
    bendy_pose(std::shared_ptr<const bendy::capi::Character> of, bendy::Pose taken)
        : character(std::move(of)), pose(std::move(taken)) {}

    std::shared_ptr<const bendy::capi::Character> character;
    bendy::Pose pose;
};

struct bendy_body_reach {
    std::shared_ptr<const bendy::capi::Character> character;
    bendy::BodyReach body;
    std::size_t effectors;  ///< their number
};

struct bendy_reach_state {
    explicit bendy_reach_state(std::shared_ptr<const bendy::capi::Character> of)
        : character(std::move(of)), state(character->model) {}

    std::shared_ptr<const bendy::capi::Character> character;
    bendy::ReachState state;
};

struct bendy_lod {
    explicit bendy_lod(std::shared_ptr<const bendy::capi::Character> of)
        : character(std::move(of)), lod(character->model) {}

    std::shared_ptr<const bendy::capi::Character> character;
    bendy::Lod lod;
};

struct bendy_playback {
    bendy::Playback playback;
};

struct bendy_fade {
    bendy::Fade fade;
};

struct bendy_crossfade {
    std::shared_ptr<const bendy::capi::Character> character;
    bendy::Crossfade crossfade;
};

struct bendy_root_path {
    bendy_root_path(std::shared_ptr<const bendy::capi::Character> of, std::uint32_t joint, const bendy::RootAxes& axes)
        : character(std::move(of)), path(character->model, joint, axes) {}

    std::shared_ptr<const bendy::capi::Character> character;
    bendy::RootPath path;
};

struct bendy_bounds {
    explicit bendy_bounds(std::shared_ptr<const bendy::capi::Character> of)
        : character(std::move(of)), bounds(character->model) {}

    std::shared_ptr<const bendy::capi::Character> character;
    bendy::Bounds bounds;
};

struct bendy_binding {
    bendy_binding(std::shared_ptr<const bendy::capi::Character> of_animated,
                  std::shared_ptr<const bendy::capi::Character> of_posed, const bendy::BindingOptions& options)
        : animated(std::move(of_animated)),
          posed(std::move(of_posed)),
          binding(animated->model, posed->model, options) {}

    std::shared_ptr<const bendy::capi::Character> animated, posed;
    bendy::Binding binding;
};

struct bendy_retarget {
    std::shared_ptr<const bendy::capi::Character> source, character;  ///< `character`: the target
    bendy::Retarget retarget;
};

struct bendy_retarget_state {
    bendy::RetargetState state;
};

struct bendy_crowd {
    bendy_crowd(std::shared_ptr<const bendy::capi::Character> of, std::size_t workers)
        : character(std::move(of)),
          crowd(character->model, workers),
          palettes(crowd.workers() * bendy::Crowd::kAtOnce * crowd.palette_size()) {}

    std::shared_ptr<const bendy::capi::Character> character;
    bendy::Crowd crowd;
    std::vector<bendy::PaletteMatrix> palettes;  ///< of the kAtOnce members that each worker plays
};
