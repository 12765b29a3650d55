#include "parts.h"
#include "poses.h"

#include <bendy/runtime/binding.h>
#include <bendy/runtime/crossfade.h>
#include <bendy/runtime/crowd.h>
#include <bendy/runtime/markers.h>
#include <bendy/runtime/playback.h>
#include <bendy/runtime/root_motion.h>
#include <bendy/runtime/sample.h>
#include <bendy/runtime/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <span>
#include <system_error>
#include <thread>
#include <utility>

// Clips over time: Playback, Crossfade, root motion, clips of other files, crowds; sockets.
namespace bendy::python {
namespace {

/// The place of a name in a list of them, as the enumeration's value. Raises ValueError with the names.
template <class Value, std::size_t N>
Value value_of(const std::string& given, const char* name, const std::array<const char*, N>& names) {
    const auto found = std::find(names.begin(), names.end(), given);
    if (found != names.end()) return static_cast<Value>(found - names.begin());
    std::string all;
    for (const char* one : names) all += (all.empty() ? "" : ", ") + std::string(one);
    throw py::value_error(std::string(name) + " must be one of: " + all);
}

constexpr std::array<const char*, 3> kLoopModes{"once", "repeat", "ping_pong"};
constexpr std::array<const char*, 2> kEasings{"linear", "smooth"};
constexpr std::array<const char*, 3> kRootTurns{"none", "yaw", "all"};
constexpr std::array<const char*, 2> kBoundTranslations{"all", "root_only"};

double finite(double number, const char* name) {
    if (!std::isfinite(number)) throw py::value_error(std::string(name) + " must be a finite number");
    return number;
}

/// A clip of a model.
struct ClipOf {
    SharedCharacter character;
    const Clip* clip = nullptr;
};

/// Of a Clip object, which knows its model.
ClipOf clip_of(const py::handle& clip) {
    if (!py::isinstance<PyClip>(clip)) throw py::type_error("expected a Clip, as model.clips[\"Walk\"]");
    const auto& given = clip.cast<const PyClip&>();
    return {given.character, &given.get()};
}

py::object clip_object(const SharedCharacter& character, const Clip& clip) {
    PyClip object;
    object.character = character;
    object.number = static_cast<std::uint32_t>(&clip - character->model.clips().data());
    return py::cast(std::move(object));
}

// Playback.

struct PyPlayedInterval {
    ClipOf clip;
    PlayedInterval interval;
};

struct PyPlayback {
    ClipOf clip;
    Playback playback;
};

Playback make_playback(const Clip& clip, const std::optional<std::string>& mode, double speed) {
    Playback playback(clip);
    if (mode) playback.set_mode(value_of<LoopMode>(*mode, "mode", kLoopModes));
    playback.set_speed(finite(speed, "speed"));
    return playback;
}

py::list markers_of(const PyPlayedInterval& self, std::size_t limit) {
    const auto& markers = self.clip.clip->markers;
    std::vector<const Marker*> met(std::min<std::uint64_t>(limit, count_markers(markers, self.interval)));
    met.resize(collect_markers(markers, self.interval, met));
    py::list list;
    for (const Marker* marker : met) list.append(PyMarker{marker->seconds, text(marker->name)});
    return list;
}

void bind_playback(py::module_& module) {
    py::class_<PyPlayedInterval>(module, "PlayedInterval", "What one step of a Playback has played, across the ends.")
        .def("markers", &markers_of, py::arg("limit") = 1000,
             "The markers that were passed, in the order in which they were: a list of at most `limit` Marker.")
        .def_property_readonly(
            "marker_count",
            [](const PyPlayedInterval& self) { return count_markers(self.clip.clip->markers, self.interval); },
            "How many markers were passed; one that was passed twice counts twice.")
        .def_property_readonly(
            "is_empty", [](const PyPlayedInterval& self) { return self.interval.is_empty(); },
            "Whether nothing was played: the clip is paused or at its end.");

    py::class_<PyPlayback>(module, "Playback", "The clock of a clip. Time does not drift, however long it plays.")
        .def(py::init([](const py::object& clip, const std::optional<std::string>& mode, double speed) {
                 const ClipOf of = clip_of(clip);
                 return PyPlayback{of, make_playback(*of.clip, mode, speed)};
             }),
             py::arg("clip"), py::arg("mode") = py::none(), py::arg("speed") = 1.0,
             "At the clip's start. clip: a Clip. mode: once, repeat or ping_pong; None: as the clip says. speed: 1 is "
             "as authored, negative is backwards. Raises TypeError, ValueError.")
        .def(
            "advance",
            [](PyPlayback& self, double seconds) {
                return PyPlayedInterval{self.clip, self.playback.advance(finite(seconds, "seconds"))};
            },
            py::arg("seconds"), "Advances by seconds times the speed; returns the PlayedInterval. Raises ValueError.")
        .def(
            "seek", [](PyPlayback& self, double seconds) { self.playback.seek(finite(seconds, "seconds")); },
            py::arg("seconds"), "Jumps to a time of the clip, clamped to it, and plays nothing. Raises ValueError.")
        .def(
            "seek_share", [](PyPlayback& self, double share) { self.playback.seek_share(finite(share, "share")); },
            py::arg("share"), "The same by the share of the length, 0 to 1: to keep a walk and a run in step.")
        .def_property_readonly(
            "clip", [](const PyPlayback& self) { return clip_object(self.clip.character, *self.clip.clip); },
            "The Clip.")
        .def_property_readonly(
            "seconds", [](const PyPlayback& self) { return self.playback.seconds(); },
            "The current time on the clip's time line, as Pose.sample takes it.")
        .def_property_readonly(
            "share", [](const PyPlayback& self) { return self.playback.share(); },
            "The current time as a share of the length, 0 to 1.")
        .def_property_readonly(
            "passes", [](const PyPlayback& self) { return self.playback.passes(); },
            "Passes completed since the last seek; negative when played backwards.")
        .def_property_readonly(
            "is_done", [](const PyPlayback& self) { return self.playback.is_done(); },
            "Whether playback has stopped at the end that it was heading for: only in mode once.")
        .def_property(
            "speed", [](const PyPlayback& self) { return self.playback.speed(); },
            [](PyPlayback& self, double speed) { self.playback.set_speed(finite(speed, "speed")); },
            "1: as authored; 0: paused; negative: backwards.")
        .def_property(
            "mode",
            [](const PyPlayback& self) { return kLoopModes.at(static_cast<std::size_t>(self.playback.mode())); },
            [](PyPlayback& self, const std::string& mode) {
                self.playback.set_mode(value_of<LoopMode>(mode, "mode", kLoopModes));
            },
            "once, repeat or ping_pong; the current time is kept.");
}

// Crossfade.

struct PyCrossfade {
    SharedCharacter character;
    Crossfade crossfade;
    Pose scratch;
};

struct PyPlaying {
    SharedCharacter character;
    Playing playing;
};

py::list playing_of(const PyCrossfade& self) {
    py::list list;
    for (const Playing& one : self.crossfade.playing()) list.append(PyPlaying{self.character, one});
    return list;
}

void bind_crossfade(py::module_& module) {
    py::class_<PyPlaying>(module, "Playing", "One of the clips of a Crossfade, as it was after the last advance.")
        .def_property_readonly(
            "clip", [](const PyPlaying& self) { return clip_object(self.character, *self.playing.clip); }, "The Clip.")
        .def_property_readonly(
            "seconds", [](const PyPlaying& self) { return self.playing.playback.seconds(); },
            "The time on the clip's time line.")
        .def_property_readonly(
            "share", [](const PyPlaying& self) { return self.playing.share; }, "Of the result; they sum to 1.")
        .def_property_readonly(
            "played",
            [](const PyPlaying& self) {
                return PyPlayedInterval{{self.character, self.playing.clip}, self.playing.played};
            },
            "The PlayedInterval of the last advance: for markers and root motion.");

    py::class_<PyCrossfade>(module, "Crossfade",
                            "Clips that each fade in over those before it; one that is interrupted plays on beneath. "
                            "At most four at a time.")
        .def(py::init([](const py::object& model) {
                 const SharedCharacter character = character_of(model);
                 return PyCrossfade{character, {}, Pose(character->model)};
             }),
             py::arg("model"), "Nothing plays yet. Raises ValueError if the model is closed.")
        .def(
            "play",
            [](PyCrossfade& self, const py::object& clip, double fade, const std::string& easing,
               const std::optional<std::string>& mode, double speed, std::optional<double> share) {
                const Clip& found = find_clip(self.character, clip);
                Playback playback = make_playback(found, mode, speed);
                if (share) playback.seek_share(finite(*share, "share"));
                self.crossfade.play(found, playback, check_finite(fade, "fade"),
                                    value_of<Easing>(easing, "easing", kEasings));
            },
            py::arg("clip"), py::arg("fade") = 0.2, py::kw_only(), py::arg("easing") = "smooth",
            py::arg("mode") = py::none(), py::arg("speed") = 1.0, py::arg("share") = py::none(),
            "Starts a clip (its name, number or object) that fades in for `fade` seconds; the first one is there at "
            "once. easing: linear or smooth. mode, speed: as for Playback. share: where it starts, 0 to 1, so that a "
            "run is in step with a walk. Raises KeyError, IndexError, ValueError.")
        .def(
            "advance", [](PyCrossfade& self, double seconds) { self.crossfade.advance(finite(seconds, "seconds")); },
            py::arg("seconds"), "Advances all clips and fades. Raises ValueError.")
        .def_property_readonly("playing", &playing_of, "A list of Playing, the oldest first.")
        .def(
            "sample",
            [](PyCrossfade& self, const py::object& pose) {
                auto& given = pose.cast<PyPose&>();
                const Use use(given);
                const auto sampled = sample(*use, self.crossfade, self.scratch);
                if (!sampled) raise_call(sampled.error());
                return pose;
            },
            py::arg("pose"),
            "Sets a pose of the same opened model to the clips that play, and returns it. Raises ValueError if "
            "nothing plays.");
}

// Root motion.

/// Rows of a 4x4 matrix, double precision.
py::array matrix_array(const glm::dmat4& matrix) {
    py::array_t<double> array({4, 4});
    double* out = array.mutable_data();
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) *out++ = matrix[column][row];
    }
    return array;
}

struct PyRootPath {
    SharedCharacter character;
    RootPath path;
};

RootMotion make_motion(const std::array<double, 3>& translation, const std::array<double, 4>& rotation) {
    constexpr double kUnit = 1e-6;
    double square = 0.0;
    for (const double number : translation) finite(number, "translation");
    for (const double number : rotation) square += number * number;
    if (!(std::abs(std::sqrt(square) - 1.0) <= kUnit))
        throw py::value_error("rotation must be a unit quaternion x, y, z, w");
    const auto& [x, y, z, w] = rotation;
    return {{translation[0], translation[1], translation[2]}, glm::dquat(w, x, y, z)};
}

RootAxes make_axes(const std::string& axes, const std::string& turn) {
    const auto has = [&](char axis) { return axes.find(axis) != std::string::npos; };
    if (axes.find_first_not_of("xyz") != std::string::npos)
        throw py::value_error("axes must be of the letters x, y and z");
    return {has('x'), has('y'), has('z'), value_of<RootTurn>(turn, "turn", kRootTurns)};
}

void bind_root_motion(py::module_& module) {
    py::class_<RootMotion>(module, "RootMotion", "A rotation followed by a translation, in double precision.")
        .def(py::init(&make_motion), py::arg("translation") = std::array{0.0, 0.0, 0.0},
             py::arg("rotation") = std::array{0.0, 0.0, 0.0, 1.0},
             "translation: x, y, z in metres. rotation: a unit quaternion x, y, z, w. Raises ValueError.")
        .def_property_readonly(
            "translation",
            [](const RootMotion& self) {
                return py::make_tuple(self.translation.x, self.translation.y, self.translation.z);
            },
            "x, y, z in metres.")
        .def_property_readonly(
            "rotation",
            [](const RootMotion& self) {
                return py::make_tuple(self.rotation.x, self.rotation.y, self.rotation.z, self.rotation.w);
            },
            "A unit quaternion x, y, z, w.")
        .def_property_readonly(
            "matrix", [](const RootMotion& self) { return matrix_array(self.matrix()); }, "(4, 4) float64, fresh.")
        .def(
            "__matmul__", [](const RootMotion& self, const RootMotion& after) { return compose(self, after); },
            py::is_operator(), "character @ motion: the motion, in the axes of `character`, after it.")
        .def(
            "inverse", [](const RootMotion& self) { return inverse(self); }, "The motion that undoes this one.")
        .def(
            "blend",
            [](const RootMotion& self, const RootMotion& other, double weight) {
                return blend(self, other, finite(weight, "weight"));
            },
            py::arg("other"), py::arg("weight"), "Between two motions, weight 0 to 1: for crossfades.")
        .def("__repr__", [](const RootMotion& self) {
            return py::str("<bendy.RootMotion ({:.6g}, {:.6g}, {:.6g})>")
                .format(self.translation.x, self.translation.y, self.translation.z);
        });

    py::class_<PyRootPath>(module, "RootPath", "How a clip carries a character over the ground.")
        .def(py::init([](const py::object& model, const py::object& joint, const std::string& axes,
                         const std::string& turn) {
                 const SharedCharacter character = character_of(model);
                 return PyRootPath{character,
                                   RootPath(character->model, find_joint(character, joint), make_axes(axes, turn))};
             }),
             py::arg("model"), py::arg("joint"), py::arg("axes") = "xz", py::arg("turn") = "yaw",
             "joint: the root or the hips. axes: along which it moves the character; the rest stays in the pose. turn: "
             "none, yaw (about y, which is up) or all. Raises KeyError, IndexError, ValueError.")
        .def(
            "at",
            [](const PyRootPath& self, const py::object& clip, double seconds) {
                return *self.path.at(find_clip(self.character, clip), finite(seconds, "seconds"));
            },
            py::arg("clip"), py::arg("seconds"), "From the root's rest pose to where it is in the clip: a RootMotion.")
        .def(
            "between",
            [](const PyRootPath& self, const py::object& clip, double from, double to) {
                return *self.path.between(find_clip(self.character, clip), finite(from, "start"), finite(to, "end"));
            },
            py::arg("clip"), py::arg("start"), py::arg("end"),
            "From one time of a clip to another, in the axes that the character has at the start.")
        .def(
            "over",
            [](const PyRootPath& self, const PyPlayedInterval& played) {
                if (played.clip.character != self.character)
                    throw py::value_error("the clip that was played belongs to another model");
                return *self.path.over(*played.clip.clip, played.interval);
            },
            py::arg("played"),
            "Over what a Playback has played; passes continue where the one before ended. Raises ValueError.")
        .def(
            "extract",
            [](const PyRootPath& self, PyPose& pose) {
                if (pose.character != self.character) throw py::value_error("the pose belongs to another model");
                const Use use(pose);
                return *self.path.extract(*use);
            },
            py::arg("pose"), "Takes the motion out of a pose and returns it. Raises ValueError.");
}

// Clips of another file.

struct PyBinding {
    SharedCharacter animated, posed;
    Binding binding;
};

py::list numbers_or_none(std::span<const std::uint32_t> numbers) {
    py::list list;
    for (const std::uint32_t number : numbers) list.append(number_or_none(number));
    return list;
}

void bind_binding(py::module_& module) {
    py::class_<PyBinding>(module, "Binding",
                          "Plays the clips of one model on another: joints and morph targets are matched by name.")
        .def(py::init([](const py::object& animated, const py::object& posed, const std::string& translations,
                         const py::object& root, double root_scale) {
                 const SharedCharacter from = character_of(animated);
                 const SharedCharacter to = character_of(posed);
                 BindingOptions options;
                 options.translations = value_of<BoundTranslations>(translations, "translations", kBoundTranslations);
                 if (!root.is_none()) options.root = find_joint(to, root);
                 options.root_scale = check_finite(root_scale, "root_scale");
                 return PyBinding{from, to, Binding(from->model, to->model, options)};
             }),
             py::arg("animated"), py::arg("posed"), py::kw_only(), py::arg("translations") = "all",
             py::arg("root") = py::none(), py::arg("root_scale") = 1.0,
             "animated: the model that has the clips. posed: the one that moves. translations: all, or root_only: "
             "limbs keep the lengths of the posed model, and `root` (usually the hips) with its ancestors moves, by "
             "root_scale times as far. Raises KeyError, IndexError, ValueError.")
        .def(
            "sample",
            [](PyBinding& self, const py::object& pose, const py::object& clip, double seconds) {
                auto& given = pose.cast<PyPose&>();
                const Use use(given);
                const auto sampled =
                    sample(*use, self.binding, &find_clip(self.animated, clip), check_finite(seconds, "seconds"));
                if (!sampled) raise_call(sampled.error());
                return pose;
            },
            py::arg("pose"), py::arg("clip"), py::arg("seconds"),
            "Sets a pose of the posed model to a clip of the animated one, and returns it. Raises KeyError, "
            "IndexError, ValueError.")
        .def_property_readonly(
            "joints", [](const PyBinding& self) { return numbers_or_none(self.binding.joints()); },
            "For each joint of the animated model, the number of the posed model's joint, or None.")
        .def_property_readonly(
            "targets", [](const PyBinding& self) { return numbers_or_none(self.binding.targets()); },
            "The same for morph targets.")
        .def_property_readonly(
            "unmatched_joints", [](const PyBinding& self) { return numbers_or_none(self.binding.unmatched_joints()); },
            "Numbers of the animated model's joints that a clip animates and that have no match.")
        .def_property_readonly(
            "unmatched_targets",
            [](const PyBinding& self) { return numbers_or_none(self.binding.unmatched_targets()); },
            "The same for morph targets.");
}

// Crowds.

struct PyCrowd {
    SharedCharacter character;
    Crowd crowd;
    bool is_busy = false;  // read and written with the GIL held
};

/// What each member plays. \param clips  one for all, or a sequence of clips or None
std::vector<CrowdMember> members_of(const SharedCharacter& character, const py::object& clips,
                                    const py::object& seconds) {
    const Floats times = floats_of(seconds, "seconds");
    if (times.ndim() != 1) throw py::value_error("seconds must have the shape (M,)");
    std::vector<CrowdMember> members(static_cast<std::size_t>(times.size()));
    const bool is_list = py::isinstance<py::list>(clips) || py::isinstance<py::tuple>(clips);
    const py::sequence list = is_list ? py::sequence(clips) : py::sequence(py::list());
    if (is_list && list.size() != members.size())
        throw py::value_error("clips must be one clip, or as many as there are seconds");
    const Clip* const of_all = is_list || clips.is_none() ? nullptr : &find_clip(character, clips);
    for (std::size_t k = 0; k < members.size(); ++k) {
        members[k].seconds = times.data()[k];
        members[k].clip = of_all;
        if (is_list && !list[k].is_none()) members[k].clip = &find_clip(character, py::object(list[k]));
    }
    return members;
}

/// Plays on as many threads as the crowd has workers; on fewer if the system refuses one.
Result<void, CallError> play_all(Crowd& crowd, std::span<const CrowdMember> members) {
    constexpr std::size_t kAtOnce = Crowd::kAtOnce;
    std::atomic<std::size_t> next{0};
    std::vector<Result<void, CallError>> results(crowd.workers());
    const auto work = [&](std::size_t worker) {
        for (;;) {
            const std::size_t first = next.fetch_add(kAtOnce);
            if (first >= members.size()) return;
            const auto played = crowd.play(members.subspan(first, std::min(kAtOnce, members.size() - first)), worker);
            if (!played && results[worker]) results[worker] = played;
        }
    };
    std::vector<std::thread> threads;
    threads.reserve(crowd.workers());  // so that nothing throws while some run
    for (std::size_t worker = 1; worker < crowd.workers() && worker * kAtOnce < members.size(); ++worker) {
        try {
            threads.emplace_back(work, worker);
        } catch (const std::system_error&) {
            break;
        }
    }
    work(0);
    for (std::thread& thread : threads) thread.join();
    for (const auto& result : results) {
        if (!result) return result;
    }
    return {};
}

void play_members(PyCrowd& self, std::span<const CrowdMember> members) {
    if (self.is_busy) throw std::runtime_error("the crowd is in use by another thread: give each thread its own");
    struct Busy {
        bool& flag;
        explicit Busy(bool& of) : flag(of) { flag = true; }
        Busy(const Busy&) = delete;
        Busy& operator=(const Busy&) = delete;
        Busy(Busy&&) = delete;
        Busy& operator=(Busy&&) = delete;
        ~Busy() { flag = false; }
    };
    const Busy busy(self.is_busy);
    const auto played = without_gil([&] { return play_all(self.crowd, members); });
    if (!played) raise_call(played.error());
}

/// What a level of detail leaves out is not written.
py::array_t<float> zeros(std::vector<py::ssize_t> shape) {
    py::array_t<float> array(std::move(shape));
    std::fill_n(array.mutable_data(), array.size(), 0.0f);
    return array;
}

py::object skin_crowd(PyCrowd& self, const py::object& clips, const py::object& seconds, bool normals,
                      const std::optional<std::shared_ptr<const PyLod>>& lod) {
    std::vector<CrowdMember> members = members_of(self.character, clips, seconds);
    const std::size_t floats = 3 * self.character->model.vertex_count();
    const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(members.size()), static_cast<py::ssize_t>(floats / 3),
                                         3};
    if (lod && (*lod)->character != self.character)
        throw py::value_error("the level of detail belongs to another model");
    py::array_t<float> positions = zeros(shape);
    std::optional<py::array_t<float>> directions;
    if (normals) directions = zeros(shape);
    float* const first_position = positions.mutable_data();
    float* const first_normal = directions ? directions->mutable_data() : nullptr;
    for (std::size_t k = 0; k < members.size() && floats != 0; ++k) {
        members[k].out.positions = {{first_position + k * floats, floats}, 3};
        if (first_normal != nullptr) members[k].out.normals = {{first_normal + k * floats, floats}, 3};
        if (lod) members[k].lod = &(*lod)->lod;
    }
    play_members(self, members);
    if (directions) return py::make_tuple(positions, *directions);
    return positions;
}

py::array palettes_of(PyCrowd& self, const py::object& clips, const py::object& seconds) {
    std::vector<CrowdMember> members = members_of(self.character, clips, seconds);
    const std::size_t entries = self.crowd.palette_size();
    std::vector<PaletteMatrix> palettes(members.size() * entries);
    for (std::size_t k = 0; k < members.size(); ++k)
        members[k].palette = std::span(palettes).subspan(k * entries, entries);
    play_members(self, members);
    py::array_t<float> array(
        {static_cast<py::ssize_t>(members.size()), static_cast<py::ssize_t>(entries), py::ssize_t{3}, py::ssize_t{4}});
    write_palette(palettes, array.mutable_data());
    return array;
}

void bind_crowd(py::module_& module) {
    py::class_<PyCrowd>(module, "Crowd", "Many characters of one model, posed and skinned on several threads.")
        .def(py::init([](const py::object& model, std::size_t threads) {
                 const SharedCharacter character = character_of(model);
                 if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
                 constexpr std::size_t kMostThreads = 256;
                 return PyCrowd{character, Crowd(character->model, std::min(threads, kMostThreads))};
             }),
             py::arg("model"), py::arg("threads") = 0,
             "threads: at most; 0: one for each processor. Raises ValueError if the model is closed.")
        .def("skin", &skin_crowd, py::arg("clips"), py::arg("seconds"), py::kw_only(), py::arg("normals") = false,
             py::arg("lod") = py::none(),
             "The vertices of M characters: (M, N, 3) float32, metres, fresh; with normals, a tuple of two. clips: one "
             "for all, or a list of M clips or None, which is the rest pose. seconds: (M,). lod: a Lod; vertices that "
             "it leaves out are zero. Raises KeyError, IndexError, ValueError, RuntimeError.")
        .def("palettes", &palettes_of, py::arg("clips"), py::arg("seconds"),
             "The skinning matrices of M characters: (M, B, 3, 4) float32, fresh, of all meshes: see first_entry. "
             "Neighbouring meshes with the same palette share them, and a rigid mesh has one. Raises KeyError, "
             "IndexError, ValueError, RuntimeError.")
        .def(
            "first_entry",
            [](const PyCrowd& self, const py::object& mesh) {
                return self.crowd.first_entry(find_mesh(self.character, mesh));
            },
            py::arg("mesh"), "Where the matrices of a mesh begin in `palettes`.")
        .def_property_readonly(
            "threads", [](const PyCrowd& self) { return self.crowd.workers(); }, "At most so many at a time.");
}

}  // namespace

glm::mat4 matrix_of(const py::handle& numbers, const char* name) {
    const Floats array = floats_of(numbers, name);
    if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4)
        throw py::value_error(std::string(name) + " must have the shape (4, 4)");
    glm::mat4 matrix;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) matrix[column][row] = array.at(row, column);
    }
    return matrix;
}

void bind_play(py::module_& module) {
    bind_playback(module);
    bind_crossfade(module);
    bind_root_motion(module);
    bind_binding(module);
    bind_crowd(module);
}

}  // namespace bendy::python
