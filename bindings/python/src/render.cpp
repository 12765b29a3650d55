#include "bindings.h"
#include "c_layer.h"

// Pictures, if the viewer is built.

#ifdef BENDY_HAS_VIEWER

#include "handles.h"

#include <bendy/viewer/picture.h>
#include <bendy/viewer/render.h>

#include <glm/vec4.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace bendy::python {
namespace {

constexpr py::ssize_t kChannels = 4;

py::array render_model(const py::object& model, const py::object& pose, const std::shared_ptr<Source>& source,
                       const std::optional<std::uint32_t>& clip, const std::vector<float>& times, std::uint32_t width,
                       std::uint32_t height, std::optional<float> yaw, std::optional<float> pitch, float distance,
                       const std::optional<std::array<float, 4>>& background, const std::vector<std::string>& drawn,
                       const std::filesystem::path& root) {
    const c::Using<bendy_model> used(model, "model", c::Null::refused, false);
    const Model& character = used.get()->get();
    const c::Using<bendy_pose> given(pose, "pose", c::Null::allowed, false);
    viewer::RenderOptions options;
    options.width = width;
    options.height = height;
    if (width < 1 || height < 1 || width > viewer::kMostPixels || height > viewer::kMostPixels)
        throw py::value_error("size must be 1 to " + std::to_string(viewer::kMostPixels) + " pixels each way");
    if (clip) options.clip = &character.clips()[*clip];
    if (yaw) options.camera.yaw = *yaw;
    if (pitch) options.camera.pitch = *pitch;
    options.camera.distance = distance;
    for (const float number : {options.camera.yaw, options.camera.pitch, distance}) {
        if (!std::isfinite(number)) throw py::value_error("camera must be finite numbers");
    }
    if (distance <= 0.0f) throw py::value_error("the camera's distance must be above 0");
    for (const float time : times) {
        if (!std::isfinite(time)) throw py::value_error("times must be finite numbers");
    }
    if (background) {
        const auto& [red, green, blue, alpha] = *background;
        options.draw.background = glm::vec4(red, green, blue, alpha);
    }
    for (const std::string& what : drawn) {
        if (what == "bones") options.draw.bones = true;
        if (what == "axes") options.draw.axes = true;
        if (what == "constraints") options.draw.constraints = options.draw.targets = true;
        if (what == "wireframe") options.draw.wireframe = true;
    }
    options.folders = folders_of(*source, root);
    const bendy_pose* const posed = given.get();
    if (posed != nullptr) options.adjust = [&](Pose& taken) { taken = posed->pose; };

    const auto pictures = static_cast<py::ssize_t>(times.size());
    py::array_t<std::uint8_t> array(
        {pictures, static_cast<py::ssize_t>(height), static_cast<py::ssize_t>(width), kChannels});
    std::uint8_t* out = array.mutable_data();
    std::vector<std::string> warnings;
    std::string problem;
    {
        const py::gil_scoped_release released;
        static std::mutex drawing;  // not all OpenGL drivers are thread-safe
        const std::scoped_lock lock(drawing);
        try {
            viewer::PictureMaker maker(character, options, [&](const std::string& what) { warnings.push_back(what); });
            for (const float time : times) {
                const viewer::Picture picture = maker.draw(time);
                std::memcpy(out, picture.pixels.data(), picture.pixels.size());
                out += picture.pixels.size();
            }
        } catch (const viewer::ViewerError& error) {
            problem = error.what();
        }
    }
    if (!problem.empty()) raise("RenderError", problem, "RENDER", source->file());
    for (const std::string& what : warnings) {
        if (PyErr_WarnEx(PyExc_UserWarning, what.c_str(), 2) != 0) throw py::error_already_set();
    }
    return array;
}

py::bytes encode_picture(const py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>& pixels) {
    if (pixels.ndim() != 3 || pixels.shape(2) != kChannels || pixels.size() == 0)
        throw py::value_error("a picture must be uint8 of the shape (height, width, 4)");
    viewer::Picture picture;
    picture.height = static_cast<std::uint32_t>(pixels.shape(0));
    picture.width = static_cast<std::uint32_t>(pixels.shape(1));
    picture.pixels.assign(pixels.data(), pixels.data() + pixels.size());
    try {
        const std::vector<std::byte> file = viewer::encode_png(picture);
        return {reinterpret_cast<const char*>(file.data()), file.size()};
    } catch (const viewer::ViewerError& error) {
        raise("RenderError", error.what(), "RENDER");
    }
}

}  // namespace

void bind_render(py::module_& module) {
    module.attr("has_viewer") = true;
    module.def("render", &render_model, py::arg("model"), py::arg("pose"), py::arg("source"), py::arg("clip"),
               py::arg("times"), py::arg("width"), py::arg("height"), py::arg("yaw"), py::arg("pitch"),
               py::arg("distance"), py::arg("background"), py::arg("drawn"), py::arg("root"), "See bendy.render.");
    module.def("encode_png", &encode_picture, py::arg("picture"), "See bendy.encode_png.");
}

}  // namespace bendy::python

#else

namespace bendy::python {

void bind_render(py::module_& module) {
    module.attr("has_viewer") = false;
}

}  // namespace bendy::python

#endif
