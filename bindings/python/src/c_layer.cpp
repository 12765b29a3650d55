#include "c_layer.h"

#include <algorithm>
#include <cstring>

namespace bendy::python::c {
namespace {

template <class T>
T number_at(const std::byte* place) {
    T number;
    std::memcpy(&number, place, sizeof number);
    return number;
}

template <class T>
void put_number(std::byte* place, T number) {
    std::memcpy(place, &number, sizeof number);
}

std::size_t size_of(Kind kind) {
    switch (kind) {
        case Kind::u8:
            return 1;
        case Kind::u64:
        case Kind::i64:
        case Kind::size:
        case Kind::f64:
            return sizeof(std::uint64_t);
        default:
            return sizeof(std::uint32_t);
    }
}

py::dtype dtype_of(Kind kind) {
    switch (kind) {
        case Kind::f32:
            return py::dtype::of<float>();
        case Kind::f64:
            return py::dtype::of<double>();
        case Kind::u8:
            return py::dtype::of<std::uint8_t>();
        default:
            return py::dtype::of<std::uint32_t>();
    }
}

py::object read_one(const std::byte* place, const FieldInfo& field) {
    switch (field.kind) {
        case Kind::i32:
            return py::int_(number_at<std::int32_t>(place));
        case Kind::u64:
            return py::int_(number_at<std::uint64_t>(place));
        case Kind::i64:
            return py::int_(number_at<std::int64_t>(place));
        case Kind::size:
            return py::int_(number_at<std::size_t>(place));
        case Kind::f32:
            return py::float_(number_at<float>(place));
        case Kind::f64:
            return py::float_(number_at<double>(place));
        case Kind::index:
            return index_result(number_at<std::uint32_t>(place));
        case Kind::flag:
            return py::bool_(number_at<std::uint32_t>(place) != 0);
        case Kind::inverse_flag:
            return py::bool_(number_at<std::uint32_t>(place) == 0);
        case Kind::word: {
            const auto value = number_at<std::uint32_t>(place);
            if (value < field.words.size()) return py::str(field.words[value]);
            return py::int_(value);
        }
        case Kind::text:
            return text_result(number_at<const char*>(place));
        case Kind::characters:
            return text(reinterpret_cast<const char*>(place));  // NOLINT(*-reinterpret-cast): chars of the struct
        default:
            return py::int_(number_at<std::uint32_t>(place));
    }
}

std::string named(const FieldInfo& field, const char* what) {
    return std::string(field.name) + what;
}

/// Converts the value to a number of type T. Raises TypeError, and ValueError for a value that does not fit.
template <class T>
T integer(const py::handle& given, const char* name) {
    const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
    if (!number) {
        PyErr_Clear();
        throw py::type_error(std::string(name) + " must be a whole number");
    }
    try {
        return number.cast<T>();
    } catch (const py::cast_error&) {
        throw py::value_error(std::string(name) + " is out of range");
    }
}

double real(const py::handle& given, const char* name) {
    const double number = PyFloat_AsDouble(given.ptr());
    if (number == -1.0 && PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        throw py::type_error(std::string(name) + " must be a number");
    }
    return number;
}

/// \return nothing if the kind is not a number
void write_one(std::byte* place, const FieldInfo& field, const py::handle& value) {
    switch (field.kind) {
        case Kind::f32:
            return put_number(place, static_cast<float>(real(value, field.name)));
        case Kind::f64:
            return put_number(place, real(value, field.name));
        case Kind::i32:
            return put_number(place, integer<std::int32_t>(value, field.name));
        case Kind::u64:
            return put_number(place, integer<std::uint64_t>(value, field.name));
        case Kind::i64:
            return put_number(place, integer<std::int64_t>(value, field.name));
        case Kind::size:
            return put_number(place, integer<std::size_t>(value, field.name));
        case Kind::flag:
        case Kind::inverse_flag: {
            const int is_true = PyObject_IsTrue(value.ptr());
            if (is_true < 0) throw py::error_already_set();
            return put_number<std::uint32_t>(place, (is_true != 0) == (field.kind == Kind::flag) ? 1 : 0);
        }
        case Kind::index:
            return put_number(place, index_argument(value, field.name));
        case Kind::word:
            return put_number(place, word_argument(value, field.name, field.words));
        case Kind::u32:
            return put_number(place, integer<std::uint32_t>(value, field.name));
        default:
            throw py::type_error(named(field, " cannot be given"));
    }
}

/// Returns the items of an array in a struct.
void write_array(std::byte* place, const FieldInfo& field, const py::handle& value) {
    const auto list = py::reinterpret_steal<py::object>(PySequence_Tuple(value.ptr()));
    if (!list) {
        PyErr_Clear();
        throw py::type_error(named(field, " must be numbers"));
    }
    const auto items = py::reinterpret_borrow<py::tuple>(list);
    if (items.size() != field.count)
        throw py::value_error(named(field, " must have the shape (") + std::to_string(field.count) + ",)");
    for (const auto& item : items) {
        write_one(place, field, item);
        place += size_of(field.kind);
    }
}

void write_pointer(Struct& self, const FieldInfo& field, const py::object& value) {
    void* pointer = nullptr;
    if (field.kind == Kind::memory) {
        if (!value.is_none()) {
            if (!py::isinstance<py::array_t<float>>(value))
                throw py::type_error(named(field, " must be a float32 array"));
            auto array = py::reinterpret_borrow<py::array>(value);
            if (!array.writeable()) throw py::value_error(named(field, " is read-only"));
            pointer = array.mutable_data();
        }
    } else if (!value.is_none()) {
        pointer = field.unwrap(value);
        if (pointer == nullptr) throw py::type_error(named(field, " is of the wrong type"));
    }
    put_number(self.data + field.offset, pointer);
    self.held.push_back(value);
}

void set_field(Struct& self, const FieldInfo& field, const py::handle& value) {
    std::byte* const place = self.data + field.offset;
    if (field.given >= 0) put_number<std::uint32_t>(self.data + field.given, value.is_none() ? 0 : 1);
    if (field.given >= 0 && value.is_none()) return;
    if (field.kind == Kind::memory || field.kind == Kind::reference) {
        write_pointer(self, field, py::reinterpret_borrow<py::object>(value));
    } else if (field.count != 0) {
        write_array(place, field, value);
    } else {
        write_one(place, field, value);
    }
}

}  // namespace

void Struct::set(const py::args& listed, const py::kwargs& given) {
    if (listed.size() > layout->fields.size()) throw py::type_error(std::string(layout->name) + " has fewer fields");
    for (std::size_t k = 0; k < listed.size(); ++k) set_field(*this, layout->fields[k], listed[k]);
    for (const auto& [key, value] : given) {
        const auto found =
            std::find_if(layout->fields.begin(), layout->fields.end(), [key = key](const FieldInfo& field) {
                return PyUnicode_CompareWithASCIIString(key.ptr(), field.name) == 0;
            });
        if (found == layout->fields.end()) {
            throw py::type_error(std::string(layout->name) + " has no field " + py::str(key).cast<std::string>());
        }
        set_field(*this, *found, value);
    }
}

py::object read_field(const py::object& self, const FieldInfo& field) {
    auto& of = self.cast<Struct&>();
    const std::byte* const place = of.data + field.offset;
    if (field.given >= 0 && number_at<std::uint32_t>(of.data + field.given) == 0) return py::none();
    if (field.kind == Kind::nested) {
        std::unique_ptr<Struct> made = field.nested->make();
        std::memcpy(made->data, place, field.count);
        made->held = of.held;
        return py::cast(std::move(made));
    }
    if (field.kind == Kind::pointer) return pointer_result(self, number_at<const void*>(place), field.element);
    if (field.kind == Kind::memory || field.kind == Kind::reference)
        return py::bool_(number_at<const void*>(place) != nullptr);
    if (field.count == 0 || field.kind == Kind::characters) return read_one(place, field);
    py::tuple items(field.count);
    for (std::size_t k = 0; k < field.count; ++k) items[k] = read_one(place + k * size_of(field.kind), field);
    return items;
}

void add_fields(const py::object& type, const Layout& layout) {
    const auto property = py::reinterpret_borrow<py::object>(reinterpret_cast<PyObject*>(&PyProperty_Type));  // NOLINT
    for (const FieldInfo& field : layout.fields) {
        const py::cpp_function get([&field](const py::object& self) { return read_field(self, field); });
        type.attr(field.name) = property(get, py::none(), py::none(), field.doc);
    }
}

py::array Pointer::array(const std::vector<py::ssize_t>& shape) const {
    py::array made(dtype_of(element), shape, data, owner);
    made.attr("setflags")(py::arg("write") = false);
    return made;
}

void bind_base(py::module_& module) {
    py::class_<Struct>(module, "Struct", "A struct of the C API.").def("__repr__", [](const py::object& self) {
        py::list fields;
        for (const FieldInfo& field : self.cast<const Struct&>().layout->fields)
            fields.append(py::str("{}={!r}").format(field.name, read_field(self, field)));
        return py::str("{}({})").format(py::type::of(self).attr("__name__"), py::str(", ").attr("join")(fields));
    });
    const py::class_<Object> handle(module, "Handle", "An object of the C API.");
    py::class_<Pointer>(module, "Pointer", "Numbers that the library owns.")
        .def(
            "array",
            [](const Pointer& self, const py::args& shape) {
                return self.array(shape.cast<std::vector<py::ssize_t>>());
            },
            "A read-only view of as many as the shape has: how many there are is up to the caller.");
}

void raise_type(const char* name, const char* kind) {
    throw py::type_error(std::string(name) + " must be a " + kind);
}

Use::Use(Object* object, bool writes) : object_(object) {
    if (object == nullptr) return;
    const std::thread::id none;
    const std::thread::id mine = std::this_thread::get_id();
    before_ = object->writer;
    if ((object->writer != none && object->writer != mine) || (writes && object->uses > 0 && object->writer != mine)) {
        object_ = nullptr;
        throw std::runtime_error("the " + std::string(object->name) +
                                 " is in use by another thread: give each thread its own");
    }
    if (writes) object->writer = mine;
    ++object->uses;
}

Use::~Use() {
    if (object_ == nullptr) return;
    object_->writer = before_;
    --object_->uses;
}

const bendy_model* model_of(py::handle given) {
    while (py::isinstance<Object>(given)) {
        const auto* const object = given.cast<Object*>();
        if (py::isinstance<Handle<bendy_model>>(given)) return static_cast<bendy_model*>(object->pointer);
        if (object->keeps.empty()) return nullptr;
        given = object->keeps.front();
    }
    return nullptr;
}

std::uint32_t index_argument(const py::handle& given, const char* name) {
    if (given.is_none()) return BENDY_NONE;
    return integer<std::uint32_t>(given, name);
}

std::uint32_t word_argument(const py::handle& given, const char* name, std::span<const char* const> words) {
    if (!py::isinstance<py::str>(given)) return integer<std::uint32_t>(given, name);
    for (std::size_t k = 0; k < words.size(); ++k) {
        if (PyUnicode_CompareWithASCIIString(given.ptr(), words[k]) == 0) return static_cast<std::uint32_t>(k);
    }
    std::string all;
    for (const char* const word : words) all += (all.empty() ? "" : ", ") + std::string(word);
    throw py::value_error(std::string(name) + " must be one of: " + all);
}

double finite_double(double given, const char* name) {
    if (!std::isfinite(given)) throw py::value_error(std::string(name) + " must be a finite number");
    return given;
}

float finite_float(double given, const char* name) {
    const auto number = static_cast<float>(given);
    if (!std::isfinite(number)) throw py::value_error(std::string(name) + " must be a finite number");
    return number;
}

Buffer::Buffer(const py::object& given) {
    if (PyObject_GetBuffer(given.ptr(), &view_, PyBUF_C_CONTIGUOUS) != 0) throw py::error_already_set();
}

std::size_t room_of(std::initializer_list<Room> arrays) {
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (const Room& array : arrays) {
        if (!array.is_given) continue;
        if (array.size % array.width != 0) {
            throw py::value_error(std::string(array.name) + " must have " + std::to_string(array.width) +
                                  " numbers for each");
        }
        least = std::min(least, array.size / array.width);
    }
    return least == std::numeric_limits<std::size_t>::max() ? 0 : least;
}

void Failure::raise_it() const {
    const py::str message = text(error_.message);
    PyObject* const type_of_call = error_.status == BENDY_BAD_ARGUMENT    ? PyExc_ValueError
                                   : error_.status == BENDY_NOT_FOUND     ? PyExc_KeyError
                                   : error_.status == BENDY_OUT_OF_MEMORY ? PyExc_MemoryError
                                   : error_.status == BENDY_IO            ? PyExc_OSError
                                                                          : nullptr;
    if (type_of_call != nullptr) {
        PyErr_SetObject(type_of_call, message.ptr());
        throw py::error_already_set();
    }
    const char* const name = error_.status == BENDY_MALFORMED ? "MalformedError"
                             : error_.status == BENDY_INVALID ? "InvalidError"
                                                              : "UnsupportedError";
    const py::object type = py::module_::import("bendy._errors").attr(name);
    const py::object made = type(message, py::arg("code") = error_.code, py::arg("offset") = error_.offset);
    PyErr_SetObject(type.ptr(), made.ptr());
    throw py::error_already_set();
}

py::object text_result(const char* given) {
    if (given == nullptr) return py::none();
    return text(given);
}

py::object index_result(std::uint32_t number) {
    if (number == BENDY_NONE) return py::none();
    return py::int_(number);
}

py::object pointer_result(const py::object& owner, const void* data, Kind element) {
    if (data == nullptr) return py::none();
    return py::cast(Pointer{owner, data, element});
}

py::object array_result(const py::object& owner, const void* data, Kind element, std::size_t count) {
    return Pointer{owner, data, element}.array({static_cast<py::ssize_t>(count)});
}

}  // namespace bendy::python::c
