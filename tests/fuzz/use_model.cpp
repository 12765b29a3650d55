#include "use_model.h"

#include "check.h"

#include <bendy/runtime/kernels.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <vector>

namespace bendy::fuzz {
namespace {

/// Reads every byte, so that a sanitizer sees it.
void look_at(std::string_view text) {
    volatile unsigned sum = 0;
    for (const char letter : text) sum = sum + static_cast<unsigned char>(letter);
}

void look_at(const StreamView& stream, std::uint32_t elements) {
    volatile float sum = 0.0f;
    for (std::uint32_t element = 0; element < elements; ++element) {
        for (std::uint32_t component = 0; component < stream.components; ++component)
            sum = sum + stream.number(element, component);
    }
}

void read_materials(const Model& model) {
    for (const Material& material : model.materials()) {
        look_at(material.name);
        look_at(material.extensions);
        look_at(material.extras);
        for (const TextureUseRecord& use :
             {material.surface.base_colour_texture, material.surface.metallic_roughness_texture,
              material.surface.normal_texture, material.surface.occlusion_texture, material.surface.emissive_texture})
            check(use.texture == kNone || use.texture < model.textures().size(), "a material's texture is there");
    }
    for (const Texture& texture : model.textures()) {
        look_at(texture.name);
        look_at(texture.extras);
        for (const ImageView& image : texture.images) {
            look_at(image.uri);
            look_at(as_text(image.bytes));
            if (image.same) look_at(as_text(model.textures()[image.same->texture].images[image.same->image].bytes));
        }
    }
}

void read_all(const Model& model) {
    look_at(model.name());
    const std::size_t joints = model.joints().size();
    for (std::uint32_t number = 0; number < joints; ++number) {
        const Joint& joint = model.joints()[number];
        look_at(joint.name);
        look_at(joint.extras);
        check(joint.parent == kNone || joint.parent < number, "a parent stands before its joint");
    }
    for (const Constraint& constraint : model.constraints())
        check(constraint.joint < joints, "a constraint's joint is there");
    for (const Chain& chain : model.chains()) {
        look_at(chain.name);
        look_at(chain.extras);
        check(chain.start <= chain.effector && chain.effector < joints, "a chain's joints are there");
        check(chain.target == kNone || chain.target < joints, "a chain's target is there");
        check(chain.pole == kNone || chain.pole < joints, "a chain's pole is there");
        for (const PullView& pull : model.chain_weights(chain)) check(pull.joint < joints, "a weight's joint is there");
    }
    for (const Draw& draw : model.draws()) {
        const Pool& pool = model.pools()[draw.pool];
        check(draw.material == kNone || draw.material < model.materials().size(), "a draw's material is there");
        for (std::uint32_t k = 0; k < draw.count; ++k)
            check(pool.indices->index(draw.first + k, 0) < pool.vertices, "an index is in its pool");
    }
    for (const PolygonView& polygons : model.polygons()) check(polygons.joint < joints, "a polygon's joint is there");
    for (const Pool& pool : model.pools()) {
        look_at(pool.name);
        look_at(pool.extras);
        for (const StreamView& stream : pool.texture_coords) look_at(stream, pool.vertices);
        for (const StreamView& stream : pool.colours) look_at(stream, pool.vertices);
        for (const AttributeView& attribute : pool.attributes) look_at(attribute.values, pool.vertices);
        for (const TargetView& target : pool.targets) look_at(target.name);
    }
    read_materials(model);
}

void reach_all(const Model& model, Pose& pose) {
    const ReachTarget target({0.3f, 0.9f, 0.2f}, glm::quat(0.6f, 0.0f, 0.8f, 0.0f));
    std::size_t chains = 0;
    for (const Chain& chain : model.chains()) {
        if (++chains > 8) break;  // one is like another
        for (unsigned solver = 0; solver < kSolvers; ++solver) {
            ReachOptions options;
            options.solver = static_cast<Solver>(solver);
            options.iterations = 3;
            options.restarts = 1;
            options.obey_constraints = solver % 2 == 0;
            (void)reach(pose, &chain, target, options);
            (void)reach(pose, &chain, glm::vec3(0.1f, 1.2f, -0.3f), options);
        }
    }
}

/// All that can be skinned, into memory of exactly the size that is asked for.
class Skins {
public:
    explicit Skins(const Model& model)
        : model_(model),
          positions_(model.vertex_count()),
          normals_(model.vertex_count()),
          tangents_(model.vertex_count()) {}

    void skin_all(Pose& pose) {
        check(skin(pose, {.out = {positions_, normals_, tangents_}}).has_value(),
              "skinning into memory that is large enough");
        check(skin(pose, {.out = {.positions = positions_}}).has_value(), "skinning positions alone");
        for (std::uint32_t pool = 0; pool < model_.pools().size(); ++pool) (void)pose.palette(pool);
    }

    void skin_levels(Pose& pose, Lod& lod) {
        for (const float share : {0.5f, 0.0f, std::numeric_limits<float>::quiet_NaN()}) {
            lod.set_share(share);
            for (const Draw& draw : lod.draws()) {
                const auto indices = lod.indices(draw.pool).subspan(draw.first, draw.count);
                for (const std::uint32_t index : indices)
                    check(index < lod.vertices(draw.pool), "what is drawn is alive");
            }
            check(skin(pose, {.lod = &lod, .out = {positions_, normals_, tangents_}}).has_value(),
                  "skinning a level of detail");
        }
    }

private:
    const Model& model_;
    std::vector<glm::vec3> positions_, normals_;
    std::vector<glm::vec4> tangents_;
};

}  // namespace

void use_model(const Model& model, unsigned choice) {
    (void)set_kernel(kernels()[choice % kernels().size()]);
    read_all(model);

    Pose pose(model);
    Skins skins(model);
    skins.skin_all(pose);
    constrain(pose);
    reach_all(model, pose);
    skins.skin_all(pose);

    Pose other(model);
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    std::size_t cycles = 0;
    for (const Cycle& cycle : model.cycles()) {
        if (++cycles > 16) break;
        look_at(cycle.name);
        for (const Marker& marker : cycle.markers) look_at(marker.name);
        for (const Curve& curve : cycle.curves) {
            look_at(curve.name);
            look_at(curve.path);
            std::array<float, 4> value{};
            for (const float seconds : {cycle.start, 0.3f, cycle.end, std::numeric_limits<float>::quiet_NaN()})
                sample_curve(curve, seconds, value);
        }
        const float middle = cycle.start + 0.4f * (cycle.end - cycle.start);
        for (const float seconds : {cycle.start, middle, cycle.end}) {
            (void)sample(pose, &cycle, seconds);
            skins.skin_all(pose);
        }
        for (const float seconds : {-1.0f, 1e30f, kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()})
            (void)sample(other, &cycle, seconds);
        (void)sample(other, &cycle, static_cast<float>(choice % 97) * 0.05f);
        (void)blend(pose, other, 0.3f);
        (void)make_additive(other, pose);
        (void)add(pose, other, 0.7f, model.joints().empty() ? std::vector<float>{} : mask_below(model, 0));
        skins.skin_all(pose);
    }
    if (model.collapse() != nullptr) {
        Lod lod(model);
        skins.skin_levels(pose, lod);
    }
}

}  // namespace bendy::fuzz
