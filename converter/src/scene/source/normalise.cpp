#include "scene/source/normalise.h"

#include "scene/failure.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace bendy::converter {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double length(const Vector& a) {
    return std::hypot(a[0], a[1], a[2]);
}

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector scaled(const Vector& a, double factor) {
    return {a[0] * factor, a[1] * factor, a[2] * factor};
}

/// The component of `a` at right angles to the unit vector `axis`; applied twice, to remove rounding errors.
Vector without(Vector a, const Vector& axis) {
    for (int pass = 0; pass < 2; ++pass) {
        const double along = dot(a, axis);
        for (std::size_t i = 0; i < 3; ++i) a[i] -= along * axis[i];
    }
    return a;
}

/// A unit vector at right angles to the unit vector `axis`.
Vector any_perpendicular(const Vector& axis) {
    std::size_t smallest = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        if (std::abs(axis[i]) < std::abs(axis[smallest])) smallest = i;
    }
    Vector basis{};
    basis[smallest] = 1.0;
    const Vector side = without(basis, axis);
    return scaled(side, 1.0 / length(side));
}

/// Rotation matrix (columns x, y, z) to quaternion, by the largest of its four components (Shepperd 1978).
std::array<double, 4> to_quaternion(const Vector& x, const Vector& y, const Vector& z) {
    const double trace = x[0] + y[1] + z[2];
    if (trace > 0.0) {
        const double k = 2.0 * std::sqrt(trace + 1.0);
        return {(y[2] - z[1]) / k, (z[0] - x[2]) / k, (x[1] - y[0]) / k, k / 4.0};
    }
    if (x[0] > y[1] && x[0] > z[2]) {
        const double k = 2.0 * std::sqrt(1.0 + x[0] - y[1] - z[2]);
        return {k / 4.0, (y[0] + x[1]) / k, (z[0] + x[2]) / k, (y[2] - z[1]) / k};
    }
    if (y[1] > z[2]) {
        const double k = 2.0 * std::sqrt(1.0 + y[1] - x[0] - z[2]);
        return {(y[0] + x[1]) / k, k / 4.0, (z[1] + y[2]) / k, (z[0] - x[2]) / k};
    }
    const double k = 2.0 * std::sqrt(1.0 + z[2] - x[0] - y[1]);
    return {(z[0] + x[2]) / k, (z[1] + y[2]) / k, k / 4.0, (x[1] - y[0]) / k};
}

/// A unit in the sixth digit of a number; 0 for tiny and huge ones.
double sixth_digit(double number) {
    constexpr double kLargest = 1e12;
    const double size = std::abs(number);
    if (!(size >= 1.0 / kLargest && size <= kLargest)) return 0.0;
    double above = 1.0;
    while (above < size) above *= 10.0;
    while (above > 10.0 * size) above /= 10.0;
    return above * 1e-6;
}

/// How a matrix was rounded when it was written as text: to four to six digits after the point, to six digits in all,
/// as most exporters do, or not. Uses only products, quotients and rounding: the same bits on every machine.
class TextRounding {
public:
    /// \param noise  elements below this say nothing
    TextRounding(const std::array<Vector, 3>& axes, double noise) {
        for (const double unit : {1e-6, 1e-5, 1e-4}) {
            if (all(axes, noise, [&](double) { return unit; })) half_unit_ = unit / 2.0;
        }
        has_six_digits_ = all(axes, noise, sixth_digit);
    }

    /// The most by which an element may differ from the number that was written.
    [[nodiscard]] double of(double element) const {
        return std::max(half_unit_, has_six_digits_ ? sixth_digit(element) / 2.0 : 0.0);
    }

private:
    /// True if all elements are floats nearest to a multiple of their unit.
    template <class Unit>
    static bool all(const std::array<Vector, 3>& axes, double noise, const Unit& unit_of) {
        return std::all_of(axes.begin(), axes.end(), [&](const Vector& axis) {
            return std::all_of(axis.begin(), axis.end(), [&](double element) {
                if (std::abs(element) <= noise) return true;
                const double unit = unit_of(element);
                return unit > 0.0 &&
                       static_cast<float>(std::round(element / unit) * unit) == static_cast<float>(element);
            });
        });
    }

    double half_unit_ = 0.0;
    bool has_six_digits_ = false;
};

/// A weight below this is not a rounded zero.
constexpr float kNegative = -1e-3f;

/// Moves a vertex's influences with weight to the front, in order; the rest become bone 0 without weight.
void move_to_front(std::uint32_t* bones, float* weights, std::size_t n) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (!(weights[i] > 0.0f)) continue;
        bones[kept] = bones[i];
        weights[kept] = weights[i];
        ++kept;
    }
    std::fill(bones + kept, bones + n, 0u);
    std::fill(weights + kept, weights + n, 0.0f);
}

/// Merges a vertex's influences by bone.
/// \param order  scratch memory
/// \return whether the vertex had a bone twice
bool merge_vertex(std::uint32_t* bones, float* weights, std::size_t n, std::vector<std::size_t>& order) {
    order.clear();
    for (std::size_t i = 0; i < n; ++i) {
        if (weights[i] > 0.0f) order.push_back(i);
    }
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::tie(bones[a], a) < std::tie(bones[b], b); });
    bool is_merged = false;
    for (std::size_t first = 0; first < order.size();) {
        double sum = weights[order[first]];
        std::size_t next = first + 1;
        for (; next < order.size() && bones[order[next]] == bones[order[first]]; ++next) {
            sum += weights[order[next]];
            weights[order[next]] = 0.0f;
            is_merged = true;
        }
        if (next > first + 1) weights[order[first]] = static_cast<float>(sum);
        first = next;
    }
    if (is_merged) move_to_front(bones, weights, n);
    return is_merged;
}

/// Merges the influences of all vertices, `n` each.
void merge_all(std::vector<std::uint32_t>& bones, std::vector<float>& weights, std::size_t n, const std::string& place,
               Report& report) {
    if (n < 2) return;
    std::uint64_t merged = 0;
    std::vector<std::size_t> order;
    for (std::size_t first = 0; first < bones.size(); first += n)
        merged += merge_vertex(bones.data() + first, weights.data() + first, n, order) ? 1 : 0;
    if (merged > 0) report.warn("influences of a vertex by the same joint merged into one", place, merged);
}

}  // namespace

Transform decompose(const std::array<double, 16>& m) {
    const Vector a{m[0], m[1], m[2]};
    const Vector b{m[4], m[5], m[6]};
    const Vector c{m[8], m[9], m[10]};
    // A column, or its remainder beside the earlier ones, counts as zero below this: its direction would be noise.
    const double largest = std::max({length(a), length(b), length(c)});
    const double vanishing = largest * 1e-12;

    // Gram-Schmidt: each axis of R is the part of the column that is orthogonal to the earlier ones; a column without
    // such a part leaves its axis open, and its diagonal element of U zero.
    Vector x{};
    Vector y{};
    Vector z{};
    const bool has_x = length(a) > vanishing;
    if (has_x) x = scaled(a, 1.0 / length(a));
    const Vector b_rest = has_x ? without(b, x) : b;
    const bool has_y = length(b_rest) > vanishing;
    if (has_y) y = scaled(b_rest, 1.0 / length(b_rest));
    Vector c_rest = has_x ? without(c, x) : c;
    if (has_y) c_rest = without(c_rest, y);
    const bool has_z = length(c_rest) > vanishing;
    if (has_z) z = scaled(c_rest, 1.0 / length(c_rest));

    // Complete the open axes to a right-handed frame; if all three are given and the frame is mirrored, negate x, which
    // negates U's first row.
    if (has_x && has_y && has_z) {
        if (dot(cross(x, y), z) < 0.0) x = scaled(x, -1.0);
    } else {
        if (!has_x && !has_y && !has_z) x = {1.0, 0.0, 0.0};
        if (!has_x && (has_y || has_z)) x = has_y && has_z ? cross(y, z) : any_perpendicular(has_y ? y : z);
        if (!has_y) y = has_z ? cross(z, x) : any_perpendicular(x);
        z = cross(x, y);
    }

    Transform transform;
    transform.translation = {static_cast<float>(m[12]), static_cast<float>(m[13]), static_cast<float>(m[14])};
    transform.rotation = make_unit(to_quaternion(x, y, z)).value;
    transform.scale = {static_cast<float>(dot(x, a)), static_cast<float>(has_y ? dot(y, b) : 0.0),
                       static_cast<float>(has_z ? dot(z, c) : 0.0)};
    // Shear that rounding may make, to floats or to the digits of a text, is noise. It is at most, of the column `of`
    // along the axis of the column `along`, what each element's rounding does to their product.
    const double noise = largest * 0x1p-22;
    const TextRounding rounding({a, b, c}, noise);
    const auto shear = [&](const Vector& axis, const Vector& along, double size, const Vector& of) {
        constexpr double kBelow = 0.95;  // so that shear of a whole unit stays
        double most = noise;
        if (size > 0.0) {
            double text = 0.0;
            for (std::size_t i = 0; i < 3; ++i)
                text += std::abs(axis[i]) * rounding.of(of[i]) + std::abs(of[i]) / size * rounding.of(along[i]);
            most += kBelow * text;
        }
        const double value = dot(axis, of);
        return std::abs(value) <= most ? 0.0f : static_cast<float>(value);
    };
    transform.shear = {shear(x, a, length(a), b), shear(x, a, length(a), c), shear(y, b, length(b_rest), c)};
    return transform;
}

UnitQuaternion make_unit(const std::array<double, 4>& q) {
    constexpr double kUnitRounding = 3e-7;
    UnitQuaternion unit;
    const double largest = std::max({std::abs(q[0]), std::abs(q[1]), std::abs(q[2]), std::abs(q[3])});
    unit.length = 0.0;
    if (!(largest > 0.0)) return unit;
    // Scale by the largest first: squares of tiny or huge components would underflow or overflow.
    double sum = 0.0;
    for (const double component : q) sum += (component / largest) * (component / largest);
    unit.length = largest * std::sqrt(sum);
    const double factor = std::abs(unit.length - 1.0) <= kUnitRounding ? 1.0 : 1.0 / unit.length;
    if (std::isfinite(factor)) {
        for (int i = 0; i < 4; ++i) unit.value[i] = static_cast<float>(q[static_cast<std::size_t>(i)] * factor);
    }
    return unit;
}

LargestBone normalise_influences(Influences& influences, const std::string& place, Report& report) {
    const std::size_t n = influences.per_vertex;
    const std::size_t vertices = influences.bones.size() / n;
    LargestBone largest;
    std::uint64_t unnormalised = 0;
    std::uint64_t weightless = 0;
    std::uint64_t negative = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
        std::uint32_t* bones = influences.bones.data() + v * n;
        float* weights = influences.weights.data() + v * n;
        double sum = 0.0;
        int used = 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (weights[i] < 0.0f) {
                if (weights[i] < kNegative) {
                    fail(place,
                         "vertex " + std::to_string(v) + ": weight " + std::to_string(weights[i]) + " is negative");
                }
                weights[i] = 0.0f;
                ++negative;
            }
            sum += static_cast<double>(weights[i]);
            if (weights[i] > 0.0f) ++used;
        }
        if (used == 0) {
            weights[0] = 1.0f;
            ++weightless;
        } else if (std::abs(sum - 1.0) > kWeightRounding * used) {
            for (std::size_t i = 0; i < n; ++i) weights[i] = static_cast<float>(static_cast<double>(weights[i]) / sum);
            ++unnormalised;
        }
        move_to_front(bones, weights, n);
        for (std::size_t i = 0; i < n; ++i) {
            if (bones[i] > largest.bone) largest = {bones[i], v};
        }
    }
    merge_all(influences.bones, influences.weights, n, place, report);
    if (unnormalised > 0) report.warn("weights of a vertex did not sum to 1, normalised", place, unnormalised);
    if (weightless > 0) report.warn("vertex without weights, bound to its first joint", place, weightless);
    if (negative > 0) report.warn("weight a little below zero set to zero", place, negative);
    return largest;
}

void merge_influences(Mesh& mesh, const std::string& place, Report& report) {
    merge_all(mesh.bones, mesh.weights, mesh.influences, place, report);
}

void trim_influences(Mesh& mesh) {
    const std::size_t n = mesh.influences;
    if (n == 0) return;
    std::size_t used = 1;
    const std::size_t vertices = mesh.positions.size();
    for (std::size_t v = 0; v < vertices; ++v) {
        while (used < n && mesh.weights[v * n + used] > 0.0f) ++used;
    }
    if (used == n) return;
    for (std::size_t v = 0; v < vertices; ++v) {
        for (std::size_t i = 0; i < used; ++i) {
            mesh.bones[v * used + i] = mesh.bones[v * n + i];
            mesh.weights[v * used + i] = mesh.weights[v * n + i];
        }
    }
    mesh.bones.resize(vertices * used);
    mesh.weights.resize(vertices * used);
    mesh.bones.shrink_to_fit();
    mesh.weights.shrink_to_fit();
    mesh.influences = static_cast<std::uint32_t>(used);
}

}  // namespace bendy::converter
