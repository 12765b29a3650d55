#include <bendy/viewer/render.h>

#include "camera.h"
#include "frame.h"
#include "opengl.h"
#include "overlay.h"
#include "renderer.h"

#include <bendy/runtime.h>

#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace bendy::viewer {
namespace {

/// Returns a box around everything that will be drawn. \param sizes  receives those of the submeshes
Box box_of(const Model& model, const RenderOptions& options, std::vector<float>& sizes) {
    std::vector<glm::vec3> targets;
    for (const DrawnTarget& target : options.targets) targets.push_back(target.position);
    return bounding_box(model, options.clip, options.adjust, targets, &sizes);
}

/// Throws ViewerError for a pose that cannot be drawn.
void require_finite(Pose& pose) {
    const auto is_finite = [](std::span<const float> numbers) {
        return std::all_of(numbers.begin(), numbers.end(), [](float number) { return std::isfinite(number); });
    };
    const auto matrices = pose.model_space();
    bool is_good = matrices.empty() || is_finite({&matrices.front()[0][0], 16 * matrices.size()});
    for (std::uint32_t mesh = 0; is_good && mesh < pose.model().meshes().size(); ++mesh) {
        const auto palette = pose.palette(mesh);
        is_good = std::all_of(palette.begin(), palette.end(), [&](const PaletteMatrix& matrix) {
            return is_finite({&matrix.rows[0][0], 12});
        });
    }
    if (!is_good) throw ViewerError("the pose is out of a float's range");
}

/// If one image goes round a character that fills the picture, half of it is seen from each side.
TextureLimits limits_of(const RenderOptions& options) {
    return {2.0 * std::max(options.width, options.height) / std::min(1.0, static_cast<double>(options.camera.distance)),
            options.texture_bytes};
}

/// Returns the context of this thread, which all makers of pictures share: a second one would be current in place of
/// the first.
std::shared_ptr<OffscreenContext> context_of_thread() {
    thread_local std::weak_ptr<OffscreenContext> known;
    std::shared_ptr<OffscreenContext> context = known.lock();
    if (context == nullptr) known = context = std::make_shared<OffscreenContext>();
    return context;
}

}  // namespace

/// In the order of construction; the context is destroyed after everything that uses it.
struct PictureMaker::Parts {
    Parts(const Model& model, const RenderOptions& wanted, const Warn& warn)
        : frame(wanted.width, wanted.height), renderer(model, wanted.folders, warn), pose(model) {
        set(wanted);
        if (!has_surface(model) && model.joints().empty()) warn("there is nothing to draw: no surface and no joints");
    }

    void set(const RenderOptions& wanted) {
        const Model& model = pose.model();
        options = wanted;
        if (!has_surface(model)) options.draw.bones = true;
        if (frame.width() != wanted.width || frame.height() != wanted.height)
            frame = Frame(wanted.width, wanted.height);
        std::vector<float> sizes;
        const Box box = box_of(model, wanted, sizes);
        renderer.set_box(box);
        camera.fit(box, wanted.camera, static_cast<float>(wanted.width) / static_cast<float>(wanted.height));
        renderer.set_level(wanted.lod);
        if (!has_textures && options.draw.surface && !options.draw.wireframe) {
            for (float& size : sizes) size /= 2.0f * box.radius();
            renderer.load_textures(limits_of(wanted), sizes);
            has_textures = true;
        }
    }

    [[nodiscard]] std::vector<TargetMark> marks() {
        std::vector<TargetMark> marks;
        std::vector<const Chain*> shown;
        for (const DrawnTarget& target : options.targets) {
            marks.push_back({target.position, tip_of(*target.chain, pose), true});
            shown.push_back(target.chain);
        }
        if (!options.draw.targets) return marks;
        const std::vector<TargetMark> others = target_marks(pose, shown);
        marks.insert(marks.end(), others.begin(), others.end());
        return marks;
    }

    [[nodiscard]] glm::vec2 size() const {
        return {static_cast<float>(options.width), static_cast<float>(options.height)};
    }

    RenderOptions options;
    std::shared_ptr<OffscreenContext> context = context_of_thread();
    Frame frame;
    Renderer renderer;
    Camera camera;
    Pose pose;
    bool has_textures = false;
};

PictureMaker::PictureMaker(const Model& model, const RenderOptions& options, const Warn& warn)
    : parts_(std::make_unique<Parts>(model, options, warn)) {}

PictureMaker::~PictureMaker() = default;

const std::string& PictureMaker::context() const {
    return parts_->context->description();
}

void PictureMaker::change(const RenderOptions& options) {
    parts_->set(options);
}

Picture PictureMaker::draw(float time) {
    Parts& p = *parts_;
    (void)sample(p.pose, p.options.clip, time);  // null: the rest pose
    if (p.options.adjust) p.options.adjust(p.pose);
    require_finite(p.pose);
    p.frame.bind();
    const std::vector<TargetMark> marks = p.marks();
    DrawOptions shown = p.options.draw;
    shown.targets = !marks.empty();
    p.renderer.draw(p.pose, p.camera, shown, marks, p.size());
    return p.frame.read(shown.background.a < 1.0f);
}

Picture PictureMaker::draw_nothing() {
    Parts& p = *parts_;
    p.frame.bind();
    DrawOptions nothing;
    nothing.surface = false;
    nothing.background = p.options.draw.background;
    p.renderer.draw(p.pose, p.camera, nothing, {}, p.size());
    return p.frame.read(nothing.background.a < 1.0f);
}

}  // namespace bendy::viewer
