#include "optimise/carried_points.h"

#include <gtest/gtest.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include <random>
#include <vector>

namespace bendy::converter::carried_points_test {
namespace {

/// Two poses of some carriers, of which the second is off by about `off`.
struct Poses {
    EvaluatedPose exact, decoded;
};

Poses make_poses(std::mt19937& random, std::size_t carriers, double off) {
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    const auto vector = [&] { return glm::dvec3(number(random), number(random), number(random)); };
    Poses poses;
    for (std::size_t k = 0; k < carriers; ++k) {
        const glm::dmat4 place = glm::rotate(glm::translate(glm::dmat4(1.0), vector()), number(random), vector());
        poses.exact.joints.push_back(place);
        poses.decoded.joints.push_back(glm::rotate(glm::translate(place, off * vector()), off, vector()));
    }
    return poses;
}

TEST(CarriedPoints, FindsTheFarthestOfAll) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    const auto vector = [&] { return glm::dvec3(number(random), number(random), number(random)); };
    for (const double apart : {0.0, 1e-3}) {
        struct Point {
            std::uint32_t joint, carrier;
            glm::dvec3 exact, decoded;
        };
        std::vector<Point> all;
        CarriedPoints points;
        for (std::uint32_t joint = 0; joint < 500; ++joint) {
            const std::uint32_t carrier = joint % 5 == 4 ? kNone : joint % 5;
            const glm::dvec3 exact = vector();
            all.push_back({joint, carrier, exact, exact + apart * vector()});
            points.add(joint, carrier, all.back().exact, all.back().decoded);
        }
        points.build();
        for (int k = 0; k < 20; ++k) {
            const Poses poses = make_poses(random, 4, 1e-3);
            double right = 0.0;
            std::uint32_t farthest = kNone;
            for (const Point& point : all) {
                const auto place = [&](const EvaluatedPose& pose, const glm::dvec3& at) {
                    return point.carrier == kNone ? at : glm::dvec3(pose.joints[point.carrier] * glm::dvec4(at, 1.0));
                };
                const double metres =
                    glm::distance(place(poses.exact, point.exact), place(poses.decoded, point.decoded));
                if (metres > right) {
                    right = metres;
                    farthest = point.joint;
                }
            }
            double most = 0.0;
            std::uint32_t found = kNone;
            points.visit_farther(poses.exact, poses.decoded, most, [&](std::uint32_t joint, double metres) {
                most = metres;
                found = joint;
            });
            EXPECT_NEAR(most, right, 1e-12);
            EXPECT_EQ(found, farthest);
        }
    }
}

TEST(CarriedPoints, APoseCostsNoWorkForEachPoint) {
    std::mt19937 random(5);
    constexpr std::uint32_t kPoints = 4000;
    constexpr int kPoses = 1000;
    CarriedPoints points;
    for (std::uint32_t joint = 0; joint < kPoints; ++joint) {
        const glm::dvec3 place(0.001 * joint, 1.0, 0.0);
        points.add(joint, 0, place, place);
    }
    points.build();
    double most = 0.0;
    for (int k = 0; k < kPoses; ++k) {
        const Poses poses = make_poses(random, 1, 1e-3);
        points.visit_farther(poses.exact, poses.decoded, most, [&](std::uint32_t, double metres) { most = metres; });
    }
    EXPECT_GT(most, 0.0);
    EXPECT_LT(points.work(), 4u * kPoints);  // of 4,000,000
}

}  // namespace
}  // namespace bendy::converter::carried_points_test
