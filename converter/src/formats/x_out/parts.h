#pragma once

#include <bendy/converter/export.h>
#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace bendy::converter::x_out {

/// Builds the text of an X-file: lines, and nested objects. Numbers are the shortest decimals that read back as the
/// same, without exponents, which some readers do not support.
class Text {
public:
    /// `TYPE NAME {`; `name` may be empty.
    void open(std::string_view type, std::string_view name = {});
    void close();
    /// Adds a line verbatim.
    void line(std::string_view text);

    void begin_line();
    void end_line() { text_ += '\n'; }
    Text& add(std::string_view text) {
        text_ += text;
        return *this;
    }
    Text& add(float number);
    Text& add(double number);
    Text& add(std::uint64_t number) { return add(std::to_string(number)); }
    /// Adds each component with a semicolon.
    template <class Vector>
    Text& add_vector(const Vector& vector) {
        for (int i = 0; i < Vector::length(); ++i) add(vector[i]).add(";");
        return *this;
    }
    /// Adds `1;2;3;,` ... `1;2;3;;`: one vector per line.
    template <class Vectors>
    void vectors(const Vectors& list) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            begin_line();
            add_vector(list[i]).add(i + 1 < list.size() ? "," : ";");
            end_line();
        }
    }
    /// Adds 16 numbers, and two semicolons at the end.
    void matrix(const std::array<double, 16>& matrix);
    void matrix(const std::array<float, 16>& matrix);

    [[nodiscard]] std::string take() && { return std::move(text_); }

private:
    template <class Number>
    void write_matrix(const std::array<Number, 16>& matrix);

    std::string text_;
    std::size_t depth_ = 0;
};

/// The identifiers by which the file's objects refer to one another: letters, digits and underscores, all unique.
class Names {
public:
    explicit Names(const Scene& scene);

    std::vector<std::string> joints;
    std::vector<std::string> meshes;
    std::vector<std::string> materials;
    std::vector<std::string> clips;
    std::string no_material;  ///< for things drawn without one

private:
    /// \param kind  prefix for things without a name
    std::string make(std::string_view name, const char* kind, std::size_t number);

    std::unordered_map<std::string, std::uint32_t> times_;  ///< how often an identifier was requested
};

/// Writes a BendyName if the identifier differs from the thing's name.
void write_name(std::string_view identifier, std::string_view name, Text& text);

// The stages of an export.

/// Writes materials. Embedded images become files beside the file.
class MaterialExporter {
public:
    MaterialExporter(const Scene& scene, const Names& names, const std::string& image_stem, Text& text,
                     std::vector<XAsset::File>& images, Report& report);

    /// Writes the materials that meshes refer to by name.
    void write_shared();
    /// Writes one entry of a mesh's material list: a joint's own material in full the first time, otherwise the name.
    void write_entry(std::uint32_t material);

private:
    void write(std::uint32_t number);
    template <class Vector>
    void line(const Vector& vector);
    void write_texture(std::uint32_t number, const std::string& place);
    std::string file_of(std::uint32_t number);
    void report_losses(const Material& material, const std::string& place);

    const Scene& scene_;
    const Names& names_;
    const std::string& image_stem_;
    Text& text_;
    std::vector<XAsset::File>& images_;
    Report& report_;
    std::unordered_set<std::uint32_t> is_written_;  ///< images already written
    std::vector<bool> is_due_;                      ///< by material: stands in a mesh that is not written yet
};

/// Writes a mesh, inside the frame that carries it.
void write_mesh(const Scene& scene, std::uint32_t number, const Names& names, MaterialExporter& materials, Text& text,
                Report& report);

/// Writes AnimTicksPerSecond, an AnimationSet for every clip, and the clips' names if they differ from the identifiers.
void write_clips(const Scene& scene, const Names& names, Text& text, Report& report);

}  // namespace bendy::converter::x_out
