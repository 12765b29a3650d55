#pragma once

#include "ozz_character.h"
#include "ozz_state.h"
#include "peer_timing.h"

#include <bendy/runtime.h>

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace bendy::bench {

/// A character as both sides have it.
struct Character {
    std::string name;
    Model model;
    OzzCharacter ozz;
    [[nodiscard]] double joints() const { return static_cast<double>(model.joints().size()); }
    [[nodiscard]] bool is_animated() const { return !model.clips().empty(); }
};

/// Ends the program with a message if the file is not a valid bendy file.
Model open_model(const std::string& path);
std::unique_ptr<Character> open_character(const std::string& path);
/// The file's name without folder and suffix.
std::string name_of(const std::string& path);

/// sample, which cannot fail here.
void sample_at(Pose& pose, const Clip& clip, float seconds);
/// Sets all morph target weights to 0, since ozz leaves morph targets to others.
void clear_morph_weights(Pose& pose);
/// Computes the palettes of all meshes.
void make_palettes(Pose& pose);

/// Prints a character's numbers, and how far the two sides' skinned positions are apart in its first clip, relative to
/// the extent. ozz quantises its keys.
void print_difference(const Character& character);

/// Seconds from the start of a clip: a 60th of a second later at each call, and from the start again at the end.
struct FrameTimes {
    float length;
    float seconds = 0.0f;
    float next() {
        seconds += 1.0f / 60.0f;
        if (!(seconds <= length)) seconds = 0.0f;
        return seconds;
    }
};

/// Seconds from the start of a clip, at random.
struct RandomTimes {
    float length;
    std::mt19937 random{1};
    float next() { return length * static_cast<float>(random() >> 8) / 16777216.0f; }
};

}  // namespace bendy::bench
