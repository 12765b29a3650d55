#include "c_layer.h"

#include "handles.h"

#include <bendy/format/names.h>
#include <bendy/format/packed_clip.h>
#include <bendy/format/record_table.h>

#include <glm/vec3.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Access to what a file stores beyond the C API: streams in their own encoding, the keys of packed clips; and the thing
// that a text refers to.
namespace bendy::python {
namespace {

const Model& model_of(const py::object& model) {
    const c::Using<bendy_model> used(model, "model", c::Null::refused, false);
    return used.get()->get();
}

template <class T>
py::array view_of(const py::object& owner, const T* data, std::vector<py::ssize_t> shape) {
    py::array array(py::dtype::of<T>(), std::move(shape), data, owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

py::array copy_of(const std::vector<float>& numbers, std::vector<py::ssize_t> shape) {
    py::array_t<float> array(std::move(shape), numbers.data());
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

py::dtype dtype_of(ComponentType type) {
    switch (type) {
        case ComponentType::u8:
            return py::dtype::of<std::uint8_t>();
        case ComponentType::i8:
            return py::dtype::of<std::int8_t>();
        case ComponentType::u16:
            return py::dtype::of<std::uint16_t>();
        case ComponentType::i16:
            return py::dtype::of<std::int16_t>();
        case ComponentType::u32:
            return py::dtype::of<std::uint32_t>();
        case ComponentType::f32:
            break;
    }
    return py::dtype::of<float>();
}

/// Returns the numbers as stored: (elements, components), without a copy.
py::object stored_array(const py::object& owner, const StreamView& stream) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(stream.data.data());
    const py::array bytes = view_of(owner, data, {static_cast<py::ssize_t>(stream.data.size())});
    return bytes.attr("view")(dtype_of(stream.type)).attr("reshape")(stream.elements, stream.components);
}

py::object stored_or_none(const py::object& owner, const std::optional<StreamView>& stream) {
    if (!stream) return py::none();
    return stored_array(owner, *stream);
}

/// Returns three floats per element: without a copy if they are stored as floats; None without a stream.
py::object vectors_or_none(const py::object& owner, const std::optional<StreamView>& stream) {
    if (!stream) return py::none();
    if (stream->type == ComponentType::f32 && stream->boxes.empty() && !stream->is_octahedral && stream->list.empty())
        return stored_array(owner, *stream);
    std::vector<float> numbers;
    numbers.reserve(3 * std::size_t{stream->elements});
    for (std::uint32_t element = 0; element < stream->elements; ++element) {
        const glm::vec3 vector = stream->vec3(element);
        numbers.insert(numbers.end(), {vector.x, vector.y, vector.z});
    }
    return copy_of(numbers, {static_cast<py::ssize_t>(stream->elements), 3});
}

py::dict stored_streams(const py::object& model, std::uint32_t number) {
    const Mesh& mesh = model_of(model).meshes()[number];
    py::dict streams;
    const auto add = [&](const std::string& name, const StreamView& stream) {
        if (!stream.empty()) streams[py::str(name)] = stored_array(model, stream);
    };
    const auto add_optional = [&](const char* name, const std::optional<StreamView>& stream) {
        if (stream) add(name, *stream);
    };
    const auto add_list = [&](const char* name, const std::vector<StreamView>& list) {
        for (std::size_t k = 0; k < list.size(); ++k) add(name + std::to_string(k), list[k]);
    };
    add("positions", mesh.positions);
    add_optional("normals", mesh.normals);
    add_optional("tangents", mesh.tangents);
    add_list("texture_coords", mesh.texture_coords);
    add_list("colours", mesh.colours);
    add_optional("bones", mesh.bones);
    add_optional("weights", mesh.weights);
    add_optional("indices", mesh.indices);
    return streams;
}

py::tuple stored_target(const py::object& model, std::uint32_t mesh, std::uint32_t number) {
    const MorphTargetView& target = model_of(model).meshes()[mesh].targets[number];
    const bool is_frame = target.is_frame();
    return py::make_tuple(is_frame, stored_or_none(model, target.vertices),
                          is_frame ? py::none() : vectors_or_none(model, target.positions),
                          is_frame ? py::none() : vectors_or_none(model, target.normals));
}

/// Returns (B, 4, 4), [row, column], without a copy: the file stores columns.
py::array inverse_bind(const py::object& model, std::uint32_t mesh) {
    const auto matrices = model_of(model).meshes()[mesh].palette.inverse_bind();
    const py::array columns = view_of(model, matrices.empty() ? nullptr : &matrices.front()[0].x,
                                      {static_cast<py::ssize_t>(matrices.size()), 4, 4});
    return columns.attr("swapaxes")(1, 2);
}

py::array palette(const py::object& model, std::uint32_t mesh) {
    const auto joints = model_of(model).meshes()[mesh].palette.joints;
    return view_of(model, joints.data(), {static_cast<py::ssize_t>(joints.size())});
}

/// Returns (path, joint, times, values) of each track of a packed clip.
py::list unpacked_tracks(const py::object& model, std::uint32_t number) {
    const Model& of = model_of(model);
    std::vector<RestRecord> rests;
    for (const Joint& joint : of.joints()) {
        const auto& [rotation, translation, scale] = joint.rest;
        rests.push_back({{rotation.x, rotation.y, rotation.z, rotation.w},
                         {translation.x, translation.y, translation.z},
                         {scale.x, scale.y, scale.z},
                         {joint.shear.x, joint.shear.y, joint.shear.z}});
    }
    py::list tracks;
    for (const UnpackedTrack& track : unpack_clip(*of.clips()[number].packed, rests)) {
        const auto keys = static_cast<py::ssize_t>(track.times.size());
        tracks.append(py::make_tuple(static_cast<std::uint32_t>(track.path), track.joint, copy_of(track.times, {keys}),
                                     copy_of(track.values, {keys, static_cast<py::ssize_t>(track.components)})));
    }
    return tracks;
}

/// Returns the number of the thing that a text refers to. Raises KeyError.
std::size_t find_key(const std::vector<std::string>& names, const std::string& wanted, const char* kind) {
    const std::vector<std::string_view> views(names.begin(), names.end());
    const auto found = find_by_key(views, wanted, kind);
    if (!found) throw py::key_error(found.error().message);
    return *found;
}

}  // namespace

void bind_stored(py::module_& module) {
    module.def("stored_streams", &stored_streams, py::arg("model"), py::arg("mesh"), "See bendy.Mesh.stored.");
    module.def("stored_target", &stored_target, py::arg("model"), py::arg("mesh"), py::arg("target"),
               "Whether a morph target is a frame, its vertices, positions and normals: see bendy.MorphTarget.");
    module.def("inverse_bind", &inverse_bind, py::arg("model"), py::arg("mesh"), "See bendy.Mesh.inverse_bind.");
    module.def("palette", &palette, py::arg("model"), py::arg("mesh"), "See bendy.Mesh.palette.");
    module.def("unpacked_tracks", &unpacked_tracks, py::arg("model"), py::arg("clip"),
               "(path, joint, times, values) of each track of a packed clip.");
    module.def("find_key", &find_key, py::arg("names"), py::arg("wanted"), py::arg("kind"),
               "The number of what a text refers to. Raises KeyError.");
}

}  // namespace bendy::python
