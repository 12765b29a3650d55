#include "formats/x/conventions.h"
#include "formats/x/rig_fields.h"
#include "optimise/passes/mesh_order.h"
#include "parts.h"
#include "rigging/humanoid/find_roles.h"
#include "scene/failure.h"
#include "scene/source/normalise.h"
#include "scene/source/source_file.h"
#include "scene/space.h"

#include <bendy/converter/export.h>
#include <bendy/converter/import.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

using x_out::Text;

/// Writes the declaration of a template from the fields that rig_fields.h visits.
class Declaration {
public:
    explicit Declaration(Text& text) : text_(text) {}

    void word(const char* field, std::span<const std::string_view> /*words*/, std::uint8_t& /*number*/) {
        declare("STRING", field);
    }
    template <class Integer>
    void integer(const char* field, Integer& /*number*/, std::uint32_t /*most*/) {
        declare("DWORD", field);
    }
    void number(const char* field, float& /*number*/, float /*low*/, float /*high*/) { declare("FLOAT", field); }
    template <std::size_t N>
    void numbers(const char* field, std::array<float, N>& /*numbers*/, float /*low*/, float /*high*/) {
        text_.line("array FLOAT " + std::string(field) + '[' + std::to_string(N) + "];");
    }
    void ranges(const char* field, std::array<float, 3>& range) { numbers(field, range, 0.0f, 0.0f); }
    void text(const char* field, std::string& /*text*/) { declare("STRING", field); }
    void frame(const char* field, std::string& /*identifier*/) { declare("STRING", field); }
    void weights(const char* field, std::vector<std::pair<std::string, float>>& /*weights*/) {
        text_.line("DWORD nWeights;");
        text_.line("array BendyIkWeight " + std::string(field) + "[nWeights];");
    }

private:
    void declare(const char* type, const char* field) { text_.line(std::string(type) + ' ' + field + ';'); }

    Text& text_;
};

void begin(const char* name, const char* uuid, Text& text) {
    text.open("template", name);
    text.line('<' + std::string(uuid) + '>');
}

void declare(const char* name, const char* uuid, std::initializer_list<const char*> members, Text& text) {
    begin(name, uuid, text);
    for (const char* member : members) text.line(member);
    text.close();
}

/// Writes the templates that some readers do not know: those for skins, and ours.
void write_templates(Text& text) {
    declare("XSkinMeshHeader", "3CF169CE-FF7C-44AB-93C0-F78F62D172E2",
            {"WORD nMaxSkinWeightsPerVertex;", "WORD nMaxSkinWeightsPerFace;", "WORD nBones;"}, text);
    declare("SkinWeights", "6F0D123B-BAD2-4167-A0D0-80224F25FABB",
            {"STRING transformNodeName;", "DWORD nWeights;", "array DWORD vertexIndices[nWeights];",
             "array FLOAT weights[nWeights];", "Matrix4x4 matrixOffset;"},
            text);
    declare("AnimTicksPerSecond", "9E415A43-7BA6-4A73-8743-B73D47E88476", {"DWORD AnimTicksPerSecond;"}, text);
    declare("BendyName", "4620F87F-D301-478E-A231-778A892284BE", {"STRING name;"}, text);
    declare("BendyClip", "37C3E628-EE6E-4EA4-AD94-B4116F6833E4", {"STRING animationSet;", "STRING name;"}, text);
    begin("BendyConstraint", "E514D09B-AD9F-4A00-915F-E216F5853E17", text);
    Declaration declaration(text);
    ConstraintRecord constraint;
    x::visit_constraint(declaration, constraint);
    text.close();
    declare("BendyIkWeight", "AB327CA5-4272-42AD-B48F-D0033667B9A7", {"STRING frame;", "FLOAT weight;"}, text);
    begin("BendyIkChain", "3386D549-B39E-43CE-8A3C-659221E001F4", text);
    x::IkChain chain;
    x::visit_chain(declaration, chain);
    text.close();
}

}  // namespace

namespace x_out {
namespace {

/// Writes the fields that rig_fields.h visits, one per line.
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

/// Writes a joint's BendyConstraint objects, one per scope.
void write_constraints(const Joint& joint, Text& text) {
    for (ConstraintRecord constraint : joint.constraints) {
        text.open("BendyConstraint");
        FieldWriter fields(text);
        x::visit_constraint(fields, constraint);
        text.close();
    }
}

/// Writes a BendyIkChain for every chain.
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

/// T * R * U (see Transform) in double, mirrored; R from a quaternion that is unit to the last bit of a double, so that
/// a reader that decomposes the matrix finds the original scale.
std::array<double, 16> matrix_of(const Transform& rest) {
    return x::mirrored(to_affine(local_of(rest), rest.shear).columns());
}

/// Writes every joint as a Frame inside its parent's, with its constraints and the meshes that it carries; then the
/// meshes without a joint.
void write_frames(const Scene& scene, const Names& names, MaterialExporter& materials, Text& text, Report& report) {
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
        for (const std::uint32_t mesh : meshes_of[number]) write_mesh(scene, mesh, names, materials, text, report);
        if (!joint.extras.empty() || !joint.extensions.empty() || !joint.more.empty())
            report.warn("extras or extensions of a joint left out: X-files have no place for it", at("joints", number));
    }
    for (; !open.empty(); open.pop_back()) text.close();
    for (const std::uint32_t mesh : free_meshes) write_mesh(scene, mesh, names, materials, text, report);
}

XAsset write(const Scene& scene, const std::string& image_stem, Report& report) {
    XAsset asset;
    Text text;
    text.line("xof 0303txt 0032");
    text.line("// bendy " BENDY_VERSION);
    write_templates(text);
    const Names names(scene);
    MaterialExporter materials(scene, names, image_stem, text, asset.images, report);
    materials.write_shared();
    write_frames(scene, names, materials, text, report);
    write_chains(scene, names, text);
    write_clips(scene, names, text, report);
    if (!scene.levels.empty()) report.warn("levels of detail left out: X-files have no place for them");
    if (!scene.extras.empty() || !scene.source_extras.empty() || !scene.extensions.empty() || !scene.more.empty() ||
        !scene.source_more.empty())
        report.warn("extras or extensions of the scene left out: X-files have no place for them");
    if (!scene.asset.empty()) report.warn("the source's asset data left out: author, copyright, generator");
    asset.text = std::move(text).take();
    return asset;
}

}  // namespace
}  // namespace x_out

namespace {

XAsset export_bytes(Bytes bytes, const std::string& image_stem, Report& report, const ExportOptions& options,
                    const std::filesystem::path& bendy_file) {
    Result<Scene, ImportError> scene = import_bendy(bytes, report);
    if (!scene) throw Failure{scene.error()};
    if (!bendy_file.empty() && !options.output.empty())
        move_links(*scene, bendy_file, options.output, ReadableFolders::of(bendy_file), report);
    if (!options.vertices.empty()) keep_level(*scene, options.vertices);
    for (std::size_t i = 0; i < scene->meshes.size(); ++i) merge_influences(scene->meshes[i], at("meshes", i), report);
    warn_of_lost_roles(*scene, report);
    if (scene->standing_pose) {
        report.warn(
            "the standing pose is left out: an X-file has no place for it (`bendy rig` writes it to a rig file)");
    }
    return x_out::write(*scene, image_stem, report);
}

}  // namespace

Result<XAsset, ImportError> export_x(Bytes bytes, const std::string& image_stem, Report& report,
                                     const ExportOptions& options) {
    return without_throwing<XAsset>(
        [&]() -> Result<XAsset, ImportError> { return export_bytes(bytes, image_stem, report, options, {}); });
}

Result<XAsset, ImportError> export_x(const std::filesystem::path& bendy_file, const std::string& image_stem,
                                     Report& report, const ExportOptions& options) {
    const Result<MappedFile> mapped = MappedFile::open(bendy_file);
    if (!mapped) return ImportError{{}, describe(mapped.error())};
    return without_throwing<XAsset>([&]() -> Result<XAsset, ImportError> {
        return export_bytes(mapped->bytes(), image_stem, report, options, bendy_file);
    });
}

}  // namespace bendy::converter
