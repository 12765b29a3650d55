#include "bindings.h"
#include "c_layer.h"
#include "fields.h"
#include "reports/conversion.h"
#include "reports/describe_chunk.h"
#include "reports/differences.h"
#include "reports/json.h"
#include "reports/suffixes.h"
#include "reports/summary.h"

#include <bendy/converter/convert.h>
#include <bendy/converter/error_bound.h>
#include <bendy/converter/export.h>
#include <bendy/converter/source_format.h>
#include <bendy/diff/compare_files.h>
#include <bendy/edit/clips.h>
#include <bendy/edit/edit.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>
#include <bendy/motion/retarget_clips.h>
#include <bendy/motion/stand.h>
#include <bendy/runtime/lod.h>
#include <bendy/text_form/text_form.h>

#include <algorithm>
#include <exception>
#include <span>
#include <type_traits>
#include <utility>

// convert, validate, inspect, edit, diff, dump and export.
namespace bendy::python {
namespace {

using SourcePointer = std::shared_ptr<Source>;

/// Raises for a file that is known to be of another kind, and says how to convert it.
void require_bendy(const Source& source) {
    const auto kind = converter::find_file_kind(source.bytes(), source.file());
    if (!kind || kind->format == converter::SourceFormat::bendy) return;
    const std::string why = converter::why_not_bendy(*kind, source.file());
    if (!why.empty()) raise("MalformedError", why, code_name(ErrorCode::kNotABendyFile), source.file());
}

py::list warnings_of(const converter::Report& report) {
    py::list list;
    for (const converter::Warning& warning : report.warnings()) {
        py::dict one;
        one["message"] = text(warning.message);
        one["place"] = text(warning.first_place);
        one["count"] = warning.count;
        list.append(one);
    }
    return list;
}

[[noreturn]] void raise_import(const converter::ImportError& error, const std::filesystem::path& file) {
    raise("ConversionError", converter::with_option_names(error.message, converter::OptionStyle::python), "CONVERSION",
          error.file.empty() ? file : error.file, error.place);
}

// Conversion.

/// Thrown to end a conversion from within its progress callback.
struct Stopped {};

/// Returns a file's name, with a folder in front of it: relative names in the file start there.
std::filesystem::path in_a_folder(const std::filesystem::path& file) {
    return file.empty() || file.has_parent_path() ? file : "." / file;
}

/// Sets the options of tools/reports/convert_options.def that are in the dict.
tools::ConvertArguments arguments_of(const py::dict& options) {
    tools::ConvertArguments arguments;
    std::size_t known = 0;
    tools::visit_options(arguments, [&](const tools::ConvertOption& option, auto& value) {
        const py::str name(option.name.data(), option.name.size());
        if (!options.contains(name)) return;
        ++known;
        try {
            value = options[name].template cast<std::decay_t<decltype(value)>>();
        } catch (const py::cast_error&) {
            throw py::type_error(std::string(option.name) + " has the wrong type");
        }
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, tools::option::word>) {
            if (const std::string why = option.why_not(value); !why.empty()) throw py::value_error(why);
        }
    });
    if (known != options.size()) throw py::type_error("convert has no such option");
    return arguments;
}

py::list convert_options() {
    const tools::ConvertArguments arguments;
    py::list names;
    tools::visit_options(arguments,
                         [&](const tools::ConvertOption& option, const auto&) { names.append(option.name); });
    return names;
}

py::tuple convert_source(const std::filesystem::path& file, const SourcePointer& source,
                         const std::filesystem::path& output, const py::dict& given,
                         const std::optional<std::string>& rig_text, unsigned jobs, const py::object& progress) {
    tools::ConvertArguments arguments = arguments_of(given);
    arguments.jobs = jobs;
    if (!arguments.max_error.empty()) {
        const auto bound = converter::parse_error_bound(arguments.max_error);
        if (!bound) throw py::value_error("compact: " + bound.error());
    }
    converter::ConvertOptions options = tools::options_of(arguments);
    options.output = output;
    if (rig_text) {
        options.rig_text = rig_text;
        options.rig = "rig";  // its name in messages
    }
    std::exception_ptr stopped;
    double told = -1.0;
    options.progress = [&](double done) {
        constexpr double kStep = 0.01;
        if (stopped != nullptr) throw Stopped();
        if (done < told + kStep && done < 1.0) return;
        told = done;
        const py::gil_scoped_acquire acquired;
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            if (!progress.is_none()) progress(done);
        } catch (...) {
            stopped = std::current_exception();
            throw Stopped();
        }
    };
    converter::Report report(converter::OptionStyle::python);
    std::string json;
    const auto work = [&]() -> Result<std::vector<std::byte>, converter::ImportError> {
        if (source == nullptr) {
            if (const std::string why = converter::why_not_convertible(file); !why.empty())
                return converter::ImportError{{}, why};
        } else if (const std::string why = converter::why_not_convertible(source->bytes(), file); !why.empty()) {
            return converter::ImportError{{}, why};
        }
        auto bytes = source == nullptr
                         ? converter::convert(file, options, report)
                         : converter::convert(std::vector<std::byte>(source->bytes().begin(), source->bytes().end()),
                                              source->is_mapped() ? in_a_folder(file) : file, options, report);
        if (bytes) json = tools::json_text(tools::converted_report(file, output, report, *bytes));
        return bytes;
    };
    auto converted = [&]() -> Result<std::vector<std::byte>, converter::ImportError> {
        const py::gil_scoped_release released;
        try {
            return work();
        } catch (const Stopped&) {
            return converter::ImportError();  // `stopped` has the reason
        }
    }();
    if (stopped != nullptr) std::rethrow_exception(stopped);
    if (!converted) raise_import(converted.error(), file);
    py::list sources;
    for (const converter::SourceFile& one : report.sources()) {
        if (one.stamp.is_there) sources.append(py::cast(one.file));
    }
    return py::make_tuple(std::make_shared<Source>(*std::move(converted), in_a_folder(output)), parse_json(json),
                          sources);
}

// Faults.

py::tuple validate_source(const SourcePointer& source) {
    require_bendy(*source);
    const Faults faults = [&] {
        const py::gil_scoped_release released;
        return validate(source->bytes());
    }();
    py::list list;
    for (const Error& fault : faults.list()) {
        py::dict one;
        one["code"] = code_name(fault.code);
        one["kind"] = class_name(error_class(fault.code));
        one["message"] = text(describe(fault));
        one["path"] = text(whole_chunk_path(source->bytes(), fault.offset));
        one["offset"] = fault.offset;
        list.append(one);
    }
    return py::make_tuple(list, faults.left_out());
}

// Inspection.

/// Returns the chunks of a file, with decoded leaves.
struct PyTree {
    std::shared_ptr<const Source> source;
    ChunkTree tree;
};

std::shared_ptr<PyTree> read_tree(const SourcePointer& source) {
    require_bendy(*source);
    auto tree = [&] {
        const py::gil_scoped_release released;
        Result<ChunkTree> read = read_chunk_tree(source->bytes());
        if (read) decode_leaves(*read);
        return read;
    }();
    if (!tree) raise_fault(tree.error(), *source);
    return std::make_shared<PyTree>(PyTree{source, *std::move(tree)});
}

void check_number(const PyTree& self, std::uint32_t number) {
    if (number >= self.tree.chunks().size()) throw py::index_error("there is no such chunk");
}

py::array payload_of(const std::shared_ptr<PyTree>& self, std::uint32_t number) {
    check_number(*self, number);
    const Bytes payload = self->tree.payload(number);
    const std::shared_ptr<const PyTree> owner = self;
    return view(owner, reinterpret_cast<const std::uint8_t*>(payload.data()),
                {static_cast<py::ssize_t>(payload.size())});
}

/// Returns None for a file with faults: it has chunks, but no character to summarise.
py::object summarize_source(const SourcePointer& source) {
    require_bendy(*source);
    std::string json;
    {
        const py::gil_scoped_release released;
        const Bytes bytes = source->bytes();
        const Result<ChunkTree> tree = read_chunk_tree(bytes);
        if (tree) {
            if (const auto summary = tools::summarize_file(*tree, bytes))
                json = tools::json_text(tools::summary_as_json(*summary));
        }
    }
    return parse_json(json);
}

// Editing.

/// Edits without the GIL. Returns the new file, what was done, and warnings.
template <class Work>
py::tuple edited(const SourcePointer& source, const Work& work) {
    require_bendy(*source);
    edit::Log log;
    auto result = [&] {
        const py::gil_scoped_release released;
        return work(source->bytes(), log);
    }();
    if (!result) raise("EditError", result.error().message, "EDIT", source->file());
    const auto texts = [](const std::vector<std::string>& lines) {
        py::list list;
        for (const std::string& line : lines) list.append(text(line));
        return list;
    };
    return py::make_tuple(std::make_shared<Source>(*std::move(result)), texts(log.done), texts(log.warnings));
}

py::tuple strip_part(const SourcePointer& source, const std::string& part) {
    const auto what = edit::parse_strip(part);
    if (!what) throw py::value_error(what.error().message);
    return edited(source, [&](Bytes bytes, edit::Log& log) { return edit::strip(bytes, *what, log); });
}

py::tuple rename_things(const SourcePointer& source, const std::string& kind,
                        const std::vector<std::pair<std::string, std::string>>& names, bool all_must_match) {
    const auto named = edit::parse_named(kind);
    if (!named) throw py::value_error(named.error().message);
    const edit::Rename rename{*named, names, all_must_match};
    return edited(source, [&](Bytes bytes, edit::Log& log) { return edit::rename(bytes, rename, log); });
}

edit::SameName read_same_name(const std::string& word) {
    const auto rule = edit::parse_same_name(word);
    if (!rule) throw py::value_error("same_name: " + rule.error().message);
    return *rule;
}

py::tuple merge_clips(const SourcePointer& source, const SourcePointer& other, const std::string& same_name) {
    require_bendy(*other);
    const edit::SameName rule = read_same_name(same_name);
    return edited(source,
                  [&](Bytes bytes, edit::Log& log) { return edit::add_clips(bytes, other->bytes(), rule, log); });
}

py::tuple retarget_clips(const SourcePointer& source, const SourcePointer& other, const std::string& clip,
                         const std::string& same_name, const c::Of<bendy_retarget_options>& options,
                         bool chooses_rests) {
    require_bendy(*other);
    motion::RetargetClips taken{clip, {}, read_same_name(same_name), chooses_rests};
    capi::from_c(options.value, taken.retarget);
    return edited(
        source, [&](Bytes bytes, edit::Log& log) { return motion::retarget_clips(bytes, other->bytes(), taken, log); });
}

py::tuple set_role(const SourcePointer& source, const std::string& text) {
    const auto what = edit::parse_role(text);
    if (!what) throw py::value_error(what.error().message);
    return edited(source, [&](Bytes bytes, edit::Log& log) { return edit::set_role(bytes, *what, log); });
}

py::tuple stand_in_clip(const SourcePointer& source, const std::string& clip, double seconds) {
    return edited(source,
                  [&](Bytes bytes, edit::Log& log) { return motion::stand_as_in_clip(bytes, clip, seconds, log); });
}

py::tuple stand_as(const SourcePointer& source, const SourcePointer& other) {
    require_bendy(*other);
    return edited(source, [&](Bytes bytes, edit::Log& log) { return motion::stand_as(bytes, other->bytes(), log); });
}

py::tuple set_material(const SourcePointer& source, const std::string& material, const std::string& field,
                       const std::string& value) {
    return edited(source, [&](Bytes bytes, edit::Log& log) {
        return edit::set_material(bytes, {material, field, value}, log);
    });
}

py::tuple extract_joint(const SourcePointer& source, const std::string& joint) {
    return edited(source, [&](Bytes bytes, edit::Log& log) { return edit::extract(bytes, joint, log); });
}

py::tuple change_clips(const SourcePointer& source, const std::string& word, const std::vector<std::string>& texts) {
    const auto what = edit::parse_clip_change(word, texts);
    if (!what) throw py::value_error(what.error().message);
    return edited(source, [&](Bytes bytes, edit::Log& log) { return edit::change_clips(bytes, *what, log); });
}

py::tuple limit_influences(const SourcePointer& source, std::uint32_t most) {
    return edited(source, [&](Bytes bytes, edit::Log& log) { return edit::limit_influences(bytes, most, log); });
}

// Comparison.

/// Reads a file for a comparison. Raises the first fault of the file.
std::unique_ptr<diff::ReadFile> read_valid(const Source& source) {
    const Faults faults = validate(source.bytes());
    if (faults.empty()) return diff::read_file(source.bytes());
    const py::gil_scoped_acquire acquired;
    raise_fault(faults.list().front(), source);
}

py::object diff_sources(const SourcePointer& a, const SourcePointer& b) {
    require_bendy(*a);
    require_bendy(*b);
    std::string json;
    try {
        const py::gil_scoped_release released;
        const auto read_a = read_valid(*a);
        const auto read_b = read_valid(*b);
        json = tools::json_text(tools::differences_as_json(a->file().string(), b->file().string(), *read_a, *read_b,
                                                           diff::compare_files(*read_a, *read_b)));
    } catch (const diff::TooMuchToCompare&) {
        throw py::value_error("tracks share more keys than can be compared");
    }
    return parse_json(json);
}

py::object compare_characters(const SourcePointer& a, const SourcePointer& b, const std::string& tolerance) {
    const auto bound = converter::parse_error_bound(tolerance);
    if (!bound) throw py::value_error("tolerance: " + bound.error());
    const auto read = [](const SourcePointer& source) {
        require_bendy(*source);
        converter::Report report(converter::OptionStyle::python);
        auto character = [&] {
            const py::gil_scoped_release released;
            return tools::read_compared(source->bytes(), report);
        }();
        if (!character) raise_import(character.error(), source->file());
        return *std::move(character);
    };
    const tools::ComparedCharacter character_a = read(a);
    const tools::ComparedCharacter character_b = read(b);
    std::string json;
    bool gave_up = false;
    {
        const py::gil_scoped_release released;
        const auto comparison = tools::compare_characters(character_a, character_b, *bound);
        gave_up = comparison.gave_up;
        json = tools::json_text(tools::comparison_as_json(a->file().string(), b->file().string(), comparison));
    }
    if (gave_up) throw py::value_error("too many polygons lie within the tolerance of one another: give a smaller one");
    return parse_json(json);
}

// The text form.

py::str dump_source(const SourcePointer& source, bool decode) {
    const auto tree = read_tree(source);
    std::string json;
    {
        const py::gil_scoped_release released;
        json = text_form::dump(tree->tree, {decode});
    }
    return text(json);
}

SourcePointer assemble_text(const std::string& json) {
    auto bytes = [&] {
        const py::gil_scoped_release released;
        return text_form::assemble(json);
    }();
    if (!bytes) {
        const auto& fault = bytes.error();
        throw py::value_error("line " + std::to_string(fault.line) + ", column " + std::to_string(fault.column) + ": " +
                              fault.what);
    }
    return std::make_shared<Source>(*std::move(bytes));
}

// Export.

/// Returns the level of detail with this fraction of the triangles.
std::vector<std::uint32_t> vertices_at(const Source& source, float share) {
    if (!(share < 1.0f)) return {};
    const auto model = Model::from_memory(source.bytes());
    if (!model) raise_fault(model.error(), source);
    if (model->collapse() == nullptr) throw py::value_error("the file has no levels of detail");
    Lod lod(*model);
    lod.set_share(share);
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t mesh = 0; mesh < model->meshes().size(); ++mesh) vertices.push_back(lod.vertices(mesh));
    return vertices;
}

SourcePointer bytes_of_text(const std::string& written) {
    const auto bytes = std::as_bytes(std::span(written));
    return std::make_shared<Source>(std::vector<std::byte>(bytes.begin(), bytes.end()));
}

/// Returns the files by name, the main one first, and warnings.
py::tuple export_source(const SourcePointer& source, const std::string& format, const std::filesystem::path& output,
                        float share) {
    require_bendy(*source);
    const converter::ExportOptions options{vertices_at(*source, share), output};
    const std::string name = output.filename().string();
    const std::string stem = output.stem().string();
    const std::filesystem::path buffer = format == "gltf" ? stem + ".bin" : "";
    converter::Report report(converter::OptionStyle::python);
    py::dict files;
    const auto finish = [&] { return py::make_tuple(files, warnings_of(report)); };
    const bool is_mapped = source->is_mapped();  // then links to images are relative to the file
#ifdef BENDY_X_FILES
    if (format == "x") {
        auto asset = [&] {
            const py::gil_scoped_release released;
            return is_mapped ? converter::export_x(source->file(), stem, report, options)
                             : converter::export_x(source->bytes(), stem, report, options);
        }();
        if (!asset) raise_import(asset.error(), source->file());
        files[py::str(name)] = bytes_of_text(asset->text);
        for (converter::XAsset::File& image : asset->images)
            files[py::str(image.name)] = std::make_shared<Source>(std::move(image.bytes));
        return finish();
    }
#endif
    if (format != "glb" && format != "gltf") throw py::value_error("cannot export ." + format + " files");
    auto asset = [&] {
        const py::gil_scoped_release released;
        return is_mapped ? converter::export_gltf(source->file(), buffer, report, options)
                         : converter::export_gltf(source->bytes(), buffer, report, options);
    }();
    if (!asset) raise_import(asset.error(), source->file());
    if (format == "glb") {
        auto glb = converter::make_glb(*asset);
        if (!glb) raise_import(glb.error(), source->file());
        files[py::str(name)] = std::make_shared<Source>(*std::move(glb));
        return finish();
    }
    files[py::str(name)] = bytes_of_text(asset->json);
    if (!asset->buffer.empty()) files[py::str(buffer.string())] = std::make_shared<Source>(std::move(asset->buffer));
    return finish();
}

}  // namespace

void bind_tools(py::module_& module) {
    module.def("convert", &convert_source, py::arg("file"), py::arg("source"), py::arg("output"), py::arg("options"),
               py::arg("rig_text"), py::arg("jobs"), py::arg("progress"), "See bendy.convert.");
    module.def("convert_options", &convert_options,
               "The names of the options that decide which bytes convert makes, as far as this build has them.");
    module.def(
        "format_named_by", [](const std::filesystem::path& file) { return text(tools::format_named_by(file)); },
        py::arg("file"), "The format that a file's suffix means, as \"binary glTF\"; empty if it has no meaning.");
    module.def("validate", &validate_source, py::arg("source"), "See bendy.validate.");
    module.def("summarize", &summarize_source, py::arg("source"), "See bendy.Model.summary.");

    py::class_<PyTree, std::shared_ptr<PyTree>>(module, "Tree", "The chunks of a file.")
        .def(py::init(&read_tree), py::arg("source"))
        .def(
            "chunks",
            [](const PyTree& self) {
                const tools::FaultyChunks faulty(self.tree, validate(self.source->bytes()));
                return parse_json(tools::json_text(tools::chunks_as_json(self.tree, 0, faulty)));
            },
            "A dict for each chunk, in file order, as `bendy inspect --json` has them.")
        .def("payload", &payload_of, py::arg("number"), "(size,) uint8, read-only: a chunk's payload, decoded.")
        .def(
            "path",
            [](const PyTree& self, std::uint32_t number) {
                check_number(self, number);
                return text(whole_chunk_path(self.source->bytes(), self.tree[number].offset));
            },
            py::arg("number"), "The path of a chunk.");

    module.def("strip", &strip_part, py::arg("source"), py::arg("part"), "See bendy.Edit.strip.");
    module.def("rename", &rename_things, py::arg("source"), py::arg("kind"), py::arg("names"),
               py::arg("all_must_match"), "See bendy.Edit.rename.");
    module.def("merge_clips", &merge_clips, py::arg("source"), py::arg("other"), py::arg("same_name"),
               "See bendy.Edit.merge_clips.");
    module.def("retarget_clips", &retarget_clips, py::arg("source"), py::arg("other"), py::arg("clip"),
               py::arg("same_name"), py::arg("options"), py::arg("chooses_rests"), "See bendy.Edit.retarget_clips.");
    module.def("set_role", &set_role, py::arg("source"), py::arg("text"), "See bendy.Edit.set_role.");
    module.def("stand", &stand_in_clip, py::arg("source"), py::arg("clip"), py::arg("seconds"),
               "See bendy.Edit.stand.");
    module.def("stand_as", &stand_as, py::arg("source"), py::arg("other"), "See bendy.Edit.stand_as.");
    module.def("set_material", &set_material, py::arg("source"), py::arg("material"), py::arg("field"),
               py::arg("value"), "See bendy.Edit.set_material.");
    module.def("extract", &extract_joint, py::arg("source"), py::arg("joint"), "See bendy.Edit.extract.");
    module.def("change_clips", &change_clips, py::arg("source"), py::arg("word"), py::arg("texts"),
               "See bendy.Edit.trim, and others.");
    module.def("limit_influences", &limit_influences, py::arg("source"), py::arg("most"),
               "See bendy.Edit.limit_influences.");
    module.def("diff", &diff_sources, py::arg("a"), py::arg("b"), "See bendy.diff.");
    module.def("compare", &compare_characters, py::arg("a"), py::arg("b"), py::arg("tolerance"), "See bendy.diff.");
    module.def("dump", &dump_source, py::arg("source"), py::arg("decode"), "See bendy.dump.");
    module.def("assemble", &assemble_text, py::arg("text"), "See bendy.assemble.");
    module.def("export", &export_source, py::arg("source"), py::arg("format"), py::arg("output"), py::arg("share"),
               "See bendy.export.");
}

}  // namespace bendy::python
