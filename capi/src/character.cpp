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
                names_of(model.clips()),
                names_of(model.chains()),
                {},
                names_of(model.meshes()),
                names_of(model.materials()),
                {}};
    for (const Mesh& mesh : model.meshes()) {
        for (const MorphTargetView& target : mesh.targets) names.targets.emplace_back(target.name);
    }
    for (const Clip& clip : model.clips()) {
        std::vector<CurveNames>& curves = names.curves.emplace_back();
        for (const CurveView& curve : clip.curves) curves.push_back({std::string(curve.name), std::string(curve.path)});
    }
    return names;
}

}  // namespace

Character::Character(Source from, Model loaded)
    : source(std::move(from)), model(std::move(loaded)), names(names_in(model)) {
    for (std::uint32_t mesh = 0; mesh < model.meshes().size(); ++mesh)
        target_meshes.insert(target_meshes.end(), model.meshes()[mesh].targets.size(), mesh);
}

}  // namespace bendy::capi
