// The streams of a mesh: vertex attributes and the index list, as they are stored or decoded.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <string>

namespace bendy::capi {
namespace {

struct MeshStream {
    bendy_stream_kind kind = BENDY_STREAM_POSITIONS;
    const StreamView* view = nullptr;  // null: the mesh has no such stream
    std::uint32_t attribute = 0;       // its index in the mesh's list, for BENDY_STREAM_ATTRIBUTE
};

/// Calls visit(stream) for each stream of a mesh, in the order of their numbers.
template <class Visit>
void visit_streams(const Mesh& mesh, const Visit& visit) {
    const auto visit_one = [&](bendy_stream_kind kind, const std::optional<StreamView>& view) {
        if (view) visit({kind, &*view});
    };
    if (!mesh.positions.empty()) visit({BENDY_STREAM_POSITIONS, &mesh.positions});
    visit_one(BENDY_STREAM_NORMALS, mesh.normals);
    visit_one(BENDY_STREAM_TANGENTS, mesh.tangents);
    for (const StreamView& view : mesh.texture_coords) visit({BENDY_STREAM_TEXTURE_COORDS, &view});
    for (const StreamView& view : mesh.colours) visit({BENDY_STREAM_COLOURS, &view});
    for (std::uint32_t k = 0; k < mesh.attributes.size(); ++k)
        visit({BENDY_STREAM_ATTRIBUTE, &mesh.attributes[k].values, k});
    visit_one(BENDY_STREAM_BONES, mesh.bones);
    visit_one(BENDY_STREAM_WEIGHTS, mesh.weights);
    visit_one(BENDY_STREAM_INDICES, mesh.indices);
}

/// Returns the stream with that number, which must exist.
MeshStream stream_of(const bendy_model* model, std::uint32_t mesh, std::uint32_t number) {
    MeshStream found;
    visit_streams(model->get().meshes()[mesh], [&](const MeshStream& stream) {
        if (number-- == 0) found = stream;
    });
    return found;
}

/// Returns the numbers per decoded element: directions are stored with fewer numbers, or as indices into a list.
std::uint32_t decoded_components(const MeshStream& stream) {
    switch (stream.kind) {
        case BENDY_STREAM_POSITIONS:
        case BENDY_STREAM_NORMALS:
            return 3;
        case BENDY_STREAM_TANGENTS:
            return 4;
        default:
            return stream.view->components;
    }
}

/// Returns true if the stored numbers need no decoding, except for normalised integers.
bool is_plain(const StreamView& view) {
    return view.boxes.empty() && !view.is_octahedral && view.list.empty();
}

bendy_status check_integers(const StreamView& view, bendy_error* error) {
    const bool is_unsigned =
        view.type == ComponentType::u8 || view.type == ComponentType::u16 || view.type == ComponentType::u32;
    if (is_unsigned && !view.normalised && is_plain(view)) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, "the stream has no unsigned integers: get its numbers");
}

void copy_numbers(const MeshStream& stream, float* numbers) {
    const StreamView& view = *stream.view;
    const std::uint32_t components = decoded_components(stream);
    const bool is_vector = stream.kind <= BENDY_STREAM_TANGENTS;
    for (std::uint32_t element = 0; element < view.elements; ++element) {
        const glm::vec4 vector = !is_vector        ? glm::vec4(0.0f)
                                 : components == 4 ? view.vec4(element)
                                                   : glm::vec4(view.vec3(element), 0.0f);
        for (std::uint32_t c = 0; c < components; ++c)
            *numbers++ = is_vector ? vector[static_cast<int>(c)] : view.number(element, c);
    }
}

std::uint64_t number_count(const MeshStream& stream) {
    return std::uint64_t{stream.view->elements} * decoded_components(stream);
}

}  // namespace

std::uint32_t count_streams(const Mesh& mesh) {
    std::uint32_t count = 0;
    visit_streams(mesh, [&](const MeshStream&) { ++count; });
    return count;
}

}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::find_stream(const bendy_model* model, uint32_t mesh, uint32_t kind, uint32_t set,
                                      uint32_t& made, bendy_error* error) {
    std::uint32_t number = 0;
    visit_streams(model->get().meshes()[mesh], [&](const MeshStream& stream) {
        if (made == BENDY_NONE && stream.kind == kind && stream.view->set == set) made = number;
        ++number;
    });
    if (made != BENDY_NONE) return BENDY_OK;
    return fail(error, BENDY_NOT_FOUND,
                "mesh " + std::to_string(mesh) + " has no such stream of set " + std::to_string(set));
}

bendy_status bendy::capi::get_stream(const bendy_model* model, uint32_t mesh, uint32_t stream, bendy_stream& out,
                                     bendy_error* /*error*/) {
    const MeshStream found = stream_of(model, mesh, stream);
    const bendy::StreamView& view = *found.view;
    to_c(view, out);
    out.kind = found.kind;
    out.name =
        found.kind == BENDY_STREAM_ATTRIBUTE ? model->character->names.attributes[mesh][found.attribute].c_str() : "";
    out.components = decoded_components(found);
    if (is_plain(view)) {
        out.data = view.data.data();
        out.data_size = view.data.size();
    }
    return BENDY_OK;
}

bendy_status bendy::capi::get_numbers(const bendy_model* model, uint32_t mesh, uint32_t stream, float* numbers,
                                      size_t count, bendy_error* error) {
    const MeshStream found = stream_of(model, mesh, stream);
    if (const bendy_status status = check_room(count, number_count(found), "numbers", error)) return status;
    copy_numbers(found, numbers);
    return BENDY_OK;
}

bendy_status bendy::capi::get_integers(const bendy_model* model, uint32_t mesh, uint32_t stream, uint32_t* integers,
                                       size_t count, bendy_error* error) {
    const MeshStream found = stream_of(model, mesh, stream);
    if (const bendy_status status = check_integers(*found.view, error)) return status;
    if (const bendy_status status = check_room(count, number_count(found), "integers", error)) return status;
    for (std::uint32_t element = 0; element < found.view->elements; ++element) {
        for (std::uint32_t c = 0; c < found.view->components; ++c) *integers++ = found.view->index(element, c);
    }
    return BENDY_OK;
}
