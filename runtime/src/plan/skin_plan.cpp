#include "skin_plan.h"

#include <algorithm>
#include <limits>

namespace bendy {
namespace {

constexpr std::uint32_t kAbsent = ~std::uint32_t{0};
constexpr std::uint32_t kMostBones = SkinPlan::kMostBones;

/// For each group of vertices, collects the bones that move it and their weights.
template <class Bone>
class Lists {
public:
    Lists(std::span<const Bone> bones, std::size_t influences, SkinPlan& plan)
        : bones_(bones), influences_(influences), plan_(plan) {
        Bone most = 0;
        for (const Bone bone : bones) most = std::max(most, bone);
        places_.resize(most + std::size_t{1}, kAbsent);
    }

    /// Adds `count` vertices from `first` on. Bones without weight are left out, except for one; nothing is appended if
    /// there are too many. weight_at(number of the influence).
    template <class WeightAt>
    void append(std::size_t first, std::size_t count, const WeightAt& weight_at) {
        const std::size_t begin = plan_.bones.size();
        plan_.bones.resize(begin + kMostBones + 1);
        plan_.weights.resize(begin + kMostBones + 1);  // zeros
        std::uint16_t* const bones = plan_.bones.data() + begin;
        SkinPlan::Weights* const weights = plan_.weights.data() + begin;
        std::uint32_t* const places = places_.data();
        std::uint32_t listed = 0;
        for (std::size_t vertex = 0; vertex < count && listed <= kMostBones; ++vertex) {
            std::size_t at = (first + vertex) * influences_;
            for (const std::size_t end = at + influences_; at < end && listed <= kMostBones; ++at) {
                const float weight = weight_at(at);
                if (weight == 0.0f) continue;
                // Branchless: whether a bone is new to a group is unpredictable.
                const std::size_t bone = bones_[at];
                const std::uint32_t place = std::min(places[bone], listed);
                places[bone] = place;
                bones[place] = static_cast<std::uint16_t>(bone);
                weights[place].of[vertex] += weight;
                listed = std::max(listed, place + 1);
            }
        }
        for (std::size_t k = 0; k < listed; ++k) places[bones[k]] = kAbsent;
        if (listed == 0) bones[listed++] = bones_[first * influences_];
        if (listed > kMostBones) {
            listed = 0;
            plan_.is_complete = false;
        }
        plan_.bones.resize(begin + listed);
        plan_.weights.resize(begin + listed);
    }

private:
    std::span<const Bone> bones_;
    std::size_t influences_;
    SkinPlan& plan_;
    std::vector<std::uint32_t> places_;  // for each bone, its index in the group's list
};

template <class Bone, class WeightAt>
void list(const MeshView& mesh, SkinPlan& plan, const WeightAt& weight_at) {
    constexpr std::size_t kProbe = 64;
    const std::size_t groups = (std::size_t{mesh.vertices} + SkinPlan::kGroup - 1) / SkinPlan::kGroup;
    plan.first.reserve(groups + 1);
    plan.first.push_back(0);
    plan.is_complete = true;
    Lists<Bone> lists(mesh.bones->as<Bone>(), mesh.bones->components, plan);
    for (std::size_t group = 0; group < groups; ++group) {
        const std::size_t first = group * SkinPlan::kGroup;
        lists.append(first, std::min(SkinPlan::kGroup, mesh.vertices - first), weight_at);
        plan.first.push_back(static_cast<std::uint32_t>(plan.bones.size()));
        if (group + 1 == kProbe) {  // the other groups are assumed to be similar
            plan.bones.reserve(plan.bones.size() * (groups / kProbe + 1));
            plan.weights.reserve(plan.bones.capacity());
        }
    }
}

template <class Bone, class Integer>
void list_normalised(const MeshView& mesh, SkinPlan& plan) {
    const auto numbers = mesh.weights->as<Integer>();
    list<Bone>(mesh, plan, [=](std::size_t at) {
        constexpr auto kOne = static_cast<float>(std::numeric_limits<Integer>::max());
        return static_cast<float>(numbers[at]) / kOne;
    });
}

template <class Bone>
void list(const MeshView& mesh, SkinPlan& plan) {
    const StreamView& weights = *mesh.weights;
    const bool is_boxed = !weights.boxes.empty();
    if (weights.type == ComponentType::f32) {
        const auto numbers = weights.as<float>();
        list<Bone>(mesh, plan, [=](std::size_t at) { return numbers[at]; });
    } else if (weights.type == ComponentType::u8 && !is_boxed) {
        list_normalised<Bone, std::uint8_t>(mesh, plan);
    } else if (weights.type == ComponentType::u16 && !is_boxed) {
        list_normalised<Bone, std::uint16_t>(mesh, plan);
    } else {
        std::vector<float> numbers(std::size_t{weights.elements} * weights.components);
        weights.decode(numbers);
        list<Bone>(mesh, plan, [&](std::size_t at) { return numbers[at]; });
    }
}

}  // namespace

SkinPlan make_skin_plan(const MeshView& mesh) {
    SkinPlan plan;
    if (mesh.is_rigid() || mesh.bones->components == 0) return plan;
    if (mesh.bones->type == ComponentType::u8) {
        list<std::uint8_t>(mesh, plan);
    } else {
        list<std::uint16_t>(mesh, plan);
    }
    return plan;
}

}  // namespace bendy
