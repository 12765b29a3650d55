#include "character.h"

#include <bendy/format/diagnostics.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <utility>

namespace bendy::bench {

Model open_model(const std::string& path) {
    auto model = Model::open(path);
    if (!model) fail(path + ": " + describe(model.error()));
    return *std::move(model);
}

std::unique_ptr<Character> open_character(const std::string& path) {
    auto character = std::make_unique<Character>(Character{name_of(path), open_model(path), {}});
    character->ozz = make_ozz(character->model);
    return character;
}

std::string name_of(const std::string& path) {
    return std::filesystem::path(path).stem().string();
}

void sample_at(Pose& pose, const Clip& clip, float seconds) {
    check(sample(pose, &clip, seconds).has_value(), "sample");
}

void clear_morph_weights(Pose& pose) {
    for (float& weight : pose.change_morph_weights()) weight = 0.0f;
}

void make_palettes(Pose& pose) {
    for (std::uint32_t mesh = 0; mesh < pose.model().meshes().size(); ++mesh) (void)pose.palette(mesh);
}

namespace {

/// Takes up distances of vertices, and where our vertices were.
class Differences {
public:
    void add(const glm::vec3& ours, const glm::vec3& theirs) {
        worst_ = std::max(worst_, glm::distance(ours, theirs));
        low_ = glm::min(low_, ours);
        high_ = glm::max(high_, ours);
    }
    [[nodiscard]] double of_extent() const { return static_cast<double>(worst_ / glm::distance(low_, high_)); }

private:
    float worst_ = 0.0f;
    glm::vec3 low_{1e30f}, high_{-1e30f};
};

double difference_of(const Character& character) {
    constexpr int kTimes = 7;
    const Model& model = character.model;
    const Clip& clip = model.clips().front();
    Pose pose(model);
    OzzState state(character.ozz);
    const auto vertices = static_cast<std::size_t>(model.vertex_count());
    std::vector<glm::vec3> ours(vertices);
    std::vector<float> theirs(3 * vertices);
    Differences differences;
    for (int k = 0; k < kTimes; ++k) {
        const float seconds = (clip.end - clip.start) * static_cast<float>(k) / (kTimes + 0.3f);
        sample_at(pose, clip, clip.start + seconds);
        clear_morph_weights(pose);
        check(skin(pose, {.out = {.positions = ours}}).has_value(), "skin");
        state.sample(*character.ozz.clips.front().plain, seconds);
        state.local_to_model();
        state.make_palettes();
        state.skin(1, theirs.data(), nullptr, nullptr);
        const float* place = theirs.data();
        for (std::uint32_t mesh = 0; mesh < model.meshes().size(); ++mesh) {
            const auto first = static_cast<std::size_t>(model.first_vertex(mesh));
            for (const OzzPart& part : character.ozz.meshes[mesh].parts) {
                for (const std::uint32_t vertex : part.vertices) {
                    differences.add(ours[first + vertex], {place[0], place[1], place[2]});
                    place += 3;
                }
            }
        }
    }
    return differences.of_extent();
}

}  // namespace

void print_difference(const Character& character) {
    const Model& model = character.model;
    const auto vertices = static_cast<double>(model.vertex_count());
    if (!character.is_animated() || vertices == 0.0) {
        std::printf("%s: no clips or no vertices, nothing to compare\n", character.name.c_str());
        return;
    }
    constexpr std::size_t kMost = 4;  // and more
    std::array<double, kMost + 1> shares{};
    for (const OzzMesh& mesh : character.ozz.meshes) {
        for (const OzzPart& part : mesh.parts)
            shares[std::min(part.influences, kMost)] += 100.0 * static_cast<double>(part.size()) / vertices;
    }
    std::printf(
        "%s: %zu joints, %.0f vertices in %zu meshes (%.0f %% with 1 influence, %.0f %% with 2, %.0f %% with 3, %.0f "
        "%% with 4 or more); the sides differ by %.2g of the extent\n",
        character.name.c_str(), model.joints().size(), vertices, model.meshes().size(), shares[1], shares[2], shares[3],
        shares[4], difference_of(character));
}

}  // namespace bendy::bench
