// The tools as one function. JavaScript writes a request and its files into the module's file system, calls
// bendy_tools_run, and reads the answer and the resulting files: bindings/web/src/tools/module.ts.
//   /request.json   {"do": "convert", "file": "fox.glb", ...}; the files are relative to the working directory
//   /answer.json    the result of the function below, or {"error": {...}}
//   /made/0, ...    the resulting files, named in the answer's "made"
#include "reports/conversion.h"
#include "reports/describe_chunk.h"
#include "reports/differences.h"
#include "reports/inspect_html.h"
#include "reports/json.h"
#include "reports/messages.h"
#include "reports/summary.h"

#include <bendy/converter/convert.h>
#include <bendy/converter/export.h>
#include <bendy/converter/import.h>
#include <bendy/converter/source_format.h>
#include <bendy/diff/compare_files.h>
#include <bendy/edit/clips.h>
#include <bendy/edit/edit.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>
#include <bendy/motion/retarget_clips.h>
#include <bendy/motion/stand.h>
#include <bendy/runtime.h>
#include <bendy/text_form/text_form.h>

#include <emscripten.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

// clang-format off: JavaScript
EM_JS(void, bendy_tell_progress, (double share), { Module["progress"](share); });
// clang-format on

namespace bendy::web {
namespace {

using Json = OrderedJson;
using Path = std::filesystem::path;

/// The content of a BendyError.
struct Failure {
    std::string kind, code, message;
    std::string path = {};
    std::uint64_t offset = 0;
};

const char* kind_name(ErrorCode code) {
    constexpr std::array kKinds{"malformed", "invalid", "unsupported", "io"};
    return kKinds[static_cast<std::size_t>(error_class(code))];
}

[[noreturn]] void fail(const Error& error, Bytes bytes) {
    throw Failure{kind_name(error.code), code_name(error.code), describe(error), whole_chunk_path(bytes, error.offset),
                  error.offset};
}

[[noreturn]] void refuse(std::string message) {
    throw Failure{"bad_argument", "BAD_ARGUMENT", std::move(message)};
}

std::string in_javascript(std::string_view text) {
    return converter::with_option_names(text, converter::OptionStyle::javascript);
}

[[noreturn]] void fail(const converter::ImportError& error) {
    const std::string file = error.file.empty() ? "" : error.file.generic_string() + ": ";
    throw Failure{"conversion", "CONVERSION", file + in_javascript(tools::describe(error)), error.place};
}

MappedFile map(const Path& file) {
    auto mapped = MappedFile::open(file);
    if (!mapped) fail(mapped.error(), {});
    return *std::move(mapped);
}

/// Maps a bendy file. If it is known to be something else, the failure says what it is.
MappedFile map_bendy(const Path& file) {
    MappedFile mapped = map(file);
    if (const auto kind = converter::find_file_kind(mapped.bytes(), file)) {
        std::string why = converter::why_not_bendy(*kind, file);
        if (kind->format && !why.empty())
            why = "the bytes are " + std::string(kind->name) + ", not a bendy file: convert makes one of them";
        if (!why.empty()) {
            throw Failure{"malformed", code_name(ErrorCode::kNotABendyFile), why, whole_chunk_path(mapped.bytes(), 0)};
        }
    }
    return mapped;
}

ChunkTree read_tree(Bytes bytes) {
    auto tree = read_chunk_tree(bytes);
    if (!tree) fail(tree.error(), bytes);
    return *std::move(tree);
}

/// The resulting files, in order.
class Made {
public:
    void add(const std::string& name, Bytes bytes) {
        const std::string path = "/made/" + std::to_string(names_.size());
        std::FILE* const file = std::fopen(path.c_str(), "wb");
        if (file == nullptr) throw std::bad_alloc();
        const bool is_written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
        if (std::fclose(file) != 0 || !is_written) throw std::bad_alloc();
        names_.push_back(name);
    }
    void add(const std::string& name, std::string_view text) {
        add(name, std::as_bytes(std::span(text.data(), text.size())));
    }
    [[nodiscard]] const Json& names() const { return names_; }

private:
    Json names_ = Json::array();
};

Json warnings_of(const converter::Report& report) {
    Json list = Json::array();
    for (const converter::Warning& warning : report.warnings())
        list.push_back({{"message", warning.message}, {"place", warning.first_place}, {"count", warning.count}});
    return list;
}

std::string text_of(const Json& request, const char* key) {
    return request.value(key, std::string());
}

Json run_convert(const Json& request, Made& made) {
    tools::ConvertArguments arguments;
    tools::visit_options(arguments, [&](const tools::ConvertOption& option, auto& value) {
        const auto given = request.find(in_javascript(option.flag()));
        if (given == request.end()) return;
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, Path>) {
            value = given->text();
        } else {
            value = given->get<Value>();
        }
        if constexpr (std::is_same_v<Value, tools::option::word>) {
            if (const std::string why = option.why_not(value); !why.empty()) refuse(why);
        }
    });
    arguments.root = "/";  // all files here belong to the caller
    if (!arguments.max_error.empty()) {
        const auto bound = converter::parse_error_bound(arguments.max_error);
        if (!bound) refuse("compact: " + bound.error());
    }
    converter::ConvertOptions options = tools::options_of(arguments);
    options.threads = 1;  // the module has no other threads
    if (request.value("progress", false)) options.progress = bendy_tell_progress;
    const Path file = text_of(request, "file");
    converter::Report report(converter::OptionStyle::javascript);
    const auto bytes = converter::convert(file, options, report);
    if (!bytes) fail(bytes.error());
    made.add("", *bytes);
    Json described = tools::converted_report(file, {}, report, *bytes);
    for (const char* key : {"status", "input", "output"}) described.erase(key);
    Json sources = Json::array();
    for (const converter::SourceFile& source : report.sources()) {
        if (source.stamp.is_there) sources.push_back(source.file.lexically_normal().generic_string());
    }
    return {{"report", std::move(described)}, {"sources", std::move(sources)}};
}

Json run_validate(const Json& request, Made& /*made*/) {
    const MappedFile file = map_bendy(text_of(request, "file"));
    const Faults faults = validate(file.bytes());
    Json list = Json::array();
    for (const Error& fault : faults.list()) {
        list.push_back({{"code", code_name(fault.code)},
                        {"kind", kind_name(fault.code)},
                        {"message", describe(fault)},
                        {"path", whole_chunk_path(file.bytes(), fault.offset)},
                        {"offset", fault.offset}});
    }
    return {{"faults", std::move(list)}, {"leftOut", faults.left_out()}};
}

Json run_inspect(const Json& request, Made& /*made*/) {
    const MappedFile file = map_bendy(text_of(request, "file"));
    ChunkTree tree = read_tree(file.bytes());
    decode_leaves(tree);
    return {{"chunks", tools::chunks_as_json(tree, 0, tools::FaultyChunks(tree, validate(file.bytes())))}};
}

Json run_summary(const Json& request, Made& /*made*/) {
    const MappedFile file = map_bendy(text_of(request, "file"));
    const ChunkTree tree = read_tree(file.bytes());
    const auto& chunks = tree.chunks();
    if (std::none_of(chunks.begin(), chunks.end(), [](const Chunk& chunk) { return chunk.id == FourCC("OBJE"); }))
        return {{"summary", tools::summary_as_json(tools::summarize_empty(file.bytes()))}};
    const auto model = Model::from_memory(file.bytes());
    if (!model) fail(model.error(), file.bytes());
    return {{"summary", tools::summary_as_json(tools::summarize(*model, file.bytes()))}};
}

Json run_inspect_page(const Json& request, Made& made) {
    const MappedFile mapped = map_bendy(text_of(request, "file"));
    tools::InspectedFile file;
    file.name = text_of(request, "name");
    file.bytes = mapped.bytes();
    file.pictures.why_none = "pages that are made in a browser have no pictures";
    auto tree = read_chunk_tree(file.bytes);
    if (tree) {
        check_sums(*tree, file.faults);
        decode_leaves(*tree);
        file.tree = &*tree;
        file.document = read_document(*tree, file.faults);
        check_values(*tree, file.document, file.faults);
    } else {
        file.faults.add(tree.error());
    }
    made.add("", tools::inspect_page(file));
    return Json::object();
}

Json run_dump(const Json& request, Made& made) {
    const MappedFile file = map_bendy(text_of(request, "file"));
    ChunkTree tree = read_tree(file.bytes());
    Faults faults;
    check_sums(tree, faults);
    if (!faults.empty() && !request.value("ignoreSums", false)) fail(faults.list().front(), file.bytes());
    decode_leaves(tree);
    text_form::DumpOptions options;
    options.decode = request.value("decode", false);
    made.add("", text_form::dump(tree, options));
    return Json::object();
}

Json run_assemble(const Json& request, Made& made) {
    const MappedFile file = map(text_of(request, "file"));
    const auto bytes = text_form::assemble(as_text(file.bytes()));
    if (!bytes) {
        const text_form::TextFault& fault = bytes.error();
        throw Failure{"malformed", "TEXT", fault.what, std::to_string(fault.line) + ':' + std::to_string(fault.column)};
    }
    const Faults faults = validate(*bytes);
    if (!faults.empty() && !request.value("allowInvalid", false)) fail(faults.list().front(), *bytes);
    made.add("", *bytes);
    return Json::object();
}

/// Returns the log of the operation; a problem becomes a Failure.
template <class Operation>
Json edited(const Json& request, Made& made, const Operation& operation) {
    const MappedFile file = map_bendy(text_of(request, "file"));
    edit::Log log;
    const edit::Edited bytes = operation(file.bytes(), log);
    if (!bytes) throw Failure{"edit", "EDIT", bytes.error().message};
    made.add("", *bytes);
    return {{"done", log.done}, {"warnings", log.warnings}};
}

/// Returns the value of a word that the caller gave.
template <class Word>
Word parsed(const Result<Word, edit::Problem>& word) {
    if (!word) refuse(word.error().message);
    return *word;
}

Json run_strip(const Json& request, Made& made) {
    const auto what = parsed(edit::parse_strip(text_of(request, "part")));
    return edited(request, made, [&](Bytes bytes, edit::Log& log) { return edit::strip(bytes, what, log); });
}

Json run_rename(const Json& request, Made& made) {
    edit::Rename rename;
    rename.kind = parsed(edit::parse_named(text_of(request, "kind")));
    for (const Json& pair : request.at("names")) rename.names.emplace_back(pair.at(0).text(), pair.at(1).text());
    rename.all_must_match = request.value("allMustMatch", true);
    return edited(request, made, [&](Bytes bytes, edit::Log& log) { return edit::rename(bytes, rename, log); });
}

Json run_merge_clips(const Json& request, Made& made) {
    const auto same_name = parsed(edit::parse_same_name(text_of(request, "sameName")));
    const MappedFile other = map_bendy(text_of(request, "other"));
    return edited(request, made,
                  [&](Bytes bytes, edit::Log& log) { return edit::add_clips(bytes, other.bytes(), same_name, log); });
}

Json run_retarget_clips(const Json& request, Made& made) {
    motion::RetargetClips options{text_of(request, "clip"), {}, {}};
    options.chooses_rests = !request.contains("restPoses");
    options.same_name = parsed(edit::parse_same_name(text_of(request, "sameName")));
    RetargetOptions& retarget = options.retarget;
    const std::string rest_poses = request.value("restPoses", "measured");
    if (rest_poses != "measured" && rest_poses != "alike") refuse("restPoses must be measured or alike");
    retarget.rest_poses = rest_poses == "alike" ? RestPoses::alike : RestPoses::measured;
    const std::string word = request.value("limits", std::string(motion::kLimitsWords.front()));
    const auto limits = motion::parse_limits(word);
    if (!limits) refuse("limits must be soft, hard or off");
    retarget.limits = *limits;
    retarget.plants_feet = request.value("plantsFeet", retarget.plants_feet);
    const MappedFile other = map_bendy(text_of(request, "other"));
    return edited(request, made, [&](Bytes bytes, edit::Log& log) {
        return motion::retarget_clips(bytes, other.bytes(), options, log);
    });
}

Json run_set_role(const Json& request, Made& made) {
    const auto what = parsed(edit::parse_role(text_of(request, "text")));
    return edited(request, made, [&](Bytes bytes, edit::Log& log) { return edit::set_role(bytes, what, log); });
}

Json run_stand(const Json& request, Made& made) {
    const std::string clip = text_of(request, "clip");
    const auto seconds = request.at("seconds").get<double>();
    return edited(request, made,
                  [&](Bytes bytes, edit::Log& log) { return motion::stand_as_in_clip(bytes, clip, seconds, log); });
}

Json run_stand_as(const Json& request, Made& made) {
    const MappedFile other = map_bendy(text_of(request, "other"));
    return edited(request, made,
                  [&](Bytes bytes, edit::Log& log) { return motion::stand_as(bytes, other.bytes(), log); });
}

Json run_set_material(const Json& request, Made& made) {
    const edit::SetMaterial what{text_of(request, "material"), text_of(request, "field"), text_of(request, "value")};
    return edited(request, made, [&](Bytes bytes, edit::Log& log) { return edit::set_material(bytes, what, log); });
}

Json run_extract(const Json& request, Made& made) {
    const std::string joint = text_of(request, "joint");
    return edited(request, made, [&](Bytes bytes, edit::Log& log) { return edit::extract(bytes, joint, log); });
}

Json run_change_clips(const Json& request, Made& made) {
    const auto texts = request.at("texts").get<std::vector<std::string>>();
    const auto what = parsed(edit::parse_clip_change(text_of(request, "work"), texts));
    return edited(request, made, [&](Bytes bytes, edit::Log& log) { return edit::change_clips(bytes, what, log); });
}

Json run_limit_influences(const Json& request, Made& made) {
    const auto most = request.at("most").get<std::uint32_t>();
    return edited(request, made, [&](Bytes bytes, edit::Log& log) { return edit::limit_influences(bytes, most, log); });
}

std::vector<std::uint32_t> vertices_at(Bytes bytes, float share) {
    if (!(share < 1.0f)) return {};
    const auto model = Model::from_memory(bytes);
    if (!model) fail(model.error(), bytes);
    if (model->collapse() == nullptr) refuse("the file has no levels of detail");
    Lod lod(*model);
    lod.set_share(share);
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t mesh = 0; mesh < model->meshes().size(); ++mesh) vertices.push_back(lod.vertices(mesh));
    return vertices;
}

Json run_export(const Json& request, Made& made) {
    const MappedFile file = map_bendy(text_of(request, "file"));
    const std::string format = text_of(request, "format");
    const std::string name = text_of(request, "name");
    const converter::ExportOptions options{vertices_at(file.bytes(), request.value("lod", 1.0f)), {}};
    converter::Report report(converter::OptionStyle::javascript);
    if (format == "x") {
        const auto asset = converter::export_x(file.bytes(), name, report, options);
        if (!asset) fail(asset.error());
        made.add(name + ".x", asset->text);
        for (const converter::XAsset::File& image : asset->images) made.add(image.name, image.bytes);
    } else if (format == "glb" || format == "gltf") {
        const std::string buffer = format == "gltf" ? name + ".bin" : "";
        const auto asset = converter::export_gltf(file.bytes(), buffer, report, options);
        if (!asset) fail(asset.error());
        if (format == "glb") {
            const auto glb = converter::make_glb(*asset);
            if (!glb) fail(glb.error());
            made.add(name + ".glb", *glb);
        } else {
            made.add(name + ".gltf", asset->json);
            if (!asset->buffer.empty()) made.add(buffer, asset->buffer);
        }
    } else {
        refuse("the format must be glb, gltf or x");
    }
    return {{"warnings", warnings_of(report)}};
}

std::unique_ptr<diff::ReadFile> read_valid(Bytes bytes) {
    const Faults faults = validate(bytes);
    if (!faults.empty()) fail(faults.list().front(), bytes);
    return diff::read_file(bytes);
}

tools::ComparedCharacter read_character(Bytes bytes, converter::Report& report) {
    auto character = tools::read_compared(bytes, report);
    if (!character) fail(character.error());
    return *std::move(character);
}

Json run_diff(const Json& request, Made& /*made*/) {
    const MappedFile a = map_bendy(text_of(request, "file"));
    const MappedFile b = map_bendy(text_of(request, "other"));
    const std::string tolerance = text_of(request, "tolerance");
    Json answer;
    if (tolerance.empty()) {
        const auto read_a = read_valid(a.bytes());
        const auto read_b = read_valid(b.bytes());
        answer = tools::differences_as_json("", "", *read_a, *read_b, diff::compare_files(*read_a, *read_b));
    } else {
        const auto bound = converter::parse_error_bound(tolerance);
        if (!bound) refuse("tolerance: " + bound.error());
        converter::Report report(converter::OptionStyle::javascript);
        const tools::ComparedCharacter character_a = read_character(a.bytes(), report);
        const tools::ComparedCharacter character_b = read_character(b.bytes(), report);
        const auto comparison = tools::compare_characters(character_a, character_b, *bound);
        if (comparison.gave_up)
            refuse(
                "too many polygons lie within the tolerance of one another; a smaller tolerance can tell them apart");
        answer = tools::comparison_as_json("", "", comparison);
        answer["notCompared"] = warnings_of(report);
    }
    for (const char* name_of_file : {"a", "b"}) answer.erase(name_of_file);
    return answer;
}

struct Tool {
    std::string_view name;
    Json (*run)(const Json& request, Made& made);
};
constexpr std::array kTools{Tool{"convert", run_convert},
                            Tool{"validate", run_validate},
                            Tool{"inspect", run_inspect},
                            Tool{"summary", run_summary},
                            Tool{"page", run_inspect_page},
                            Tool{"dump", run_dump},
                            Tool{"assemble", run_assemble},
                            Tool{"strip", run_strip},
                            Tool{"rename", run_rename},
                            Tool{"mergeClips", run_merge_clips},
                            Tool{"retargetClips", run_retarget_clips},
                            Tool{"setMaterial", run_set_material},
                            Tool{"setRole", run_set_role},
                            Tool{"stand", run_stand},
                            Tool{"standAs", run_stand_as},
                            Tool{"extract", run_extract},
                            Tool{"changeClips", run_change_clips},
                            Tool{"limitInfluences", run_limit_influences},
                            Tool{"export", run_export},
                            Tool{"diff", run_diff}};

Json answer_to(const Json& request) {
    const std::string name = text_of(request, "do");
    const auto tool = std::find_if(kTools.begin(), kTools.end(), [&](const Tool& one) { return one.name == name; });
    if (tool == kTools.end()) refuse("unknown tool " + name);
    Made made;
    Json answer = tool->run(request, made);
    answer["made"] = made.names();
    return answer;
}

Json error_answer(const Failure& failure) {
    return {{"error",
             {{"kind", failure.kind},
              {"code", failure.code},
              {"message", failure.message},
              {"path", failure.path},
              {"offset", failure.offset}}}};
}

Json answer_or_error() {
    try {
        const MappedFile request = map("/request.json");
        const auto json = Json::parse(as_text(request.bytes()));
        if (!json) throw JsonError("the request is not valid JSON");
        return answer_to(*json);
    } catch (const Failure& failure) {
        return error_answer(failure);
    } catch (const diff::TooMuchToCompare&) {
        return error_answer({"unsupported", "UNSUPPORTED", "tracks share more keys than can be compared"});
    } catch (const JsonError& problem) {
        return error_answer({"bad_argument", "BAD_ARGUMENT", problem.what()});
    }
}

}  // namespace
}  // namespace bendy::web

/// Returns 0 if there is an answer, and 1 if memory ran out.
extern "C" EMSCRIPTEN_KEEPALIVE int bendy_tools_run() {
    try {
        const std::string answer = bendy::tools::json_text(bendy::web::answer_or_error());
        std::FILE* const file = std::fopen("/answer.json", "wb");
        if (file == nullptr) return 1;
        const bool is_written = std::fwrite(answer.data(), 1, answer.size(), file) == answer.size();
        return std::fclose(file) == 0 && is_written ? 0 : 1;
    } catch (const std::exception&) {
        return 1;
    }
}
