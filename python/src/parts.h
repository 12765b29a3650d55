#pragma once

#include "bindings.h"

#include <bendy/format/clip.h>
#include <bendy/format/record_table.h>
#include <bendy/runtime/curve.h>

#include <array>
#include <map>
#include <string>
#include <utility>

// What a model consists of, as Python sees it: for the sources that bind it.
namespace bendy::python {

/// The name of an enumeration's value, as records.def lists it.
template <class Value>
py::str name_of(std::string_view record, std::string_view field, Value value) {
    return text(find_layout(record)->find(field)->value_name(static_cast<std::uint64_t>(value)));
}

/// Numbers of a record.
template <std::size_t N>
py::tuple tuple_of(const std::array<float, N>& numbers) {
    py::tuple tuple(N);
    for (std::size_t k = 0; k < N; ++k) tuple[k] = numbers[k];
    return tuple;
}

/// A read-only array with a copy of these numbers.
inline py::array fresh(std::vector<py::ssize_t> shape, const float* numbers) {
    py::array_t<float> array(std::move(shape), numbers);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

/// A thing of a model: the model's data, and its number.
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

/// Those of a model that have a name.
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

template <class Thing>
py::str repr_of(const char* kind, const Thing& thing) {
    return py::str("<bendy.{} {} {!r}>").format(kind, thing.number, text(thing.get().name));
}

/// A joint at rest, as a file has it.
inline RestRecord rest_record(const Joint& joint) {
    const auto& [rotation, translation, scale] = joint.rest;
    return {{rotation.x, rotation.y, rotation.z, rotation.w},
            {translation.x, translation.y, translation.z},
            {scale.x, scale.y, scale.z},
            {joint.shear.x, joint.shear.y, joint.shear.z}};
}

void bind_meshes(py::module_& module);
void bind_clips(py::module_& module);

}  // namespace bendy::python
