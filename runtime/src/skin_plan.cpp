#include "skin_plan.h"

#include <algorithm>
#include <array>

namespace bendy {
namespace {

/// The bones that a group follows.
class Group {
public:
    Group() {}  // NOLINT(*-member-init,*-use-equals-default): what is not used is not set, for speed
    /// False if there are too many.
    bool add(std::uint32_t vertex, std::uint32_t bone, float weight) {
        std::size_t at = 0;
        while (at < count_ && bones_[at] != bone) ++at;
        if (at == count_) {
            if (count_ == bones_.size()) return false;
            bones_[count_] = static_cast<std::uint16_t>(bone);
            weights_[count_] = {};
            ++count_;
        }
        weights_[at].of[vertex] += weight;
        return true;
    }
    void append_to(SkinPlan& plan) const {
        const auto count = static_cast<std::ptrdiff_t>(count_);
        plan.bones.insert(plan.bones.end(), bones_.begin(), bones_.begin() + count);
        plan.weights.insert(plan.weights.end(), weights_.begin(), weights_.begin() + count);
    }

private:
    std::size_t count_ = 0;
    std::array<std::uint16_t, SkinPlan::kMostBones> bones_;        // the first count_ are set
    std::array<SkinPlan::Weights, SkinPlan::kMostBones> weights_;  // as bones_
};

/// A pool's bones and weights, of the types that most files have without a look at the type each time.
struct Influences {
    explicit Influences(const PoolView& pool)
        : bones(*pool.bones),
          weights(*pool.weights),
          count(bones.components),
          is_narrow(bones.type == ComponentType::u8),
          is_float(weights.type == ComponentType::f32),
          bones8(is_narrow ? bones.as<std::uint8_t>() : std::span<const std::uint8_t>{}),
          bones16(is_narrow ? std::span<const std::uint16_t>{} : bones.as<std::uint16_t>()),
          floats(is_float ? weights.as<float>() : std::span<const float>{}) {}

    [[nodiscard]] float weight(std::uint32_t vertex, std::uint32_t k) const {
        return is_float ? floats[std::size_t{vertex} * count + k] : weights.number(vertex, k);
    }
    [[nodiscard]] std::uint32_t bone(std::uint32_t vertex, std::uint32_t k) const {
        const std::size_t at = std::size_t{vertex} * count + k;
        return is_narrow ? bones8[at] : bones16[at];
    }

    const StreamView& bones;
    const StreamView& weights;
    std::uint32_t count;
    bool is_narrow, is_float;
    std::span<const std::uint8_t> bones8;
    std::span<const std::uint16_t> bones16;
    std::span<const float> floats;
};

/// Vertices [first, end). Bones that no weight goes to are left out, but for one.
bool fill_group(const Influences& influences, std::uint32_t first, std::uint32_t end, Group& group) {
    bool is_empty = true;
    for (std::uint32_t vertex = first; vertex < end; ++vertex) {
        for (std::uint32_t k = 0; k < influences.count; ++k) {
            const float weight = influences.weight(vertex, k);
            if (weight == 0.0f) continue;
            is_empty = false;
            if (!group.add(vertex - first, influences.bone(vertex, k), weight)) return false;
        }
    }
    return !is_empty || group.add(0, influences.bone(first, 0), 0.0f);
}

}  // namespace

SkinPlan make_skin_plan(const PoolView& pool) {
    SkinPlan plan;
    if (pool.is_rigid() || pool.bones->components == 0) return plan;
    constexpr auto kGroup = static_cast<std::uint32_t>(SkinPlan::kGroup);
    const Influences influences(pool);
    plan.first.reserve(pool.vertices / kGroup + std::size_t{2});
    plan.first.push_back(0);
    plan.is_complete = true;
    for (std::uint32_t first = 0; first < pool.vertices;) {
        const std::uint32_t end = first + std::min(kGroup, pool.vertices - first);
        Group group;
        if (fill_group(influences, first, end, group)) {
            group.append_to(plan);
        } else {
            plan.is_complete = false;
        }
        plan.first.push_back(static_cast<std::uint32_t>(plan.bones.size()));
        first = end;
    }
    return plan;
}

}  // namespace bendy
