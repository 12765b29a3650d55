#include "failure.h"
#include "parts.h"
#include "space.h"
#include "x/conventions.h"
#include "x/rig_fields.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace bendy::converter::x_out {
namespace {

/// Writes the fields that rig_fields.h walks, a line each.
class FieldWriter {
public:
    explicit FieldWriter(Text& text) : text_(text) {}

    void word(const char* /*field*/, std::span<const std::string_view> words, std::uint8_t& number) {
        string(std::string(words[number]));
    }
    template <class Integer>
    void integer(const char* /*field*/, Integer& number, std::uint32_t /*most*/) {
        text_.line(std::to_string(number) + ';');
    }
    void number(const char* /*field*/, float& number, float /*low*/, float /*high*/) {
        text_.begin_line();
        text_.add(number).add(";");
        text_.end_line();
    }
    template <std::size_t N>
    void numbers(const char* /*field*/, std::array<float, N>& numbers, float /*low*/, float /*high*/) {
        text_.begin_line();
        for (std::size_t i = 0; i < N; ++i) text_.add(numbers[i]).add(i + 1 < N ? "," : ";");
        text_.end_line();
    }
    void ranges(const char* field, std::array<float, 3>& numbers) {
        std::array<float, 3> finite = numbers;
        for (float& number : finite) number = std::isinf(number) ? std::copysign(x::kMost, number) : number;
        this->numbers(field, finite, 0.0f, 0.0f);
    }
    void text(const char* /*field*/, std::string& text) { string(x::encode_text(text)); }
    void frame(const char* /*field*/, std::string& identifier) { string(identifier); }
    void weights(const char* /*field*/, std::vector<std::pair<std::string, float>>& weights) {
        text_.line(std::to_string(weights.size()) + ';');
        for (std::size_t i = 0; i < weights.size(); ++i) {
            text_.begin_line();
            text_.add('"' + weights[i].first + "\";").add(weights[i].second).add(i + 1 < weights.size() ? ";," : ";;");
            text_.end_line();
        }
    }

private:
    void string(const std::string& text) { text_.line('"' + text + "\";"); }

    Text& text_;
};

}  // namespace

void write_constraints(const Joint& joint, Text& text) {
    for (ConstraintRecord constraint : joint.constraints) {
        text.open("BendyConstraint");
        FieldWriter fields(text);
        x::visit_constraint(fields, constraint);
        text.close();
    }
}

void write_chains(const Scene& scene, const Names& names, Text& text) {
    const auto name_of = [&](std::uint32_t joint) { return joint == kNone ? std::string() : names.joints[joint]; };
    for (const Chain& source : scene.chains) {
        x::IkChain chain;
        chain.name = source.name;
        chain.start = name_of(source.record.start);
        chain.effector = name_of(source.record.effector);
        chain.target = name_of(source.record.target);
        chain.pole = name_of(source.record.pole);
        chain.record = source.record;
        for (const Chain::Weight& weight : source.weights)
            chain.weights.emplace_back(name_of(weight.joint), weight.weight);
        chain.extras = source.extras;
        text.open("BendyIkChain");
        FieldWriter fields(text);
        x::visit_chain(fields, chain);
        text.close();
    }
}

namespace {

/// T * R * U (see Transform) in double, mirrored; R from a quaternion that is unit to the last bit of a double, so that
/// a reader who takes the matrix apart finds the scale that was put in.
std::array<double, 16> matrix_of(const Transform& rest) {
    return x::mirrored(to_affine(local_of(rest), rest.shear).columns());
}

}  // namespace

void write_frames(const Scene& scene, const Names& names, Text& text, Report& report) {
    std::vector<std::vector<std::uint32_t>> meshes_of(scene.joints.size());
    std::vector<std::uint32_t> free_meshes;
    for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        const std::uint32_t joint = scene.meshes[mesh].joint;
        (joint == kNone ? free_meshes : meshes_of[joint]).push_back(mesh);
    }
    std::vector<std::uint32_t> open;
    for (std::uint32_t number = 0; number < scene.joints.size(); ++number) {
        const Joint& joint = scene.joints[number];
        for (; !open.empty() && open.back() != joint.parent; open.pop_back()) text.close();
        open.push_back(number);
        text.open("Frame", names.joints[number]);
        text.open("FrameTransformMatrix");
        text.matrix(matrix_of(joint.rest));
        text.close();
        write_name(names.joints[number], joint.name, text);
        write_constraints(joint, text);
        for (const std::uint32_t mesh : meshes_of[number]) write_mesh(scene, mesh, names, text, report);
        if (!joint.extras.empty() || !joint.extensions.empty() || !joint.more.empty())
            report.warn("extras or extensions of a joint left out: X-files have no place for it", at("joints", number));
    }
    for (; !open.empty(); open.pop_back()) text.close();
    for (const std::uint32_t mesh : free_meshes) write_mesh(scene, mesh, names, text, report);
}

}  // namespace bendy::converter::x_out
