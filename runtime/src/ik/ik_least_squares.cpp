#include "damped_step.h"
#include "ik_problem.h"
#include "math/rotation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

// Damped least squares over all joints at once (Buss, "Introduction to inverse kinematics with Jacobian transpose,
// pseudoinverse and damped least squares methods", 2004), in the coordinates in which limits are intervals: a number
// that is at its limit and would leave it is fixed for a step. The step is found for six unknowns, however long the
// chain is. For chains that have too many links for Newton's method.
namespace bendy {
namespace {

constexpr std::size_t kMost = 6;
using Unknowns = std::array<double, kMost>;
using Matrix = std::array<Unknowns, kMost>;

/// At the tip: a force and a torque.
struct Screw {
    glm::dvec3 along{0.0}, about{0.0};
};

class LeastSquares {
public:
    explicit LeastSquares(IkProblem& problem)
        : problem_(problem),
          position_(std::sqrt(problem.position_weight)),
          rotation_(problem.has_rotation ? std::sqrt(problem.rotation_weight) : 0.0) {
        for (IkLink& link : problem.links) link.chart.read(link, link.local);
    }

    [[nodiscard]] bool is_reached() const { return problem_.is_reached(); }
    [[nodiscard]] Measured measure() const { return measured(problem_.links, problem_.cost()); }
    void take_step(double spring, double damping) {
        const Screw errors{position_ * (problem_.target - problem_.tip),
                           rotation_ * to_vector(problem_.target_rotation * glm::conjugate(problem_.tip_global))};
        for (std::size_t i = 0; i < problem_.links.size(); ++i)
            open_ways(problem_.links[i], problem_.parent_global(i), torque(problem_.links[i], errors), spring);
        Matrix A = gather();
        Unknowns y{errors.along.x, errors.along.y, errors.along.z, errors.about.x, errors.about.y, errors.about.z};
        solve_damped(A[0].data(), kMost, kMost, damping, y.data());
        const Screw force{{y[0], y[1], y[2]}, {y[3], y[4], y[5]}};
        for (IkLink& link : problem_.links) bendy::take_step(link, torque(link, force));
        problem_.place();
    }
    void take_back_step() {
        for (IkLink& link : problem_.links) bendy::take_back_step(link);
        problem_.place();
    }

private:
    [[nodiscard]] glm::dvec3 torque(const IkLink& link, const Screw& force) const {
        return position_ * glm::cross(problem_.tip - link.position, force.along) + rotation_ * force.about;
    }

    /// Returns the sum of J mobility J^T, J of each link: a rotation w moves the tip by cross(w, arm), and rotates it
    /// by w.
    [[nodiscard]] Matrix gather() const {
        glm::dmat3 pp(0.0);
        glm::dmat3 pr(0.0);
        glm::dmat3 rr(0.0);
        for (const IkLink& link : problem_.links) {
            if (link.way_count == 0) continue;
            const glm::dmat3 cross_arm = cross_matrix(problem_.tip - link.position);
            const glm::dmat3 left = cross_arm * link.mobility;
            pp -= left * cross_arm;  // the transpose of [arm]x is -[arm]x
            pr -= left;
            rr += link.mobility;
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

    IkProblem& problem_;
    double position_, rotation_;  ///< square roots of the weights
};

}  // namespace

std::uint32_t solve_least_squares(IkProblem& problem, std::uint32_t most) {
    LeastSquares method(problem);
    return descend_damped(method, most);
}

}  // namespace bendy
