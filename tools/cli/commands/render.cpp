#include "commands/commands.h"
#include "reports/messages.h"

#ifdef BENDY_HAS_VIEWER

#include "commands/frames.h"
#include "commands/model_options.h"
#include "commands/reaching.h"
#include "files/input.h"
#include "files/output.h"
#include "files/progress.h"

#include <bendy/motion/stand.h>
#include <bendy/runtime.h>
#include <bendy/viewer/picture.h>
#include <bendy/viewer/render.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace bendy::tools {
namespace {

/// The pictures that --frames asks for.
struct Frames {
    unsigned count = 0;               ///< spread over the clip; 0: not given
    std::optional<FrameRange> range;  ///< overrides the count
    [[nodiscard]] unsigned number() const { return range ? range->count() : count; }
};

struct RenderArguments {
    std::filesystem::path file;
    std::filesystem::path root;
    std::filesystem::path output;
    std::string clip;
    bool has_clip = false;
    bool stands = false;
    float time = 0.0f;
    bool has_time = false;
    std::string size;
    std::string camera;
    std::string background;
    std::string format;  // empty: chosen by the output's name
    std::string frames;  // a number, or A..B@RATE; empty: not given
    Frames pictures;
    bool verbose = false;
    std::string beside;  // FILE or FILE:CLIP; empty: not given
    ReachRequest reach;
    viewer::RenderOptions render;
};

void parse_size(const std::string& text, viewer::RenderOptions& options) {
    const char* const end = text.data() + text.size();
    const auto [cross, bad_width] = std::from_chars(text.data(), end, options.width);
    const bool has_cross = bad_width == std::errc() && cross != end && *cross == 'x';
    const auto [stop, bad_height] = std::from_chars(has_cross ? cross + 1 : end, end, options.height);
    const auto fits = [](std::uint32_t side) { return side >= 1 && side <= viewer::kMostPixels; };
    if (!has_cross || bad_height != std::errc() || stop != end || !fits(options.width) || !fits(options.height))
        throw CLI::ValidationError(
            "--size", "must be WIDTHxHEIGHT in pixels, 1 to " + std::to_string(viewer::kMostPixels) + " each");
}

void parse_camera(const std::string& text, viewer::CameraOptions& camera) {
    const std::vector<float> numbers = read_numbers(text);
    if (numbers.size() < 2 || numbers.size() > 3 || (numbers.size() == 3 && numbers[2] <= 0.0f))
        throw CLI::ValidationError("--camera",
                                   "must be YAW,PITCH or YAW,PITCH,DISTANCE: degrees, and a factor above 0");
    constexpr float kDegree = 3.14159265f / 180.0f;
    camera.yaw = numbers[0] * kDegree;
    camera.pitch = numbers[1] * kDegree;
    if (numbers.size() == 3) camera.distance = numbers[2];
}

float linear(unsigned srgb) {
    const float value = static_cast<float>(srgb) / 255.0f;
    return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

void parse_background(const std::string& text, glm::vec4& background) {
    if (text == "transparent") {
        background = glm::vec4(0.0f);
        return;
    }
    struct Named {
        std::string_view name;
        unsigned colour;
    };
    constexpr std::array<Named, 3> kNamed{{{"white", 0xffffff}, {"black", 0}, {"grey", 0x808080}}};
    for (const Named& named : kNamed) {
        if (text != named.name) continue;
        background = {linear(named.colour >> 16u), linear(named.colour >> 8u & 255u), linear(named.colour & 255u),
                      1.0f};
        return;
    }
    unsigned colour = 0;
    const std::size_t hash = text.starts_with('#') ? 1 : 0;
    const char* const end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data() + hash, end, colour, 16);
    if (text.size() - hash != 6 || problem != std::errc() || stop != end)
        throw CLI::ValidationError("--background", "must be RRGGBB, white, black, grey or transparent");
    background = {linear(colour >> 16u), linear(colour >> 8u & 255u), linear(colour & 255u), 1.0f};
}

constexpr unsigned kMostInOneFile = 1000;  // of a sheet or an animation

Frames parse_frames(const std::string& text) {
    Frames frames;
    if (text.empty()) return frames;
    if (is_frame_range(text)) {
        frames.range = read_frame_range(text);
        return frames;
    }
    const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), frames.count);
    if (problem != std::errc() || stop != text.data() + text.size() || frames.count < 1 ||
        frames.count > kMostInOneFile)
        throw CLI::ValidationError("--frames",
                                   "must be a number from 1 to " + std::to_string(kMostInOneFile) + ", or A..B@RATE");
    return frames;
}

/// The times of the frames on the clip's time line. Without a range, a repeating clip does not show its end, which
/// equals its start.
std::vector<float> frame_times(const Clip& clip, const Frames& frames, bool repeats) {
    std::vector<float> times;
    for (unsigned k = 0; frames.range && k < frames.range->count(); ++k)
        times.push_back(frames.range->time(frames.range->first + k));
    if (frames.range) return times;
    const float steps = static_cast<float>(repeats ? frames.count : std::max(1u, frames.count - 1));
    for (unsigned k = 0; k < frames.count; ++k)
        times.push_back(clip.start + (clip.end - clip.start) * static_cast<float>(k) / steps);
    return times;
}

/// Returns true if every frame is a file of its own.
bool is_sequence(const RenderArguments& arguments, const std::string& format) {
    return format == "png" && arguments.pictures.range && is_numbered(arguments.output);
}

/// \param characters  beside one another in each picture
std::uint32_t sheet_columns(unsigned frames, unsigned characters) {
    return static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(frames) / characters)));
}

/// A sheet is a single picture, and an animation a single file, assembled in memory.
void check_frames(const RenderArguments& arguments, const std::string& format) {
    const unsigned number = arguments.pictures.number();
    if (number > kMostInOneFile) {
        throw CLI::ValidationError("--frames", "at most " + std::to_string(kMostInOneFile) +
                                                   " fit in one file; a # in OUT.png makes a file of each");
    }
    constexpr std::uint64_t kMostSheetPixels = std::uint64_t{viewer::kMostPixels} * viewer::kMostPixels;
    const std::uint64_t characters = arguments.beside.empty() ? 1 : 2;
    const std::uint64_t columns = characters * sheet_columns(number, 1);
    if (format == "png" && columns * columns * arguments.render.width * arguments.render.height > kMostSheetPixels)
        throw CLI::ValidationError("--frames", "so many pictures of this --size are too large for one");
}

/// Draws poses whose chains have reached for their targets, and records how near they came.
class ReachingMaker {
public:
    ReachingMaker(const RenderArguments& arguments, const Model& model)
        : stands_(arguments.stands),
          reaching_(arguments.reach, arguments.file, model),
          maker_(model, options_of(arguments),
                 [&](const std::string& what) { warn(arguments.file, printable(what)); }) {}

    viewer::Picture draw(float time) {
        time_ = time;
        viewer::Picture picture = maker_.draw(time);
        reaching_.count();
        return picture;
    }
    /// From now on, the pictures are those frames of the clip.
    void follow_frames(const Clip& clip, const std::optional<FrameRange>& range) {
        if (!range) return reaching_.follow_frames();
        reaching_.follow_frames(clip, *range, [&](Pose& pose, float time) { (void)sample(pose, &clip, time); });
    }
    viewer::Picture draw_nothing() { return maker_.draw_nothing(); }

    [[nodiscard]] const std::string& context() const { return maker_.context(); }
    void print_reached() const { reaching_.print(); }

private:
    viewer::RenderOptions options_of(const RenderArguments& arguments) {
        viewer::RenderOptions options = arguments.render;
        options.adjust = [this](Pose& pose) {
            if (stands_) (void)stand(pose);
            reaching_.apply(pose, time_);
        };
        for (const ReachGoal& goal : reaching_.goals()) options.targets.push_back({goal.chain, goal.target.position});
        return options;
    }

    bool stands_;
    float time_ = 0.0f;
    Reaching reaching_;
    viewer::PictureMaker maker_;
};

/// The folders of the images that the file links to, which are drawn.
void note_inputs(const ReadableFolders& folders, const Model& model, Outputs& outputs) {
    for (const Texture& texture : model.textures()) {
        for (const ImageView& image : texture.images) {
            if (const auto file = folders.find(image.uri)) outputs.reads(*file);
        }
    }
}

/// The character of --beside.
class Companion {
public:
    Companion(const RenderArguments& arguments, Outputs& outputs)
        : path_(split_clip(arguments.beside).first),
          file_(open(path_, arguments.root, outputs)),
          model_(read_valid_model(path_, file_.bytes())),
          folders_(folders_of(path_, arguments.root)) {
        note_inputs(folders_, model_, outputs);
    }

    viewer::Picture draw(float time) { return maker_->draw(time); }

    /// Makes ready to draw it.
    void prepare(const RenderArguments& arguments, const Model& shown) {
        viewer::RenderOptions options = arguments.render;
        options.clip = clip_for(arguments);
        options.camera.yaw += static_cast<float>(motion::facing(model_) - motion::facing(shown));
        options.folders = folders_;
        if (arguments.stands) options.adjust = [](Pose& pose) { (void)stand(pose); };
        maker_.emplace(model_, options, [this](const std::string& what) { warn(path_, printable(what)); });
    }

private:
    static CharacterFile open(const std::filesystem::path& path, const std::filesystem::path& root, Outputs& outputs) {
        outputs.reads(path);
        return open_character(path, root, outputs, Storage::copied);
    }

    /// The clip that was asked for, or the one that the shown clip is made from: of the same name, which may have got a
    /// number, or the only one.
    [[nodiscard]] const Clip* clip_for(const RenderArguments& arguments) const {
        const std::string asked = split_clip(arguments.beside).second;
        if (!asked.empty()) return &find_clip(asked, path_, model_);
        if (arguments.render.clip == nullptr) return nullptr;
        std::string name(arguments.render.clip->name);
        if (const Clip* clip = model_.clip(name)) return clip;
        if (const std::size_t dot = name.rfind('.'); dot != std::string::npos) name.resize(dot);
        if (const Clip* clip = model_.clip(name)) return clip;
        if (model_.clips().size() == 1) return model_.clips().data();
        return &find_clip(std::string(arguments.render.clip->name), path_, model_);  // fails with a list
    }

    std::filesystem::path path_;
    CharacterFile file_;
    Model model_;
    ReadableFolders folders_;
    std::optional<viewer::PictureMaker> maker_;
};

/// The character and, to its left, the one of --beside.
class Stage {
public:
    Stage(const RenderArguments& arguments, const Model& model, Companion* companion)
        : maker_(arguments, model), companion_(companion) {
        if (companion_ != nullptr) companion_->prepare(arguments, model);
    }

    viewer::Picture draw(float time) {
        viewer::Picture picture = maker_.draw(time);
        return companion_ == nullptr ? picture : side_by_side(companion_->draw(time), std::move(picture));
    }
    viewer::Picture draw_nothing() {
        viewer::Picture picture = maker_.draw_nothing();
        return companion_ == nullptr ? picture : side_by_side(picture, picture);
    }
    /// How many characters there are in a picture.
    [[nodiscard]] std::uint32_t characters() const { return companion_ == nullptr ? 1 : 2; }
    ReachingMaker& maker() { return maker_; }

private:
    static viewer::Picture side_by_side(viewer::Picture left, viewer::Picture right) {
        const viewer::Picture unused;
        return viewer::contact_sheet({std::move(left), std::move(right)}, 2, unused);
    }

    ReachingMaker maker_;
    Companion* companion_;
};

std::vector<std::byte> draw_sheet(Stage& maker, const RenderArguments& arguments) {
    ProgressBar bar("drawing");
    std::vector<viewer::Picture> pictures;
    const Clip& clip = *arguments.render.clip;
    const unsigned number = arguments.pictures.number();
    for (const float time : frame_times(clip, arguments.pictures, clip.loop)) {
        pictures.push_back(maker.draw(time));
        bar.show(pictures.size(), number);
    }
    return viewer::encode_png(
        viewer::contact_sheet(pictures, sheet_columns(number, maker.characters()), maker.draw_nothing()));
}

std::vector<std::byte> draw_animation(Stage& maker, const RenderArguments& arguments, bool is_gif) {
    const viewer::RenderOptions& render = arguments.render;
    const std::uint32_t width = maker.characters() * render.width;
    const auto file = is_gif ? viewer::make_gif(width, render.height) : viewer::make_webp(width, render.height);
    const unsigned number = arguments.pictures.number();
    const double length = arguments.pictures.range
                              ? number / arguments.pictures.range->rate
                              : static_cast<double>(render.clip->end) - static_cast<double>(render.clip->start);
    ProgressBar bar("drawing");
    unsigned done = 0;
    for (const float time : frame_times(*render.clip, arguments.pictures, true)) {
        file->add(maker.draw(time), length * done / number);
        bar.show(++done, number);
    }
    return file->finish(length);
}

void draw_sequence(Stage& maker, const RenderArguments& arguments, Outputs& outputs) {
    const FrameRange& range = *arguments.pictures.range;
    ProgressBar bar("drawing");
    for (std::uint32_t k = 0; k < range.count(); ++k) {
        const std::uint32_t frame = range.first + k;
        outputs.stage(frame_output(arguments.output, frame), viewer::encode_png(maker.draw(range.time(frame))));
        bar.show(k + 1, range.count());
    }
    outputs.replace_staged();
}

/// The number of frames of an animation if it was not given: 25 per second.
unsigned default_frames(const Clip& clip) {
    constexpr double kRate = 25.0;
    constexpr double kMost = 1000.0;
    const double length = static_cast<double>(clip.end) - static_cast<double>(clip.start);
    return static_cast<unsigned>(std::clamp(std::round(kRate * length), 1.0, kMost));
}

void draw_all(RenderArguments& arguments, const Model& model, const std::string& format, Companion* companion,
              Outputs& outputs) {
    const bool is_animation = format != "png";
    viewer::RenderOptions& render = arguments.render;
    Frames& frames = arguments.pictures;
    if (arguments.has_clip) render.clip = &find_clip(arguments.clip, arguments.file, model);
    if (arguments.stands && model.standing_pose() == nullptr)
        warn(arguments.file, "the file has no standing pose: --stand draws the rest pose");
    if (model.clips().empty() && (is_animation || frames.number() != 0)) {
        fail(arguments.file, std::string("there is no clip for ") + (is_animation ? "an animation" : "--frames") +
                                 "; OUT.png without --frames shows the rest pose");
    }
    if (render.clip == nullptr && (is_animation || frames.range || frames.count > 1)) {
        render.clip = model.clips().data();
    }
    if (is_animation && frames.number() == 0) frames.count = default_frames(*render.clip);
    if (frames.range) warn_outside(arguments.file, *render.clip, *frames.range);
    warn_without_levels(arguments.file, model, render.lod);
    Stage stage(arguments, model, companion);
    ReachingMaker& maker = stage.maker();
    if (arguments.verbose) std::cerr << "bendy: drawing with " << printable(maker.context()) << '\n';
    const float start = render.clip == nullptr ? 0.0f : render.clip->start;
    if (render.clip != nullptr && (is_animation || frames.number() > 1))
        maker.follow_frames(*render.clip, frames.range);
    if (is_sequence(arguments, format)) {
        draw_sequence(stage, arguments, outputs);
    } else if (is_animation) {
        outputs.write(arguments.output, draw_animation(stage, arguments, format == "gif"));
    } else if (frames.range || frames.count > 1) {
        outputs.write(arguments.output, draw_sheet(stage, arguments));
    } else {
        outputs.write(arguments.output, viewer::encode_png(stage.draw(arguments.has_time ? arguments.time : start)));
    }
    maker.print_reached();
}

/// Notes the files that the command writes.
void note_outputs(const RenderArguments& arguments, const std::string& format, Outputs& outputs) {
    if (!is_sequence(arguments, format)) {
        outputs.writes(arguments.output, NamedBy::user, Content::binary);
        return;
    }
    const FrameRange& range = *arguments.pictures.range;
    for (std::uint32_t k = 0; k < range.count(); ++k)
        outputs.writes(frame_output(arguments.output, range.first + k), NamedBy::user, Content::binary);
}

void run(RenderArguments arguments) {
    Outputs outputs;
    outputs.reads(arguments.file);
    check_suffix({"render", "--output", {".png", ".gif", ".webp"}, false}, arguments.file, arguments.output,
                 arguments.format);
    const std::string format = format_of(arguments.format, arguments.output, "png");
    arguments.pictures = parse_frames(arguments.frames);
    note_outputs(arguments, format, outputs);
    const bool has_several = arguments.pictures.range || arguments.pictures.count > 1;
    if (has_several && arguments.has_time) throw CLI::ValidationError("--time", "does not go with --frames");
    if ((has_several || format != "png") && !is_sequence(arguments, format)) {
        arguments.render.width = 320;
        arguments.render.height = 240;
    }
    if (!arguments.size.empty()) parse_size(arguments.size, arguments.render);
    if (!is_sequence(arguments, format)) check_frames(arguments, format);
    if (!arguments.camera.empty()) parse_camera(arguments.camera, arguments.render.camera);
    if (!arguments.background.empty()) parse_background(arguments.background, arguments.render.draw.background);
    arguments.render.draw.targets = arguments.render.draw.constraints;
    require_folder_of(arguments.output);
    const CharacterFile file = open_character(arguments.file, arguments.root, outputs, Storage::copied);
    const Model model = read_valid_model(arguments.file, file.bytes());
    arguments.render.camera.yaw += static_cast<float>(motion::facing(model));
    arguments.render.folders = folders_of(arguments.file, arguments.root);
    note_inputs(arguments.render.folders, model, outputs);
    std::optional<Companion> companion;
    if (!arguments.beside.empty()) companion.emplace(arguments, outputs);
    try {
        draw_all(arguments, model, format, companion ? &*companion : nullptr, outputs);
    } catch (const viewer::ViewerError& problem) {
        fail(arguments.file, printable(problem.what()));
    }
}

}  // namespace

void add_render(CLI::App& program) {
    const auto arguments = std::make_shared<RenderArguments>();
    CLI::App* command = program.add_subcommand("render", "Render a picture or an animation, without a display");
    add_character(*command, arguments->file)->required();
    command
        ->add_option("-o,--output", arguments->output,
                     "OUT.png; or OUT.gif, OUT.webp: an animation; - is standard output")
        ->required();
    add_format(*command, arguments->format, {"png", "gif", "webp"});
    add_root(*command, arguments->root);
    CLI::Option* clip = add_clip(*command, arguments->clip);
    CLI::Option* time = command->add_option("--time", arguments->time, "seconds on the clip's time line")->needs(clip);
    CLI::Option* stand = command->add_flag(
        "--stand", arguments->stands, "draw the pose from which retargeting measures the body, in place of a clip's");
    stand->excludes(clip);
    add_reach(*command, arguments->reach);
    CLI::Option* drawn_frames = command->add_option(
        "--frames", arguments->frames,
        "N pictures, 1 to 1000, spread over the clip; or A..B@RATE: frames A to B, RATE per second. "
        "They are a sheet in OUT.png, the frames of an animation in OUT.gif and OUT.webp, and files of "
        "their own if a # in OUT.png is the place of A to B, as in run_####.png. With --reach, each frame follows from "
        "those before it: no chain jumps");
    stand->excludes(drawn_frames);
    command->add_option(
        "--beside", arguments->beside,
        "FILE or FILE:CLIP: draw that character to the left of this one, at the same times; its clip of "
        "the same name if none is given. --size is of each of the two");
    command->add_option("--size", arguments->size, "WIDTHxHEIGHT of a picture, pixels; 1024x768, of several 320x240");
    command->add_option("--camera", arguments->camera,
                        "YAW,PITCH[,DISTANCE]: degrees round the character, 0,0 its front; and a factor; 34,11 fitted");
    command->add_flag("--bones", arguments->render.draw.bones, "draw the skeleton");
    command->add_flag("--axes", arguments->render.draw.axes, "draw the joints' axes");
    command->add_flag("--constraints", arguments->render.draw.constraints,
                      "draw the joints' limits and the IK targets");
    command->add_flag("--wireframe", arguments->render.draw.wireframe, "draw the edges instead of the surface");
    add_lod(*command, arguments->render.lod);
    command->add_option("--background", arguments->background, "RRGGBB, white, black, grey or transparent");
    command->add_flag("-v,--verbose", arguments->verbose, "print the OpenGL driver in use");
    command->footer(
        "A file without a surface is drawn as its skeleton. Targets of --reach are drawn, each with a line from the "
        "tip that should reach it.\nExample: bendy render fox.bendy --clip Run --time 0.35 --bones -o run.png\n        "
        " bendy render fox.bendy --clip Run --frames 0..59@60 -o run_####.png\n        "
        " bendy render robot.bendy --reach LeftArm=0.3,1.2,0.4 -o reach.png");
    command->callback([arguments, clip, time] {
        arguments->has_clip = clip->count() != 0;
        arguments->has_time = time->count() != 0;
        if (!std::isfinite(arguments->time)) throw CLI::ValidationError("--time", "must be a finite number");
        run(*arguments);
    });
}

}  // namespace bendy::tools

#else

namespace bendy::tools {

void add_render(CLI::App& program) {
    CLI::App* command = program.add_subcommand("render", "Make a picture (this bendy was built without it)");
    command->allow_extras();
    command->callback([] { fail("render", kWithoutViewer); });
}

}  // namespace bendy::tools

#endif
