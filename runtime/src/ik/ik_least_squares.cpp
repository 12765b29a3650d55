#include "damped_step.h"
#include "ik_problem.h"
#include "math/rotation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

// Damped least squares: Levenberg-Marquardt over all joints at once (Buss, "Introduction to inverse kinematics with
// Jacobian transpose, pseudoinverse and damped least squares methods", 2004). If a constraint stops a joint in some
// direction, that direction is removed from the joint and the step is solved again, so that the other joints make up
// for it. If it is stuck short of the target it restarts elsewhere, and the best result counts.
namespace bendy {
namespace {

constexpr std::size_t kMost = 6;
using Unknowns = std::array<double, kMost>;
using Matrix = std::array<Unknowns, kMost>;

class LeastSquares {
public:
    explicit LeastSquares(IkProblem& problem)
        : problem_(problem),
          size_(problem.has_rotation ? 6 : 3),
          position_(std::sqrt(problem.position_weight)),
          rotation_(problem.has_rotation ? std::sqrt(problem.rotation_weight) : 0.0) {}

    [[nodiscard]] bool is_reached() const { return problem_.is_reached(); }
    [[nodiscard]] double cost() const { return problem_.cost(); }
    void swap() {
        for (IkLink& link : problem_.links) std::swap(link.local, link.trial);
        problem_.place();
    }
    /// Computes a step and fills the links' trial with it.
    void try_step(double damping) {
        for (IkLink& link : problem_.links) set_mobility(link);
        // In a short chain few joints can make up for a stopped one, and they may be stopped in turn.
        constexpr std::size_t kShort = 4;
        const int rounds = problem_.links.size() <= kShort ? 3 : 2;
        for (int round = 0; round < rounds; ++round) {
            Matrix A = gather();
            Unknowns y = errors();
            solve_damped(A[0].data(), kMost, size_, damping, y.data());
            if (!apply(y)) return;
        }
    }

private:
    [[nodiscard]] Unknowns errors() const {
        const glm::dvec3 p = position_ * (problem_.target - problem_.tip);
        Unknowns e{p.x, p.y, p.z};
        if (size_ == 6) {
            const glm::dvec3 r = rotation_ * to_vector(problem_.target_rotation * glm::conjugate(problem_.tip_global));
            e[3] = r.x;
            e[4] = r.y;
            e[5] = r.z;
        }
        return e;
    }

    /// Returns the sum of J mobility J^T, J of each link: a rotation w moves the tip by cross(w, arm), and rotates it
    /// by w.
    [[nodiscard]] Matrix gather() const {
        glm::dmat3 pp(0.0);
        glm::dmat3 pr(0.0);
        glm::dmat3 rr(0.0);
        for (const IkLink& link : problem_.links) {
            if (link.is_fixed) continue;
            const glm::dvec3 arm = problem_.tip - link.position;
            const glm::dmat3 cross_arm = cross_matrix(arm);
            const glm::dmat3 left = cross_arm * link.mobility;
            pp -= left * cross_arm;  // the transpose of [arm]x is -[arm]x
            if (size_ == 6) {
                pr -= left;
                rr += link.mobility;
            }
        }
        Matrix A{};
        for (int column = 0; column < 3; ++column) {
            for (int row = 0; row < 3; ++row) {
                const auto i = static_cast<std::size_t>(row);
                const auto j = static_cast<std::size_t>(column);
                A[i][j] = position_ * position_ * pp[column][row];
                A[i][j + 3] = position_ * rotation_ * pr[column][row];
                A[j + 3][i] = A[i][j + 3];
                A[i + 3][j + 3] = rotation_ * rotation_ * rr[column][row];
            }
        }
        return A;
    }

    /// Applies the rotation mobility J^T y to every link's trial. Returns true if a constraint stopped a link in a
    /// direction in which it was free so far: that direction is then removed from its mobility.
    bool apply(const Unknowns& y) {
        const glm::dvec3 p = position_ * glm::dvec3(y[0], y[1], y[2]);
        const glm::dvec3 r = size_ == 6 ? rotation_ * glm::dvec3(y[3], y[4], y[5]) : glm::dvec3(0.0);
        bool is_stopped = false;
        glm::dquat parent(1.0, 0.0, 0.0, 0.0);
        for (IkLink& link : problem_.links) {
            link.trial = link.local;
            if (!link.is_fixed) {
                const glm::dvec3 arm = problem_.tip - link.position;
                is_stopped = try_rotation(link, parent, link.mobility * (glm::cross(arm, p) + r)) || is_stopped;
            }
            parent = link.global;
        }
        return is_stopped;
    }

    IkProblem& problem_;
    std::size_t size_;
    double position_, rotation_;  ///< square roots of the weights
};

/// Three orthonormal axes in base space, in which a chain and its mirror image have the same numbers for mirrored
/// rotations: derived from the chain's bends at rest, what its constraints allow, its pole, and the direction of the
/// target. The orientation of the joints' own axes does not matter. Rotations are axial vectors, and so are these.
glm::dmat3 turn_axes(const IkProblem& problem) {
    glm::dvec3 bends(0.0);
    glm::dquat global(1.0, 0.0, 0.0, 0.0);
    glm::dvec3 tip = problem.origin;
    glm::dvec3 before(0.0);
    for (const IkLink& link : problem.links) {
        if (link.constraint != nullptr) {
            bends += global * (link.rest_frame * (link.freedom * preferred_side(*link.constraint)));
        }
        global = global * link.rest_frame * glm::conjugate(link.frame);
        const glm::dvec3 bone = global * link.bone;
        bends += glm::cross(before, bone);
        if (link.bone_length > 0.0) before = bone / link.bone_length;
        tip += bone;
    }
    const glm::dvec3 reached = tip - problem.origin;
    if (problem.has_pole) bends += glm::cross(problem.pole - problem.origin, reached);
    const glm::dvec3 aside = glm::cross(problem.target - problem.origin, reached);
    const double size = std::sqrt(glm::dot(bends, bends));
    constexpr double kClear = 1e-3;
    if (!(size > kClear && std::isfinite(size))) return glm::dmat3(1.0);
    const glm::dvec3 x = bends / size;
    const glm::dvec3 across = aside - x * glm::dot(x, aside);
    const double rest = std::sqrt(glm::dot(across, across));
    if (!(rest > kClear)) return glm::dmat3(1.0);
    const glm::dvec3 y = across / rest;
    return {x, y, glm::cross(x, y)};
}

/// Sets another starting point: first the preferred pose, then that pose improved by the closed form, then any legal
/// one.
void begin_anew(IkProblem& problem, std::uint32_t attempt, const glm::dmat3& axes, Dice& dice) {
    constexpr std::uint32_t kPreferred = 2;  // attempts
    glm::dquat parent(1.0, 0.0, 0.0, 0.0);   // at rest
    for (IkLink& link : problem.links) {
        const glm::dquat rest = parent * link.rest_frame;
        parent = rest * glm::conjugate(link.frame);
        if (link.is_fixed) continue;
        glm::dvec3 turn(0.0);  // about the frame's axes
        if (attempt < kPreferred) {
            if (link.constraint == nullptr) continue;
            const auto& preferred = link.constraint->record.preferred;
            turn = {preferred[0], preferred[1], preferred[2]};
        } else {
            // One at a time: the evaluation order of arguments is up to the compiler.
            for (int axis = 2; axis >= 0; --axis) turn[axis] = dice.next() * 2.0;
            turn = glm::conjugate(rest) * (axes * turn);
        }
        link.local = legal_local(
            link, glm::normalize(link.rest_frame * from_vector(turn * link.freedom) * glm::conjugate(link.frame)));
    }
    problem.place();
    if (attempt == kPreferred - 1) solve_two_bone(problem);
}

}  // namespace

std::uint32_t solve_least_squares(IkProblem& problem) {
    const std::uint32_t most = problem.iterations != 0 ? problem.iterations : 60;
    constexpr std::size_t kLong = 256;  // a long rope that is stuck stays stuck, and each restart costs as much as the
                                        // first attempt
    const bool is_hopeless = problem.is_out_of_reach || problem.links.size() > kLong;
    const std::uint32_t restarts = is_hopeless ? 0 : problem.options->restarts;
    LeastSquares method(problem);
    std::uint32_t iterations = descend_damped(method, most);
    if (problem.is_reached()) return iterations;
    double best = problem.cost();
    problem.save();
    const auto descend = [&] {
        iterations += descend_damped(method, most);
        // If two results are nearly equal, the first counts: rounding must not choose between them.
        constexpr double kNearer = 0.99;
        if (!problem.is_reached() && problem.cost() >= kNearer * best) return;
        best = problem.cost();
        problem.save();
    };
    // The closed form from the best result so far: it slides along a limit in one step where descent creeps.
    const auto bend_best = [&] {
        problem.restore();
        solve_two_bone(problem);
        descend();
    };
    if (restarts > 0) bend_best();
    const glm::dmat3 axes = restarts > 0 ? turn_axes(problem) : glm::dmat3(1.0);
    Dice dice;
    for (std::uint32_t attempt = 0; attempt < restarts && !problem.is_reached(); ++attempt) {
        begin_anew(problem, attempt, axes, dice);
        descend();
    }
    constexpr int kLast = 4;
    for (int i = 0; i < kLast && restarts > 0 && !problem.is_reached(); ++i) bend_best();
    problem.restore();
    return iterations;
}

}  // namespace bendy
