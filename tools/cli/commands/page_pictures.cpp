#include "reports/inspect_html.h"

#ifdef BENDY_HAS_VIEWER

#include <bendy/runtime/model.h>
#include <bendy/viewer/picture.h>
#include <bendy/viewer/render.h>

#include <algorithm>

namespace bendy::tools {
namespace {

constexpr std::size_t kMostPictures = 6;
constexpr std::size_t kMostBytes = std::size_t{8} << 20u;  // of all pictures together
constexpr std::uint32_t kStillSide = 512;                  // pixels
constexpr std::uint32_t kClipSide = 256;
constexpr unsigned kFrames = 16;  // of an animation

viewer::RenderOptions options_of(std::uint32_t side, const Clip* clip, const ReadableFolders& folders) {
    viewer::RenderOptions options;
    options.width = options.height = side;
    options.clip = clip;
    options.folders = folders;
    options.draw.background = glm::vec4(0.0f);
    return options;
}

std::vector<std::byte> animate(viewer::PictureMaker& maker, const Clip& clip) {
    maker.change(options_of(kClipSide, &clip, ReadableFolders()));
    const double length = static_cast<double>(clip.end) - static_cast<double>(clip.start);
    if (!(length > 0.0)) return viewer::encode_png(maker.draw(clip.start));
    const auto file = viewer::make_webp(kClipSide, kClipSide);
    for (unsigned frame = 0; frame < kFrames; ++frame) {
        const double share = static_cast<double>(frame) / kFrames;
        file->add(maker.draw(static_cast<float>(clip.start + share * length)), share * length);
    }
    return file->finish(length);
}

}  // namespace

PagePictures draw_page_pictures(Bytes file, const ReadableFolders& folders) {
    PagePictures pictures;
    const Result<Model> model = Model::from_memory(file);
    if (!model) {
        pictures.why_none = "the file has faults";
        return pictures;
    }
    try {
        viewer::PictureMaker maker(*model, options_of(kStillSide, nullptr, folders), [](const std::string&) {});
        pictures.list.push_back({{}, false, "image/png", viewer::encode_png(maker.draw(0.0f))});
        std::size_t bytes = pictures.list.back().bytes.size();
        const auto clips = model->clips();
        std::size_t shown = 0;
        for (; shown < std::min(clips.size(), kMostPictures) && bytes < kMostBytes; ++shown) {
            const Clip& clip = clips[shown];
            const bool moves = clip.end > clip.start;
            pictures.list.push_back(
                {std::string(clip.name), true, moves ? "image/webp" : "image/png", animate(maker, clip)});
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
