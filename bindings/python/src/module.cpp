#include "bindings.h"
#include "c_layer.h"

#include <bendy/converter/source_format.h>
#include <bendy/format/diagnostics.h>

#include <cmath>
#include <cstring>

// The module bendy._bendy: its errors, and the bytes of files.
namespace bendy::python {
namespace {

py::object name_of_file(const std::filesystem::path& file) {
    if (file.empty()) return py::none();
    return py::str(py::cast(file));  // decoded as Python decodes names that are not UTF-8
}

[[noreturn]] void raise_object(const py::object& exception) {
    PyErr_SetObject(py::type::of(exception).ptr(), exception.ptr());
    throw py::error_already_set();
}

std::shared_ptr<const Source> open_file(const std::filesystem::path& file, Storage storage) {
    Result<MappedFile> opened = [&] {
        const py::gil_scoped_release released;
        return storage == Storage::copied ? MappedFile::read(file) : MappedFile::open(file);
    }();
    if (!opened) raise_os_error(opened.error(), file);
    return std::make_shared<const Source>(*std::move(opened), file, storage);
}

std::shared_ptr<const Source> copy_bytes(const py::buffer& buffer, const std::filesystem::path& name) {
    Py_buffer view{};
    if (PyObject_GetBuffer(buffer.ptr(), &view, PyBUF_C_CONTIGUOUS) != 0) throw py::error_already_set();
    const auto* first = static_cast<const std::byte*>(view.buf);
    std::vector<std::byte> bytes;
    if (view.len > 0) bytes.assign(first, first + view.len);
    PyBuffer_Release(&view);
    return std::make_shared<const Source>(std::move(bytes), name);
}

/// Returns numbers as finite floats without gaps. \param shape  the required shape; None: any number
py::array floats(const py::object& numbers, const py::tuple& shape, const std::string& name) {
    auto array = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(numbers);
    if (!array) {
        PyErr_Clear();
        throw py::type_error(name + " must be numbers");
    }
    bool fits = static_cast<std::size_t>(array.ndim()) == shape.size();
    for (std::size_t k = 0; fits && k < shape.size(); ++k)
        fits = shape[k].is_none() || shape[k].cast<py::ssize_t>() == array.shape(static_cast<py::ssize_t>(k));
    if (!fits) {
        const py::str wanted = py::str(py::repr(shape)).attr("replace")("None", "T");
        throw py::value_error(name + " must have the shape " + wanted.cast<std::string>());
    }
    for (py::ssize_t k = 0; k < array.size(); ++k) {
        if (!std::isfinite(array.data()[k])) throw py::value_error(name + " must be finite numbers");
    }
    return array;
}

void bind_source(py::module_& module) {
    py::class_<Source, std::shared_ptr<Source>>(module, "Source", "The bytes of a file, mapped or in memory.")
        .def_static(
            "map",
            [](const std::filesystem::path& file) {
                return std::const_pointer_cast<Source>(open_file(file, Storage::mapped));
            },
            py::arg("file"), "Maps a file. Raises FileNotFoundError or another OSError.")
        .def_static(
            "read",
            [](const std::filesystem::path& file) {
                return std::const_pointer_cast<Source>(open_file(file, Storage::copied));
            },
            py::arg("file"), "Reads a file into memory. Raises as map.")
        .def_static(
            "copy",
            [](const py::buffer& data, const std::filesystem::path& name) {
                return std::const_pointer_cast<Source>(copy_bytes(data, name));
            },
            py::arg("data"), py::arg("name") = "", "Copies bytes. `name` is for messages.")
        .def_property_readonly(
            "bytes",
            [](const std::shared_ptr<Source>& self) {
                const Bytes bytes = self->bytes();
                const std::shared_ptr<const Source> owner = self;
                return view(owner, reinterpret_cast<const std::uint8_t*>(bytes.data()),
                            {static_cast<py::ssize_t>(bytes.size())});
            },
            "The bytes without a copy: (size,) uint8, read-only.")
        .def_property_readonly(
            "file", [](const Source& self) { return name_of_file(self.file()); }, "The file's name, or None.")
        .def_property_readonly(
            "is_mapped", [](const Source& self) { return self.is_mapped(); }, "Whether the bytes are a mapped file.")
        .def_property_readonly(
            "is_converted", [](const Source& self) { return converter::is_converted(self.bytes(), self.file()); },
            "Whether the bytes are to be converted to a bendy file, or else to be opened as one.")
        .def(
            "chunk_path",
            [](const Source& self, std::uint64_t offset) { return text(whole_chunk_path(self.bytes(), offset)); },
            py::arg("offset"), "The path of the chunk at an offset of the bytes.")
        .def(
            "write",
            [](const Source& self, const std::filesystem::path& file) {
                const auto written = [&] {
                    const py::gil_scoped_release released;
                    return write_file(file, self.bytes());
                }();
                if (!written) raise_os_error(written.error(), file);
            },
            py::arg("file"), "Writes the whole file or nothing: beside it, then renamed over it. Raises OSError.");
}

}  // namespace

py::str text(std::string_view utf8) {
    PyObject* decoded = PyUnicode_DecodeUTF8(utf8.data(), static_cast<Py_ssize_t>(utf8.size()), "replace");
    if (decoded == nullptr) throw py::error_already_set();
    return py::reinterpret_steal<py::str>(decoded);
}

py::object text_or_none(std::string_view utf8) {
    if (utf8.empty()) return py::none();
    return text(utf8);
}

py::object parse_json(std::string_view json) {
    if (json.empty()) return py::none();
    return py::module_::import("json").attr("loads")(text(json));
}

void raise_os_error(const Error& error, const std::filesystem::path& file) {
    const auto number = static_cast<int>(error.value);
    // OSError creates the subclass that belongs to the number.
    raise_object(py::reinterpret_borrow<py::object>(PyExc_OSError)(number, std::strerror(number), name_of_file(file)));
}

void raise_fault(const Error& error, const Source& source) {
    const ErrorClass kind = error_class(error.code);
    if (kind == ErrorClass::io) raise_os_error(error, source.file());
    const char* const name = kind == ErrorClass::malformed ? "MalformedError"
                             : kind == ErrorClass::invalid ? "InvalidError"
                                                           : "UnsupportedError";
    const auto errors = py::module_::import("bendy._errors");
    raise_object(errors.attr(name)(text(describe(error)), py::arg("code") = code_name(error.code),
                                   py::arg("path") = text(whole_chunk_path(source.bytes(), error.offset)),
                                   py::arg("offset") = error.offset, py::arg("file") = name_of_file(source.file())));
}

void raise(const char* name, const std::string& message, const char* code, const std::filesystem::path& file,
           const std::string& place) {
    const auto errors = py::module_::import("bendy._errors");
    raise_object(errors.attr(name)(text(message), py::arg("code") = code, py::arg("path") = text_or_none(place),
                                   py::arg("file") = name_of_file(file)));
}

}  // namespace bendy::python

PYBIND11_MODULE(_bendy, module) {
    namespace python = bendy::python;
    namespace py = pybind11;
    module.doc() = "Bindings of the C++ library; import bendy instead.";
    module.attr("__version__") = BENDY_VERSION;
    python::bind_source(module);
    py::module_ c = module.def_submodule("c", "The C API, bendy.h.");
    python::c::bind_made(c);
    module.def("floats", &python::floats, py::arg("numbers"), py::arg("shape"), py::arg("name"),
               "Finite float32 numbers of this shape, without gaps. Raises TypeError, ValueError.");
    python::bind_stored(module);
    python::bind_tools(module);
    python::bind_render(module);
}
