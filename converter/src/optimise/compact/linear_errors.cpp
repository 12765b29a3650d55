#include "optimise/compact/linear_errors.h"

#include <bendy/format/public.h>
#include <bendy/format/trig.h>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace bendy::converter {
namespace {

constexpr std::size_t kLanes = 8;                                     // frames processed together
constexpr std::size_t kMostTried = 160;                               // frames on which plans are tried
constexpr std::size_t kMostCoefficientBytes = std::size_t{1} << 26U;  // for all coefficients

// One number per lane. Functions of lanes are inlined into one for each set of instructions. Like all of the converter,
// lanes are computed without fused multiply-add, so that every machine chooses the same steps.
#if defined(BENDY_GNU)
#pragma GCC diagnostic ignored "-Wpsabi"  // of passing registers that a processor may not have: all is inlined
using Floats [[gnu::vector_size(kLanes * sizeof(float))]] = float;
using WideFloats [[gnu::vector_size(kLanes * sizeof(double))]] = double;

struct alignas(kLanes * sizeof(float)) Lane {
    Floats all;
    BENDY_ALWAYS_INLINE friend Lane operator+(const Lane& a, const Lane& b) { return {a.all + b.all}; }
    BENDY_ALWAYS_INLINE friend Lane operator-(const Lane& a, const Lane& b) { return {a.all - b.all}; }
    BENDY_ALWAYS_INLINE friend Lane operator*(const Lane& a, const Lane& b) { return {a.all * b.all}; }
    BENDY_ALWAYS_INLINE friend Lane operator*(const Lane& a, float b) { return {a.all * b}; }
};

struct alignas(kLanes * sizeof(double)) Doubles {
    WideFloats all;
    BENDY_ALWAYS_INLINE friend Doubles operator+(const Doubles& a, const Doubles& b) { return {a.all + b.all}; }
    BENDY_ALWAYS_INLINE friend Doubles operator-(const Doubles& a, const Doubles& b) { return {a.all - b.all}; }
    BENDY_ALWAYS_INLINE friend Doubles operator+(const Doubles& a, double b) { return {a.all + b}; }
    BENDY_ALWAYS_INLINE friend Doubles operator-(const Doubles& a, double b) { return {a.all - b}; }
    BENDY_ALWAYS_INLINE friend Doubles operator*(const Doubles& a, double b) { return {a.all * b}; }
};

BENDY_ALWAYS_INLINE Doubles to_doubles(const Lane& numbers) {
    return {__builtin_convertvector(numbers.all, WideFloats)};
}
BENDY_ALWAYS_INLINE Lane to_floats(const Doubles& numbers) {
    return {__builtin_convertvector(numbers.all, Floats)};
}
#else
template <class Number>
struct Numbers {
    std::array<Number, kLanes> all;

    template <class Operation>
    static Numbers each(const Operation& operation) {
        Numbers result;
        for (std::size_t l = 0; l < kLanes; ++l) result.all[l] = operation(l);
        return result;
    }
    friend Numbers operator+(const Numbers& a, const Numbers& b) {
        return each([&](std::size_t l) { return a.all[l] + b.all[l]; });
    }
    friend Numbers operator-(const Numbers& a, const Numbers& b) {
        return each([&](std::size_t l) { return a.all[l] - b.all[l]; });
    }
    friend Numbers operator*(const Numbers& a, const Numbers& b) {
        return each([&](std::size_t l) { return a.all[l] * b.all[l]; });
    }
    friend Numbers operator+(const Numbers& a, Number b) {
        return each([&](std::size_t l) { return a.all[l] + b; });
    }
    friend Numbers operator-(const Numbers& a, Number b) {
        return each([&](std::size_t l) { return a.all[l] - b; });
    }
    friend Numbers operator*(const Numbers& a, Number b) {
        return each([&](std::size_t l) { return a.all[l] * b; });
    }
};
using Lane = Numbers<float>;
using Doubles = Numbers<double>;

Doubles to_doubles(const Lane& numbers) {
    return Doubles::each([&](std::size_t l) { return double{numbers.all[l]}; });
}
Lane to_floats(const Doubles& numbers) {
    return Lane::each([&](std::size_t l) { return static_cast<float>(numbers.all[l]); });
}
#endif
using Vector = std::array<Lane, 3>;
using Matrix = std::array<Vector, 3>;  // columns

/// v + m * w
BENDY_ALWAYS_INLINE Vector plus_product(const Vector& v, const Matrix& m, const Vector& w) {
    return {v[0] + (m[0][0] * w[0] + m[1][0] * w[1] + m[2][0] * w[2]),
            v[1] + (m[0][1] * w[0] + m[1][1] * w[1] + m[2][1] * w[2]),
            v[2] + (m[0][2] * w[0] + m[1][2] * w[1] + m[2][2] * w[2])};
}

/// v + f * w
BENDY_ALWAYS_INLINE Vector plus_scaled(const Vector& v, const Lane& f, const Vector& w) {
    return {v[0] + f * w[0], v[1] + f * w[1], v[2] + f * w[2]};
}

/// -v in lanes where it is shorter than `most`, else 0.
BENDY_ALWAYS_INLINE Vector minus_short(const Vector& v, float most) {
    const Lane square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    Lane sign{};
    for (std::size_t l = 0; l < kLanes; ++l) sign.all[l] = square.all[l] < most * most ? -1.0f : 0.0f;
    return {v[0] * sign, v[1] * sign, v[2] * sign};
}

/// Column `c` of m * [by]x: the change of m under a rotation by a small vector.
BENDY_ALWAYS_INLINE Vector turned_column(const Matrix& m, const Vector& by, std::size_t c) {
    const std::size_t next = (c + 1) % 3;
    const std::size_t last = (c + 2) % 3;
    return {m[next][0] * by[last] - m[last][0] * by[next], m[next][1] * by[last] - m[last][1] * by[next],
            m[next][2] * by[last] - m[last][2] * by[next]};
}

/// Squared lengths of m * point + v.
BENDY_ALWAYS_INLINE Lane squares_of(const Matrix& m, const Vector& v, const glm::vec3& point) {
    const Lane x = m[0][0] * point.x + m[1][0] * point.y + m[2][0] * point.z + v[0];
    const Lane y = m[0][1] * point.x + m[1][1] * point.y + m[2][1] * point.z + v[1];
    const Lane z = m[0][2] * point.x + m[1][2] * point.y + m[2][2] * point.z + v[2];
    return x * x + y * y + z * z;
}

/// sum + the squares of a vector's numbers
BENDY_ALWAYS_INLINE Lane plus_squares(const Lane& sum, const Vector& v) {
    return sum + (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// The larger value per lane; NaN is kept.
BENDY_ALWAYS_INLINE Lane larger(const Lane& a, const Lane& b) {
    Lane most{};
    for (std::size_t l = 0; l < kLanes; ++l) most.all[l] = b.all[l] <= a.all[l] ? a.all[l] : b.all[l];
    return most;
}

BENDY_ALWAYS_INLINE bool are_at_most(const Lane& numbers, float most) {
    int above = 0;
    for (std::size_t l = 0; l < kLanes; ++l) above += numbers.all[l] <= most ? 0 : 1;
    return above == 0;
}

BENDY_ALWAYS_INLINE Lane filled(float number) {
    Lane all{};
    for (std::size_t l = 0; l < kLanes; ++l) all.all[l] = number;
    return all;
}

void set_lane(Vector& out, std::size_t lane, const glm::dvec3& v) {
    for (std::size_t r = 0; r < 3; ++r) out[r].all[lane] = static_cast<float>(v[static_cast<int>(r)]);
}

void set_lane(Matrix& out, std::size_t lane, const glm::dmat3& m) {
    for (std::size_t c = 0; c < 3; ++c) set_lane(out[c], lane, m[static_cast<int>(c)]);
}

glm::dmat3 cross_matrix(const glm::dvec3& v) {
    return {{0.0, v.z, -v.y}, {-v.z, 0.0, v.x}, {v.y, -v.x, 0.0}};
}

/// The matrix d with exp(v + dv) = exp(v) exp(d dv), to first order.
glm::dmat3 jacobian_of(const glm::dvec3& v) {
    const double square = glm::dot(v, v);
    const double angle = std::sqrt(square);
    const glm::dmat3 cross = cross_matrix(v);
    constexpr double kSmall = 1e-3;
    double a = 0.5 - square / 24.0;
    double b = 1.0 / 6.0 - square / 120.0;
    if (angle > kSmall) {
        const auto [sine, cosine] = trig::sin_cos(angle);
        a = (1.0 - cosine) / square;
        b = (angle - sine) / (square * angle);
    }
    return glm::dmat3(1.0) - a * cross + b * (cross * cross);
}

bool is_finite(const glm::dmat3& m) {
    return bendy::converter::is_finite(m[0]) && bendy::converter::is_finite(m[1]) && bendy::converter::is_finite(m[2]);
}

/// The error of a property's component after rounding, relative to the source.
/// \param wish  the value to round, without the correction
BENDY_ALWAYS_INLINE Lane rounded(const Doubles& wish, const Lane& correction, double step, const Doubles& source) {
    constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer
    const Doubles number = (wish + to_doubles(correction)) * (1.0 / step) + kShift - kShift;
    return to_floats(number * step - source);
}

/// As above, for all components.
/// \param correction  added to the values of animated properties before rounding
BENDY_ALWAYS_INLINE Vector rounded(const Property& property, const std::array<Doubles, 3>& values,
                                   const Vector& correction) {
    Vector off{};
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t from = c < property.components ? c : 0;
        const double step = step_size(property.steps[from]);
        Doubles number{};
        switch (property.state) {
            case PropertyState::unpacked:
                break;
            case PropertyState::rest:
                off[c] = rounded(number, Lane{}, step, values[c]);
                break;
            case PropertyState::constant:
                number = number + property.middle[static_cast<int>(from)];
                off[c] = rounded(number, Lane{}, step, values[c]);
                break;
            case PropertyState::animated:
                off[c] = rounded(values[from], correction[from], step, values[c]);
                break;
        }
    }
    return off;
}

}  // namespace

/// The plan-independent data of a joint at several frames.
struct LinearErrors::JointFrames {
    Matrix above;                     // parent to model space
    Matrix below_above;               // its inverse; 0 if there is none
    Matrix turned;                    // after the joint's rotation
    Matrix local;                     // rotation and scale of the joint
    Matrix jacobian;                  // from a change of the rotation vector to a rotation in the joint's space
    Matrix by_origin;                 // correction of the rotation vector for an error of the origin
    std::array<Matrix, 3> by_linear;  // and for an error of each column of the linear part
    Vector translation, scale;
    std::array<std::array<Doubles, 3>, kPaths> values;  // relative to rest
};

/// Decoded minus source, joint to model space.
struct LinearErrors::Error {
    Matrix linear;
    Vector origin;
};

struct LinearErrors::ProbeSet {
    std::vector<glm::vec3> points;
    glm::vec3 middle{0.0f};
    float radius = 0.0f;  // of all points around the middle
};

LinearErrors::LinearErrors(const ClipFrames& frames, std::span<const JointPlan> plans,
                           const std::vector<std::vector<glm::dvec3>>& aims,
                           const std::vector<std::vector<glm::dvec3>>& probes, bool corrects)
    : joints_(frames.joints()), corrects_(corrects) {
    for (std::size_t j = 0; j < joints_; ++j) {
        parents_.push_back(frames.scene().joints[j].parent);
        shears_.push_back(frames.scene().joints[j].rest.shear);
        ProbeSet& set = probes_.emplace_back();
        glm::dvec3 middle(0.0);
        for (const glm::dvec3& probe : probes[j]) middle += probe / static_cast<double>(probes[j].size());
        double radius = 0.0;
        for (const glm::dvec3& probe : probes[j]) {
            set.points.emplace_back(probe);
            radius = std::max(radius, glm::distance(probe, middle));
        }
        set.middle = glm::vec3(middle);
        set.radius = static_cast<float>(radius);
    }
    const std::size_t most_blocks = kMostCoefficientBytes / (sizeof(JointFrames) * std::max<std::size_t>(joints_, 1));
    const std::size_t tried = std::min({frames.frames(), kMostTried, std::max<std::size_t>(most_blocks, 1) * kLanes});
    blocks_ = (tried + kLanes - 1) / kLanes;
    coefficients_.resize(blocks_ * joints_);
    kept_.resize(blocks_ * joints_);
    trial_.resize(blocks_ * joints_);
    order_.resize(blocks_);
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::vector<Affine> pose(joints_);
    for (std::size_t k = 0; k < blocks_ * kLanes; ++k) {  // incomplete blocks repeat the last frame
        const std::size_t frame = tried < 2 ? 0 : std::min(k, tried - 1) * (frames.frames() - 1) / (tried - 1);
        frames.place(frame, pose);
        for (std::size_t j = 0; j < joints_; ++j)
            read_joint(frames, frame, k % kLanes, j, pose, plans[j], aims[j], coefficients_[k / kLanes * joints_ + j]);
    }
}

LinearErrors::~LinearErrors() = default;

void LinearErrors::read_joint(const ClipFrames& frames, std::size_t frame, std::size_t lane, std::size_t joint,
                              std::span<const Affine> pose, const JointPlan& plan, const std::vector<glm::dvec3>& aims,
                              JointFrames& out) const {
    const std::uint32_t parent = parents_[joint];
    const Local& local = frames.local(frame, joint);
    const glm::dmat3 above = parent == kNone ? glm::dmat3(1.0) : pose[parent].linear;
    const glm::dmat3 rotation = glm::mat3_cast(local.rotation);
    const glm::dmat3 stretched = stretch(local.scale, shears_[joint]);
    const glm::dmat3 turned = above * rotation;
    set_lane(out.above, lane, above);
    set_lane(out.turned, lane, turned);
    set_lane(out.local, lane, rotation * stretched);
    set_lane(out.translation, lane, local.translation);
    set_lane(out.scale, lane, local.scale);
    const auto is_corrected = [&](TrackPath path) {
        return corrects_ && plan[index(path)].state == PropertyState::animated;
    };
    if (is_corrected(TrackPath::translation)) {
        const glm::dmat3 inverse = glm::inverse(above);
        set_lane(out.below_above, lane, is_finite(inverse) ? inverse : glm::dmat3(0.0));
    }
    for (std::size_t path = 0; path < kPaths; ++path) {
        const glm::dvec3 value = frames.relative(frame, joint, static_cast<TrackPath>(path));
        for (std::size_t c = 0; c < 3; ++c) out.values[path][c].all[lane] = value[static_cast<int>(c)];
    }
    if (plan[index(TrackPath::rotation)].state == PropertyState::unpacked) return;
    const glm::dmat3 jacobian = jacobian_of(frames.relative(frame, joint, TrackPath::rotation));
    set_lane(out.jacobian, lane, jacobian);
    if (!is_corrected(TrackPath::rotation)) return;

    // The correction is the rotation that brings the aims nearest to their targets, by least squares.
    glm::dmat3 normal(0.0);
    glm::dmat3 right_by_origin(0.0);  // effect of an error on the right side of the normal equations
    std::array<glm::dmat3, 3> right_by_linear{glm::dmat3(0.0), glm::dmat3(0.0), glm::dmat3(0.0)};
    for (const glm::dvec3& aim : aims) {
        const glm::dmat3 moves = turned * -cross_matrix(stretched * aim);  // columns: a turn about each axis
        const glm::dmat3 transposed = glm::transpose(moves);
        normal += transposed * moves;
        right_by_origin -= transposed;
        for (std::size_t c = 0; c < 3; ++c) right_by_linear[c] -= transposed * aim[static_cast<int>(c)];
    }
    const double damping = 1e-6 * (normal[0][0] + normal[1][1] + normal[2][2]);
    normal += glm::dmat3(damping);
    const glm::dmat3 back = glm::inverse(jacobian);
    const glm::dmat3 solve = back * glm::inverse(normal);
    constexpr double kMost = 30.0;  // near a full turn, rotation vectors change fast
    const bool has_correction =
        damping > 0.0 && is_finite(solve) && glm::length(back[0]) + glm::length(back[1]) + glm::length(back[2]) < kMost;
    set_lane(out.by_origin, lane, has_correction ? solve * right_by_origin : glm::dmat3(0.0));
    for (std::size_t c = 0; c < 3; ++c)
        set_lane(out.by_linear[c], lane, has_correction ? solve * right_by_linear[c] : glm::dmat3(0.0));
}

bool LinearErrors::try_subtree(std::span<const JointPlan> plans, std::size_t first, std::size_t end, double metres) {
    most_ = static_cast<float>(metres * metres);
    for (std::size_t o = 0; o < order_.size(); ++o) {
        if (try_block(plans, order_[o], first, end)) continue;
        std::rotate(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(o),
                    order_.begin() + static_cast<std::ptrdiff_t>(o) + 1);
        return false;
    }
    return true;
}

void LinearErrors::keep(std::size_t first, std::size_t end) {
    for (std::size_t block = 0; block < blocks_; ++block) {
        const auto row = static_cast<std::ptrdiff_t>(block * joints_);
        std::copy(trial_.begin() + row + static_cast<std::ptrdiff_t>(first),
                  trial_.begin() + row + static_cast<std::ptrdiff_t>(end),
                  kept_.begin() + row + static_cast<std::ptrdiff_t>(first));
    }
}

BENDY_ALWAYS_INLINE bool LinearErrors::is_near(const ProbeSet& probes, const Error& error) const {
    // A point's error is at most that of the middle plus the linear part's at the radius; (a + b)^2 <= 2 (a^2 + b^2).
    Lane bound{};
    for (const Vector& column : error.linear) bound = plus_squares(bound, column);
    const Lane middle = squares_of(error.linear, error.origin, probes.middle);
    const float radius = probes.radius * probes.radius;
    bound = (bound * radius + middle) * 2.0f;
    if (are_at_most(bound, most_)) return true;
    Lane most{};
    for (const glm::vec3& point : probes.points) most = larger(most, squares_of(error.linear, error.origin, point));
    return are_at_most(most, most_);
}

BENDY_ALWAYS_INLINE bool LinearErrors::try_block_anywhere(std::span<const JointPlan> plans, std::size_t block,
                                                          std::size_t first, std::size_t end) {
    static const Error no_error{};
    const std::size_t row = block * joints_;
    for (std::size_t j = first; j < end; ++j) {
        work_ += kLanes;
        const std::uint32_t parent = parents_[j];
        const Error& above = parent == kNone ? no_error : (parent >= first ? trial_ : kept_)[row + parent];
        const JointFrames& at = coefficients_[row + j];
        const JointPlan& plan = plans[j];
        Error& out = trial_[row + j];

        // The position to which the parent moves it.
        Vector origin = plus_product(above.origin, above.linear, at.translation);
        const Property& move = plan[index(TrackPath::translation)];
        if (move.state != PropertyState::unpacked) {
            Vector correction{};
            if (corrects_ && move.state == PropertyState::animated) {
                // Not if the parent has no volume.
                const double near =
                    64.0 * (step_size(move.steps[0]) + step_size(move.steps[1]) + step_size(move.steps[2]));
                correction = minus_short(plus_product({}, at.below_above, origin), static_cast<float>(near));
            }
            origin = plus_product(origin, at.above, rounded(move, at.values[0], correction));
        }

        Matrix linear;  // without the joint's own rotation
        for (std::size_t c = 0; c < 3; ++c) linear[c] = plus_product({}, above.linear, at.local[c]);
        const Property& grow = plan[index(TrackPath::scale)];
        if (grow.state != PropertyState::unpacked) {
            const Vector change = rounded(grow, at.values[2], {});
            for (std::size_t c = 0; c < 3; ++c) linear[c] = plus_scaled(linear[c], change[c], at.turned[c]);
        }

        const Property& turn = plan[index(TrackPath::rotation)];
        if (turn.state != PropertyState::unpacked) {
            Vector correction{};
            if (corrects_ && turn.state == PropertyState::animated) {
                correction = plus_product({}, at.by_origin, origin);
                for (std::size_t c = 0; c < 3; ++c) correction = plus_product(correction, at.by_linear[c], linear[c]);
            }
            const Vector by = plus_product({}, at.jacobian, rounded(turn, at.values[1], correction));
            const Matrix turned{turned_column(at.turned, by, 0), turned_column(at.turned, by, 1),
                                turned_column(at.turned, by, 2)};
            for (std::size_t c = 0; c < 3; ++c) linear[c] = plus_scaled(linear[c], at.scale[c], turned[c]);
            if (const glm::vec3 shear = shears_[j]; shear != glm::vec3(0.0f)) {
                linear[1] = plus_scaled(linear[1], filled(shear.x), turned[0]);
                linear[2] = plus_scaled(linear[2], filled(shear.y), turned[0]);
                linear[2] = plus_scaled(linear[2], filled(shear.z), turned[1]);
            }
        }
        out = {linear, origin};
        if (!probes_[j].points.empty() && !is_near(probes_[j], out)) return false;
    }
    return true;
}

bool LinearErrors::try_block(std::span<const JointPlan> plans, std::size_t block, std::size_t first, std::size_t end) {
#if defined(BENDY_GNU) && defined(__x86_64__) && !defined(__OPTIMIZE_SIZE__)
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
    if (has_avx2) return try_block_avx2(plans, block, first, end);
#endif
    return try_block_anywhere(plans, block, first, end);
}

#if defined(BENDY_GNU) && defined(__x86_64__) && !defined(__OPTIMIZE_SIZE__)
/// The same operations, of more lanes at once: AVX2 does not include fused multiply-add.
[[gnu::target("avx2")]] bool LinearErrors::try_block_avx2(std::span<const JointPlan> plans, std::size_t block,
                                                          std::size_t first, std::size_t end) {
    return try_block_anywhere(plans, block, first, end);
}
#endif

}  // namespace bendy::converter
