#include "handles.h"

namespace bendy::capi {
namespace {

template <class Things>
std::vector<std::string> names_of(const Things& things) {
    std::vector<std::string> names;
    names.reserve(things.size());
    for (const auto& thing : things) names.emplace_back(thing.name);
    return names;
}

Names names_in(const Model& model) {
    Names names{std::string(model.name()),
                names_of(model.joints()),
                names_of(model.cycles()),
                names_of(model.chains()),
                {},
                names_of(model.pools()),
                names_of(model.materials()),
                {}};
    for (const Pool& pool : model.pools()) {
        for (const TargetView& target : pool.targets) names.targets.emplace_back(target.name);
    }
    for (const Cycle& cycle : model.cycles()) {
        std::vector<CurveNames>& curves = names.curves.emplace_back();
        for (const CurveView& curve : cycle.curves)
            curves.push_back({std::string(curve.name), std::string(curve.path)});
    }
    return names;
}

}  // namespace

Character::Character(Source from, Model loaded)
    : source(std::move(from)), model(std::move(loaded)), names(names_in(model)) {
    for (std::uint32_t mesh = 0; mesh < model.pools().size(); ++mesh)
        target_meshes.insert(target_meshes.end(), model.pools()[mesh].targets.size(), mesh);
}

}  // namespace bendy::capi
