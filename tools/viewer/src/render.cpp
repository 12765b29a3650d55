#include <bendy/viewer/render.h>

#include "camera.h"
#include "frame.h"
#include "opengl.h"
#include "overlay.h"
#include "renderer.h"

#include <bendy/runtime.h>

#include <glm/vec2.hpp>

#include <vector>

namespace bendy::viewer {
namespace {

/// Returns a box around everything that will be drawn.
Box box_of(const Model& model, const RenderOptions& options) {
    std::vector<glm::vec3> targets;
    for (const DrawnTarget& target : options.targets) targets.push_back(target.position);
    return bounding_box(model, options.clip, options.adjust, targets);
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
        const Box box = box_of(model, wanted);
        renderer.set_box(box);
        camera.fit(box, wanted.camera, static_cast<float>(wanted.width) / static_cast<float>(wanted.height));
        renderer.set_level(wanted.lod);
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
    OffscreenContext context;
    Frame frame;
    Renderer renderer;
    Camera camera;
    Pose pose;
};

PictureMaker::PictureMaker(const Model& model, const RenderOptions& options, const Warn& warn)
    : parts_(std::make_unique<Parts>(model, options, warn)) {}

PictureMaker::~PictureMaker() = default;

const std::string& PictureMaker::context() const {
    return parts_->context.description();
}

void PictureMaker::change(const RenderOptions& options) {
    parts_->set(options);
}

Picture PictureMaker::draw(float time) {
    Parts& p = *parts_;
    (void)sample(p.pose, p.options.clip, time);  // null: the rest pose
    if (p.options.adjust) p.options.adjust(p.pose);
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
