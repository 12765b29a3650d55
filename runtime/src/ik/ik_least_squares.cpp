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
// for it.
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

}  // namespace

std::uint32_t solve_least_squares(IkProblem& problem) {
    LeastSquares method(problem);
    return descend_damped(method, problem.iterations != 0 ? problem.iterations : 60);
}

}  // namespace bendy
