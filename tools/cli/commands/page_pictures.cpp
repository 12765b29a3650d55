#include "reports/inspect_html.h"

#ifdef BENDY_HAS_VIEWER

#include <bendy/format/diagnostics.h>
#include <bendy/runtime/model.h>
#include <bendy/viewer/picture.h>
#include <bendy/viewer/render.h>

#include <algorithm>

namespace bendy::tools {
namespace {

constexpr std::size_t kMostPictures = 6;
constexpr std::size_t kMostBytes = std::size_t{8} << 20u;          // of all pictures together
constexpr std::uint64_t kTextureBytes = std::uint64_t{32} << 20u;  // of all textures: the pictures are small
constexpr std::uint32_t kStillSide = 512;                          // pixels
constexpr std::uint32_t kClipSide = 256;
constexpr unsigned kFrames = 16;  // of an animation
constexpr unsigned kFewestFrames = 4;
constexpr std::size_t kMostBones = 200'000;  // in all pictures together, which software draws
constexpr std::size_t kManyBones = 500;      // more are as well seen as lines in pictures of this size

viewer::RenderOptions options_of(std::uint32_t side, const Clip* clip, std::size_t bones,
                                 const ReadableFolders& folders) {
    viewer::RenderOptions options;
    options.width = options.height = side;
    options.clip = clip;
    options.folders = folders;
    options.texture_bytes = kTextureBytes;
    options.draw.background = glm::vec4(0.0f);
    options.draw.thin_bones = bones > kManyBones;
    return options;
}

/// \param frames  of an animation
std::vector<std::byte> animate(viewer::PictureMaker& maker, const Clip& clip, std::size_t bones, unsigned frames) {
    maker.change(options_of(kClipSide, &clip, bones, ReadableFolders()));
    const double length = static_cast<double>(clip.end) - static_cast<double>(clip.start);
    if (!(length > 0.0)) return viewer::encode_png(maker.draw(clip.start));
    const auto file = viewer::make_webp(kClipSide, kClipSide);
    for (unsigned frame = 0; frame < frames; ++frame) {
        const double share = static_cast<double>(frame) / frames;
        file->add(maker.draw(static_cast<float>(clip.start + share * length)), share * length);
    }
    return file->finish(length);
}

}  // namespace

PagePictures draw_page_pictures(Bytes file, const ReadableFolders& folders) {
    PagePictures pictures;
    const Result<Model> model = Model::from_memory(file);
    if (!model) {
        pictures.why_none = describe(model.error());
        return pictures;
    }
    const std::size_t bones = model->vertex_count() == 0 ? model->joints().size() : 0;  // drawn without a surface only
    const std::size_t animations = std::clamp<std::size_t>(model->clips().size(), 1, kMostPictures);
    const auto frames = static_cast<unsigned>(
        std::clamp<std::size_t>(kMostBones / std::max<std::size_t>(bones * animations, 1), kFewestFrames, kFrames));
    try {
        viewer::PictureMaker maker(*model, options_of(kStillSide, nullptr, bones, folders), [](const std::string&) {});
        pictures.list.push_back({{}, false, "image/png", viewer::encode_png(maker.draw(0.0f))});
        std::size_t bytes = pictures.list.back().bytes.size();
        const auto clips = model->clips();
        std::size_t shown = 0;
        for (; shown < std::min(clips.size(), kMostPictures) && bytes < kMostBytes; ++shown) {
            const Clip& clip = clips[shown];
            const bool moves = clip.end > clip.start;
            pictures.list.push_back({std::string(clip.name), true, moves ? "image/webp" : "image/png",
                                     animate(maker, clip, bones, frames)});
            bytes += pictures.list.back().bytes.size();
        }
        pictures.clips_left_out = clips.size() - shown;
    } catch (const viewer::ViewerError& problem) {
        pictures.why_none = problem.what();
    }
    return pictures;
}

}  // namespace bendy::tools

#else

namespace bendy::tools {

PagePictures draw_page_pictures(Bytes /*file*/, const ReadableFolders& /*folders*/) {
    return {{}, 0, "this program was built without the viewer"};
}

}  // namespace bendy::tools

#endif
