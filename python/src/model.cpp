#include "parts.h"

#include <bendy/format/names.h>
#include <bendy/runtime/blend.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Model, its joints, constraints and chains, and how its things are found.
namespace bendy::python {
namespace {

/// The number of what a text refers to. Raises KeyError.
std::uint32_t find_key(const std::vector<std::string_view>& names, std::string_view wanted, const char* kind) {
    const auto found = find_by_key(names, wanted, kind);
    if (!found) throw py::key_error(found.error().message);
    return static_cast<std::uint32_t>(*found);
}

bool has_item(const Items& items, const py::object& key) {
    if (py::isinstance<py::str>(key)) {
        return std::find(items.names.begin(), items.names.end(), key.cast<std::string>()) != items.names.end();
    }
    for (const auto& one : items.list) {
        if (one.is(key)) return true;
    }
    return false;
}

py::object get_item(const Items& items, const py::object& key) {
    if (py::isinstance<py::slice>(key)) return items.list.attr("__getitem__")(key);
    if (py::isinstance<PyJoint>(key) && !has_item(items, key))  // which counts as a number elsewhere
        throw py::value_error("the joint is none of these");
    if (!py::isinstance<py::str>(key)) return items.list[index_of(key, items.names.size(), items.kind.c_str())];
    const std::vector<std::string_view> names(items.names.begin(), items.names.end());
    return items.list[find_key(names, key.cast<std::string>(), items.kind.c_str())];
}

/// A model, until it is closed. Lists are made at the first use.
struct PyModel {
    SharedCharacter character;
    std::map<std::string, py::object> lists;

    [[nodiscard]] const SharedCharacter& get() const {
        if (character == nullptr) throw py::value_error("the model is closed");
        return character;
    }
    [[nodiscard]] SharedCharacter share() const { return get(); }
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
    return {std::make_shared<const Character>(source, *std::move(model)), {}};
}

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

void bind_items(py::module_& module) {
    py::class_<Items>(module, "Items",
                      "A list of things that are found by number or by name: clips[0], clips[\"Walk\"]. Names need not "
                      "be unique; the first one counts. \"#3\" is always a number and \"=3\" always a name.")
        .def("__len__", [](const Items& self) { return self.names.size(); })
        .def("__iter__", [](const Items& self) { return py::iter(self.list); })
        .def("__getitem__", &get_item, py::arg("key"),
             "One by its number (-1 is the last) or its name; a slice gives a tuple. Raises IndexError, or KeyError "
             "with the names that there are.")
        .def("__contains__", &has_item, py::arg("key"), "Whether there is one with exactly that name, or that object.")
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
    py::class_<PyConstraint>(module, "Constraint",
                             "What a joint may do, relative to its rest pose, in the constraint's frame: X is the "
                             "twist axis, Y and Z are the swing axes.")
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
        const auto text = wanted.cast<std::string>();
        const ThingKey key = read_key(text);
        if (!key.number) {  // the model finds a name faster than find_key
            const std::uint32_t number = find(std::string(*key.name));
            if (number != kNone) return number;
        }
        std::vector<std::string_view> all;
        for (const auto& one : names) all.push_back(one.name);
        return find_key(all, text, kind);
    }
    if (py::isinstance<PyJoint>(wanted) || PyIndex_Check(wanted.ptr()) == 0)  // a joint counts as its number elsewhere
        throw py::type_error("a " + std::string(kind) + " is a name, a number or one of the model's own");
    return index_of(wanted, count, kind);
}

}  // namespace

const Bounds& Character::bounds() const {
    std::call_once(is_bounded_, [&] { bounds_.emplace(model); });
    return *bounds_;
}

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
            "extras", [](const PyModel& self) { return parse_json(self.model().extras()); },
            "Application-specific data of the object: parsed JSON, or None.")
        .def_property_readonly(
            "file_extras", [](const PyModel& self) { return parse_json(self.model().file_extras()); },
            "Application-specific data of the whole file: parsed JSON, or None.")
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
                const SharedCharacter character = self.share();  // another thread may close the model
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
