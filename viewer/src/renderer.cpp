#include "renderer.h"

#include "lighting.h"
#include "reflectance_table.h"
#include "shaders.h"
#include "texture_units.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bendy::viewer {
namespace {

enum WhichFaces : GLint { kBothFaces, kFrontFaces, kBackFaces };

bool is_blended(const SurfaceRecord& surface) {
    return static_cast<AlphaMode>(surface.alpha_mode) == AlphaMode::blend;
}

/// T * R * S, KHR_texture_transform.
glm::mat3 uv_matrix(const TextureUseRecord& use) {
    const float c = std::cos(use.rotation);
    const float s = std::sin(use.rotation);
    return {glm::vec3(c * use.scale[0], -s * use.scale[0], 0.0f), glm::vec3(s * use.scale[1], c * use.scale[1], 0.0f),
            glm::vec3(use.offset[0], use.offset[1], 1.0f)};
}

struct MapUse {
    const TextureUseRecord* record;
    const char* sampler;
    bool srgb;
};

constexpr std::uint32_t kLastSet = 3;  // of texture coordinates

enum Map : std::size_t { kBaseColour, kMetallicRoughness, kNormal, kOcclusion, kEmissive };

std::array<MapUse, 5> maps_of(const SurfaceRecord& surface) {
    return {{{&surface.base_colour_texture, "base_colour_map", true},
             {&surface.metallic_roughness_texture, "metallic_roughness_map", false},
             {&surface.normal_texture, "normal_map", false},
             {&surface.occlusion_texture, "occlusion_map", false},
             {&surface.emissive_texture, "emissive_map", true}}};
}

/// 16 entries a side: as fine as three.js has it.
void upload_reflectance(GLuint texture) {
    constexpr GLsizei kSide = 16;
    gl::ActiveTexture(GL_TEXTURE0 + kUploadUnit);
    gl::BindTexture(GL_TEXTURE_2D, texture);
    gl::TexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, kSide, kSide, 0, GL_RG, GL_FLOAT, reflectance_table(kSide).data());
    for (const GLenum filter : std::array<GLenum, 2>{GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        gl::TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (const GLenum wrap : std::array<GLenum, 2>{GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        gl::TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
}

void set_vector(GLint place, const glm::vec3& v) {
    gl::Uniform3fv(place, 1, glm::value_ptr(v));
}

std::vector<glm::vec3> draw_centres(const Model& model) {
    std::vector<glm::vec3> positions(model.vertex_count());
    Pose pose(model);
    (void)skin(pose, {.out = {.positions = positions}});
    std::vector<glm::vec3> centres;
    for (const Draw& draw : model.draws()) {
        glm::dvec3 sum(0.0);
        for (std::uint32_t k = 0; k < draw.count; ++k) {
            sum +=
                positions[model.first_vertex(draw.pool) + model.pools()[draw.pool].indices->index(draw.first + k, 0)];
        }
        centres.emplace_back(sum / std::max(1.0, static_cast<double>(draw.count)));
    }
    return centres;
}

}  // namespace

Renderer::Renderer(const Model& model, const Box& box, const std::filesystem::path& folder, const Warn& warn)
    : model_(&model),
      surfaces_(shown_surfaces(model)),
      level_(model),
      buffers_(model),
      textures_(model, folder, warn),
      overlay_(model, 2.0f * box.radius()),
      surface_(kSkinShader, kSurfaceShader),
      flat_(kSkinShader, kFlatShader),
      numbers_(kSkinShader, kNumberShader),
      overlay_program_(kOverlayVertexShader, kOverlayShader),
      centres_(draw_centres(model)) {
    buffers_.set_level(level_);
    load_textures(warn);
    gl::BindVertexArray(overlay_layout_.name());
    gl::BindBuffer(GL_ARRAY_BUFFER, overlay_vertices_.name());
    const auto floats = [](GLuint place, GLint components, std::size_t offset) {
        gl::EnableVertexAttribArray(place);
        gl::VertexAttribPointer(
            place, components, GL_FLOAT, GL_FALSE, sizeof(OverlayVertex),
            reinterpret_cast<const void*>(offset));  // NOLINT(performance-no-int-to-ptr): as OpenGL wants it
    };
    floats(0, 3, offsetof(OverlayVertex, position));
    floats(1, 3, offsetof(OverlayVertex, other));
    floats(2, 4, offsetof(OverlayVertex, colour));
    floats(3, 1, offsetof(OverlayVertex, side));
}

void Renderer::set_level(float share) {
    level_.set_share(share);
    buffers_.set_level(level_);
}

void Renderer::draw(Pose& pose, const Camera& camera, const DrawOptions& options, std::span<const TargetMark> targets,
                    const glm::vec2& size) {
    const glm::vec4& back = options.background;
    gl::ClearColor(back.r * back.a, back.g * back.a, back.b * back.a, back.a);
    gl::DepthMask(GL_TRUE);
    gl::Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl::Enable(GL_DEPTH_TEST);
    gl::DepthFunc(GL_LEQUAL);
    // The alpha of what was drawn over nothing adds up, so that a picture can be laid over another.
    gl::BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    buffers_.set_pose(pose);
    buffers_.bind();
    if (options.surface && !options.wireframe) draw_surface(camera);
    if (options.wireframe) draw_wireframe(camera);
    draw_overlay(pose, camera, options, targets, size);
}

void Renderer::set_skin(const Program& program, const Camera& camera) const {
    program.use();
    gl::UniformMatrix4fv(program["view_projection"], 1, GL_FALSE, glm::value_ptr(camera.view_projection()));
    gl::Uniform1i(program["palette"], kPaletteUnit);
    gl::Uniform1i(program["influence_list"], kInfluenceUnit);
    gl::Uniform1i(program["displacement_list"], kDisplacementUnit);
    gl::Uniform1i(program["target_weights"], kWeightUnit);
}

void Renderer::draw_range(const Draw& draw) const {
    constexpr std::array<GLenum, kTopologies> kModes{GL_TRIANGLES, GL_LINES, GL_POINTS};
    const std::size_t first = std::size_t{buffers_.first_index(draw.pool)} + draw.first;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): as OpenGL wants it
    const auto* place = reinterpret_cast<const void*>(first * sizeof(GLuint));
    gl::DrawElements(kModes.at(static_cast<std::size_t>(draw.topology)), static_cast<GLsizei>(draw.count),
                     GL_UNSIGNED_INT, place);
}

const ShownSurface& Renderer::surface_of(const Draw& draw) const {
    return surfaces_[std::min<std::size_t>(draw.material, surfaces_.size() - 1)];
}

/// All that any draw needs, before the first: nothing is uploaded between the calls that set a draw up.
void Renderer::load_textures(const Warn& warn) {
    bool is_beyond = false;
    for (const Draw& draw : model_->draws()) {
        for (const MapUse& use : maps_of(surface_of(draw).record)) {
            textures_.load(use.record->texture, use.srgb);
            is_beyond = is_beyond || (use.record->texture != kNone && use.record->coords > kLastSet);
        }
    }
    if (is_beyond) warn("a texture uses a set of coordinates after the fourth: it is drawn with the fourth");
    upload_reflectance(reflectance_.name());
}

void Renderer::set_material(const Draw& draw) const {
    const ShownSurface& shown = surface_of(draw);
    const SurfaceRecord& surface = shown.record;
    const std::array<MapUse, 5> uses = maps_of(surface);
    std::array<glm::mat3, 5> matrices{};
    std::array<GLint, 5> sets{};
    std::array<bool, 5> is_shown{};
    for (std::size_t k = 0; k < uses.size(); ++k) {
        const auto unit = static_cast<GLuint>(kMaterialUnit + k);
        gl::ActiveTexture(GL_TEXTURE0 + unit);
        const auto texture = textures_.texture(uses[k].record->texture, uses[k].srgb);
        is_shown[k] = texture.has_value();
        const bool is_checked = k == kBaseColour && uses[k].record->texture != kNone;
        gl::BindTexture(GL_TEXTURE_2D, texture.value_or(is_checked ? textures_.check() : textures_.white()));
        gl::Uniform1i(surface_[uses[k].sampler], static_cast<GLint>(unit));
        matrices[k] = uv_matrix(*uses[k].record);
        sets[k] = static_cast<GLint>(std::min(uses[k].record->coords, kLastSet));
    }
    gl::UniformMatrix3fv(surface_["uv_matrix"], 5, GL_FALSE, glm::value_ptr(matrices[0]));
    gl::Uniform1iv(surface_["uv_set"], 5, sets.data());
    gl::Uniform4fv(surface_["base_colour"], 1, surface.base_colour.data());
    // Without its map a surface has no light of its own, and no bumps.
    const bool is_dark = surface.emissive_texture.texture != kNone && !is_shown[kEmissive];
    set_vector(surface_["emissive"], is_dark ? glm::vec3(0.0f) : glm::make_vec3(surface.emissive.data()));
    set_vector(surface_["dielectric"], shown.dielectric);
    gl::Uniform1f(surface_["dielectric_at_grazing"], shown.dielectric_at_grazing);
    gl::Uniform1f(surface_["metallic"], surface.metallic);
    gl::Uniform1f(surface_["roughness"], surface.roughness);
    gl::Uniform1f(surface_["normal_scale"], surface.normal_scale);
    gl::Uniform1f(surface_["occlusion_strength"], surface.occlusion_strength);
    gl::Uniform1f(surface_["alpha_cutoff"], surface.alpha_cutoff);
    gl::Uniform1i(surface_["alpha_mode"], surface.alpha_mode);
    gl::Uniform1i(surface_["double_sided"], surface.double_sided);
    gl::Uniform1i(surface_["unlit"], surface.unlit);
    gl::Uniform1i(surface_["has_normal_map"], is_shown[kNormal] ? 1 : 0);
    gl::Uniform1i(surface_["has_faces"], draw.topology == Topology::triangles ? 1 : 0);
}

void Renderer::draw_surface(const Camera& camera) const {
    set_skin(surface_, camera);
    set_vector(surface_["eye"], camera.eye());
    const glm::mat3 to_view(camera.view());
    gl::UniformMatrix3fv(surface_["to_view"], 1, GL_FALSE, glm::value_ptr(to_view));
    const Lighting lighting = lighting_for(camera);
    gl::Uniform3fv(surface_["light_direction"], 2, glm::value_ptr(lighting.directions[0]));
    gl::Uniform2f(surface_["light_irradiance"], lighting.irradiance[0], lighting.irradiance[1]);
    gl::Uniform1f(surface_["sky"], lighting.sky);
    gl::Uniform1f(surface_["ground"], lighting.ground);
    gl::Uniform1f(surface_["environment"], lighting.environment);
    gl::ActiveTexture(GL_TEXTURE0 + kReflectanceUnit);
    gl::BindTexture(GL_TEXTURE_2D, reflectance_.name());
    gl::Uniform1i(surface_["reflectance"], kReflectanceUnit);
    gl::Uniform1i(surface_["which_faces"], kBothFaces);
    struct SeeThrough {
        float distance;
        std::size_t number;
    };
    std::vector<SeeThrough> later;
    const auto draws = level_.draws();
    for (std::size_t number = 0; number < draws.size(); ++number) {
        if (is_blended(surface_of(draws[number]).record)) {
            const glm::vec3 centre = number < centres_.size() ? centres_[number] : glm::vec3(0.0f);
            later.push_back({glm::length(centre - camera.eye()), number});
            continue;
        }
        set_material(draws[number]);
        draw_range(draws[number]);
    }
    if (later.empty()) return;
    std::stable_sort(later.begin(), later.end(),
                     [](const SeeThrough& a, const SeeThrough& b) { return a.distance > b.distance; });
    gl::Enable(GL_BLEND);
    gl::DepthMask(GL_FALSE);
    for (const SeeThrough& each : later) {
        set_material(draws[each.number]);
        for (const WhichFaces faces : {kBackFaces, kFrontFaces}) {
            gl::Uniform1i(surface_["which_faces"], faces);
            draw_range(draws[each.number]);
        }
    }
    gl::DepthMask(GL_TRUE);
    gl::Disable(GL_BLEND);
}

void Renderer::draw_wireframe(const Camera& camera) const {
    constexpr std::array<float, 4> kWire{0.75f, 0.8f, 0.85f, 1.0f};
    set_skin(flat_, camera);
    gl::Uniform4fv(flat_["flat_colour"], 1, kWire.data());
    gl::PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    for (const Draw& draw : level_.draws()) draw_range(draw);
    gl::PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void Renderer::draw_numbers(Pose& pose, const Camera& camera, bool behind_surface) {
    gl::ClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    gl::DepthMask(GL_TRUE);
    gl::Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl::Enable(GL_DEPTH_TEST);
    gl::DepthFunc(GL_LEQUAL);
    gl::Disable(GL_FRAMEBUFFER_SRGB);
    buffers_.set_pose(pose);
    buffers_.bind();
    set_skin(numbers_, camera);
    gl::Uniform1i(numbers_["depth_only"], 1);
    if (behind_surface) {
        for (const Draw& draw : level_.draws()) draw_range(draw);
    }
    gl::Uniform1i(numbers_["depth_only"], 0);
    gl::DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(buffers_.vertices()));
}

void Renderer::draw_list(const std::vector<OverlayVertex>& list) const {
    if (list.empty()) return;
    gl::BindVertexArray(overlay_layout_.name());
    gl::BindBuffer(GL_ARRAY_BUFFER, overlay_vertices_.name());
    gl::BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(list.size() * sizeof(OverlayVertex)), list.data(),
                   GL_STREAM_DRAW);
    gl::DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(list.size()));
}

void Renderer::draw_overlay(Pose& pose, const Camera& camera, const DrawOptions& options,
                            std::span<const TargetMark> targets, const glm::vec2& size) {
    list_.clear();
    if (options.bones) overlay_.add_bones(pose, list_);
    if (options.axes) overlay_.add_axes(pose, list_);
    if (options.constraints) overlay_.add_constraints(pose, list_);
    if (options.targets) overlay_.add_targets(targets, list_);
    if (options.marked_joint != kNone) overlay_.add_mark(pose, options.marked_joint, list_);
    gl::Clear(GL_DEPTH_BUFFER_BIT);  // over the character, which would hide its own bones
    overlay_program_.use();
    gl::UniformMatrix4fv(overlay_program_["view_projection"], 1, GL_FALSE, glm::value_ptr(camera.view_projection()));
    gl::Uniform2f(overlay_program_["size"], size.x, size.y);
    draw_list(list_.solid);
    gl::Enable(GL_BLEND);
    gl::DepthMask(GL_FALSE);
    draw_list(list_.translucent);
    draw_list(list_.lines);
    gl::DepthMask(GL_TRUE);
    gl::Disable(GL_BLEND);
}

}  // namespace bendy::viewer
