#include <bendy/viewer/render.h>

#include "bounds.h"
#include "camera.h"
#include "frame.h"
#include "gl_context.h"
#include "overlay.h"
#include "renderer.h"

#include <bendy/runtime.h>

namespace bendy::viewer {

/// In the order in which they are made: the context goes last.
struct PictureMaker::Parts {
    Parts(const Model& model, const RenderOptions& wanted, const Warn& warn)
        : options(wanted),
          context(wanted.context),
          frame(wanted.width, wanted.height),
          box(bounding_box(model, wanted.cycle)),
          renderer(model, box, wanted.folder, warn),
          pose(model) {
        camera.fit(box, wanted.camera, static_cast<float>(wanted.width) / static_cast<float>(wanted.height));
        renderer.set_level(wanted.lod);
    }

    RenderOptions options;
    OffscreenContext context;
    Frame frame;
    Box box;
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

Picture PictureMaker::draw(float time) {
    Parts& p = *parts_;
    if (p.options.cycle != nullptr) sample(p.options.cycle, time, p.pose);
    local_to_model(p.pose);
    p.frame.bind();
    const glm::vec2 size(static_cast<float>(p.options.width), static_cast<float>(p.options.height));
    p.renderer.draw(p.pose, p.camera, p.options.draw, target_marks(p.pose), size);
    return p.frame.read(p.options.draw.background.a < 1.0f);
}

}  // namespace bendy::viewer
