#include "bindings.h"

#include <bendy/format/names.h>
#include <bendy/format/packed_clip.h>
#include <bendy/format/record_table.h>
#include <bendy/runtime/blend.h>
#include <bendy/runtime/curve.h>
#include <bendy/runtime/lod.h>

#include <array>
#include <map>
#include <span>
#include <utility>

// Model and what it consists of: joints, meshes, clips, chains, constraints, materials, textures.
namespace bendy::python {
namespace {

/// The name of an enumeration's value, as records.def lists it.
template <class Value>
py::str name_of(std::string_view record, std::string_view field, Value value) {
    return text(find_layout(record)->find(field)->value_name(static_cast<std::uint64_t>(value)));
}

template <std::size_t N>
py::tuple tuple_of(const std::array<float, N>& numbers) {
    py::tuple tuple(N);
    for (std::size_t k = 0; k < N; ++k) tuple[k] = numbers[k];
    return tuple;
}

py::array fresh(std::vector<py::ssize_t> shape, const float* numbers) {
    py::array_t<float> array(std::move(shape), numbers);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

// A thing of a model: the model's data, and its number.
struct Thing {
    SharedCharacter character;
    std::uint32_t number = 0;

    [[nodiscard]] const Model& model() const { return character->model; }
};
struct PyJoint : Thing {
    [[nodiscard]] const Joint& get() const { return model().joints()[number]; }
};
struct PyChain : Thing {
    [[nodiscard]] const Chain& get() const { return model().chains()[number]; }
};
struct PyConstraint : Thing {
    [[nodiscard]] const Constraint& get() const { return model().constraints()[number]; }
};
struct PyMaterial : Thing {
    [[nodiscard]] const Material& get() const { return model().materials()[number]; }
};
struct PyTexture : Thing {
    [[nodiscard]] const Texture& get() const { return model().textures()[number]; }
};
struct PySubmesh : Thing {
    [[nodiscard]] const Submesh& get() const { return model().submeshes()[number]; }
};
struct PyClip : Thing {
    [[nodiscard]] const Clip& get() const { return model().clips()[number]; }
    py::object tracks;  // made at the first use
};
struct PyMesh : Thing {
    [[nodiscard]] const Mesh& get() const { return model().meshes()[number]; }
    std::map<std::string, py::object> arrays;  // made at the first use
};
struct PyMorphTarget : Thing {
    std::uint32_t mesh = 0;
    [[nodiscard]] const MorphTargetView& get() const { return model().meshes()[mesh].targets[number]; }
};
struct PyCurve : Thing {
    std::uint32_t clip = 0;
    [[nodiscard]] const Curve& get() const { return model().clips()[clip].curves[number]; }
};
struct PyTrack {
    py::str path;
    std::uint32_t target = 0;
    py::str interpolation;
    py::object times, values;
};
struct PyMarker {
    float seconds = 0.0f;
    py::str name;
};

/// A list of things that are found by name or by number.
struct Items {
    std::string kind;  ///< of one, for messages: "clip"
    py::tuple list;
    std::vector<std::string> names;  ///< as in the file
};

/// \param name  gives the name of one
template <class Item, class Make, class Name>
Items make_items(const char* kind, std::size_t count, const Make& make, const Name& name) {
    Items items{kind, py::tuple(count), {}};
    for (std::size_t k = 0; k < count; ++k) {
        Item item = make(static_cast<std::uint32_t>(k));
        items.names.emplace_back(name(item));
        items.list[k] = py::cast(std::move(item));
    }
    return items;
}

template <class Item>
Items things(const char* kind, const SharedCharacter& character, std::size_t count) {
    const auto make = [&](std::uint32_t number) {
        Item item;
        item.character = character;
        item.number = number;
        return item;
    };
    return make_items<Item>(kind, count, make, [](const Item& item) { return item.get().name; });
}

[[noreturn]] void raise_no_such(const char* kind, std::string_view wanted, std::span<const std::string_view> names) {
    throw py::key_error(no_such_name(kind, wanted, names));
}

/// The place of the first name that is `wanted`, or kNone.
template <class Names>
std::uint32_t find_name(const Names& names, std::string_view wanted) {
    for (std::size_t k = 0; k < names.size(); ++k) {
        if (names[k] == wanted) return static_cast<std::uint32_t>(k);
    }
    return kNone;
}

py::object get_item(const Items& items, const py::object& key) {
    if (py::isinstance<py::slice>(key)) return items.list.attr("__getitem__")(key);
    if (!py::isinstance<py::str>(key)) return items.list[index_of(key, items.names.size(), items.kind.c_str())];
    const auto wanted = key.cast<std::string>();
    const std::uint32_t place = find_name(items.names, wanted);
    if (place != kNone) return items.list[place];
    const std::vector<std::string_view> names(items.names.begin(), items.names.end());
    raise_no_such(items.kind.c_str(), wanted, names);
}

bool has_item(const Items& items, const py::object& key) {
    if (py::isinstance<py::str>(key)) return find_name(items.names, key.cast<std::string>()) != kNone;
    for (const auto& one : items.list) {
        if (one.is(key)) return true;
    }
    return false;
}

/// A model, until it is closed. Lists are made at the first use.
struct PyModel {
    SharedCharacter character;
    std::map<std::string, py::object> lists;

    [[nodiscard]] const SharedCharacter& get() const {
        if (character == nullptr) throw py::value_error("the model is closed");
        return character;
    }
    [[nodiscard]] const Model& model() const { return get()->model; }
    template <class Make>
    py::object list(const char* name, const Make& make) {
        const SharedCharacter shared = get();
        py::object& list = lists[name];
        if (!list) list = make(shared);
        return list;
    }
};

PyModel open_model(const std::shared_ptr<Source>& source, std::uint32_t object, bool check_sums) {
    const OpenOptions options{object, check_sums ? Sums::checked : Sums::later};
    auto model = [&] {
        const py::gil_scoped_release released;
        return Model::from_memory(source->bytes(), options);
    }();
    if (!model) raise_fault(model.error(), *source);
    return {std::make_shared<const Character>(Character{source, *std::move(model)}), {}};
}

// Streams of a mesh.

enum class Meaning : std::uint8_t { vec3, vec4, numbers };

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

/// The numbers as they are stored: (elements, components), without a copy.
py::array stored_array(const SharedCharacter& character, const StreamView& stream) {
    const py::array bytes = view(character, reinterpret_cast<const std::uint8_t*>(stream.data.data()),
                                 {static_cast<py::ssize_t>(stream.data.size())});
    return bytes.attr("view")(dtype_of(stream.type)).attr("reshape")(stream.elements, stream.components);
}

bool is_plain_floats(const StreamView& stream) {
    return stream.type == ComponentType::f32 && stream.boxes.empty() && !stream.is_octahedral && stream.list.empty();
}

template <class Vector>
py::array decoded_vectors(const StreamView& stream) {
    std::vector<Vector> vectors(stream.elements);
    stream.decode(std::span<Vector>(vectors));
    return fresh({static_cast<py::ssize_t>(stream.elements), static_cast<py::ssize_t>(sizeof(Vector) / sizeof(float))},
                 vectors.empty() ? nullptr : &vectors.front().x);
}

/// The numbers as floats: without a copy if they are stored as such.
py::array float_array(const SharedCharacter& character, const StreamView& stream, Meaning meaning) {
    if (is_plain_floats(stream)) return stored_array(character, stream);
    if (meaning == Meaning::vec3) return decoded_vectors<glm::vec3>(stream);
    if (meaning == Meaning::vec4) return decoded_vectors<glm::vec4>(stream);
    std::vector<float> numbers;
    numbers.reserve(std::size_t{stream.elements} * stream.components);
    for (std::uint32_t element = 0; element < stream.elements; ++element) {
        for (std::uint32_t c = 0; c < stream.components; ++c) numbers.push_back(stream.number(element, c));
    }
    return fresh({static_cast<py::ssize_t>(stream.elements), static_cast<py::ssize_t>(stream.components)},
                 numbers.data());
}

template <class Make>
py::object mesh_array(PyMesh& mesh, const char* name, const Make& make) {
    py::object& array = mesh.arrays[name];
    if (!array) array = make(mesh.get());
    return array;
}

py::object optional_array(PyMesh& mesh, const char* name, const std::optional<StreamView>& stream, Meaning meaning) {
    if (!stream) return py::none();
    return mesh_array(mesh, name, [&](const Mesh&) { return float_array(mesh.character, *stream, meaning); });
}

py::object list_of(PyMesh& mesh, const char* name, const std::vector<StreamView>& streams) {
    return mesh_array(mesh, name, [&](const Mesh&) {
        py::tuple list(streams.size());
        for (std::size_t k = 0; k < streams.size(); ++k)
            list[k] = float_array(mesh.character, streams[k], Meaning::numbers);
        return list;
    });
}

/// What is stored, by stream.
py::dict stored_streams(const PyMesh& mesh) {
    const Mesh& view = mesh.get();
    py::dict streams;
    const auto add = [&](const std::string& name, const StreamView& stream) {
        if (!stream.empty()) streams[py::str(name)] = stored_array(mesh.character, stream);
    };
    const auto add_optional = [&](const char* name, const std::optional<StreamView>& stream) {
        if (stream) add(name, *stream);
    };
    add("positions", view.positions);
    add_optional("normals", view.normals);
    add_optional("tangents", view.tangents);
    for (std::size_t k = 0; k < view.texture_coords.size(); ++k)
        add("texture_coords" + std::to_string(k), view.texture_coords[k]);
    for (std::size_t k = 0; k < view.colours.size(); ++k) add("colours" + std::to_string(k), view.colours[k]);
    add_optional("bones", view.bones);
    add_optional("weights", view.weights);
    add_optional("indices", view.indices);
    return streams;
}

/// Matrices as [row, column], without a copy: the file has them column by column.
py::array inverse_bind_of(const PyMesh& mesh) {
    const auto matrices = mesh.get().palette.inverse_bind();
    constexpr py::ssize_t kMatrix = sizeof(glm::mat4);
    constexpr py::ssize_t kColumn = sizeof(glm::vec4);
    constexpr py::ssize_t kFloat = sizeof(float);
    return view(mesh.character, matrices.empty() ? nullptr : &matrices.front()[0].x,
                {static_cast<py::ssize_t>(matrices.size()), 4, 4}, {kMatrix, kFloat, kColumn});
}

py::array triangles_of(const PyMesh& mesh, float share) {
    if (!(share >= 0.0f)) throw py::value_error("share must be 0 to 1");
    Lod lod(mesh.model());
    lod.set_share(share);
    std::vector<std::uint32_t> corners;
    const auto indices = lod.indices(mesh.number);
    for (const Submesh& submesh : lod.submeshes()) {
        if (submesh.mesh != mesh.number || submesh.topology != Topology::triangles) continue;
        const auto part = indices.subspan(submesh.first, submesh.count);
        corners.insert(corners.end(), part.begin(), part.end());
    }
    return py::array_t<std::uint32_t>({static_cast<py::ssize_t>(corners.size() / 3), py::ssize_t{3}}, corners.data());
}

// Clips.

py::array times_of(const SharedCharacter& character, const Clip& clip, const TrackView& track) {
    const auto keys = static_cast<py::ssize_t>(track.keys);
    if (!track.times.empty()) return view(character, track.times.data(), {keys});
    std::vector<float> times(track.keys);
    for (std::uint32_t k = 0; k < track.keys; ++k) times[k] = clip.start + static_cast<float>(k) / clip.frame_rate;
    return fresh({keys}, times.data());
}

std::vector<py::ssize_t> shape_of_values(std::uint32_t keys, std::uint32_t components, Interpolation interpolation) {
    if (interpolation == Interpolation::cubic) return {keys, 3, components};
    return {keys, components};
}

PyTrack make_track(const SharedCharacter& character, const Clip& clip, const TrackView& track) {
    return {name_of("TrackRecord", "path", track.path), track.target,
            name_of("TrackRecord", "interpolation", track.interpolation), times_of(character, clip, track),
            view(character, track.values.data(), shape_of_values(track.keys, track.components, track.interpolation))};
}

RestRecord rest_record(const Joint& joint) {
    const auto& [rotation, translation, scale] = joint.rest;
    return {{rotation.x, rotation.y, rotation.z, rotation.w},
            {translation.x, translation.y, translation.z},
            {scale.x, scale.y, scale.z},
            {joint.shear.x, joint.shear.y, joint.shear.z}};
}

py::object tracks_of(PyClip& self) {
    if (self.tracks) return self.tracks;
    const Clip& clip = self.get();
    py::list tracks;
    for (const TrackView& track : clip.tracks) tracks.append(py::cast(make_track(self.character, clip, track)));
    if (clip.packed) {
        std::vector<RestRecord> rests;
        for (const Joint& joint : self.model().joints()) rests.push_back(rest_record(joint));
        for (const UnpackedTrack& track : unpack_clip(*clip.packed, rests)) {
            const auto keys = static_cast<py::ssize_t>(track.times.size());
            tracks.append(py::cast(PyTrack{name_of("TrackRecord", "path", track.path), track.joint,
                                           name_of("TrackRecord", "interpolation", Interpolation::linear),
                                           fresh({keys}, track.times.data()),
                                           fresh({keys, track.components}, track.values.data())}));
        }
    }
    self.tracks = py::tuple(tracks);
    return self.tracks;
}

py::tuple markers_of(const PyClip& self) {
    const auto& markers = self.get().markers;
    py::tuple list(markers.size());
    for (std::size_t k = 0; k < markers.size(); ++k)
        list[k] = py::cast(PyMarker{markers[k].seconds, text(markers[k].name)});
    return list;
}

py::object curve_values(const PyCurve& self) {
    const Curve& curve = self.get();
    const auto shape = shape_of_values(curve.keys, curve.components, curve.interpolation);
    if (!curve.is_packed()) return view(self.character, curve.values.data(), shape);
    std::vector<float> values(curve.value_count());
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = curve.value(k);
    return fresh(shape, values.data());
}

py::array sample_one(const PyCurve& self, double seconds) {
    std::array<float, 4> value{};
    if (const auto sampled = sample_curve(self.get(), seconds, value); !sampled) raise_call(sampled.error());
    return py::array_t<float>(static_cast<py::ssize_t>(self.get().components), value.data());
}

// Chains.

py::tuple links_of(const PyChain& self) {
    const Chain& chain = self.get();
    py::tuple links(chain.links);
    std::uint32_t joint = chain.effector;
    for (std::size_t k = chain.links; k-- > 0; joint = self.model().joints()[joint].parent) links[k] = joint;
    return links;
}

py::dict chain_weights_of(const PyChain& self) {
    py::dict weights;
    for (const ChainWeightView& weight : self.model().chain_weights(self.get()))
        weights[py::int_(weight.joint)] = weight.weight;
    return weights;
}

// Materials and textures.

py::object texture_of(const TextureUseRecord& use) {
    return number_or_none(use.texture);
}

py::list images_of(const PyTexture& self) {
    py::list images;
    for (const ImageView& image : self.get().images) {
        py::dict one;
        one["type"] = name_of("ImageRecord", "media", image.media);
        one["uri"] = text_or_none(image.uri);
        one["same_as"] = image.same ? number_or_none(image.same->texture) : py::object(py::none());
        one["bytes"] = image.bytes.empty()
                           ? py::object(py::none())
                           : view(self.character, reinterpret_cast<const std::uint8_t*>(image.bytes.data()),
                                  {static_cast<py::ssize_t>(image.bytes.size())});
        images.append(one);
    }
    return images;
}

template <class Thing>
py::str repr_of(const char* kind, const Thing& thing) {
    return py::str("<bendy.{} {} {!r}>").format(kind, thing.number, text(thing.get().name));
}

void bind_items(py::module_& module) {
    py::class_<Items>(
        module, "Items",
        "A list of things that are found by number or by name: clips[0], clips[\"Walk\"]. Names need not be "
        "unique; the first one counts.")
        .def("__len__", [](const Items& self) { return self.names.size(); })
        .def("__iter__", [](const Items& self) { return py::iter(self.list); })
        .def("__getitem__", &get_item, py::arg("key"),
             "One by its number (-1 is the last) or its name; a slice gives a tuple. Raises IndexError, or KeyError "
             "with "
             "the names that there are.")
        .def("__contains__", &has_item, py::arg("key"), "Whether there is one with that name, or that object.")
        .def_property_readonly(
            "names",
            [](const Items& self) {
                py::list names;
                for (const std::string& name : self.names) names.append(text(name));
                return names;
            },
            "The names in order; they may be empty.")
        .def("__repr__", [](const Items& self) { return py::repr(self.list); });
}

void bind_joints(py::module_& module) {
    py::class_<PyJoint>(module, "Joint", "A joint of a model. Parents come before their children.")
        .def_property_readonly(
            "name", [](const PyJoint& self) { return text(self.get().name); }, "May be empty.")
        .def_readonly("number", &PyJoint::number, "Index among the joints of the model.")
        .def_property_readonly(
            "parent", [](const PyJoint& self) { return number_or_none(self.get().parent); },
            "The parent's number, smaller than the joint's own; None for a root.")
        .def_property_readonly(
            "rotation", [](const PyJoint& self) { return tuple_of(rest_record(self.get()).rotation); },
            "At rest, relative to the parent: a unit quaternion x, y, z, w.")
        .def_property_readonly(
            "translation", [](const PyJoint& self) { return tuple_of(rest_record(self.get()).translation); },
            "At rest, relative to the parent: x, y, z in metres.")
        .def_property_readonly(
            "scale", [](const PyJoint& self) { return tuple_of(rest_record(self.get()).scale); },
            "At rest, along the joint's axes: x, y, z.")
        .def_property_readonly(
            "shear", [](const PyJoint& self) { return tuple_of(rest_record(self.get()).shear); },
            "xy, xz, yz: part of the local matrix that clips do not animate.")
        .def_property_readonly(
            "extras", [](const PyJoint& self) { return parse_json(self.get().extras); },
            "The author's own data, parsed; None without. Raises ValueError if it is not JSON.")
        .def("__index__", [](const PyJoint& self) { return self.number; })
        .def("__repr__", [](const PyJoint& self) { return repr_of("Joint", self); });

    const auto record = [](const PyConstraint& self) -> const ConstraintRecord& { return self.get().record; };
    py::class_<PyConstraint>(
        module, "Constraint",
        "What a joint may do, relative to its rest pose, in the constraint's frame: X is the twist "
        "axis, Y and Z are the swing axes.")
        .def_property_readonly(
            "joint", [](const PyConstraint& self) { return self.get().joint; }, "The joint's number.")
        .def_property_readonly(
            "model", [=](const PyConstraint& self) { return name_of("ConstraintRecord", "model", record(self).model); },
            "free, locked, hinge, swing_twist_ellipse, swing_twist_pyramid, euler_box or largest_angle.")
        .def_property_readonly(
            "euler_order",
            [=](const PyConstraint& self) {
                return name_of("ConstraintRecord", "euler_order", record(self).euler_order);
            },
            "Of an euler_box: xyz, xzy, ...")
        .def_property_readonly(
            "scope", [=](const PyConstraint& self) { return name_of("ConstraintRecord", "scope", record(self).scope); },
            "every_pose, ik_only or all_but_ik.")
        .def_property_readonly(
            "frame", [=](const PyConstraint& self) { return tuple_of(record(self).frame); },
            "A unit quaternion x, y, z, w, relative to the joint at rest.")
        .def_property_readonly(
            "rotation_min", [=](const PyConstraint& self) { return tuple_of(record(self).rotation_min); },
            "About X, Y, Z in radians; -inf where free.")
        .def_property_readonly(
            "rotation_max", [=](const PyConstraint& self) { return tuple_of(record(self).rotation_max); },
            "About X, Y, Z in radians; inf where free.")
        .def_property_readonly(
            "translation_min", [=](const PyConstraint& self) { return tuple_of(record(self).translation_min); },
            "Along X, Y, Z in metres; -inf where free.")
        .def_property_readonly(
            "translation_max", [=](const PyConstraint& self) { return tuple_of(record(self).translation_max); },
            "Along X, Y, Z in metres; inf where free.")
        .def_property_readonly(
            "stiffness", [=](const PyConstraint& self) { return tuple_of(record(self).stiffness); },
            "In IK, about X, Y, Z: 0 to 1.")
        .def_property_readonly(
            "is_proposed", [=](const PyConstraint& self) { return (record(self).flags & kProposed) != 0; },
            "Whether it was guessed from the joints' names, not authored.")
        .def("__repr__", [=](const PyConstraint& self) {
            return py::str("<bendy.Constraint of joint {}: {}>")
                .format(self.get().joint, name_of("ConstraintRecord", "model", record(self).model));
        });

    py::class_<PyChain>(module, "Chain", "An IK chain: the joints on the path from its start to its effector.")
        .def_property_readonly(
            "name", [](const PyChain& self) { return text(self.get().name); }, "May be empty.")
        .def_readonly("number", &PyChain::number, "Index among the chains of the model.")
        .def_property_readonly(
            "start", [](const PyChain& self) { return self.get().start; }, "Number of the first joint.")
        .def_property_readonly(
            "effector", [](const PyChain& self) { return self.get().effector; }, "Number of the last joint.")
        .def_property_readonly("links", &links_of, "Numbers of the joints from start to effector.")
        .def_property_readonly(
            "target", [](const PyChain& self) { return number_or_none(self.get().target); },
            "Number of the joint that it reaches for, or None.")
        .def_property_readonly(
            "pole", [](const PyChain& self) { return number_or_none(self.get().pole); },
            "Number of the joint that it bends towards, or None.")
        .def_property_readonly(
            "solver", [](const PyChain& self) { return name_of("ChainRecord", "solver", self.get().solver); },
            "any, pull, two_bone, ccd, fabrik, aim or least_squares.")
        .def_property_readonly(
            "priority", [](const PyChain& self) { return self.get().record.priority; }, "Solved in ascending order.")
        .def_property_readonly(
            "influence", [](const PyChain& self) { return self.get().record.influence; }, "0 to 1.")
        .def_property_readonly(
            "tip_offset", [](const PyChain& self) { return tuple_of(self.get().record.tip_offset); },
            "The tip in the effector's space, metres.")
        .def_property_readonly("weights", &chain_weights_of, "Weight by joint; joints that are not in it have 1.")
        .def_property_readonly(
            "extras", [](const PyChain& self) { return parse_json(self.get().extras); },
            "The author's own data, parsed; None without. Raises ValueError if it is not JSON.")
        .def("__repr__", [](const PyChain& self) { return repr_of("Chain", self); });
}

void bind_meshes(py::module_& module) {
    py::class_<PyMorphTarget>(module, "MorphTarget", "Displacements of a mesh's vertices, or a frame of it.")
        .def_property_readonly(
            "name", [](const PyMorphTarget& self) { return text(self.get().name); }, "May be empty.")
        .def_readonly("number", &PyMorphTarget::number, "Index among the morph targets of the mesh.")
        .def_property_readonly(
            "rest_weight", [](const PyMorphTarget& self) { return self.get().rest_weight; }, "Usually 0 to 1.")
        .def_property_readonly(
            "is_frame", [](const PyMorphTarget& self) { return self.get().is_frame(); },
            "Whether it is a whole shape, as of Quake II models; positions and normals are then None.")
        .def_property_readonly(
            "vertices",
            [](const PyMorphTarget& self) -> py::object {
                if (!self.get().vertices) return py::none();
                return stored_array(self.character, *self.get().vertices).attr("reshape")(-1);
            },
            "(K,) unsigned: the vertices that it moves, ascending, without a copy; None: all of them, in order.")
        .def_property_readonly(
            "positions",
            [](const PyMorphTarget& self) -> py::object {
                if (self.get().is_frame() || !self.get().positions) return py::none();
                return float_array(self.character, *self.get().positions, Meaning::vec3);
            },
            "(K, 3) float32, metres: displacements at weight 1, without a copy if stored as floats; None without.")
        .def_property_readonly(
            "normals",
            [](const PyMorphTarget& self) -> py::object {
                if (self.get().is_frame() || !self.get().normals) return py::none();
                return float_array(self.character, *self.get().normals, Meaning::vec3);
            },
            "(K, 3) float32: displacements of normals; None without.")
        .def("__repr__", [](const PyMorphTarget& self) { return repr_of("MorphTarget", self); });

    py::class_<PyMesh>(
        module, "Mesh",
        "A mesh with N vertices. Arrays are read-only and keep the file open. They are views of the file, "
        "without a copy, if it stores floats, as exact files do; compact files are decoded at the first "
        "access. `stored` has all streams as they are, never copied.")
        .def_property_readonly(
            "name", [](const PyMesh& self) { return text(self.get().name); }, "May be empty.")
        .def_readonly("number", &PyMesh::number, "Index among the meshes of the model.")
        .def_property_readonly(
            "vertices", [](const PyMesh& self) { return self.get().vertices; }, "How many: N.")
        .def_property_readonly(
            "first_vertex", [](const PyMesh& self) { return self.model().first_vertex(self.number); },
            "Index of its first vertex in the arrays of Pose.skin().")
        .def_property_readonly(
            "first_morph_target", [](const PyMesh& self) { return self.model().first_morph_target(self.number); },
            "Index of its first morph target in Pose.morph_weights.")
        .def_property_readonly(
            "joint", [](const PyMesh& self) { return number_or_none(self.get().joint); },
            "Number of the joint that carries it, or None.")
        .def_property_readonly(
            "is_rigid", [](const PyMesh& self) { return self.get().is_rigid(); },
            "Whether it has no bones and weights.")
        .def_property_readonly(
            "positions",
            [](PyMesh& self) {
                return mesh_array(self, "positions", [&](const Mesh& mesh) -> py::object {
                    if (mesh.positions.empty()) return fresh({0, 3}, nullptr);
                    return float_array(self.character, mesh.positions, Meaning::vec3);
                });
            },
            "(N, 3) float32, metres, in mesh space.")
        .def_property_readonly(
            "normals", [](PyMesh& self) { return optional_array(self, "normals", self.get().normals, Meaning::vec3); },
            "(N, 3) float32, unit; None without.")
        .def_property_readonly(
            "tangents",
            [](PyMesh& self) { return optional_array(self, "tangents", self.get().tangents, Meaning::vec4); },
            "(N, 4) float32: unit x, y, z and the handedness, +1 or -1; None without.")
        .def_property_readonly(
            "texture_coords", [](PyMesh& self) { return list_of(self, "texture_coords", self.get().texture_coords); },
            "One (N, 2) float32 array for each set.")
        .def_property_readonly(
            "colours", [](PyMesh& self) { return list_of(self, "colours", self.get().colours); },
            "One (N, 3) or (N, 4) float32 array for each set, 0 to 1, linear.")
        .def_property_readonly(
            "attributes",
            [](const PyMesh& self) {
                py::dict attributes;
                for (const AttributeView& attribute : self.get().attributes)
                    attributes[text(attribute.name)] = float_array(self.character, attribute.values, Meaning::numbers);
                return attributes;
            },
            "The author's own attributes by name: (N, components) float32.")
        .def_property_readonly(
            "bones",
            [](const PyMesh& self) -> py::object {
                if (!self.get().bones) return py::none();
                return stored_array(self.character, *self.get().bones);
            },
            "(N, influences) unsigned: indices into `palette`, never copied; None for a rigid mesh.")
        .def_property_readonly(
            "weights",
            [](PyMesh& self) { return optional_array(self, "weights", self.get().weights, Meaning::numbers); },
            "(N, influences) float32, 0 to 1; None for a rigid mesh.")
        .def_property_readonly(
            "palette",
            [](const PyMesh& self) {
                const auto joints = self.get().palette.joints;
                return view(self.character, joints.data(), {static_cast<py::ssize_t>(joints.size())});
            },
            "(B,) uint32: numbers of the joints that bones refer to.")
        .def_property_readonly("inverse_bind", &inverse_bind_of,
                               "(B, 4, 4) float32, [row, column]: mesh space to joint space at bind time.")
        .def_property_readonly(
            "indices",
            [](const PyMesh& self) -> py::object {
                if (!self.get().indices) return py::none();
                return stored_array(self.character, *self.get().indices).attr("reshape")(-1);
            },
            "(M,) uint16 or uint32: the index list that submeshes are ranges of; None without.")
        .def("triangles", &triangles_of, py::arg("share") = 1.0f,
             "(T, 3) uint32, fresh: the mesh's triangles, of all submeshes. `share`, 0 to 1, is the level of detail: "
             "that "
             "share of the model's triangles, if the file has a collapse sequence. Raises ValueError.")
        .def_property_readonly(
            "morph_targets",
            [](PyMesh& self) {
                return mesh_array(self, "morph_targets", [&](const Mesh& mesh) {
                    return py::cast(make_items<PyMorphTarget>(
                        "morph target", mesh.targets.size(),
                        [&](std::uint32_t k) {
                            PyMorphTarget target;
                            target.character = self.character;
                            target.number = k;
                            target.mesh = self.number;
                            return target;
                        },
                        [](const PyMorphTarget& target) { return target.get().name; }));
                });
            },
            "Items of MorphTarget.")
        .def_property_readonly(
            "stored", &stored_streams,
            "All streams by name as they are stored, never copied: (elements, components) of the file's "
            "own type.")
        .def_property_readonly(
            "extras", [](const PyMesh& self) { return parse_json(self.get().extras); },
            "The author's own data, parsed; None without. Raises ValueError if it is not JSON.")
        .def("__repr__", [](const PyMesh& self) { return repr_of("Mesh", self); });

    py::class_<PySubmesh>(module, "Submesh", "One draw call: a range of a mesh's index list with one material.")
        .def_property_readonly(
            "mesh", [](const PySubmesh& self) { return self.get().mesh; }, "The mesh's number.")
        .def_property_readonly(
            "material", [](const PySubmesh& self) { return number_or_none(self.get().material); },
            "The material's number, or None.")
        .def_property_readonly(
            "topology", [](const PySubmesh& self) { return name_of("SubmeshRecord", "topology", self.get().topology); },
            "triangles, lines or points.")
        .def_property_readonly(
            "first", [](const PySubmesh& self) { return self.get().first; }, "Index of its first index.")
        .def_property_readonly(
            "count", [](const PySubmesh& self) { return self.get().count; }, "Number of indices.");

    const auto surface = [](const PyMaterial& self) -> const SurfaceRecord& { return self.get().surface; };
    py::class_<PyMaterial>(module, "Material", "A metallic-roughness material; colours are linear.")
        .def_property_readonly(
            "name", [](const PyMaterial& self) { return text(self.get().name); }, "May be empty.")
        .def_readonly("number", &PyMaterial::number, "Index among the materials of the model.")
        .def_property_readonly(
            "base_colour", [=](const PyMaterial& self) { return tuple_of(surface(self).base_colour); },
            "Red, green, blue, alpha: 0 to 1.")
        .def_property_readonly(
            "emissive", [=](const PyMaterial& self) { return tuple_of(surface(self).emissive); }, "Red, green, blue.")
        .def_property_readonly(
            "metallic", [=](const PyMaterial& self) { return surface(self).metallic; }, "0 to 1.")
        .def_property_readonly(
            "roughness", [=](const PyMaterial& self) { return surface(self).roughness; }, "0 to 1.")
        .def_property_readonly(
            "alpha_mode",
            [=](const PyMaterial& self) { return name_of("SurfaceRecord", "alpha_mode", surface(self).alpha_mode); },
            "opaque, mask or blend.")
        .def_property_readonly(
            "double_sided", [=](const PyMaterial& self) { return surface(self).double_sided != 0; },
            "Whether back faces are drawn.")
        .def_property_readonly(
            "base_colour_texture",
            [=](const PyMaterial& self) { return texture_of(surface(self).base_colour_texture); },
            "The texture's number, or None.")
        .def_property_readonly(
            "normal_texture", [=](const PyMaterial& self) { return texture_of(surface(self).normal_texture); },
            "The texture's number, or None.")
        .def_property_readonly(
            "extras", [](const PyMaterial& self) { return parse_json(self.get().extras); },
            "The author's own data, parsed; None without. Raises ValueError if it is not JSON.")
        .def("__repr__", [](const PyMaterial& self) { return repr_of("Material", self); });

    py::class_<PyTexture>(module, "Texture", "One or more encodings of an image.")
        .def_property_readonly(
            "name", [](const PyTexture& self) { return text(self.get().name); }, "May be empty.")
        .def_readonly("number", &PyTexture::number, "Index among the textures of the model.")
        .def_property_readonly(
            "images", &images_of,
            "In order of preference: a dict with type (png, jpeg, ktx2, webp, avif, other), bytes ((size,) uint8 "
            "without a "
            "copy, or None), uri (or None), same_as (the number of the texture whose image it is, or None).")
        .def("__repr__", [](const PyTexture& self) { return repr_of("Texture", self); });
}

void bind_clips(py::module_& module) {
    py::class_<PyMarker>(module, "Marker", "A named time of a clip: a footstep, a hit.")
        .def_readonly("seconds", &PyMarker::seconds, "On the clip's time line.")
        .def_readonly("name", &PyMarker::name, "May be empty.")
        .def("__repr__", [](const PyMarker& self) {
            return py::str("<bendy.Marker {!r} at {} s>").format(self.name, self.seconds);
        });

    py::class_<PyTrack>(module, "Track", "Keys of one animated property.")
        .def_readonly("path", &PyTrack::path, "translation, rotation, scale or weights.")
        .def_readonly("target", &PyTrack::target, "Number of the joint; for weights, of the mesh.")
        .def_readonly("interpolation", &PyTrack::interpolation, "step, linear or cubic.")
        .def_readonly("times", &PyTrack::times, "(K,) float32, seconds, ascending.")
        .def_readonly("values", &PyTrack::values,
                      "(K, components) float32: metres, unit quaternions x, y, z, w, factors or weights. For cubic "
                      "(K, 3, components): in-tangent, value, out-tangent.")
        .def("__repr__", [](const PyTrack& self) {
            return py::str("<bendy.Track {} of {}, {} keys>").format(self.path, self.target, py::len(self.times));
        });

    py::class_<PyCurve>(module, "Curve", "A named curve: animated numbers other than joints and morph targets.")
        .def_property_readonly(
            "name", [](const PyCurve& self) { return text(self.get().name); }, "May be empty.")
        .def_readonly("number", &PyCurve::number, "Index among the curves of the clip.")
        .def_property_readonly(
            "path", [](const PyCurve& self) { return text(self.get().path); },
            "Of the property, relative to the target; may be empty.")
        .def_property_readonly(
            "kind", [](const PyCurve& self) { return name_of("CurveRecord", "kind", self.get().kind); },
            "Of the target: nothing, joint, material, mesh or texture.")
        .def_property_readonly(
            "target", [](const PyCurve& self) { return number_or_none(self.get().target); }, "Its number, or None.")
        .def_property_readonly(
            "interpolation",
            [](const PyCurve& self) { return name_of("CurveRecord", "interpolation", self.get().interpolation); },
            "step, linear or cubic.")
        .def_property_readonly(
            "times",
            [](const PyCurve& self) {
                return view(self.character, self.get().times.data(), {static_cast<py::ssize_t>(self.get().keys)});
            },
            "(K,) float32, seconds, without a copy.")
        .def_property_readonly("values", &curve_values,
                               "(K, components) float32, for cubic (K, 3, components): without a copy unless packed.")
        .def("sample", &sample_one, py::arg("seconds"),
             "(components,) float32, fresh: the value at a time of the clip. Raises ValueError for NaN.")
        .def("__repr__", [](const PyCurve& self) { return repr_of("Curve", self); });

    py::class_<PyClip>(module, "Clip", "An animation clip.")
        .def_property_readonly(
            "name", [](const PyClip& self) { return text(self.get().name); }, "May be empty.")
        .def_readonly("number", &PyClip::number, "Index among the clips of the model.")
        .def_property_readonly(
            "start", [](const PyClip& self) { return self.get().start; }, "Seconds.")
        .def_property_readonly(
            "end", [](const PyClip& self) { return self.get().end; }, "Seconds.")
        .def_property_readonly(
            "seconds", [](const PyClip& self) { return self.get().end - self.get().start; }, "Its length.")
        .def_property_readonly(
            "loop", [](const PyClip& self) { return self.get().loop; }, "Whether it repeats.")
        .def_property_readonly(
            "is_packed", [](const PyClip& self) { return self.get().packed.has_value(); },
            "Whether tracks are quantised samples, which `tracks` decodes.")
        .def_property_readonly("tracks", &tracks_of,
                               "Tuple of Track. Their arrays are views of the file, without a copy, except for packed "
                               "clips and the times of fixed frames.")
        .def_property_readonly("markers", &markers_of, "Tuple of Marker, ascending by time.")
        .def_property_readonly(
            "curves",
            [](const PyClip& self) {
                return make_items<PyCurve>(
                    "curve", self.get().curves.size(),
                    [&](std::uint32_t k) {
                        PyCurve curve;
                        curve.character = self.character;
                        curve.number = k;
                        curve.clip = self.number;
                        return curve;
                    },
                    [](const PyCurve& curve) {
                        return curve.get().name.empty() ? curve.get().path : curve.get().name;
                    });
            },
            "Items of Curve; one without a name is found by its path.")
        .def_property_readonly(
            "extras", [](const PyClip& self) { return parse_json(self.get().extras); },
            "The author's own data, parsed; None without. Raises ValueError if it is not JSON.")
        .def("__repr__", [](const PyClip& self) { return repr_of("Clip", self); });
}

/// A list of the model that is made once.
template <class Item, class Count>
auto listed(const char* name, const char* kind, Count count) {
    return [=](PyModel& self) {
        return self.list(name, [&](const SharedCharacter& shared) {
            return py::cast(things<Item>(kind, shared, count(shared->model)));
        });
    };
}

template <class Item, class Count>
auto unnamed(const char* name, Count count) {
    return [=](PyModel& self) {
        return self.list(name, [&](const SharedCharacter& shared) -> py::object {
            const std::size_t size = count(shared->model);
            py::tuple list(size);
            for (std::size_t k = 0; k < size; ++k) {
                Item item;
                item.character = shared;
                item.number = static_cast<std::uint32_t>(k);
                list[k] = py::cast(std::move(item));
            }
            return list;
        });
    };
}

/// A thing by its name, number or object.
/// \param find  by name
template <class Item, class Find, class Names>
std::uint32_t find_thing(const SharedCharacter& character, const py::handle& wanted, const char* kind,
                         std::size_t count, const Find& find, const Names& names) {
    if (py::isinstance<Item>(wanted)) {
        const auto& item = wanted.cast<const Item&>();
        if (item.character != character)
            throw py::value_error("the " + std::string(kind) + " belongs to another model");
        return item.number;
    }
    if (py::isinstance<py::str>(wanted)) {
        const auto name = wanted.cast<std::string>();
        const std::uint32_t number = find(name);
        if (number != kNone) return number;
        std::vector<std::string_view> all;
        for (const auto& one : names) all.push_back(one.name);
        raise_no_such(kind, name, all);
    }
    if (PyIndex_Check(wanted.ptr()) == 0)
        throw py::type_error("a " + std::string(kind) + " is a name, a number or one of the model's own");
    return index_of(wanted, count, kind);
}

}  // namespace

SharedCharacter character_of(const py::handle& model) {
    return model.cast<const PyModel&>().get();
}

const Clip& find_clip(const SharedCharacter& character, const py::handle& clip) {
    const Model& model = character->model;
    const auto find = [&](const std::string& name) {
        const Clip* found = model.clip(name);
        return found == nullptr ? kNone : static_cast<std::uint32_t>(found - model.clips().data());
    };
    return model.clips()[find_thing<PyClip>(character, clip, "clip", model.clips().size(), find, model.clips())];
}

const Chain& find_chain(const SharedCharacter& character, const py::handle& chain) {
    const Model& model = character->model;
    const auto find = [&](const std::string& name) {
        const Chain* found = model.chain(name);
        return found == nullptr ? kNone : found->number;
    };
    return model.chains()[find_thing<PyChain>(character, chain, "chain", model.chains().size(), find, model.chains())];
}

std::uint32_t find_joint(const SharedCharacter& character, const py::handle& joint) {
    const Model& model = character->model;
    const auto find = [&](const std::string& name) { return model.joint(name); };
    return find_thing<PyJoint>(character, joint, "joint", model.joints().size(), find, model.joints());
}

std::uint32_t find_mesh(const SharedCharacter& character, const py::handle& mesh) {
    const Model& model = character->model;
    const auto find = [&](const std::string& name) {
        for (std::size_t k = 0; k < model.meshes().size(); ++k) {
            if (model.meshes()[k].name == name) return static_cast<std::uint32_t>(k);
        }
        return kNone;
    };
    return find_thing<PyMesh>(character, mesh, "mesh", model.meshes().size(), find, model.meshes());
}

void bind_model(py::module_& module) {
    bind_items(module);
    bind_joints(module);
    bind_meshes(module);
    bind_clips(module);

    py::class_<PyModel>(module, "Model", "A character: a mapped file. Immutable; threads may share it.")
        .def(py::init(&open_model), py::arg("source"), py::arg("object") = 0, py::arg("check_sums") = true)
        .def_property_readonly(
            "name", [](const PyModel& self) { return text(self.model().name()); }, "The object's name; may be empty.")
        .def_property_readonly(
            "source", [](const PyModel& self) { return std::const_pointer_cast<Source>(self.get()->source); },
            "The file's bytes.")
        .def_property_readonly("joints",
                               listed<PyJoint>("joints", "joint", [](const Model& m) { return m.joints().size(); }),
                               "Items of Joint, parents before children.")
        .def_property_readonly(
            "parents",
            [](const PyModel& self) {
                const auto parents = self.model().parents();
                std::vector<std::int32_t> numbers(parents.size());
                for (std::size_t k = 0; k < parents.size(); ++k)
                    numbers[k] = parents[k] == kNone ? -1 : static_cast<std::int32_t>(parents[k]);
                return py::array_t<std::int32_t>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
            },
            "(J,) int32, fresh: the joints' parents; -1 for a root.")
        .def_property_readonly("meshes",
                               listed<PyMesh>("meshes", "mesh", [](const Model& m) { return m.meshes().size(); }),
                               "Items of Mesh.")
        .def_property_readonly(
            "clips", listed<PyClip>("clips", "clip", [](const Model& m) { return m.clips().size(); }), "Items of Clip.")
        .def_property_readonly("chains",
                               listed<PyChain>("chains", "chain", [](const Model& m) { return m.chains().size(); }),
                               "Items of Chain.")
        .def_property_readonly(
            "materials",
            listed<PyMaterial>("materials", "material", [](const Model& m) { return m.materials().size(); }),
            "Items of Material.")
        .def_property_readonly(
            "textures", listed<PyTexture>("textures", "texture", [](const Model& m) { return m.textures().size(); }),
            "Items of Texture.")
        .def_property_readonly(
            "constraints", unnamed<PyConstraint>("constraints", [](const Model& m) { return m.constraints().size(); }),
            "Tuple of Constraint, ascending by joint.")
        .def_property_readonly("submeshes",
                               unnamed<PySubmesh>("submeshes", [](const Model& m) { return m.submeshes().size(); }),
                               "Tuple of Submesh.")
        .def_property_readonly(
            "vertices", [](const PyModel& self) { return self.model().vertex_count(); },
            "Number of vertices of all meshes.")
        .def_property_readonly(
            "morph_targets", [](const PyModel& self) { return self.model().morph_target_count(); },
            "Number of morph targets of all meshes.")
        .def_property_readonly(
            "has_levels", [](const PyModel& self) { return self.model().collapse() != nullptr; },
            "Whether the file has levels of detail.")
        .def(
            "joint", [](const PyModel& self, const py::object& joint) { return find_joint(self.get(), joint); },
            py::arg("joint"), "The number of a joint by its name. Raises KeyError.")
        .def(
            "check_sums",
            [](const PyModel& self) {
                const SharedCharacter character = self.get();
                const auto checked = [&] {
                    const py::gil_scoped_release released;
                    return character->model.check_sums();
                }();
                if (!checked) raise_fault(checked.error(), *character->source);
            },
            "Checks the bytes against their sums, for a model opened with check_sums=False. Raises Error.")
        .def(
            "mask_below",
            [](const PyModel& self, const py::object& joint, float inside, float outside) {
                const auto mask = mask_below(self.model(), find_joint(self.get(), joint), inside, outside);
                return py::array_t<float>(static_cast<py::ssize_t>(mask.size()), mask.data());
            },
            py::arg("joint"), py::arg("inside") = 1.0f, py::arg("outside") = 0.0f,
            "(J,) float32, fresh, for Pose.blend and add: `inside` for the joint and all below it, `outside` for the "
            "others. Raises KeyError.")
        .def(
            "close",
            [](PyModel& self) {
                self.lists.clear();
                self.character = nullptr;
            },
            "Gives up the file. Arrays, poses and other objects made from the model stay valid and keep the file open; "
            "any other use of the model raises ValueError.")
        .def_property_readonly(
            "closed", [](const PyModel& self) { return self.character == nullptr; }, "Whether it was closed.")
        .def(
            "same_character", [](const PyModel& self, const PyModel& other) { return self.get() == other.get(); },
            py::arg("other"), "Whether both are the same opened file, so that poses can be blended.");
}

}  // namespace bendy::python
