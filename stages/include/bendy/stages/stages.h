#pragma once

#include <bendy/runtime/lod.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/pose.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <functional>
#include <random>
#include <string>
#include <vector>

// What is done with a file from opening it to its vertices on the screen, a step at a time: what `bendy bench` and
// bench/ time.
namespace bendy::stages {

struct Stage {
    std::string name;
    const char* item = "";  ///< what a time is stated for: "file", "joint", "vertex", ...
    double items = 1.0;     ///< of these in one run
    std::function<void()> run;
};

/// The stages of one file, with all that they work on; they use it, and it must not move.
class Stages {
public:
    using Open = std::function<Result<Model>(const OpenOptions&)>;

    /// \param open   opens the file once more, or the bytes that were piped in
    /// \param model  the file opened
    /// \param clip  what is played; null: the rest pose, and nothing is sampled
    Stages(const Open& open, const Model& model, const Clip* clip);
    Stages(const Stages&) = delete;
    Stages& operator=(const Stages&) = delete;
    Stages(Stages&&) = delete;
    Stages& operator=(Stages&&) = delete;
    ~Stages() = default;

    [[nodiscard]] const std::vector<Stage>& list() const { return list_; }

private:
    void add(std::string name, const char* item, double items, std::function<void()> run);
    void add_opening(const Open& open);
    void add_posing();
    void add_skinning();
    void add_morphing();
    void add_reaching();
    void add_levels();
    void next_frame();
    void touch();
    /// Positions, normals, tangents: the first so many.
    void skin_attributes(std::size_t attributes);

    const Model& model_;
    const Clip* clip_;
    Pose pose_, other_;
    Lod lod_;
    float seconds_ = 0.0f;
    std::mt19937 random_{1};
    std::vector<glm::vec3> positions_, normals_;
    std::vector<glm::vec4> tangents_;
    std::vector<float> weights_;      // of morph targets
    std::vector<glm::vec3> targets_;  // two for each chain
    std::size_t turn_ = 0;            // which of two
    std::vector<Stage> list_;
};

}  // namespace bendy::stages
