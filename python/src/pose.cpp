#include "poses.h"

#include <bendy/format/clip.h>
#include <bendy/format/read_record.h>
#include <bendy/format/record_table.h>
#include <bendy/runtime/blend.h>
#include <bendy/runtime/bounds.h>
#include <bendy/runtime/constrain.h>
#include <bendy/runtime/ik.h>
#include <bendy/runtime/sample.h>
#include <bendy/runtime/skin.h>
#include <bendy/runtime/socket.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

// Pose: sampling, blending, IK, skinning.
namespace bendy::python {
namespace {

struct PyReachResult {
    const char* status = "";
    bool reached = false;
    float distance = 0.0f, angle = 0.0f;
    std::uint32_t iterations = 0;
    bool is_aim = false;
};

// Arrays of local transforms.

std::uint32_t joint_count(const PyPose& self) {
    return static_cast<std::uint32_t>(self.pose.model().joints().size());
}

template <std::size_t N>
using Component = std::array<float, N>;

Component<4> rotation_of(const JointTransform& joint) {
    return {joint.rotation.x, joint.rotation.y, joint.rotation.z, joint.rotation.w};
}
Component<3> translation_of(const JointTransform& joint) {
    return {joint.translation.x, joint.translation.y, joint.translation.z};
}
Component<3> scale_of(const JointTransform& joint) {
    return {joint.scale.x, joint.scale.y, joint.scale.z};
}

template <std::size_t N>
py::array local_array(const PyPose& self, Component<N> (*get)(const JointTransform&)) {
    const std::uint32_t joints = joint_count(self);
    py::array_t<float> array({static_cast<py::ssize_t>(joints), static_cast<py::ssize_t>(N)});
    float* out = array.mutable_data();
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        const Component<N> numbers = get(self.pose.local(joint));
        out = std::copy(numbers.begin(), numbers.end(), out);
    }
    return array;
}

/// What was given for all joints: finite floats of the shape (rows, columns).
Floats table_of(const py::handle& numbers, std::size_t rows, std::size_t columns, const char* name) {
    Floats array = floats_of(numbers, name);
    if (array.ndim() != 2 || static_cast<std::size_t>(array.shape(0)) != rows ||
        static_cast<std::size_t>(array.shape(1)) != columns) {
        throw py::value_error(std::string(name) + " must have the shape (" + std::to_string(rows) + ", " +
                              std::to_string(columns) + ")");
    }
    return array;
}

void set_rotations(PyPose& self, const py::object& numbers) {
    const Use pose(self);
    const auto table = table_of(numbers, joint_count(self), 4, "rotations");
    for (py::ssize_t k = 0; k < table.shape(0); ++k) {
        if (!is_unit(std::span<const float, 4>(table.data(k), 4), kUnitTolerance))
            throw py::value_error("rotation " + std::to_string(k) + " must be a unit quaternion x, y, z, w");
    }
    for (std::uint32_t joint = 0; joint < joint_count(self); ++joint) {
        const float* q = table.data(static_cast<py::ssize_t>(joint));
        JointTransform local = (*pose).local(joint);
        local.rotation = glm::quat(q[3], q[0], q[1], q[2]);
        (*pose).set_local(joint, local);
    }
}

void set_vectors(PyPose& self, const py::object& numbers, glm::vec3 JointTransform::*member, const char* name) {
    const Use pose(self);
    const auto table = table_of(numbers, joint_count(self), 3, name);
    for (std::uint32_t joint = 0; joint < joint_count(self); ++joint) {
        const float* v = table.data(static_cast<py::ssize_t>(joint));
        JointTransform local = (*pose).local(joint);
        local.*member = glm::vec3(v[0], v[1], v[2]);
        (*pose).set_local(joint, local);
    }
}

py::array matrices_of(PyPose& self) {
    const Use pose(self);
    py::array_t<float> array({static_cast<py::ssize_t>(joint_count(self)), py::ssize_t{4}, py::ssize_t{4}});
    write_matrices((*pose).model_space(), array.mutable_data());
    return array;
}

py::array palette_of(PyPose& self, const py::object& mesh) {
    const Use pose(self);
    const auto entries = (*pose).palette(find_mesh(self.character, mesh));
    py::array_t<float> array({static_cast<py::ssize_t>(entries.size()), py::ssize_t{3}, py::ssize_t{4}});
    write_palette(entries, array.mutable_data());
    return array;
}

// Skinning.

/// Which attributes are wanted, how many vertices there are, and where they go.
struct Outputs {
    py::tuple arrays;
    VertexBuffer buffer;
};

/// The floats of an array that the caller gave.
StridedFloats strided(const py::handle& given, std::size_t rows, std::size_t columns, const char* name) {
    const std::string shape = '(' + std::to_string(rows) + ", " + std::to_string(columns) + ')';
    if (!py::isinstance<py::array_t<float>>(given))
        throw py::type_error("out: " + std::string(name) + " must be a float32 array of the shape " + shape);
    const auto array = py::reinterpret_borrow<py::array>(given);
    if (array.ndim() != 2 || static_cast<std::size_t>(array.shape(0)) != rows ||
        static_cast<std::size_t>(array.shape(1)) != columns)
        throw py::value_error("out: " + std::string(name) + " must have the shape " + shape);
    if (!array.writeable()) throw py::value_error("out: " + std::string(name) + " is read-only");
    constexpr auto kFloat = static_cast<py::ssize_t>(sizeof(float));
    const py::ssize_t row = array.strides(0);
    const bool is_aligned = (array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0;
    if (rows == 0) return {};
    if (!is_aligned || array.strides(1) != kFloat || row % kFloat != 0 ||
        (rows > 1 && row < kFloat * static_cast<py::ssize_t>(columns))) {
        throw py::value_error("out: " + std::string(name) +
                              " must have its components next to each other and its rows in order");
    }
    const std::size_t stride = rows > 1 ? static_cast<std::size_t>(row / kFloat) : columns;
    auto* data = static_cast<float*>(py::array(array).mutable_data());
    return {{data, stride * (rows - 1) + columns}, stride};
}

Outputs make_outputs(std::size_t vertices, bool normals, bool tangents, const py::object& out) {
    struct Attribute {
        const char* name;
        std::size_t columns;
        StridedFloats VertexBuffer::*place;
    };
    std::vector<Attribute> wanted{{"positions", 3, &VertexBuffer::positions}};
    if (normals) wanted.push_back({"normals", 3, &VertexBuffer::normals});
    if (tangents) wanted.push_back({"tangents", 4, &VertexBuffer::tangents});
    Outputs outputs{py::tuple(wanted.size()), {}};
    py::tuple given;
    if (!out.is_none()) {
        given = wanted.size() == 1 && !py::isinstance<py::tuple>(out) ? py::make_tuple(out) : py::tuple(out);
    }
    if (!out.is_none() && given.size() != wanted.size()) {
        throw py::value_error("out must have one array for each of the " + std::to_string(wanted.size()) +
                              " attributes");
    }
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        const Attribute& attribute = wanted[k];
        const py::object array = out.is_none()
                                     ? py::object(py::array_t<float>({static_cast<py::ssize_t>(vertices),
                                                                      static_cast<py::ssize_t>(attribute.columns)}))
                                     : py::object(given[k]);
        outputs.buffer.*attribute.place = strided(array, vertices, attribute.columns, attribute.name);
        outputs.arrays[k] = array;
    }
    return outputs;
}

SkinningMethod method_of(const std::string& name) {
    if (name == "linear") return SkinningMethod::linear;
    if (name == "dual_quaternion") return SkinningMethod::dual_quaternion;
    throw py::value_error("method must be linear or dual_quaternion");
}

py::object skin_pose(PyPose& self, const py::object& mesh, bool normals, bool tangents, const std::string& method,
                     const std::optional<std::shared_ptr<const PyLod>>& lod, const py::object& out) {
    const Use pose(self);
    const Model& model = self.character->model;
    SkinRequest request;
    request.method = method_of(method);
    std::size_t vertices = model.vertex_count();
    if (!mesh.is_none()) {
        request.mesh = find_mesh(self.character, mesh);
        vertices = model.meshes()[request.mesh].vertices;
    }
    if (lod) {
        if ((*lod)->character != self.character) throw py::value_error("the level of detail belongs to another model");
        request.lod = &(*lod)->lod;
        if (!mesh.is_none()) vertices = request.lod->vertices(request.mesh);
    }
    const Outputs outputs = make_outputs(vertices, normals, tangents, out);
    for (const py::handle array : outputs.arrays) {
        if (lod && out.is_none()) array.attr("fill")(0.0f);
    }
    request.out = outputs.buffer;
    const auto skinned = without_gil([&] { return skin(*pose, request); });
    if (!skinned) raise_call(skinned.error());
    if (outputs.arrays.size() == 1) return outputs.arrays[0];
    return outputs.arrays;
}

// Inverse kinematics.

Solver solver_of(const std::string& name) {
    const RecordField* field = find_layout("ChainRecord")->find("solver");
    for (unsigned k = 0; k < kSolvers; ++k) {
        if (field->value_name(k) == name) return static_cast<Solver>(k);
    }
    throw py::value_error("solver must be one of: " + std::string(field->values));
}

ReachTarget target_of(const py::object& position, const py::object& rotation) {
    const std::vector<float> p = numbers_of(position, 3, "target");
    ReachTarget target(glm::vec3(p[0], p[1], p[2]));
    if (rotation.is_none()) return target;
    const std::vector<float> q = numbers_of(rotation, 4, "rotation");
    if (!is_unit(std::span(q).first<4>(), kUnitTolerance))
        throw py::value_error("rotation must be a unit quaternion x, y, z, w");
    target.rotation = glm::quat(q[3], q[0], q[1], q[2]);
    return target;
}

PyReachResult result_of(const ReachResult& result, bool is_aim) {
    constexpr std::array<const char*, 4> kNames{"reached", "out_of_reach", "not_reached", "aimed"};
    return {kNames.at(static_cast<std::size_t>(result.status)),
            result.status == ReachStatus::reached || result.status == ReachStatus::aimed,
            result.distance,
            result.angle,
            result.iterations,
            is_aim};
}

float fraction_of(double number, const char* name) {
    if (number >= 0.0 && number <= 1.0) return static_cast<float>(number);
    throw py::value_error(std::string(name) + " must lie between 0 and 1");
}

PyReachResult reach_target(PyPose& self, const py::object& chain, const py::object& position,
                           const py::object& rotation, const std::string& solver, const py::object& pole,
                           double influence, double tolerance, std::uint32_t iterations, bool obey_constraints,
                           bool carry_target, double softness, double gain, double step_limit, std::uint32_t restarts) {
    const Use pose(self);
    const Chain& found = find_chain(self.character, chain);
    const ReachTarget target = target_of(position, rotation);
    ReachOptions options;
    options.solver = solver_of(solver);
    options.iterations = iterations;
    options.tolerance = check_finite(tolerance, "tolerance");
    options.influence = fraction_of(influence, "influence");
    options.obey_constraints = obey_constraints;
    options.carry_target = carry_target;
    options.softness = fraction_of(softness, "softness");
    options.gain = check_finite(gain, "gain");
    options.step_limit = check_finite(step_limit, "step_limit");
    options.restarts = restarts;
    if (!pole.is_none()) {
        const std::vector<float> p = numbers_of(pole, 3, "pole");
        options.pole = glm::vec3(p[0], p[1], p[2]);
    }
    const auto result = without_gil([&] { return reach(*pose, &found, target, options); });
    if (!result) raise_call(result.error());
    return result_of(*result, (options.solver == Solver::any ? found.solver : options.solver) == Solver::aim);
}

// Blending.

std::vector<float> mask_of(const PyPose& self, const py::object& mask) {
    if (mask.is_none()) return {};
    return numbers_of(mask, joint_count(self), "mask");
}

/// Blends, adds or subtracts. \param work  takes the pose and the other one, which may be the same
template <class Work>
void combine(PyPose& self, const PyPose& other, const Work& work) {
    check_free(other);
    const Use pose(self);
    const auto done = &self == &other ? work(*pose, Pose(other.pose)) : work(*pose, other.pose);
    if (!done) raise_call(done.error());
}

PyPose& sample_clip(PyPose& self, const py::object& clip, double seconds) {
    const Use pose(self);
    const Clip& found = find_clip(self.character, clip);
    const float time = check_finite(seconds, "seconds");
    const auto sampled = without_gil([&] { return sample(*pose, &found, time); });
    if (!sampled) raise_call(sampled.error());
    return self;
}

PyPose rest_pose(const py::handle& model) {
    const SharedCharacter character = character_of(model);
    return {character, without_gil([&] { return Pose(character->model); })};
}

// Many poses at once.

/// Finite times, (T,).
std::vector<float> checked_times(const py::object& times) {
    const Floats array = floats_of(times, "times");
    if (array.ndim() != 1) throw py::value_error("times must have the shape (T,)");
    return {array.data(), array.data() + array.size()};
}

py::array skin_clip(const py::object& model, const py::object& clip, const py::object& times) {
    const SharedCharacter character = character_of(model);
    const Clip& found = find_clip(character, clip);
    const std::vector<float> list = checked_times(times);
    const std::size_t floats = 3 * character->model.vertex_count();
    py::array_t<float> array({static_cast<py::ssize_t>(list.size()),
                              static_cast<py::ssize_t>(character->model.vertex_count()), py::ssize_t{3}});
    float* out = array.mutable_data();
    const auto done = without_gil([&]() -> Result<void, CallError> {
        Pose pose(character->model);
        for (std::size_t k = 0; k < list.size(); ++k) {
            if (auto sampled = sample(pose, &found, list[k]); !sampled) return sampled;
            const StridedFloats place = floats == 0 ? StridedFloats() : StridedFloats({out + k * floats, floats}, 3);
            SkinRequest request;
            request.out.positions = place;
            if (auto skinned = skin(pose, request); !skinned) return skinned;
        }
        return {};
    });
    if (!done) raise_call(done.error());
    return array;
}

py::array pose_clip(const py::object& model, const py::object& clip, const py::object& times) {
    const SharedCharacter character = character_of(model);
    const Clip& found = find_clip(character, clip);
    const std::vector<float> list = checked_times(times);
    const std::size_t joints = character->model.joints().size();
    py::array_t<float> array(
        {static_cast<py::ssize_t>(list.size()), static_cast<py::ssize_t>(joints), py::ssize_t{4}, py::ssize_t{4}});
    float* out = array.mutable_data();
    const auto done = without_gil([&]() -> Result<void, CallError> {
        Pose pose(character->model);
        for (std::size_t k = 0; k < list.size(); ++k) {
            if (auto sampled = sample(pose, &found, list[k]); !sampled) return sampled;
            write_matrices(pose.model_space(), out + k * joints * 16);
        }
        return {};
    });
    if (!done) raise_call(done.error());
    return array;
}

py::array bounds_of(PyPose& self) {
    const Use pose(self);
    const Box box = without_gil([&] { return *self.character->bounds().of(*pose); });
    const std::array<float, 6> corners{box.minimum.x, box.minimum.y, box.minimum.z,
                                       box.maximum.x, box.maximum.y, box.maximum.z};
    return py::array_t<float>({2, 3}, corners.data());
}

void bind_results(py::module_& module) {
    py::class_<PyReachResult>(module, "ReachResult", "How near a chain came to its target.")
        .def_readonly("status", &PyReachResult::status,
                      "reached; out_of_reach: farther away than the chain is long; not_reached: stopped at the nearest "
                      "solution found; aimed: the tip points at the target.")
        .def_readonly("reached", &PyReachResult::reached, "Whether the status is reached or aimed.")
        .def_readonly("distance", &PyReachResult::distance, "Metres left between the tip and the target.")
        .def_readonly("angle", &PyReachResult::angle,
                      "Radians left, if the target has a rotation; of an aim, between the tip's Z axis and the line to "
                      "the target.")
        .def_readonly("iterations", &PyReachResult::iterations, "Number of iterations made.")
        .def("__bool__", [](const PyReachResult& self) { return self.reached; })
        .def("__repr__", [](const PyReachResult& self) {
            return self.is_aim ? py::str("<bendy.ReachResult {}, {:.6g} rad left>").format(self.status, self.angle)
                               : py::str("<bendy.ReachResult {}, {:.6g} m left>").format(self.status, self.distance);
        });
}

}  // namespace

std::optional<GivenPose> pose_of(const py::handle& pose) {
    if (!py::isinstance<PyPose>(pose)) return std::nullopt;
    const auto& given = pose.cast<const PyPose&>();
    check_free(given);
    return GivenPose{given.character, given.pose};
}

void bind_pose(py::module_& module) {
    bind_results(module);
    py::class_<PyPose>(module, "Pose",
                       "A model in one position: local transforms, morph target weights, and what follows from them. "
                       "For one thread at a time: a call while another thread uses the pose raises RuntimeError. "
                       "Methods that change the pose return it, except reach.")
        .def(py::init(&rest_pose), py::arg("model"), "At rest. Raises ValueError if the model is closed.")
        .def("sample", &sample_clip, py::arg("clip"), py::arg("seconds"), py::return_value_policy::reference,
             "Sets the pose to a clip (its name, number or object) at a time on the clip's time line, held at the ends "
             "of the keys. What the clip does not animate is at rest. Raises KeyError, IndexError, ValueError.")
        .def(
            "reset",
            [](PyPose& self) -> PyPose& {
                (*Use(self)).set_rest();
                return self;
            },
            py::return_value_policy::reference, "Sets the rest pose.")
        .def(
            "copy",
            [](const PyPose& self) {
                check_free(self);
                return PyPose{self.character, self.pose};
            },
            "A second pose, equal to this one.")
        .def(
            "blend",
            [](PyPose& self, const PyPose& other, double weight, const py::object& mask) -> PyPose& {
                const std::vector<float> numbers = mask_of(self, mask);
                const float share = check_finite(weight, "weight");
                combine(self, other, [&](Pose& pose, const Pose& to) { return blend(pose, to, share, numbers); });
                return self;
            },
            py::arg("other"), py::arg("weight"), py::arg("mask") = py::none(), py::return_value_policy::reference,
            "Blends towards another pose of the same opened model: weight 0 changes nothing, 1 makes it equal. `mask`, "
            "(J,) numbers, scales the weight by joint: see Model.mask_below. Raises ValueError.")
        .def(
            "make_additive",
            [](PyPose& self, const PyPose& reference) -> PyPose& {
                combine(self, reference, [](Pose& pose, const Pose& from) { return make_additive(pose, from); });
                return self;
            },
            py::arg("reference"), py::return_value_policy::reference,
            "Turns the pose into its difference from the reference, for add. Raises ValueError.")
        .def(
            "add",
            [](PyPose& self, const PyPose& difference, double weight, const py::object& mask) -> PyPose& {
                const std::vector<float> numbers = mask_of(self, mask);
                const float share = check_finite(weight, "weight");
                combine(self, difference,
                        [&](Pose& pose, const Pose& added) { return add(pose, added, share, numbers); });
                return self;
            },
            py::arg("difference"), py::arg("weight") = 1.0, py::arg("mask") = py::none(),
            py::return_value_policy::reference, "Adds a difference, scaled by the weight. Raises ValueError.")
        .def(
            "constrain",
            [](PyPose& self) -> PyPose& {
                const Use pose(self);
                without_gil([&] { constrain(*pose); });
                return self;
            },
            py::return_value_policy::reference, "Moves every joint into the range of its constraints.")
        .def(
            "reach", &reach_target, py::arg("chain"), py::arg("target"), py::kw_only(),
            py::arg("rotation") = py::none(), py::arg("solver") = "any", py::arg("pole") = py::none(),
            py::arg("influence") = 1.0, py::arg("tolerance") = 0.0, py::arg("iterations") = 0,
            py::arg("obey_constraints") = true, py::arg("carry_target") = false, py::arg("softness") = 0.0,
            py::arg("gain") = 1.0, py::arg("step_limit") = 0.2, py::arg("restarts") = 8,
            "Moves an IK chain (its name, number or object) so that its tip reaches `target`, (3,) metres in model "
            "space, and there has `rotation`, a unit quaternion x, y, z, w. Joints stay within their constraints. A "
            "target that is not reached is a result, not an error.\n\nsolver: any (the chain's own), pull, two_bone, "
            "ccd, fabrik, aim, least_squares. pole: (3,) metres, the point to bend towards. influence: 0 to 1, how far "
            "the solution is blended in. tolerance: metres; 0: the chain's own. iterations: at most; 0: the chain's "
            "own. carry_target: also moves the joint that the chain follows. softness: two_bone, 0 to 1, the fraction "
            "of "
            "its length over which the chain slows near full reach. gain, step_limit: pull, radians per chain length "
            "of "
            "distance, and radians per joint and call. restarts: least_squares, other starting points to try when it "
            "is "
            "stuck. Raises KeyError, IndexError, ValueError.")
        .def(
            "reach_all",
            [](PyPose& self) -> PyPose& {
                const Use pose(self);
                without_gil([&] { reach_all(*pose); });
                return self;
            },
            py::return_value_policy::reference, "Solves every chain that follows a target joint, by priority.")
        .def("skin", &skin_pose, py::arg("mesh") = py::none(), py::kw_only(), py::arg("normals") = false,
             py::arg("tangents") = false, py::arg("method") = "linear", py::arg("lod") = py::none(),
             py::arg("out") = py::none(),
             "The posed vertices in model space: (N, 3) float32 positions in metres, of all meshes one after another "
             "(Mesh.first_vertex) or of one `mesh`. With normals, (N, 3) unit, or tangents, (N, 4), a tuple in that "
             "order. method: linear or dual_quaternion. lod: a level of detail, see Model.lod: a mesh has only the "
             "vertices that are left; of all meshes, vertices that are left out are zero.\n\nFresh arrays, or those in "
             "`out` (one, or a tuple): float32, "
             "writeable, of the same shapes; rows may have gaps between them, as in interleaved buffers. Raises "
             "TypeError, ValueError, KeyError, IndexError.")
        .def_property_readonly("matrices", &matrices_of,
                               "(J, 4, 4) float32, [row, column], fresh: joint space to model space.")
        .def("palette", &palette_of, py::arg("mesh"),
             "(B, 3, 4) float32, fresh: the skinning matrices of a mesh, for skinning elsewhere; the last row, 0 0 0 "
             "1, is left out. Empty for a rigid mesh. Raises KeyError, IndexError.")
        .def(
            "socket",
            [](PyPose& self, const py::object& joint, const py::object& offset, const py::object& model_to_world,
               bool keeps_size) {
                Socket socket;
                socket.joint = find_joint(self.character, joint);
                socket.keeps_size = keeps_size;
                if (!offset.is_none()) socket.offset = matrix_of(offset, "offset");
                const glm::mat4 world =
                    model_to_world.is_none() ? glm::mat4(1.0f) : matrix_of(model_to_world, "model_to_world");
                const Use pose(self);
                const glm::mat4 matrix = *socket_matrix(*pose, socket, world);  // the joint was looked up
                py::array_t<float> array({4, 4});
                write_matrices(std::span(&matrix, 1), array.mutable_data());
                return array;
            },
            py::arg("joint"), py::arg("offset") = py::none(), py::kw_only(), py::arg("model_to_world") = py::none(),
            py::arg("keeps_size") = true,
            "(4, 4) float32, [row, column], fresh: where a thing is that a joint carries: model_to_world @ joint @ "
            "offset. keeps_size: without the joint's scale. Raises KeyError, IndexError, ValueError.")
        .def_property_readonly("bounds", &bounds_of,
                               "(2, 3) float32, fresh: minimum and maximum corner of a box around all vertices, "
                               "metres; the minimum is above the maximum if there are none.")
        .def_property(
            "rotations",
            [](const PyPose& self) {
                check_free(self);
                return local_array(self, &rotation_of);
            },
            &set_rotations,
            "(J, 4) float32, fresh: unit quaternions x, y, z, w relative to the parent. Assign the whole array; raises "
            "ValueError for another shape and for what is no unit quaternion.")
        .def_property(
            "translations",
            [](const PyPose& self) {
                check_free(self);
                return local_array(self, &translation_of);
            },
            [](PyPose& self, const py::object& numbers) {
                set_vectors(self, numbers, &JointTransform::translation, "translations");
            },
            "(J, 3) float32, fresh: metres, relative to the parent. Assign the whole array; raises ValueError.")
        .def_property(
            "scales",
            [](const PyPose& self) {
                check_free(self);
                return local_array(self, &scale_of);
            },
            [](PyPose& self, const py::object& numbers) {
                set_vectors(self, numbers, &JointTransform::scale, "scales");
            },
            "(J, 3) float32, fresh: along the joints' axes. Assign the whole array; raises ValueError.")
        .def_property(
            "morph_weights",
            [](const PyPose& self) {
                check_free(self);
                const auto weights = self.pose.morph_weights();
                return py::array_t<float>(static_cast<py::ssize_t>(weights.size()), weights.data());
            },
            [](PyPose& self, const py::object& numbers) {
                const Use pose(self);
                const std::vector<float> weights =
                    numbers_of(numbers, self.pose.morph_weights().size(), "morph_weights");
                std::copy(weights.begin(), weights.end(), (*pose).change_morph_weights().begin());
            },
            "(M,) float32, fresh: usually 0 to 1, of all meshes (Mesh.first_morph_target). Assign the whole array; "
            "raises ValueError.")
        .def("__copy__",
             [](const PyPose& self) {
                 check_free(self);
                 return PyPose{self.character, self.pose};
             })
        .def("__repr__", [](const PyPose& self) {
            return py::str("<bendy.Pose of {!r}, {} joints>")
                .format(text(self.character->model.name()), self.character->model.joints().size());
        });

    module.def("skin_clip", &skin_clip, py::arg("model"), py::arg("clip"), py::arg("times"), "See Model.skin_clip.");
    module.def("pose_clip", &pose_clip, py::arg("model"), py::arg("clip"), py::arg("times"), "See Model.pose_clip.");
}

}  // namespace bendy::python
