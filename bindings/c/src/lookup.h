#pragma once

#include "fail.h"
#include "handles.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

// Looks up what a call refers to: the parts of a model by their indices.
namespace bendy::capi {

/// The number of streams of a mesh.
std::uint32_t count_streams(const Mesh& mesh);

/// Counts the parts of each kind: of a model, or of the clip, mesh or texture with that index.
class Parts {
public:
    explicit Parts(const Character& of) : model_(of.model), targets_(of.target_meshes.size()) {}

    [[nodiscard]] std::size_t joint() const { return model_.joints().size(); }
    [[nodiscard]] std::size_t clip() const { return model_.clips().size(); }
    [[nodiscard]] std::size_t chain() const { return model_.chains().size(); }
    [[nodiscard]] std::size_t morph_target() const { return targets_; }
    [[nodiscard]] std::size_t mesh() const { return model_.meshes().size(); }
    [[nodiscard]] std::size_t submesh() const { return model_.submeshes().size(); }
    [[nodiscard]] std::size_t joint_submesh() const { return model_.joint_submeshes().size(); }
    [[nodiscard]] std::size_t material() const { return model_.materials().size(); }
    [[nodiscard]] std::size_t texture() const { return model_.textures().size(); }
    [[nodiscard]] std::size_t constraint() const { return model_.constraints().size(); }
    [[nodiscard]] std::size_t track(std::uint32_t clip) const { return model_.clips()[clip].tracks.size(); }
    [[nodiscard]] std::size_t marker(std::uint32_t clip) const { return model_.clips()[clip].markers.size(); }
    [[nodiscard]] std::size_t curve(std::uint32_t clip) const { return model_.clips()[clip].curves.size(); }
    [[nodiscard]] std::size_t frame_sequence(std::uint32_t clip) const { return model_.clips()[clip].plays.size(); }
    [[nodiscard]] std::size_t stream(std::uint32_t mesh) const { return count_streams(model_.meshes()[mesh]); }
    [[nodiscard]] std::size_t image(std::uint32_t texture) const { return model_.textures()[texture].images.size(); }

private:
    const Model& model_;
    std::size_t targets_;
};

/// The model whose parts a call on a handle names; for a binding, the animated model.
template <class Handle>
Parts parts(const Handle& handle) {
    return Parts(*handle.character);
}
inline Parts parts(const bendy_binding& binding) {
    return Parts(*binding.animated);
}

template <class Handle>
const Character& character_of(const Handle& handle) {
    return *handle.character;
}
inline const Character& character_of(const bendy_binding& binding) {
    return *binding.posed;
}

/// Checks that two handles, if both are given, belong to one model.
template <class Handle, class Other>
bendy_status check_same_model(const Handle* handle, const Other& other, const char* name, const char* what,
                              bendy_error* error) {
    if (handle == nullptr || &character_of(*handle) == &character_of(other)) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + " is of another model than " + what);
}

/// The first of several numbers; NULL if there are none.
inline const std::uint32_t* first_of(std::span<const std::uint32_t> numbers) {
    return numbers.empty() ? nullptr : numbers.data();
}

/// Checks that a mesh has bones.
inline bendy_status check_skinned(const Mesh& mesh, std::uint32_t number, bendy_error* error) {
    if (!mesh.is_rigid()) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, "mesh " + std::to_string(number) + " is rigid: it has no bones");
}

template <class Out>
void put_json(const Json& json, Out& out) {
    out.extras = json.extras.c_str();
    out.more = json.more.c_str();
}

}  // namespace bendy::capi
