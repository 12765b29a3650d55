#include "posture.h"

#include <glm/geometric.hpp>

#include <utility>

namespace bendy::converter {
namespace {

using Bone = HumanBone;

class Measurer {
public:
    Measurer(const RestFrames& rest, const NamedHumanoid& found) : rest_(rest), found_(found) {}

    [[nodiscard]] std::optional<Posture> measure() const {
        const auto arms = line(Bone::right_upper_arm, Bone::left_upper_arm);
        const auto legs = line(Bone::right_upper_leg, Bone::left_upper_leg);
        if (!arms && !legs) return std::nullopt;
        const auto left = unit((arms ? *arms : glm::dvec3(0.0)) + (legs ? *legs : glm::dvec3(0.0)));
        const auto stands = up_from_legs();
        const auto spine = up_spine();
        if (!left || (!stands && !spine)) return std::nullopt;
        Posture posture;
        posture.is_upright = !stands || !spine || glm::dot(*stands, *spine) > kUpright;
        const auto up = unit_across(posture.is_upright && spine ? *spine : *stands, *left);
        if (!up) return std::nullopt;
        posture.stance = {*left, *up, glm::cross(*left, *up)};
        posture.has_feet_forward = has_feet_forward(posture.stance);
        return posture;
    }

private:
    [[nodiscard]] bool has_feet_forward(const Stance& stance) const {
        for (const auto& [foot, toes] :
             {std::pair(Bone::left_foot, Bone::left_toes), std::pair(Bone::right_foot, Bone::right_toes)}) {
            const auto direction = line(foot, toes);
            if (direction && glm::dot(*direction, stance.forward) < -0.3) return false;
        }
        return true;
    }

    static constexpr double kUpright = 0.7;  // cosine: 45 degrees

    [[nodiscard]] std::optional<glm::dvec3> line(Bone from, Bone to) const {
        if (!found_.bones.has(from) || !found_.bones.has(to)) return std::nullopt;
        return rest_.direction(found_.bones[from], found_.bones[to]);
    }

    [[nodiscard]] std::optional<glm::dvec3> up_from_legs() const {
        glm::dvec3 sum(0.0);
        for (const Limb leg : {Limb::left_leg, Limb::right_leg}) {
            const LimbBones bones = bones_of(leg);
            if (!found_.bones.has(bones.upper)) continue;
            const std::optional<glm::dvec3> end = end_of(found_, rest_, leg);
            if (!end && !found_.bones.has(bones.lower)) continue;
            const glm::dvec3 foot = end ? *end : rest_.position(found_.bones[bones.lower]);
            if (const auto up = unit(rest_.position(found_.bones[bones.upper]) - foot)) sum += *up;
        }
        return unit(sum);
    }

    [[nodiscard]] std::optional<glm::dvec3> up_spine() const {
        for (const Bone top : {Bone::neck, Bone::head}) {
            for (const Bone bottom : {Bone::hips, Bone::spine}) {
                if (const auto up = line(bottom, top)) return up;
            }
        }
        return std::nullopt;
    }

    const RestFrames& rest_;
    const NamedHumanoid& found_;
};

}  // namespace

std::optional<Posture> measure_posture(const RestFrames& rest, const NamedHumanoid& found) {
    return Measurer(rest, found).measure();
}

}  // namespace bendy::converter
