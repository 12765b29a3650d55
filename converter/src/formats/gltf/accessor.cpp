#include "accessor.h"

#include "scene/failure.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>

namespace bendy::converter::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "the loads below copy glTF's little-endian numbers");

template <class T>
double load_as(const std::byte* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return static_cast<double>(value);
}

/// Loads one component; a double holds every component type exactly.
double load(const std::byte* from, int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return load_as<std::int8_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load_as<std::uint8_t>(from);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return load_as<std::int16_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load_as<std::uint16_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load_as<std::uint32_t>(from);
        default:
            return load_as<float>(from);
    }
}

/// The layout of an element's components. Columns of matrices start on 4-byte boundaries.
struct Layout {
    std::size_t component = 0;  ///< bytes
    std::size_t rows = 0;
    std::size_t columns = 0;
    std::size_t column_stride = 0;  ///< bytes
    std::size_t size = 0;           ///< bytes per element
};

Layout layout_of(const tinygltf::Accessor& accessor) {
    Layout layout;
    layout.component = component_size(accessor.componentType);
    layout.columns = accessor.type == TINYGLTF_TYPE_MAT2   ? 2
                     : accessor.type == TINYGLTF_TYPE_MAT3 ? 3
                     : accessor.type == TINYGLTF_TYPE_MAT4 ? 4
                                                           : 1;
    layout.rows = component_count(accessor) / layout.columns;
    layout.column_stride = layout.rows * layout.component;
    if (layout.columns > 1) layout.column_stride = (layout.column_stride + 3) / 4 * 4;
    layout.size = layout.column_stride * layout.columns;
    return layout;
}

/// The elements of one accessor, or of its sparse values, in a view.
struct Elements {
    std::span<const std::byte> bytes;  ///< from the first element
    std::size_t stride = 0;
};

/// Checks that `count` elements fit into the view from `offset` on. `what` begins the error message.
Elements elements_in(const Document& document, std::size_t view, std::uint64_t offset, std::uint64_t count,
                     std::size_t size, std::size_t stride, const std::string& place, const std::string& what) {
    const auto bytes = document.buffers.view(view, document.budget);
    if (stride < size) {
        fail(place, what + ": the byteStride of " + at("bufferViews", view) + " is " + std::to_string(stride) +
                        ", smaller than an element of " + std::to_string(size) + " bytes");
    }
    const std::uint64_t available = bytes.size();
    if (offset > available || size > available - offset || count - 1 > (available - offset - size) / stride) {
        fail(place, what + ": " + std::to_string(count) + " elements of " + std::to_string(size) + " bytes from byte " +
                        std::to_string(offset) + " on exceed " + at("bufferViews", view) + " of " +
                        std::to_string(available) + " bytes");
    }
    return {bytes.subspan(static_cast<std::size_t>(offset)), stride};
}

/// Decodes an accessor: `convert(component, element)` converts each component to an Out.
template <class Out, class Convert>
std::vector<Out> decode(const Document& document, std::size_t index, const std::string& place, const Convert& convert) {
    const tinygltf::Accessor& accessor = document.model.accessors[index];
    const std::string what = at("accessors", index);
    const Layout layout = layout_of(accessor);
    const std::size_t components = component_count(accessor);
    const auto count = static_cast<std::uint64_t>(accessor.count);

    Elements base;
    if (accessor.bufferView >= 0) {
        const auto view = static_cast<std::size_t>(accessor.bufferView);
        base = elements_in(document, view, accessor.byteOffset, count, layout.size,
                           document.buffers.stride(view).value_or(layout.size), place, what);
    } else {
        const auto sparse = accessor.sparse.isSparse ? static_cast<std::uint64_t>(accessor.sparse.count) : 0;
        const std::uint64_t most = std::max(kMaxImpliedElements, document.budget.source_bytes());
        if (count > sparse && count - sparse > most) {
            fail(place, what + ": " + std::to_string(count - sparse) + " elements without stored data, at most " +
                            std::to_string(most) + " are accepted");
        }
    }
    document.budget.take(count, components * sizeof(Out), place);
    std::vector<Out> values(static_cast<std::size_t>(count) * components, Out{});

    const auto write = [&](const Elements& elements, std::size_t from, std::size_t to) {
        const std::byte* element = elements.bytes.data() + from * elements.stride;
        Out* out = values.data() + to * components;
        for (std::size_t column = 0; column < layout.columns; ++column) {
            for (std::size_t row = 0; row < layout.rows; ++row) {
                const std::byte* component = element + column * layout.column_stride + row * layout.component;
                *out++ = convert(load(component, accessor.componentType), to);
            }
        }
    };
    if (accessor.bufferView >= 0) {
        for (std::size_t i = 0; i < accessor.count; ++i) write(base, i, i);
    }
    if (accessor.sparse.isSparse) {
        const auto& sparse = accessor.sparse;
        const auto sparse_count = static_cast<std::size_t>(sparse.count);
        if (sparse_count > count) fail(place, what + ".sparse: more values than the accessor has elements");
        const std::size_t index_size = component_size(sparse.indices.componentType);
        const auto indices = elements_in(document, static_cast<std::size_t>(sparse.indices.bufferView),
                                         static_cast<std::uint64_t>(sparse.indices.byteOffset), sparse_count,
                                         index_size, index_size, place, what + ".sparse.indices");
        const auto replacements = elements_in(document, static_cast<std::size_t>(sparse.values.bufferView),
                                              static_cast<std::uint64_t>(sparse.values.byteOffset), sparse_count,
                                              layout.size, layout.size, place, what + ".sparse.values");
        for (std::size_t i = 0; i < sparse_count; ++i) {
            const auto to =
                static_cast<std::size_t>(load(indices.bytes.data() + i * index_size, sparse.indices.componentType));
            if (to >= count) {
                fail(place, what + ".sparse.indices: index " + std::to_string(to) + " is out of range (" +
                                std::to_string(count) + " elements)");
            }
            write(replacements, i, to);
        }
    }
    return values;
}

}  // namespace

std::size_t component_count(const tinygltf::Accessor& accessor) {
    return static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
}

std::size_t component_size(int component_type) {
    return static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type)));
}

double normalised(double value, int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return std::max(value / 127.0, -1.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return value / 255.0;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return std::max(value / 32767.0, -1.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return value / 65535.0;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return value / 4294967295.0;
        default:
            return value;
    }
}

namespace {

/// All elements as floats; with `nans`, NaN is counted and becomes 0.
std::vector<float> read_finite(const Document& document, std::size_t index, const std::string& place,
                               std::uint64_t* nans) {
    const tinygltf::Accessor& accessor = document.model.accessors[index];
    return decode<float>(document, index, place, [&](double value, std::size_t element) {
        if (nans != nullptr && std::isnan(value)) {
            ++*nans;
            return 0.0f;
        }
        if (!std::isfinite(value)) {
            fail(place, at("accessors", index) + ", element " + std::to_string(element) + ": " +
                            (std::isnan(value) ? "NaN" : "infinity") + " is not a finite number");
        }
        return static_cast<float>(accessor.normalized ? normalised(value, accessor.componentType) : value);
    });
}

}  // namespace

std::vector<float> read_floats(const Document& document, std::size_t index, const std::string& place) {
    return read_finite(document, index, place, nullptr);
}

std::vector<float> read_floats_or_zero(const Document& document, std::size_t index, const std::string& place) {
    std::uint64_t nans = 0;
    std::vector<float> values = read_finite(document, index, place, &nans);
    if (nans > 0) document.report.warn("NaN replaced by 0", place, nans);
    return values;
}

std::vector<std::uint32_t> read_unsigned(const Document& document, std::size_t index, const std::string& place) {
    return decode<std::uint32_t>(document, index, place, [&](double value, std::size_t element) {
        if (!(value >= 0.0 && value <= 4294967295.0) || value != std::floor(value)) {
            fail(place, at("accessors", index) + ", element " + std::to_string(element) + ": an index cannot be " +
                            std::to_string(value));
        }
        return static_cast<std::uint32_t>(value);
    });
}

}  // namespace bendy::converter::gltf
