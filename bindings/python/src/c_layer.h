#pragma once

#include "bindings.h"

#include <bendy.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

// The C API in Python, module bendy._bendy.c: the building blocks of the functions that bindings/make_python.py makes
// from bendy.h. Handles free themselves, structs have attributes, arrays are numpy's, and errors are exceptions.
namespace bendy::python::c {

// Structs.

enum class Kind : std::uint8_t {
    u32,
    i32,
    u64,
    i64,
    size,
    f32,
    f64,
    u8,
    index,         ///< uint32_t; BENDY_NONE is None
    flag,          ///< uint32_t: True or False
    inverse_flag,  ///< negated in Python
    word,          ///< uint32_t of an enumeration
    text,          ///< const char*
    characters,    ///< zero-terminated, inside the struct
    pointer,       ///< to numbers owned by the library: a Pointer
    memory,        ///< floats of the caller: a float32 array
    reference,     ///< to a struct or handle of the caller
    nested,        ///< a struct in the struct
};

struct Layout;

struct FieldInfo {
    const char* name;
    const char* doc;
    std::size_t offset;
    Kind kind;
    Kind element = Kind::u8;                  ///< the type that a pointer points to
    std::size_t count = 0;                    ///< of an array; 0 for a single value
    std::span<const char* const> words = {};  ///< of an enumeration
    std::ptrdiff_t given = -1;                ///< index of has_NAME; if that is 0, the value is None
    const Layout* nested = nullptr;
    void* (*unwrap)(const py::handle&) = nullptr;  ///< returns the C pointer of a reference; null for another type
};

class Struct;

struct Layout {
    const char* name;
    const char* doc;
    std::span<const FieldInfo> fields;
    std::unique_ptr<Struct> (*make)();
};

/// A struct of C, and the objects that own the memory it points to.
class Struct {
public:
    Struct(const Layout& of, void* place) : layout(&of), data(static_cast<std::byte*>(place)) {}
    Struct(const Struct&) = delete;
    Struct& operator=(const Struct&) = delete;
    Struct(Struct&&) = delete;
    Struct& operator=(Struct&&) = delete;
    virtual ~Struct() = default;

    /// Sets fields in their order, or by name. Raises TypeError, ValueError.
    void set(const py::args& listed, const py::kwargs& given);

    const Layout* layout;
    std::byte* data;
    std::vector<py::object> held;
};

/// The description of S that make_python.py makes: a layout and initial values.
template <class S>
struct About;

template <class S>
class Of : public Struct {
public:
    Of() : Struct(About<S>::layout(), &value), value(About<S>::initial()) {}
    S value;
};

/// Numbers that the library owns. Only `array` trusts the caller about their count.
struct Pointer {
    py::object owner;
    const void* data;
    Kind element;

    [[nodiscard]] py::array array(const std::vector<py::ssize_t>& shape) const;
};

py::object read_field(const py::object& self, const FieldInfo& field);
void bind_base(py::module_& module);
void add_fields(const py::object& type, const Layout& layout);

template <class S>
void bind_struct(py::module_& module) {
    const Layout& layout = About<S>::layout();
    py::class_<Of<S>, Struct> type(module, layout.name, layout.doc);
    type.def(py::init([](const py::args& listed, const py::kwargs& given) {
        auto made = std::make_unique<Of<S>>();
        made->set(listed, given);
        return made;
    }));
    add_fields(type, layout);
}

template <class S>
std::unique_ptr<Struct> make_struct() {
    return std::make_unique<Of<S>>();
}

// Handles.

/// Owns an object of the C API. Functions that change or read it mark it as in use while they run.
class Object {
public:
    Object(void* owned, const char* kind) : pointer(owned), name(kind) {}
    Object(const Object&) = delete;
    Object& operator=(const Object&) = delete;
    Object(Object&&) = delete;
    Object& operator=(Object&&) = delete;
    virtual ~Object() = default;

    void* pointer;
    const char* name;
    std::vector<py::object> keeps;  ///< the objects that must outlive it
    // Read and written with the GIL held.
    std::thread::id writer;
    std::size_t uses = 0;
};

template <class H>
class Handle : public Object {
public:
    using Object::Object;
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    Handle(Handle&&) = delete;
    Handle& operator=(Handle&&) = delete;
    ~Handle() override { release(static_cast<H*>(pointer)); }
    static inline void (*release)(H*) = nullptr;
    static inline const char* kind = nullptr;
};

template <class H>
void bind_handle(py::module_& module, const char* name, const char* kind, const char* doc, void (*release)(H*)) {
    Handle<H>::release = release;
    Handle<H>::kind = kind;
    const py::class_<Handle<H>, Object> type(module, name, doc);
}

enum class Null : std::uint8_t { refused, allowed };

/// Raises TypeError: NAME must be a KIND.
[[noreturn]] void raise_type(const char* name, const char* kind);

/// The C object of an argument, in use until the call ends. Another thread that needs it meanwhile gets a RuntimeError.
class Use {
public:
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    Use(Use&&) = delete;
    Use& operator=(Use&&) = delete;
    ~Use();

protected:
    Use(Object* object, bool writes);
    Object* object_;

private:
    std::thread::id before_;
};

template <class H>
class Using : public Use {
public:
    Using(const py::handle& given, const char* name, Null null, bool writes)
        : Use(object_of(given, name, null), writes) {}
    [[nodiscard]] H* get() const { return object_ == nullptr ? nullptr : static_cast<H*>(object_->pointer); }

private:
    static Object* object_of(const py::handle& given, const char* name, Null null) {
        if (given.is_none() && null == Null::allowed) return nullptr;
        if (!py::isinstance<Handle<H>>(given)) raise_type(name, Handle<H>::kind);
        return given.cast<Handle<H>*>();
    }
};

/// Returns the model behind a handle: itself, or the first object that it keeps, or that object's; null if there is
/// none.
const bendy_model* model_of(py::handle given);

/// For structs of the caller that refer to one.
template <class H>
void* handle_pointer(const py::handle& given) {
    return py::isinstance<Handle<H>>(given) ? given.cast<Handle<H>*>()->pointer : nullptr;
}
template <class S>
void* struct_pointer(const py::handle& given) {
    return py::isinstance<Of<S>>(given) ? static_cast<void*>(&given.cast<Of<S>*>()->value) : nullptr;
}

/// Wraps a new object. \param keeps  the objects that it may refer to; a copy refers to what the original does
template <class H>
py::object own(H* made, std::initializer_list<py::object> keeps) {
    auto handle = std::make_unique<Handle<H>>(made, Handle<H>::kind);
    for (const py::object& one : keeps) {
        if (py::isinstance<Handle<H>>(one)) {
            handle->keeps = one.cast<Handle<H>*>()->keeps;
        } else {
            handle->keeps.push_back(one);
        }
    }
    return py::cast(std::move(handle));
}

// Arguments and results.

std::uint32_t index_argument(const py::handle& given, const char* name);
std::uint32_t word_argument(const py::handle& given, const char* name, std::span<const char* const> words);
float finite_float(double given, const char* name);
double finite_double(double given, const char* name);

/// Numbers that the function reads.
/// \param count  their number; 0: any
template <class T>
class Numbers {
public:
    using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;
    Numbers(const py::handle& given, const char* name, std::size_t count, Null null) {
        if (given.is_none() && null == Null::allowed) return;
        array_ = Array::ensure(given);
        if (!array_) {
            PyErr_Clear();
            throw py::type_error(std::string(name) + " must be numbers");
        }
        is_given_ = true;
        if (count != 0) check_size(count, name);
    }
    /// Raises ValueError for another number of numbers, if any are given.
    void check_size(std::size_t count, const char* name) const {
        if (is_given_ && size() != count)
            throw py::value_error(std::string(name) + " must have the shape (" + std::to_string(count) + ",)");
    }
    [[nodiscard]] std::size_t size() const { return is_given_ ? static_cast<std::size_t>(array_.size()) : 0; }
    [[nodiscard]] bool is_given() const { return is_given_; }
    [[nodiscard]] const T* get() const { return is_given_ ? array_.data() : nullptr; }

private:
    Array array_{0};
    bool is_given_ = false;
};

/// Memory of the caller that the function fills: an array of exactly this type, without gaps.
template <class T>
class Memory {
public:
    Memory(const py::handle& given, const char* name, Null null) {
        if (given.is_none() && null == Null::allowed) return;
        if (!py::isinstance<py::array_t<T, py::array::c_style>>(given)) {
            throw py::type_error(std::string(name) + " must be an array of " +
                                 std::string(py::str(py::dtype::of<T>())) + " without gaps");
        }
        auto array = py::reinterpret_borrow<py::array_t<T>>(given);
        if (!array.writeable()) throw py::value_error(std::string(name) + " is read-only");
        size_ = static_cast<std::size_t>(array.size());
        data_ = array.mutable_data();
        is_given_ = true;
    }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool is_given() const { return is_given_; }
    [[nodiscard]] T* get() const { return data_; }

private:
    T* data_ = nullptr;
    std::size_t size_ = 0;
    bool is_given_ = false;
};

/// Numbers that the function fills; their count is fixed.
template <class T>
class Fresh {
public:
    explicit Fresh(std::size_t count) : array(static_cast<py::ssize_t>(count)) {}
    [[nodiscard]] T* get() { return array.mutable_data(); }
    py::array_t<T> array;
};

/// A struct that the function reads.
template <class S>
class In {
public:
    In(const py::handle& given, const char* name, Null null) {
        if (given.is_none() && null == Null::allowed) return;
        pointer_ = static_cast<S*>(struct_pointer<S>(given));
        if (pointer_ == nullptr) raise_type(name, About<S>::layout().name);
    }
    [[nodiscard]] const S* get() const { return pointer_; }

private:
    S* pointer_ = nullptr;
};

/// A struct that the function fills: the caller's, or a new one.
/// \param held  objects that own the memory it will point to
template <class S>
class Out {
public:
    Out(const py::handle& given, const char* name, std::initializer_list<py::object> held) {
        object = given.is_none() ? py::cast(std::make_unique<Of<S>>()) : py::reinterpret_borrow<py::object>(given);
        if (!py::isinstance<Of<S>>(object)) raise_type(name, About<S>::layout().name);
        auto* const filled = object.cast<Of<S>*>();
        filled->held = held;
        pointer_ = &filled->value;
    }
    [[nodiscard]] S* get() { return pointer_; }
    py::object object;

private:
    S* pointer_;
};

/// Several structs that the function reads, contiguous.
template <class S>
class InList {
public:
    InList(const py::handle& given, const char* name) {
        for (const auto& one : py::reinterpret_borrow<py::object>(given)) {
            const auto* pointer = static_cast<const S*>(struct_pointer<S>(one));
            if (pointer == nullptr) raise_type(name, About<S>::layout().name);
            list_.push_back(*pointer);
            held_.push_back(py::reinterpret_borrow<py::object>(one));
        }
    }
    [[nodiscard]] std::size_t size() const { return list_.size(); }
    [[nodiscard]] static bool is_given() { return true; }
    [[nodiscard]] const S* get() const { return list_.data(); }

private:
    std::vector<S> list_;
    std::vector<py::object> held_;
};

/// Several structs that the function fills. \param given  the caller's, or None for new ones
template <class S>
class OutList {
public:
    OutList(const py::handle& given, const char* name, std::size_t count)
        : list_(count, About<S>::initial()),
          objects_(given.is_none() ? py::list() : py::list(py::reinterpret_borrow<py::object>(given))) {
        if (given.is_none()) {
            for (std::size_t k = 0; k < count; ++k) objects_.append(py::cast(std::make_unique<Of<S>>()));
        }
        if (objects_.size() != count) throw py::value_error(std::string(name) + " must have one for each");
        for (const auto& one : objects_) {
            if (struct_pointer<S>(one) == nullptr) raise_type(name, About<S>::layout().name);
        }
    }
    [[nodiscard]] S* get() { return list_.data(); }
    /// After the call.
    py::object objects() {
        for (std::size_t k = 0; k < list_.size(); ++k) *static_cast<S*>(struct_pointer<S>(objects_[k])) = list_[k];
        return objects_;
    }

private:
    std::vector<S> list_;
    py::list objects_;
};

/// Bytes that the function reads.
class Buffer {
public:
    explicit Buffer(const py::object& given);
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    Buffer(Buffer&&) = delete;
    Buffer& operator=(Buffer&&) = delete;
    ~Buffer() { PyBuffer_Release(&view_); }
    [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(view_.len); }
    [[nodiscard]] static bool is_given() { return true; }
    [[nodiscard]] const void* get() const { return view_.buf; }

private:
    Py_buffer view_{};
};

/// The number of elements that the arrays have room for: the smallest of those given. A width is the count of numbers
/// in one element. Raises ValueError if an array ends within an element.
struct Room {
    std::size_t size;
    std::size_t width;
    bool is_given;
    const char* name;
};
std::size_t room_of(std::initializer_list<Room> arrays);
template <class Array>
Room room(const Array& array, std::size_t width, const char* name) {
    return {array.size(), width, array.is_given(), name};
}

/// The error of a call.
class Failure {
public:
    [[nodiscard]] bendy_error* get() { return &error_; }
    /// Raises the exception of the status, if the call has failed.
    void check() const {
        if (error_.status != BENDY_OK) raise_it();
    }

private:
    [[noreturn]] void raise_it() const;
    bendy_error error_ = BENDY_ERROR_INIT;
};

/// Calls without the GIL.
template <class Work>
auto released(const Work& work) {
    const py::gil_scoped_release release;
    return work();
}

py::object text_result(const char* given);
py::object index_result(std::uint32_t number);
/// Returns an array of `count` numbers if `count` is known, otherwise a Pointer; None for NULL.
py::object pointer_result(const py::object& owner, const void* data, Kind element);
py::object array_result(const py::object& owner, const void* data, Kind element, std::size_t count);

/// Made by make_python.py.
void bind_made(py::module_& module);

}  // namespace bendy::python::c
