#include <bendy/stages/stages.h>

#include <bendy/runtime.h>

#include <algorithm>
#include <array>
#include <utility>

namespace bendy::stages {
namespace {

constexpr float kFrame = 1.0f / 60.0f;  // seconds

bool has_attribute(const Model& model, std::size_t attribute) {
    const auto meshes = model.meshes();
    return std::any_of(meshes.begin(), meshes.end(), [&](const Mesh& mesh) {
        return attribute == 0 || (attribute == 1 ? mesh.normals.has_value() : mesh.tangents.has_value());
    });
}

}  // namespace

Stages::Stages(const Open& open, const Model& model, const Clip* clip)
    : model_(model),
      clip_(clip),
      pose_(model),
      other_(model),
      lod_(model),
      seconds_(clip == nullptr ? 0.0f : clip->start),
      positions_(model.vertex_count()),
      normals_(has_attribute(model, 1) ? model.vertex_count() : 0),
      tangents_(has_attribute(model, 2) ? model.vertex_count() : 0),
      weights_(model.morph_target_count(), 0.5f) {
    add_opening(open);
    add_posing();
    add_skinning();
    add_morphing();
    add_reaching();
    add_levels();
}

void Stages::add(std::string name, const char* item, double items, std::function<void()> run) {
    if (items > 0.0) list_.push_back({std::move(name), item, items, std::move(run)});
}

void Stages::add_opening(const Open& open) {
    add("open, sums checked", "file", 1.0, [open] { (void)open({}); });
    add("open, sums not checked", "file", 1.0, [open] {
        OpenOptions options;
        options.sums = Sums::later;
        (void)open(options);
    });
    const std::size_t clip = clip_ == nullptr ? 0 : static_cast<std::size_t>(clip_ - model_.clips().data());
    add("open to the first pose", "file", 1.0, [open, clip] {
        const Result<Model> opened = open({});
        if (!opened) return;
        Pose pose(*opened);
        if (clip < opened->clips().size()) (void)sample(pose, &opened->clips()[clip], opened->clips()[clip].start);
        (void)pose.model_space();
    });
}

void Stages::next_frame() {
    seconds_ += kFrame;
    if (!(seconds_ <= clip_->end)) seconds_ = clip_->start;
    (void)sample(pose_, clip_, seconds_);
}

void Stages::add_posing() {
    const auto joints = static_cast<double>(model_.joints().size());
    if (clip_ != nullptr) {
        add("sample, next frame", "joint", joints, [this] { next_frame(); });
        add("sample, random time", "joint", joints, [this] {
            const float share = static_cast<float>(random_() >> 8) / 16777216.0f;
            (void)sample(pose_, clip_, clip_->start + share * (clip_->end - clip_->start));
        });
    }
    if (clip_ != nullptr) (void)sample(other_, clip_, 0.5f * (clip_->start + clip_->end));
    add("blend two poses", "joint", joints, [this] { (void)blend(pose_, other_, 0.5f); });
    add("local to model", "joint", joints, [this] {
        (void)pose_.change_local_blocks();
        (void)pose_.model_space();
    });
    add("local to model and palettes", "joint", joints, [this] {
        (void)pose_.change_local_blocks();
        (void)pose_.model_space();
        for (std::uint32_t mesh = 0; mesh < model_.meshes().size(); ++mesh) (void)pose_.palette(mesh);
    });
}

void Stages::skin_attributes(std::size_t attributes) {
    Vertices out;
    out.positions = positions_;
    if (attributes > 1) out.normals = normals_;
    if (attributes > 2) out.tangents = tangents_;
    (void)skin(pose_, {.out = out});
}

void Stages::add_skinning() {
    constexpr std::array kNames{"skin positions", "skin positions, normals", "skin positions, normals, tangents"};
    const auto vertices = static_cast<double>(model_.vertex_count());
    std::size_t most = 1;
    for (std::size_t attributes = 1; attributes <= kNames.size(); ++attributes) {
        if (!has_attribute(model_, attributes - 1)) continue;
        most = attributes;
        add(kNames.at(attributes - 1), "vertex", vertices, [this, attributes] { skin_attributes(attributes); });
    }
    add("a whole frame", "character", 1.0, [this, most] {
        if (clip_ != nullptr) next_frame();
        (void)pose_.change_local_blocks();
        skin_attributes(most);
    });
}

void Stages::add_morphing() {
    double moved = 0.0;
    for (const Mesh& mesh : model_.meshes()) moved += mesh.targets.empty() ? 0.0 : mesh.vertices;
    add("morph, all targets", "vertex", moved, [this] {
        for (std::uint32_t number = 0; number < model_.meshes().size(); ++number) {
            const Mesh& mesh = model_.meshes()[number];
            if (mesh.targets.empty()) continue;
            const auto weights = std::span(weights_).subspan(model_.first_morph_target(number), mesh.targets.size());
            (void)apply_morph_targets(mesh, weights, {positions_, normals_, {}});
        }
    });
}

void Stages::add_reaching() {
    for (const Chain& chain : model_.chains()) {
        const glm::vec3 start(pose_.model_space()[chain.record.start][3]);
        const glm::vec3 tip(pose_.model_space()[chain.record.effector][3]);
        targets_.push_back(start + 0.95f * (tip - start));
        targets_.push_back(start + 0.85f * (tip - start));
    }
    // The target alternates between two positions, as if it moved.
    add("reach", "chain", static_cast<double>(model_.chains().size()), [this] {
        turn_ ^= 1;
        for (std::size_t k = 0; k < model_.chains().size(); ++k)
            (void)reach(pose_, &model_.chains()[k], targets_[2 * k + turn_]);
    });
}

void Stages::add_levels() {
    if (model_.collapse() == nullptr) return;
    add("switch the level of detail", "switch", 1.0, [this] {
        turn_ ^= 1;
        lod_.set_share(turn_ == 0 ? 0.5f : 0.25f);
    });
}

}  // namespace bendy::stages
