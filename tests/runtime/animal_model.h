#pragma once

#include "runtime/body_model.h"

#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bendy::test {

/// How an animal is built. Lengths in metres, angles in degrees: a bone hangs at 0, and leans forward above it.
struct AnimalSpec {
    BodyAxes body{};
    std::array<double, 3> hind{0.33, 0.43, 0.24};         ///< thigh, shin, from hock to paw
    std::array<double, 3> hind_leans{22.0, -38.0, 10.0};  ///< of these
    std::vector<double> front{0.4, 0.36};                 ///< from shoulder to elbow, wrist, paw
    std::vector<double> front_leans{-20.0, 1.0};
    double trunk = 1.2;       ///< from the hips to the shoulders
    bool has_girdles = true;  ///< shoulder blades and pelvis
    bool has_toes = true;
    bool has_front = true;  ///< otherwise it is a bird without wings
    std::uint32_t spine = 3, neck = 2, tail = 4;
    std::vector<ConstraintRecord> hocks{}, shoulders{}, elbows{};
};

/// An animal made of joints, in the order of the file, standing on the ground. leftHind0 is the hip, leftHind1 the
/// knee, ...; leftFront0 the shoulder; leftHindToes, leftFrontToes; leftHindGirdle, leftFrontGirdle.
class AnimalModel : public BodyModel {
public:
    explicit AnimalModel(const AnimalSpec& animal) : BodyModel(animal.body), animal_(animal) {
        const std::vector<double> hind(animal.hind.begin(), animal.hind.end());
        const std::vector<double> hind_leans(animal.hind_leans.begin(), animal.hind_leans.end());
        const double height = height_of(hind, hind_leans);
        hips_ = add("hips", 0, {0, height + 0.04, -0.05}, Role::hips);
        add_chain("tail", hips_, animal.tail, {0, height, -0.15}, {0, -0.02, -0.25}, Role::tail);
        for (const double side : {1.0, -1.0})
            add_leg(side, "Hind", hips_, hind, hind_leans, 0.0,
                    side > 0.0 ? Role::left_hind_leg : Role::right_hind_leg);
        const double step = animal.trunk / (animal.spine + 1.0);
        chest_ = add_chain("spine", hips_, animal.spine, {0, height + 0.05, step}, {0, 0.01, step}, Role::spine_chain);
        for (const double side : {1.0, -1.0}) {
            if (!animal.has_front) continue;
            add_leg(side, "Front", chest_, animal.front, animal.front_leans, animal.trunk,
                    side > 0.0 ? Role::left_front_leg : Role::right_front_leg);
        }
        const std::uint32_t neck = add_chain("neck", chest_, animal.neck, {0, height + 0.15, animal.trunk + 0.1},
                                             {0, 0.12, 0.12}, Role::neck_chain);
        add("head", neck, {0, height + 0.5, animal.trunk + 0.4}, Role::head);
        store_roles();
    }

private:
    static constexpr double kPaw = 0.1;  // metres above the ground

    static double height_of(const std::vector<double>& bones, const std::vector<double>& leans) {
        double height = kPaw;
        for (std::size_t k = 0; k < bones.size(); ++k) height += bones[k] * std::cos(leans[k] * M_PI / 180.0);
        return height;
    }

    /// Returns the last joint.
    std::uint32_t add_chain(const std::string& name, std::uint32_t parent, std::uint32_t count, glm::dvec3 place,
                            const glm::dvec3& step, Role role) {
        for (std::uint32_t k = 0; k < count; ++k, place += step)
            parent = add(name + std::to_string(k), parent, place, role, k);
        return parent;
    }

    void add_leg(double side, const std::string& which, std::uint32_t carrier, const std::vector<double>& bones,
                 const std::vector<double>& leans, double ahead, Role role) {
        const std::string name = (side > 0.0 ? "left" : "right") + which;
        glm::dvec3 place(side * 0.15, height_of(bones, leans), ahead);
        std::size_t in_chain = 0;
        if (animal_.has_girdles) {
            const double back = which == "Hind" ? -1.0 : 1.0;
            carrier =
                add(name + "Girdle", carrier, place + glm::dvec3(-side * 0.08, 0.2, -0.3 * back), role, in_chain++);
        }
        for (std::size_t k = 0; k <= bones.size(); ++k) {
            carrier = add(name + std::to_string(k), carrier, place, role, in_chain++);
            if (which == "Hind" && k == 2) spec.joints[carrier].constraints = animal_.hocks;
            if (which == "Front" && k < 2)
                spec.joints[carrier].constraints = k == 0 ? animal_.shoulders : animal_.elbows;
            if (k == bones.size()) break;
            const double lean = leans[k] * M_PI / 180.0;
            place += bones[k] * glm::dvec3(0, -std::cos(lean), std::sin(lean));
        }
        if (animal_.has_toes) add(name + "Toes", carrier, {place.x, 0.02, place.z + 0.08}, role, in_chain);
    }

    AnimalSpec animal_;
    std::uint32_t hips_ = 0, chest_ = 0;
};

}  // namespace bendy::test
