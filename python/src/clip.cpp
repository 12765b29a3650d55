#include "parts.h"

#include <bendy/format/packed_clip.h>

// Clips with their tracks, curves and markers.
namespace bendy::python {
namespace {

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

}  // namespace

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
                      "(K, components) float32: metres, unit quaternions x, y, z, w, factors or weights. For cubic (K, "
                      "3, components): in-tangent, value, out-tangent.")
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

}  // namespace bendy::python
