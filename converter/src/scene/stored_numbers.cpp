#include "scene/stored_numbers.h"

#include "scene/frame_shapes.h"

#include <bendy/format/charconv.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>

namespace bendy::converter {
namespace {

template <class T>
void append(std::vector<std::byte>& bytes, T value) {
    const auto pieces = bit_cast<std::array<std::byte, sizeof(T)>>(value);
    bytes.insert(bytes.end(), pieces.begin(), pieces.end());
}

template <class T>
std::vector<std::byte> as_integers(std::span<const std::uint32_t> values) {
    std::vector<std::byte> bytes;
    bytes.reserve(values.size() * sizeof(T));
    for (const std::uint32_t value : values) append(bytes, static_cast<T>(value));
    return bytes;
}

/// Fills `bytes` and returns true if every value is a multiple of 1 / largest(T).
template <class T>
bool as_fractions(std::span<const float> values, std::vector<std::byte>& bytes) {
    constexpr float kLargest = std::numeric_limits<T>::max();
    bytes.clear();
    bytes.reserve(values.size() * sizeof(T));
    for (const float value : values) {
        if (!(value >= 0.0f && value <= 1.0f)) return false;
        const auto steps = static_cast<T>(std::lround(value * kLargest));
        if (bit_cast<std::uint32_t>(static_cast<float>(steps) / kLargest) != bit_cast<std::uint32_t>(value))
            return false;
        append(bytes, steps);
    }
    return true;
}

}  // namespace

StoredNumbers smallest_exact_fractions(std::span<const float> values) {
    std::vector<std::byte> bytes;
    if (as_fractions<std::uint8_t>(values, bytes)) return {ComponentType::u8, true, std::move(bytes)};
    if (as_fractions<std::uint16_t>(values, bytes)) return {ComponentType::u16, true, std::move(bytes)};
    return {ComponentType::f32, false, std::as_bytes(values)};
}

StoredNumbers smallest_exact_indices(std::span<const std::uint32_t> values, std::uint64_t count, bool allow_bytes) {
    if (allow_bytes && count <= 0x100) return {ComponentType::u8, false, as_integers<std::uint8_t>(values)};
    if (count <= 0x10000) return {ComponentType::u16, false, as_integers<std::uint16_t>(values)};
    return {ComponentType::u32, false, std::as_bytes(values)};
}

namespace {

using Steps = std::array<std::uint16_t, 3>;

/// The smallest number of steps that gives the value exactly; otherwise the nearest one.
std::uint16_t steps_to(float value, float minimum, float step) {
    constexpr double kMost = 65535.0;
    if (step == 0.0f) return 0;
    const double nearest = std::clamp(std::round((double{value} - minimum) / step), 0.0, kMost);
    for (const double more : {-1.0, 0.0, 1.0}) {
        const double steps = nearest + more;
        if (steps < 0.0 || steps > kMost) continue;
        const float moved = step * static_cast<float>(steps);  // two statements: rounded in between
        if (minimum + moved == value) return static_cast<std::uint16_t>(steps);
    }
    return static_cast<std::uint16_t>(nearest);
}

std::vector<Steps> steps_of(const std::vector<glm::vec3>& positions, const FrameGrid& grid) {
    std::vector<Steps> steps;
    steps.reserve(positions.size());
    for (const glm::vec3& position : positions) {
        Steps& made = steps.emplace_back();
        for (int axis = 0; axis < 3; ++axis)
            made[static_cast<std::size_t>(axis)] = steps_to(position[axis], grid.minimum[axis], grid.step[axis]);
    }
    return steps;
}

void add_boxes(const FrameGrid& grid, std::vector<StreamBox>& boxes) {
    for (int axis = 0; axis < 3; ++axis) boxes.push_back({grid.minimum[axis], grid.step[axis]});
}

/// As u8 if all numbers fit, otherwise u16.
StoredStream to_stream(std::span<const Steps> steps, Numbers numbers) {
    StoredStream stream;
    stream.numbers = numbers;
    stream.components = 3;
    const bool fits = std::all_of(steps.begin(), steps.end(), [](const Steps& s) {
        return std::all_of(s.begin(), s.end(), [](std::uint16_t number) { return number <= 0xff; });
    });
    stream.type = fits ? ComponentType::u8 : ComponentType::u16;
    for (const Steps& element : steps) {
        for (const std::uint16_t number : element) {
            stream.bytes.push_back(static_cast<std::byte>(number & 0xff));
            if (!fits) stream.bytes.push_back(static_cast<std::byte>(number >> 8));
        }
    }
    return stream;
}

StoredStream to_stream(std::vector<std::byte> numbers) {
    StoredStream stream;
    stream.numbers = Numbers::listed;
    stream.components = 1;
    stream.bytes = std::move(numbers);
    return stream;
}

/// The distinct normals of a mesh's frames, by first use, then those of the mesh itself, if all fit.
class NormalList {
public:
    explicit NormalList(const Mesh& mesh) {
        for (const MorphTarget& target : mesh.targets) {
            if (target.is_frame) add(target.normals);
        }
        const std::size_t of_frames = list_.size();
        holds_own_ = add(mesh.normals);
        if (holds_own_) return;
        for (std::size_t k = of_frames; k < list_.size(); ++k) numbers_.erase(bits_of(list_[k]));
        list_.resize(of_frames);
    }

    [[nodiscard]] const std::vector<glm::vec3>& list() const { return list_; }
    [[nodiscard]] bool holds_own() const { return holds_own_; }
    [[nodiscard]] std::byte number_of(const glm::vec3& normal) const {
        const auto known = numbers_.find(bits_of(normal));
        if (known != numbers_.end()) return static_cast<std::byte>(known->second);
        const auto nearer = [&](const glm::vec3& a, const glm::vec3& b) {
            return glm::dot(a, normal) < glm::dot(b, normal);
        };
        return static_cast<std::byte>(std::max_element(list_.begin(), list_.end(), nearer) - list_.begin());
    }
    [[nodiscard]] std::vector<std::byte> numbers_of(const std::vector<glm::vec3>& normals) const {
        std::vector<std::byte> numbers;
        numbers.reserve(normals.size());
        for (const glm::vec3& normal : normals) numbers.push_back(number_of(normal));
        return numbers;
    }

private:
    using Bits = std::array<std::uint32_t, 3>;
    static Bits bits_of(const glm::vec3& v) {
        return {bit_cast<std::uint32_t>(v.x), bit_cast<std::uint32_t>(v.y), bit_cast<std::uint32_t>(v.z)};
    }

    /// False if they do not all fit.
    bool add(const std::vector<glm::vec3>& normals) {
        constexpr std::size_t kMost = 256;
        for (const glm::vec3& normal : normals) {
            if (numbers_.contains(bits_of(normal))) continue;
            if (list_.size() == kMost) return false;
            numbers_.emplace(bits_of(normal), list_.size());
            list_.push_back(normal);
        }
        return true;
    }

    std::vector<glm::vec3> list_;
    std::map<Bits, std::size_t> numbers_;
    bool holds_own_ = false;
};

/// The data of a vertex in all frames, vertex after vertex.
struct Columns {
    std::vector<std::byte> bytes;
    std::size_t width = 0;

    [[nodiscard]] int compare(std::uint32_t a, std::uint32_t b) const {
        return width == 0 ? 0 : std::memcmp(bytes.data() + a * width, bytes.data() + b * width, width);
    }
};

Columns columns_of(std::span<const std::vector<Steps>> steps, std::span<const std::vector<std::byte>> normals,
                   std::size_t vertices) {
    Columns columns;
    columns.width = steps.size() * sizeof(Steps) + normals.size();
    columns.bytes.reserve(columns.width * vertices);
    for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
        for (const std::vector<Steps>& frame : steps) {
            const auto bytes = std::as_bytes(std::span(frame[vertex]));
            columns.bytes.insert(columns.bytes.end(), bytes.begin(), bytes.end());
        }
        for (const std::vector<std::byte>& frame : normals) columns.bytes.push_back(frame[vertex]);
    }
    return columns;
}

/// Numbers distinct columns by first use.
std::vector<std::uint32_t> number_places(const Columns& columns, std::size_t vertices) {
    std::vector<std::uint32_t> order(vertices);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const int sign = columns.compare(a, b);
        return sign != 0 ? sign < 0 : a < b;
    });
    std::vector<std::uint32_t> first_of(vertices);  // the first identical vertex
    for (std::size_t k = 0; k < vertices; ++k) {
        const bool is_alike = k != 0 && columns.compare(order[k - 1], order[k]) == 0;
        first_of[order[k]] = is_alike ? first_of[order[k - 1]] : order[k];
    }
    std::vector<std::uint32_t> places(vertices);
    std::uint32_t next = 0;
    for (std::size_t vertex = 0; vertex < vertices; ++vertex)
        places[vertex] = first_of[vertex] == vertex ? next++ : places[first_of[vertex]];
    return places;
}

StoredFrames store_frames(const Mesh& mesh, const NormalList& list) {
    StoredFrames stored;
    std::vector<std::vector<Steps>> steps;
    std::vector<std::vector<std::byte>> normals;
    bool is_named = false;
    bool has_zero = false;
    for (const MorphTarget& target : mesh.targets) {
        if (!target.is_frame) continue;
        steps.push_back(steps_of(target.positions, target.grid));
        if (!target.normals.empty()) normals.push_back(list.numbers_of(target.normals));
        add_boxes(target.grid, stored.grid);
        is_named = is_named || !target.name.empty();
        has_zero = has_zero || target.name.find('\0') != std::string::npos;
        stored.names.append(target.name).push_back('\0');
    }
    if (!is_named || has_zero) stored.names.clear();
    const std::size_t vertices = mesh.positions.size();
    stored.places = number_places(columns_of(steps, normals, vertices), vertices);
    std::vector<std::uint32_t> vertex_of;  // the first vertex of each place
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
        if (stored.places[vertex] == vertex_of.size()) vertex_of.push_back(vertex);
    }
    stored.place_count = static_cast<std::uint32_t>(vertex_of.size());
    std::vector<Steps> all_steps;
    std::vector<std::byte> all_normals;
    all_steps.reserve(steps.size() * vertex_of.size());
    all_normals.reserve(normals.size() * vertex_of.size());
    for (const std::vector<Steps>& frame : steps) {
        for (const std::uint32_t vertex : vertex_of) all_steps.push_back(frame[vertex]);
    }
    for (const std::vector<std::byte>& frame : normals) {
        for (const std::uint32_t vertex : vertex_of) all_normals.push_back(frame[vertex]);
    }
    stored.positions = to_stream(all_steps, Numbers::plain);
    if (!normals.empty()) stored.normals = to_stream(std::move(all_normals));
    return stored;
}

}  // namespace

StoredShapes store_shapes(const Mesh& mesh) {
    StoredShapes stored;
    if (!mesh.grid && !has_frames(mesh)) return stored;
    const NormalList list(mesh);
    stored.list = list.list();
    if (mesh.grid && !mesh.positions.empty()) {
        stored.positions = to_stream(steps_of(mesh.positions, *mesh.grid), Numbers::boxed);
        add_boxes(*mesh.grid, stored.positions->boxes);
    }
    if (list.holds_own() && !mesh.normals.empty()) stored.normals = to_stream(list.numbers_of(mesh.normals));
    if (has_frames(mesh)) stored.frames = store_frames(mesh, list);
    return stored;
}

}  // namespace bendy::converter
