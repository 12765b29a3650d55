#include "convert/batch.h"

#include "reports/json.h"
#include "reports/messages.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <algorithm>
#include <cerrno>

namespace bendy::tools {
namespace {

namespace fs = std::filesystem;

using converter::FileStamp;
using converter::SourceFile;

/// Returns the same path for a file however its folder was written. Does not follow a link to the file itself: related
/// files are looked for beside the link.
fs::path in_plain_folder(const fs::path& file) {
    const fs::path whole = fs::absolute(file);
    std::error_code unknown;
    return fs::weakly_canonical(whole.parent_path(), unknown) / whole.filename();
}

Json as_json(const FileStamp& stamp) {
    return stamp.is_there ? Json::array({stamp.size, stamp.modified}) : Json();
}

FileStamp as_stamp(const Json& numbers) {
    if (numbers.is_null()) return {};
    return {true, numbers.at(0).get<std::uint64_t>(), numbers.at(1).get<std::int64_t>()};
}

}  // namespace

BatchRecord::BatchRecord(const fs::path& folder) : folder_(folder), file_(folder / kName) {
    try {
        read();
    } catch (const JsonError&) {
        entries_.clear();  // damaged, or of another version: everything is converted again
    }
}

bool BatchRecord::knows(const BatchFile& file) const {
    return entries_.contains(file.place.generic_string());
}

void BatchRecord::read() {
    const Result<MappedFile> mapped = MappedFile::open(file_);
    if (!mapped) {
        if (mapped.error().value != ENOENT)
            warn(file_, "the record of earlier conversions cannot be read: " + describe(mapped.error()));
        return;
    }
    const Json record = Json::parse(as_text(mapped->bytes())).value_or(Json());
    for (const auto& [output, members] : record.at("outputs").items()) {
        Entry entry{members.at("recipe").get<std::string>(), as_stamp(members.at("output")), {}};
        for (const Json& source : members.at("sources"))
            entry.sources.push_back({source.at(0).get<std::string>(), as_stamp(source.at(1))});
        entries_.emplace(output, std::move(entry));
    }
}

bool BatchRecord::is_up_to_date(const BatchFile& file, const std::string& recipe) const {
    const auto found = entries_.find(file.place.generic_string());
    if (found == entries_.end()) return false;
    const Entry& entry = found->second;
    return entry.recipe == recipe && entry.output.is_there && entry.output == converter::stamp_of(file.output) &&
           !entry.sources.empty() && in_plain_folder(entry.sources.front().file) == in_plain_folder(file.input) &&
           std::all_of(entry.sources.begin(), entry.sources.end(),
                       [](const SourceFile& source) { return source.stamp == converter::stamp_of(source.file); });
}

void BatchRecord::note(const BatchFile& file, const std::string& recipe, const std::vector<SourceFile>& sources) {
    Entry entry{recipe, converter::stamp_of(file.output), sources};
    for (SourceFile& source : entry.sources) source.file = fs::absolute(source.file);
    entries_[file.place.generic_string()] = std::move(entry);
}

std::string BatchRecord::write() const {
    Json outputs = Json::object();
    for (const auto& [output, entry] : entries_) {
        if (!converter::stamp_of(folder_ / output).is_there) continue;
        Json sources = Json::array();
        for (const SourceFile& source : entry.sources)
            sources.push_back(Json::array({source.file.string(), as_json(source.stamp)}));
        outputs[output] = {
            {"recipe", entry.recipe}, {"output", as_json(entry.output)}, {"sources", std::move(sources)}};
    }
    // A name that is not UTF-8 is not stored, so its file is converted again.
    const std::string text = json_text(Json{{"outputs", std::move(outputs)}});
    const auto written = write_file(file_, as_byte_span(text));
    return written ? std::string() : bendy::describe(written.error());
}

}  // namespace bendy::tools
