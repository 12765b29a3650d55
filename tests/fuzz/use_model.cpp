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
        check(chain.record.start <= chain.record.effector && chain.record.effector < joints,
              "a chain's joints are there");
        check(chain.record.target == kNone || chain.record.target < joints, "a chain's target is there");
        check(chain.record.pole == kNone || chain.record.pole < joints, "a chain's pole is there");
        for (const ChainWeightView& chain_weight : model.chain_weights(chain))
            check(chain_weight.joint < joints, "a weight's joint is there");
    }
    for (const Submesh& submesh : model.submeshes()) {
        const Mesh& mesh = model.meshes()[submesh.mesh];
        check(submesh.material == kNone || submesh.material < model.materials().size(),
              "a submesh's material is there");
        for (std::uint32_t k = 0; k < submesh.count; ++k)
            check(mesh.indices->index(submesh.first + k, 0) < mesh.vertices, "an index is in its mesh");
    }
    for (const SubmeshView& submesh : model.joint_submeshes())
        check(submesh.joint < joints, "a polygon's joint is there");
    for (const Mesh& mesh : model.meshes()) {
        look_at(mesh.name);
        look_at(mesh.extras);
        for (const StreamView& stream : mesh.texture_coords) look_at(stream, mesh.vertices);
        for (const StreamView& stream : mesh.colours) look_at(stream, mesh.vertices);
        for (const AttributeView& attribute : mesh.attributes) look_at(attribute.values, mesh.vertices);
        for (const MorphTargetView& target : mesh.targets) look_at(target.name);
    }
    read_materials(model);
}

void reach_all(const Model& model, Pose& pose) {
    const ReachTarget target({0.3f, 0.9f, 0.2f}, glm::quat(0.6f, 0.0f, 0.8f, 0.0f));
    std::size_t chains = 0;
    ReachState state(model);
    for (const Chain& chain : model.chains()) {
        if (++chains > 8) break;  // one is like another
        for (unsigned solver = 0; solver < kSolvers; ++solver) {
            ReachOptions options;
            options.solver = static_cast<Solver>(solver);
            options.iterations = 3;
            options.restarts = 1;
            options.obey_constraints = solver % 2 == 0;
            (void)reach(pose, &chain, target, options);
            options.state = &state;
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
        for (std::uint32_t mesh = 0; mesh < model_.meshes().size(); ++mesh) (void)pose.palette(mesh);
    }

    void skin_levels(Pose& pose, Lod& lod) {
        for (const float share : {0.5f, 0.0f, std::numeric_limits<float>::quiet_NaN()}) {
            lod.set_share(share);
            for (const Submesh& submesh : lod.submeshes()) {
                const auto indices = lod.indices(submesh.mesh).subspan(submesh.first, submesh.count);
                for (const std::uint32_t index : indices)
                    check(index < lod.vertices(submesh.mesh), "what is drawn is alive");
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
    std::size_t clips = 0;
    for (const Clip& clip : model.clips()) {
        if (++clips > 16) break;
        look_at(clip.name);
        for (const Marker& marker : clip.markers) look_at(marker.name);
        for (const Curve& curve : clip.curves) {
            look_at(curve.name);
            look_at(curve.path);
            std::array<float, 4> value{};
            for (const float seconds : {clip.start, 0.3f, clip.end, std::numeric_limits<float>::quiet_NaN()})
                (void)sample_curve(curve, seconds, value);
        }
        const float middle = clip.start + 0.4f * (clip.end - clip.start);
        for (const float seconds : {clip.start, middle, clip.end}) {
            (void)sample(pose, &clip, seconds);
            skins.skin_all(pose);
        }
        for (const float seconds : {-1.0f, 1e30f, kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()})
            (void)sample(other, &clip, seconds);
        (void)sample(other, &clip, static_cast<float>(choice % 97) * 0.05f);
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
