#include "damped_step.h"

#include <cmath>

namespace bendy {

void solve_damped(double* A, std::size_t stride, std::size_t size, double damping, double* y) {
    for (std::size_t j = 0; j < size; ++j) {
        const double* const row = A + j * stride;
        double diagonal = row[j] + damping;
        for (std::size_t k = 0; k < j; ++k) diagonal -= row[k] * row[k];
        A[j * stride + j] = std::sqrt(std::max(diagonal, 1e-30));
        for (std::size_t i = j + 1; i < size; ++i) {
            double* const other = A + i * stride;
            double sum = other[j];
            for (std::size_t k = 0; k < j; ++k) sum -= other[k] * row[k];
            other[j] = sum / row[j];
        }
    }
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = 0; k < i; ++k) y[i] -= A[i * stride + k] * y[k];
        y[i] /= A[i * stride + i];
    }
    for (std::size_t i = size; i-- > 0;) {
        for (std::size_t k = i + 1; k < size; ++k) y[i] -= A[k * stride + i] * y[k];
        y[i] /= A[i * stride + i];
    }
}

void open_ways(IkLink& link, const glm::dquat& parent, const glm::dvec3& torque, double spring) {
    link.way_count = 0;
    link.mobility = glm::dmat3(0.0);
    LimitChart& chart = link.chart;
    if (chart.size() == 0) return;
    chart.rebase(link.local);
    const glm::dmat3 space = glm::mat3_cast(parent * chart.basis());
    if (chart.is_free() && link.freedom == glm::dvec3(1.0)) {
        for (int n = 0; n < 3; ++n)
            link.ways[link.way_count++] = {{n == 0 ? 1.0 : 0.0, n == 1 ? 1.0 : 0.0, n == 2 ? 1.0 : 0.0}, space[n]};
        link.mobility = glm::dmat3(1.0);
        return;
    }
    const glm::dvec3 pull = spring * Spring(link).turn;
    const auto axes = chart.axes();
    const auto ways = chart.ways();
    std::array<glm::dvec3, 3> strains{};
    for (std::size_t n = 0; n < chart.size(); ++n) {
        LimitChart::Numbers numbers = ways[n].numbers;
        const glm::dvec3 by = numbers[0] * axes[0] + numbers[1] * axes[1] + numbers[2] * axes[2];
        glm::dvec3 axis = space * by;
        glm::dvec3 strain = strain_of(link, chart.basis() * by);
        if (ways[n].is_stopped(glm::dot(strain, pull) - glm::dot(axis, torque))) continue;
        const double size = glm::dot(strain, strain);
        for (std::size_t k = 0; k < link.way_count; ++k) {
            const double part = glm::dot(strain, strains[k]);
            strain -= part * strains[k];
            axis -= part * link.ways[k].axis;
            for (std::size_t i = 0; i < 3; ++i) numbers[i] -= part * link.ways[k].numbers[i];
        }
        const double left = glm::dot(strain, strain);
        if (!(left > 1e-6 * size)) continue;
        const double unit = 1.0 / std::sqrt(left);
        for (double& number : numbers) number *= unit;
        axis *= unit;
        strains[link.way_count] = strain * unit;
        link.ways[link.way_count++] = {numbers, axis};
        link.mobility += glm::outerProduct(axis, axis);
    }
}

void take_step(IkLink& link, const glm::dvec3& torque) {
    if (link.chart.size() == 0) return;
    LimitChart::Numbers by{};
    for (std::size_t k = 0; k < link.way_count; ++k) {
        const double step = glm::dot(link.ways[k].axis, torque);
        for (std::size_t i = 0; i < 3; ++i) by[i] += step * link.ways[k].numbers[i];
    }
    constexpr double kLongest = 1.0;  // radians: beyond it the derivative is meaningless
    const double angle = glm::length(link.mobility * torque);
    if (angle > kLongest) {
        for (double& number : by) number *= kLongest / angle;
    }
    take_step(link, by);
}

}  // namespace bendy
