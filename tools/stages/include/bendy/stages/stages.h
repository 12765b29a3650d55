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

// The steps from opening a file to its skinned vertices, which `bendy bench` and bench/ measure.
namespace bendy::stages {

struct Stage {
    std::string name;
    const char* item = "";  ///< the unit of work that times refer to: "file", "joint", "vertex", ...
    double items = 1.0;     ///< number of items in one run
    std::function<void()> run;
};

/// The stages of one file and their data. The stages refer to this object, so it cannot be moved.
class Stages {
public:
    using Open = std::function<Result<Model>(const OpenOptions&)>;

    /// \param open   opens the file again, or the bytes from standard input
    /// \param model  the opened file
    /// \param clip   the clip to play; null: the rest pose, and nothing is sampled
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
    /// Skins the first so many of positions, normals, tangents.
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
    std::size_t turn_ = 0;            // which of the two
    std::vector<Stage> list_;
};

}  // namespace bendy::stages
