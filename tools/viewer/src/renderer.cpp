#include "renderer.h"

#include "shading.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace bendy::viewer {
namespace {

enum WhichFaces : GLint { kBothFaces, kFrontFaces, kBackFaces };

bool is_blended(const SurfaceRecord& surface) {
    return static_cast<AlphaMode>(surface.alpha_mode) == AlphaMode::blend;
}

/// KHR_texture_transform: T * R * S.
glm::mat3 uv_matrix(const TextureUseRecord& use) {
    const float c = std::cos(use.rotation);
    const float s = std::sin(use.rotation);
    return {glm::vec3(c * use.scale[0], -s * use.scale[0], 0.0f), glm::vec3(s * use.scale[1], c * use.scale[1], 0.0f),
            glm::vec3(use.offset[0], use.offset[1], 1.0f)};
}

struct MapUse {
    const TextureUseRecord* record;
    const char* sampler;
    Texels texels;
};

constexpr std::uint32_t kLastSet = 3;  // of texture coordinates

enum Map : std::size_t { kBaseColour, kMetallicRoughness, kNormal, kOcclusion, kEmissive };

std::array<MapUse, 5> maps_of(const SurfaceRecord& surface) {
    return {{{&surface.base_colour_texture, "base_colour_map", Texels::srgb},
             {&surface.metallic_roughness_texture, "metallic_roughness_map", Texels::linear},
             {&surface.normal_texture, "normal_map", Texels::linear},
             {&surface.occlusion_texture, "occlusion_map", Texels::linear},
             {&surface.emissive_texture, "emissive_map", Texels::srgb}}};
}

/// Lines, points and unlit surfaces show their base colour only.
bool is_lit(const Submesh& submesh, const SurfaceRecord& surface) {
    return surface.unlit == 0 && submesh.topology == Topology::triangles;
}

/// Returns the share of an image's side that a submesh shows, above 0 to 1.
double shown_share(const Model& model, const TextureUse& use) {
    const Mesh& mesh = model.meshes()[use.submesh->mesh];
    const std::uint32_t set = std::min(use.record->coords, kLastSet);
    const auto coords = std::find_if(mesh.texture_coords.begin(), mesh.texture_coords.end(),
                                     [set](const StreamView& stream) { return stream.set == set; });
    if (coords == mesh.texture_coords.end() || coords->components < 2) return 1.0;
    const glm::mat3 matrix = uv_matrix(*use.record);
    glm::vec2 low(std::numeric_limits<float>::max());
    glm::vec2 high = -low;
    for (std::uint32_t k = 0; k < use.submesh->count; ++k) {
        const std::uint32_t vertex = mesh.indices->index(use.submesh->first + k, 0);
        const glm::vec2 uv(matrix * glm::vec3(coords->number(vertex, 0), coords->number(vertex, 1), 1.0f));
        low = glm::min(low, uv);
        high = glm::max(high, uv);
    }
    const glm::vec2 extent = high - low;
    constexpr double kLeast = 1.0 / 16'384.0;
    return std::max(std::min(1.0, static_cast<double>(std::max(extent.x, extent.y))), kLeast);  // 1 if not a number
}

/// 16 entries a side, as in three.js.
void upload_reflectance(GLuint texture) {
    constexpr GLsizei kSide = 16;
    bind_texture(kUploadUnit, GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, kSide, kSide, 0, GL_RG, GL_FLOAT, reflectance_table(kSide).data());
    for (const GLenum filter : std::array<GLenum, 2>{GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (const GLenum wrap : std::array<GLenum, 2>{GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
}

void set_vector(GLint place, const glm::vec3& v) {
    glUniform3fv(place, 1, glm::value_ptr(v));
}

std::vector<glm::vec3> draw_centres(const Model& model) {
    std::vector<glm::vec3> positions(model.vertex_count());
    Pose pose(model);
    (void)skin(pose, {.out = {.positions = positions}});
    std::vector<glm::vec3> centres;
    for (const Submesh& submesh : model.submeshes()) {
        glm::dvec3 sum(0.0);
        for (std::uint32_t k = 0; k < submesh.count; ++k) {
            sum += positions[model.first_vertex(submesh.mesh) +
                             model.meshes()[submesh.mesh].indices->index(submesh.first + k, 0)];
        }
        centres.emplace_back(sum / std::max(1.0, static_cast<double>(submesh.count)));
    }
    return centres;
}

}  // namespace

Renderer::Renderer(const Model& model, const ReadableFolders& folders, const Warn& warn)
    : model_(&model),
      warn_(warn),
      surfaces_(shown_surfaces(model)),
      level_(model),
      buffers_(model),
      textures_(model, folders, warn),
      overlay_(model),
      surface_(kSkinShader, kSurfaceShader),
      flat_(kSkinShader, kFlatShader),
      numbers_(kSkinShader, kNumberShader),
      overlay_program_(kOverlayVertexShader, kOverlayShader),
      centres_(draw_centres(model)) {
    buffers_.set_level(level_);
    upload_reflectance(reflectance_.name());
    glBindVertexArray(overlay_layout_.name());
    glBindBuffer(GL_ARRAY_BUFFER, overlay_vertices_.name());
    describe_floats(0, 3, sizeof(OverlayVertex), offsetof(OverlayVertex, position));
    describe_floats(1, 3, sizeof(OverlayVertex), offsetof(OverlayVertex, other));
    describe_floats(2, 4, sizeof(OverlayVertex), offsetof(OverlayVertex, colour));
    describe_floats(3, 1, sizeof(OverlayVertex), offsetof(OverlayVertex, side));
}

void Renderer::set_level(float share) {
    level_.set_share(share);
    buffers_.set_level(level_);
}

void Renderer::draw(Pose& pose, const Camera& camera, const DrawOptions& options, std::span<const TargetMark> targets,
                    const glm::vec2& size) {
    const glm::vec4& back = options.background;
    glClearColor(back.r * back.a, back.g * back.a, back.b * back.a, back.a);
    glDepthMask(GL_TRUE);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    // Alpha accumulates, so that a picture with a transparent background can be composited.
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    buffers_.set_pose(pose);
    buffers_.bind();
    if (options.surface && !options.wireframe) draw_surface(camera);
    if (options.wireframe) draw_wireframe(camera);
    draw_overlay(pose, camera, options, targets, size);
}

void Renderer::set_skin(const Program& program, const Camera& camera) const {
    program.use();
    glUniformMatrix4fv(program["view_projection"], 1, GL_FALSE, glm::value_ptr(camera.view_projection()));
    glUniform1i(program["palette"], kPaletteUnit);
    glUniform1i(program["influence_list"], kInfluenceUnit);
    glUniform1i(program["displacement_list"], kDisplacementUnit);
    glUniform1i(program["morph_weights"], kWeightUnit);
}

void Renderer::draw_range(const Submesh& submesh) const {
    constexpr std::array<GLenum, kTopologies> kModes{GL_TRIANGLES, GL_LINES, GL_POINTS};
    const std::size_t first = std::size_t{buffers_.first_index(submesh.mesh)} + submesh.first;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): as OpenGL wants it
    const auto* place = reinterpret_cast<const void*>(first * sizeof(GLuint));
    glDrawElements(kModes.at(static_cast<std::size_t>(submesh.topology)), static_cast<GLsizei>(submesh.count),
                   GL_UNSIGNED_INT, place);
}

const ShownSurface& Renderer::surface_of(const Submesh& submesh) const {
    return surfaces_[std::min<std::size_t>(submesh.material, surfaces_.size() - 1)];
}

void Renderer::load_textures(const TextureLimits& limits, std::span<const float> sizes) {
    bool is_beyond = false;
    std::vector<TextureUse> uses;
    for (const Submesh& submesh : model_->submeshes()) {
        if (submesh.count == 0) continue;
        const SurfaceRecord& surface = surface_of(submesh).record;
        const std::array<MapUse, 5> maps = maps_of(surface);
        for (const MapUse& map : std::span(maps).first(is_lit(submesh, surface) ? maps.size() : kBaseColour + 1)) {
            uses.push_back({&submesh, map.record, map.texels});
            is_beyond = is_beyond || (map.record->texture != kNone && map.record->coords > kLastSet);
        }
    }
    textures_.load(uses, limits, [&](const TextureUse& use) {
        const auto number = static_cast<std::size_t>(use.submesh - model_->submeshes().data());
        constexpr double kLeast = 0.125;  // it may grow in another clip
        const double size = sizes.empty() ? 1.0 : std::clamp(static_cast<double>(sizes[number]), kLeast, 1.0);
        return size / shown_share(*model_, use);
    });
    if (is_beyond) warn_("a texture uses a set of coordinates after the fourth: it is drawn with the fourth");
}

void Renderer::set_material(const Submesh& submesh) const {
    const ShownSurface& shown = surface_of(submesh);
    const SurfaceRecord& surface = shown.record;
    const std::array<MapUse, 5> uses = maps_of(surface);
    std::array<glm::mat3, 5> matrices{};
    std::array<GLint, 5> sets{};
    std::array<bool, 5> is_shown{};
    for (std::size_t k = 0; k < uses.size(); ++k) {
        const auto unit = static_cast<GLuint>(kMaterialUnit + k);
        is_shown[k] = textures_.bind(unit, uses[k].record->texture, uses[k].texels);
        const bool is_checked = k == kBaseColour && uses[k].record->texture != kNone;
        if (!is_shown[k]) bind_texture(unit, GL_TEXTURE_2D, is_checked ? textures_.check() : textures_.white());
        glUniform1i(surface_[uses[k].sampler], static_cast<GLint>(unit));
        matrices[k] = uv_matrix(*uses[k].record);
        sets[k] = static_cast<GLint>(std::min(uses[k].record->coords, kLastSet));
    }
    glUniformMatrix3fv(surface_["uv_matrix"], 5, GL_FALSE, glm::value_ptr(matrices[0]));
    glUniform1iv(surface_["uv_set"], 5, sets.data());
    glUniform4fv(surface_["base_colour"], 1, surface.base_colour.data());
    // A surface whose emissive map cannot be shown emits nothing.
    const bool is_dark = surface.emissive_texture.texture != kNone && !is_shown[kEmissive];
    set_vector(surface_["emissive"], is_dark ? glm::vec3(0.0f) : glm::make_vec3(surface.emissive.data()));
    set_vector(surface_["dielectric"], shown.dielectric);
    glUniform1f(surface_["dielectric_at_grazing"], shown.dielectric_at_grazing);
    glUniform1f(surface_["metallic"], surface.metallic);
    glUniform1f(surface_["roughness"], surface.roughness);
    glUniform1f(surface_["normal_scale"], surface.normal_scale);
    glUniform1f(surface_["occlusion_strength"], surface.occlusion_strength);
    glUniform1f(surface_["alpha_cutoff"], surface.alpha_cutoff);
    glUniform1i(surface_["alpha_mode"], surface.alpha_mode);
    glUniform1i(surface_["double_sided"], surface.double_sided);
    glUniform1i(surface_["unlit"], surface.unlit);
    glUniform1i(surface_["has_normal_map"], is_shown[kNormal] ? 1 : 0);
    glUniform1i(surface_["has_faces"], submesh.topology == Topology::triangles ? 1 : 0);
}

void Renderer::draw_surface(const Camera& camera) const {
    set_skin(surface_, camera);
    set_vector(surface_["eye"], camera.eye());
    const glm::mat3 to_view(camera.view());
    glUniformMatrix3fv(surface_["to_view"], 1, GL_FALSE, glm::value_ptr(to_view));
    const Lighting lighting = lighting_for(camera);
    glUniform3fv(surface_["light_direction"], 2, glm::value_ptr(lighting.directions[0]));
    glUniform2f(surface_["light_irradiance"], lighting.irradiance[0], lighting.irradiance[1]);
    glUniform1f(surface_["sky"], lighting.sky);
    glUniform1f(surface_["ground"], lighting.ground);
    glUniform1f(surface_["environment"], lighting.environment);
    bind_texture(kReflectanceUnit, GL_TEXTURE_2D, reflectance_.name());
    glUniform1i(surface_["reflectance"], kReflectanceUnit);
    glUniform1i(surface_["which_faces"], kBothFaces);
    struct SeeThrough {
        float distance;
        std::size_t number;
    };
    std::vector<SeeThrough> later;
    const auto submeshes = level_.submeshes();
    for (std::size_t number = 0; number < submeshes.size(); ++number) {
        if (is_blended(surface_of(submeshes[number]).record)) {
            const glm::vec3 centre = number < centres_.size() ? centres_[number] : glm::vec3(0.0f);
            later.push_back({glm::length(centre - camera.eye()), number});
            continue;
        }
        set_material(submeshes[number]);
        draw_range(submeshes[number]);
    }
    if (later.empty()) return;
    std::stable_sort(later.begin(), later.end(),
                     [](const SeeThrough& a, const SeeThrough& b) { return a.distance > b.distance; });
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    for (const SeeThrough& each : later) {
        set_material(submeshes[each.number]);
        for (const WhichFaces faces : {kBackFaces, kFrontFaces}) {
            glUniform1i(surface_["which_faces"], faces);
            draw_range(submeshes[each.number]);
        }
    }
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

void Renderer::draw_wireframe(const Camera& camera) const {
    constexpr std::array<float, 4> kWire{0.75f, 0.8f, 0.85f, 1.0f};
    set_skin(flat_, camera);
    glUniform4fv(flat_["flat_colour"], 1, kWire.data());
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    for (const Submesh& submesh : level_.submeshes()) draw_range(submesh);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void Renderer::draw_numbers(Pose& pose, const Camera& camera, bool behind_surface) {
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glDepthMask(GL_TRUE);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDisable(GL_FRAMEBUFFER_SRGB);
    buffers_.set_pose(pose);
    buffers_.bind();
    set_skin(numbers_, camera);
    glUniform1i(numbers_["depth_only"], 1);
    if (behind_surface) {
        for (const Submesh& submesh : level_.submeshes()) draw_range(submesh);
    }
    glUniform1i(numbers_["depth_only"], 0);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(buffers_.vertices()));
}

void Renderer::draw_list(const std::vector<OverlayVertex>& list) const {
    if (list.empty()) return;
    glBindVertexArray(overlay_layout_.name());
    glBindBuffer(GL_ARRAY_BUFFER, overlay_vertices_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(list.size() * sizeof(OverlayVertex)), list.data(),
                 GL_STREAM_DRAW);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(list.size()));
}

void Renderer::draw_overlay(Pose& pose, const Camera& camera, const DrawOptions& options,
                            std::span<const TargetMark> targets, const glm::vec2& size) {
    list_.clear();
    if (options.bones && options.thin_bones) {
        overlay_.add_thin_bones(pose, list_);
    } else if (options.bones) {
        overlay_.add_bones(pose, list_);
    }
    if (options.axes) overlay_.add_axes(pose, list_);
    if (options.constraints) overlay_.add_constraints(pose, list_);
    if (options.targets) overlay_.add_targets(targets, list_);
    if (options.marked_joint != kNone) overlay_.add_mark(pose, options.marked_joint, list_);
    glClear(GL_DEPTH_BUFFER_BIT);  // otherwise the character would hide its bones
    overlay_program_.use();
    glUniformMatrix4fv(overlay_program_["view_projection"], 1, GL_FALSE, glm::value_ptr(camera.view_projection()));
    glUniform2f(overlay_program_["size"], size.x, size.y);
    draw_list(list_.solid);
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    draw_list(list_.translucent);
    draw_list(list_.lines);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

}  // namespace bendy::viewer
