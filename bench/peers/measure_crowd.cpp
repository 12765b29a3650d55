#include "sections.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <thread>
#include <utility>

namespace bendy::bench {
namespace {

constexpr std::size_t kCrowd = 1000;
constexpr std::size_t kLargeCharacter = 20000;  // vertices; a crowd of such is a fifth as large

/// One more thread.
class Helper {
public:
    Helper() : thread_([this] { serve(); }) {}
    ~Helper() {
        start({});
        thread_.join();
    }
    Helper(const Helper&) = delete;
    Helper& operator=(const Helper&) = delete;

    /// \param work  an empty one ends the thread
    void start(std::function<void()> work) {
        work_ = std::move(work);
        ++turn_;
        turn_.notify_one();
    }
    void wait() const {
        const std::uint64_t turn = turn_;
        for (std::uint64_t done = done_; done != turn; done = done_) done_.wait(done);
    }

private:
    void serve() {
        for (std::uint64_t seen = 0;; ++seen) {
            turn_.wait(seen);
            if (!work_) return;
            work_();
            done_ = seen + 1;
            done_.notify_one();
        }
    }

    std::function<void()> work_;
    std::atomic<std::uint64_t> turn_{0}, done_{0};
    std::thread thread_;
};

/// Runs part(worker, first, end) for all members, or for one half of them here and for the other on the helper.
template <class Part>
void in_parts(Helper* helper, std::size_t members, const Part& part) {
    if (helper == nullptr) {
        part(0, 0, members);
        return;
    }
    helper->start([&] { part(1, members / 2, members); });
    part(0, 0, members / 2);
    helper->wait();
}

/// What each member of a crowd writes.
struct Outputs {
    int attributes = 0;       ///< 0: palettes, 1: positions, 2: and normals
    std::size_t count = 0;    ///< members
    std::size_t numbers = 0;  ///< of one attribute of a member
    [[nodiscard]] std::size_t of_a_member() const { return numbers * static_cast<std::size_t>(attributes); }
};

std::vector<FrameTimes> make_times(float length, std::size_t count) {
    std::vector<FrameTimes> times;
    for (std::size_t k = 0; k < count; ++k)
        times.push_back({length, length * static_cast<float>(k) / static_cast<float>(count)});
    return times;
}

class OurCrowd {
public:
    OurCrowd(const Model& model, std::size_t threads, const Outputs& outputs)
        : clip_(model.clips().front()),
          outputs_(outputs),
          crowd_(model, threads),
          vertices_(outputs.count * outputs.of_a_member()),
          palettes_(outputs.attributes == 0 ? outputs.count * crowd_.palette_size() : 0),
          members_(outputs.count),
          times_(make_times(clip_.end - clip_.start, outputs.count)) {
        const std::size_t entries = crowd_.palette_size();
        for (std::size_t k = 0; k < outputs.count; ++k) {
            CrowdMember& member = members_[k];
            member.clip = &clip_;
            if (outputs.attributes == 0) member.palette = std::span(palettes_).subspan(k * entries, entries);
            const auto floats = std::span(vertices_).subspan(k * outputs.of_a_member(), outputs.of_a_member());
            if (outputs.attributes > 0) member.out.positions = {floats.first(outputs.numbers), 3};
            if (outputs.attributes > 1) member.out.normals = {floats.subspan(outputs.numbers), 3};
        }
    }

    void play(std::size_t worker, std::size_t first, std::size_t end) {
        for (std::size_t k = first; k < end; ++k) members_[k].seconds = clip_.start + times_[k].next();
        const auto part = std::span<const CrowdMember>(members_).subspan(first, end - first);
        if (outputs_.attributes == 0) {
            check(crowd_.play(part, worker).has_value(), "Crowd::play");
            return;
        }
        const auto pose_member = [](const CrowdMember& member, Pose& pose) {
            sample_at(pose, *member.clip, member.seconds);
            clear_morph_weights(pose);
        };
        check(crowd_.play(part, worker, pose_member).has_value(), "Crowd::play");
    }

private:
    const Clip& clip_;
    Outputs outputs_;
    Crowd crowd_;
    std::vector<float> vertices_;
    std::vector<PaletteMatrix> palettes_;
    std::vector<CrowdMember> members_;
    std::vector<FrameTimes> times_;
};

/// Each member with a sampling context of its own, which ozz is made for; each thread with the rest of a state.
class OzzCrowd {
public:
    OzzCrowd(const Character& character, const ozz::animation::Animation& clip, std::size_t threads,
             const Outputs& outputs)
        : character_(character.ozz),
          clip_(clip),
          outputs_(outputs),
          vertices_(outputs.count * outputs.of_a_member()),
          times_(
              make_times(character.model.clips().front().end - character.model.clips().front().start, outputs.count)) {
        for (const OzzPalette& palette : character_.palettes) entries_ += palette.joints.size();
        if (outputs.attributes == 0) palettes_.resize(outputs.count * entries_);
        const auto joints = static_cast<int>(character_.joints());
        for (std::size_t k = 0; k < outputs.count; ++k)
            contexts_.push_back(std::make_unique<ozz::animation::SamplingJob::Context>(joints));
        for (std::size_t k = 0; k < threads; ++k) states_.push_back(std::make_unique<OzzState>(character_));
    }

    void play(std::size_t worker, std::size_t first, std::size_t end) {
        OzzState& state = *states_[worker];
        for (std::size_t k = first; k < end; ++k) {
            ozz::animation::SamplingJob job;
            job.animation = &clip_;
            job.context = contexts_[k].get();
            job.ratio = times_[k].next() / clip_.duration();
            job.output = ozz::make_span(state.locals);
            check(job.Run(), "ozz's SamplingJob");
            state.local_to_model();
            if (outputs_.attributes == 0) {
                write_palettes(state, palettes_.data() + k * entries_);
            } else {
                state.make_palettes();
                float* const to = vertices_.data() + k * outputs_.of_a_member();
                state.skin(outputs_.attributes, to, to + outputs_.numbers, nullptr);
            }
        }
    }

private:
    void write_palettes(const OzzState& state, ozz::math::Float4x4* to) const {
        for (std::size_t number = 0; number < character_.palettes.size(); ++number) {
            state.make_palette(number, to);
            to += character_.palettes[number].joints.size();
        }
    }

    const OzzCharacter& character_;
    const ozz::animation::Animation& clip_;
    Outputs outputs_;
    std::size_t entries_ = 0;  // of the palettes of a member
    std::vector<float> vertices_;
    std::vector<ozz::math::Float4x4> palettes_;
    std::vector<FrameTimes> times_;
    std::vector<std::unique_ptr<ozz::animation::SamplingJob::Context>> contexts_;
    std::vector<std::unique_ptr<OzzState>> states_;
};

void measure_crowd(Table& table, const Character& character, std::size_t threads, int attributes) {
    const auto vertices = static_cast<std::size_t>(character.model.vertex_count());
    Outputs outputs;
    outputs.attributes = attributes;
    outputs.count = attributes > 0 && vertices > kLargeCharacter ? kCrowd / 5 : kCrowd;
    outputs.numbers = 3 * vertices;
    std::unique_ptr<Helper> helper;
    if (threads == 2) helper = std::make_unique<Helper>();
    OurCrowd ours(character.model, threads, outputs);
    OzzCrowd all_keys(character, *character.ozz.clips.front().plain, threads, outputs);
    OzzCrowd optimised(character, *character.ozz.clips.front().optimised, threads, outputs);
    const auto play = [&](auto& crowd) {
        return [&] {
            in_parts(helper.get(), outputs.count,
                     [&](std::size_t worker, std::size_t first, std::size_t end) { crowd.play(worker, first, end); });
        };
    };
    const std::string what = "crowd of " + std::to_string(outputs.count) +
                             (attributes == 0   ? ", palettes, "
                              : attributes == 1 ? ", P, "
                                                : ", P, N, ") +
                             std::to_string(threads) + (threads == 1 ? " thread" : " threads");
    table.compare(
        {character.name, what, "character", static_cast<double>(outputs.count)},
        {{"ours", play(ours)}, {"ozz, all keys", play(all_keys)}, {"ozz, optimised, iframes", play(optimised)}});
}

}  // namespace

void measure_crowds(Table& table, const Character& character) {
    const auto meshes = character.model.meshes();
    const bool has_normals =
        std::all_of(meshes.begin(), meshes.end(), [](const Mesh& mesh) { return mesh.normals.has_value(); });
    for (const std::size_t threads : {1, 2}) measure_crowd(table, character, threads, 0);
    for (const std::size_t threads : {1, 2}) measure_crowd(table, character, threads, has_normals ? 2 : 1);
}

}  // namespace bendy::bench
