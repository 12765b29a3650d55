#pragma once

#include <bendy/converter/report.h>
#include <bendy/format/error.h>
#include <bendy/format/file.h>
#include <bendy/format/readable_folders.h>
#include <bendy/runtime/bounds.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/pose.h>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// What the sources of the Python module share: the objects behind Python's, arrays, and errors as exceptions.
namespace bendy::python {

namespace py = pybind11;

/// The bytes of a file: mapped, or in memory. They never change and start on a 16-byte boundary.
class Source {
public:
    Source(MappedFile opened, std::filesystem::path file, Storage storage)
        : opened_(std::move(opened)), file_(std::move(file)), is_mapped_(storage == Storage::mapped) {}
    explicit Source(std::vector<std::byte> owned, std::filesystem::path file = {})
        : owned_(std::move(owned)), file_(std::move(file)) {}

    [[nodiscard]] Bytes bytes() const { return owned_.empty() ? opened_.bytes() : Bytes(owned_); }
    /// Empty, or a name for messages, if the bytes are not those of a file.
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] bool is_mapped() const { return is_mapped_; }

private:
    MappedFile opened_;
    std::vector<std::byte> owned_;
    std::filesystem::path file_;
    bool is_mapped_ = false;
};

/// The folders in which the names in a source are looked for. Bytes have the folder in front of their name, if there is
/// one. \param root  of the caller, or empty
inline ReadableFolders folders_of(const Source& source, const std::filesystem::path& root) {
    return source.is_mapped() || source.file().has_parent_path() ? ReadableFolders::of(source.file(), root)
                                                                 : ReadableFolders(root);
}

/// An opened model with the bytes that it refers to. Everything made from a model holds one.
class Character {
public:
    Character(std::shared_ptr<const Source> from, Model opened) : source(std::move(from)), model(std::move(opened)) {}

    /// Made at the first use.
    [[nodiscard]] const Bounds& bounds() const;

    const std::shared_ptr<const Source> source;
    const Model model;

private:
    mutable std::once_flag is_bounded_;
    mutable std::optional<Bounds> bounds_;
};
using SharedCharacter = std::shared_ptr<const Character>;

/// Text of a file as Python's; what is not UTF-8 becomes U+FFFD.
py::str text(std::string_view utf8);
/// The same; None if it is empty.
py::object text_or_none(std::string_view utf8);
/// JSON of a file, parsed; None if it is empty. Raises ValueError if it is not JSON.
py::object parse_json(std::string_view json);
/// A number, or None for kNone.
py::object number_or_none(std::uint32_t number);

/// A read-only array over memory of the owner, which it keeps alive.
/// \param strides  bytes; empty: without gaps
template <class T, class Owner>
py::array view(const std::shared_ptr<const Owner>& owner, const T* data, std::vector<py::ssize_t> shape,
               std::vector<py::ssize_t> strides = {}) {
    const py::capsule base(new std::shared_ptr<const Owner>(owner),
                           [](void* held) { delete static_cast<std::shared_ptr<const Owner>*>(held); });
    py::array array = strides.empty() ? py::array(py::dtype::of<T>(), std::move(shape), data, base)
                                      : py::array(py::dtype::of<T>(), std::move(shape), std::move(strides), data, base);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

/// An index that Python was given, -1 being the last. Raises IndexError with `kind`, the name of what is counted.
std::uint32_t index_of(const py::handle& index, std::size_t count, const char* kind);

/// An array of any shape that numpy makes of what was given. Raises TypeError if it makes none, ValueError if a number
/// is not finite. \param name  of the argument
using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
Floats floats_of(const py::handle& numbers, const char* name);
/// The same, for `count` numbers. Raises ValueError if there are not as many.
std::vector<float> numbers_of(const py::handle& numbers, std::size_t count, const char* name);

// Raising. `file` is None or the name of the file that is at fault.

/// bendy.MalformedError, InvalidError or UnsupportedError with the fault's path and offset; OSError for those of the
/// operating system.
[[noreturn]] void raise_fault(const Error& error, const Source& source);
/// OSError, or the subclass for the errno number.
[[noreturn]] void raise_os_error(const Error& error, const std::filesystem::path& file);
/// bendy.NAME with this message and `code`. \param place  in a source that was converted
[[noreturn]] void raise(const char* name, const std::string& message, const char* code,
                        const std::filesystem::path& file = {}, const std::string& place = {});
/// ValueError, IndexError or RuntimeError, as the error is the caller's.
[[noreturn]] void raise_call(CallError error);

void bind_model(py::module_& module);
void bind_pose(py::module_& module);
void bind_play(py::module_& module);
void bind_tools(py::module_& module);
/// render, if the viewer is built.
void bind_render(py::module_& module);

/// The character of a Python model. Raises ValueError if the model is closed.
SharedCharacter character_of(const py::handle& model);
/// A copy of a Python pose; nothing if the object is something else. Raises RuntimeError if another thread uses it.
struct GivenPose {
    SharedCharacter character;
    Pose pose;
};
std::optional<GivenPose> pose_of(const py::handle& pose);
/// A clip, chain or joint of the model by its name, number or object. Raises KeyError, IndexError, ValueError for an
/// object of another model, TypeError.
const Clip& find_clip(const SharedCharacter& character, const py::handle& clip);
const Chain& find_chain(const SharedCharacter& character, const py::handle& chain);
std::uint32_t find_joint(const SharedCharacter& character, const py::handle& joint);
std::uint32_t find_mesh(const SharedCharacter& character, const py::handle& mesh);

}  // namespace bendy::python
