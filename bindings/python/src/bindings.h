#pragma once

#include <bendy/converter/report.h>
#include <bendy/format/error.h>
#include <bendy/format/file.h>
#include <bendy/format/readable_folders.h>
#include <bendy/runtime/model.h>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Shared by the sources of the Python module: the C++ objects behind Python's, arrays, and errors as exceptions.
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
    /// Empty, or a name for messages, if the bytes are not from a file.
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] bool is_mapped() const { return is_mapped_; }

private:
    MappedFile opened_;
    std::vector<std::byte> owned_;
    std::filesystem::path file_;
    bool is_mapped_ = false;
};

/// Returns the folders in which the names in a source are looked up. Bytes use the folder in their name, if there is
/// one. \param root  from the caller, or empty
inline ReadableFolders folders_of(const Source& source, const std::filesystem::path& root) {
    return source.is_mapped() || source.file().has_parent_path() ? ReadableFolders::of(source.file(), root)
                                                                 : ReadableFolders(root);
}

/// Converts a file's text to Python; bytes that are not UTF-8 become U+FFFD.
py::str text(std::string_view utf8);
/// The same; None if it is empty.
py::object text_or_none(std::string_view utf8);
/// JSON of a file, parsed; None if it is empty. Raises ValueError if it is not JSON.
py::object parse_json(std::string_view json);
/// Returns a read-only array over memory of the owner, and keeps the owner alive.
/// \param strides  in bytes; empty: without gaps
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

// Raising. `file` is None or the name of the faulty file.

/// bendy.MalformedError, InvalidError or UnsupportedError with the fault's path and offset; OSError for errors of the
/// operating system.
[[noreturn]] void raise_fault(const Error& error, const Source& source);
/// OSError, or the subclass for the errno number.
[[noreturn]] void raise_os_error(const Error& error, const std::filesystem::path& file);
/// bendy.NAME with this message and `code`. \param place  in a source that was converted
[[noreturn]] void raise(const char* name, const std::string& message, const char* code,
                        const std::filesystem::path& file = {}, const std::string& place = {});

/// Access to what a file stores beyond the C API.
void bind_stored(py::module_& module);
void bind_tools(py::module_& module);
/// Binds render, if the viewer is built.
void bind_render(py::module_& module);

}  // namespace bendy::python
