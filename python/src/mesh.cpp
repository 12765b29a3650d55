#include "parts.h"
#include "poses.h"

#include <bendy/runtime/lod.h>

#include <optional>
#include <span>

// Meshes with their streams and morph targets, submeshes, materials and textures.
namespace bendy::python {
namespace {

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

std::shared_ptr<const PyLod> make_lod(const py::handle& model, float share) {
    if (!(share >= 0.0f)) throw py::value_error("share must be 0 to 1");
    const SharedCharacter character = character_of(model);
    auto lod = std::make_shared<PyLod>(PyLod{character, share, Lod(character->model)});
    lod->lod.set_share(share);
    return lod;
}

/// Of one mesh: (T, 3).
py::array triangles_at(const Lod& lod, std::uint32_t mesh) {
    std::vector<std::uint32_t> corners;
    const auto indices = lod.indices(mesh);
    for (const Submesh& submesh : lod.submeshes()) {
        if (submesh.mesh != mesh || submesh.topology != Topology::triangles) continue;
        const auto part = indices.subspan(submesh.first, submesh.count);
        corners.insert(corners.end(), part.begin(), part.end());
    }
    return py::array_t<std::uint32_t>({static_cast<py::ssize_t>(corners.size() / 3), py::ssize_t{3}}, corners.data());
}

py::array triangles_of(const PyMesh& mesh, float share) {
    if (!(share >= 0.0f)) throw py::value_error("share must be 0 to 1");
    Lod lod(mesh.model());
    lod.set_share(share);
    return triangles_at(lod, mesh.number);
}

void bind_lod(py::module_& module) {
    py::class_<PyLod, std::shared_ptr<PyLod>>(
        module, "Lod", "A model at one level of detail. It never changes, so that threads may share it.")
        .def(py::init([](const py::object& model, float share) {
                 return std::const_pointer_cast<PyLod>(make_lod(model, share));
             }),
             py::arg("model"), py::arg("share") = 1.0f,
             "About this share of the model's triangles: 1 keeps all, 0 as few as the file's collapse sequence allows; "
             "without a sequence, all. Raises ValueError.")
        .def_readonly("share", &PyLod::share, "As it was asked for.")
        .def_property_readonly(
            "triangle_count", [](const PyLod& self) { return self.lod.triangles(); }, "In all meshes.")
        .def_property_readonly(
            "error", [](const PyLod& self) { return self.lod.error(); },
            "Metres that the surface may be off, as the file states it; 0 at full detail or if it does not.")
        .def(
            "vertex_count",
            [](const PyLod& self, const py::object& mesh) {
                return self.lod.vertices(find_mesh(self.character, mesh));
            },
            py::arg("mesh"), "How many vertices of a mesh are left: its first ones. Raises KeyError, IndexError.")
        .def(
            "triangles",
            [](const PyLod& self, const py::object& mesh) {
                return triangles_at(self.lod, find_mesh(self.character, mesh));
            },
            py::arg("mesh"), "(T, 3) uint32, fresh: the triangles of a mesh. Raises KeyError, IndexError.");
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

}  // namespace

void bind_meshes(py::module_& module) {
    bind_lod(module);
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

    py::class_<PyMesh>(module, "Mesh",
                       "A mesh with N vertices. Arrays are read-only and keep the file open. They are views of the "
                       "file, without a copy, if it stores floats, as exact files do; compact files are decoded at the "
                       "first access. `stored` has all streams as they are, never copied.")
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
             "that share of the model's triangles, if the file has a collapse sequence. Raises ValueError.")
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
            "All streams by name as they are stored, never copied: (elements, components) of the file's own type.")
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
            "without a copy, or None), uri (or None), same_as (the number of the texture whose image it is, or None).")
        .def("__repr__", [](const PyTexture& self) { return repr_of("Texture", self); });
}

}  // namespace bendy::python
