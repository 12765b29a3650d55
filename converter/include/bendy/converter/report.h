#pragma once

#include <bendy/format/byte_reader.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace bendy::converter {

/// The number of bytes in a file for one kind of content, headers and padding included.
struct ByteCount {
    std::string kind;  ///< skeleton, POSI, ..., indices, targets, LODD, clips, textures, other
    std::uint64_t bytes = 0;
};

/// Every kind, in display order. The bytes must be a well-formed file.
std::vector<ByteCount> count_bytes(Bytes file);

/// How compact encodings changed a character.
struct CompactReport {
    double max_error = 0.0;       ///< metres: the requested bound
    double height = 0.0;          ///< metres, at rest
    double measured_error = 0.0;  ///< metres: the largest that was measured
    std::string place;            ///< where: mesh, vertex, pose; empty if nothing moved
    std::vector<ByteCount> exact, compact;
    std::uint64_t curves = 0;         ///< in all clips
    std::uint64_t packed_curves = 0;  ///< how many of them are packed; the others are exact
    double curve_error = 0.0;         ///< largest error of packed values, as a share of their component's range
    /// The bytes that levels of detail add to the file: LODD, and other chunks, which compress less well because
    /// vertices and triangles are in the order of the levels.
    std::optional<std::int64_t> lod_bytes;
};

/// Tells whether a file has changed, without reading it.
struct FileStamp {
    bool is_there = false;
    std::uint64_t size = 0;     ///< bytes
    std::int64_t modified = 0;  ///< ticks of the file system's clock, as std::filesystem counts them

    bool operator==(const FileStamp&) const = default;
};

/// The stamp of the file as it is now; if the file cannot be accessed, it counts as missing.
FileStamp stamp_of(const std::filesystem::path& file);

/// A file that a conversion has read, or has looked for and not found.
struct SourceFile {
    std::filesystem::path file;
    FileStamp stamp;  ///< taken before it was read
};

/// A file that a source names and whose bytes are in the result.
struct EmbeddedFile {
    std::filesystem::path file;
    std::uint64_t size = 0;  ///< bytes
    std::string media_type;  ///< detected from its first bytes; may be empty
};

/// Why an import failed: what is wrong and where in the source, e.g. place
/// `meshes[2].primitives[0].attributes.JOINTS_0`.
struct ImportError {
    std::string place;                ///< JSON path in the source, or empty for the whole file
    std::string message;              ///< one line, no trailing full stop
    std::filesystem::path file = {};  ///< the file at fault, if it is not the imported one
};

/// Something that the result lacks or holds differently from the source: named, and counted.
struct Warning {
    std::string message;      ///< one line; the same text for the same kind of loss
    std::string first_place;  ///< the first occurrence (JSON path); may be empty
    std::uint64_t count = 1;  ///< number of occurrences
};

/// A guess that was put into the result.
struct Proposal {
    enum class Kind : std::uint8_t { chain, limits, skin };

    Kind kind = Kind::chain;
    std::string name;  ///< of the chain, of the joint that has the limits, or of the mesh
    std::string line;  ///< what was guessed, in one line: `chain LeftArm: ...`
};

/// How an interface spells option names: `--merge-clips`, `merge_clips`, `mergeClips`.
enum class OptionStyle : std::uint8_t { program, python, javascript };

/// A message of the converter, which names options as the program does, with the option names spelled as the interface
/// spells them. Quoted text, which comes from files, is unchanged.
std::string with_option_names(std::string_view message, OptionStyle style);

/// Collects warnings during a conversion; equal messages are counted together, in the order of their first occurrence.
/// Also collects proposals, the files that were read, and which of them are in the result.
class Report {
public:
    Report() = default;
    /// \param style  how messages spell option names
    explicit Report(OptionStyle style) : style_(style) {}

    void warn(std::string message, std::string place = {}, std::uint64_t count = 1);
    [[nodiscard]] const std::vector<Warning>& warnings() const { return warnings_; }

    void propose(Proposal proposal) { proposals_.push_back(std::move(proposal)); }
    [[nodiscard]] const std::vector<Proposal>& proposals() const { return proposals_; }

    /// Notes a suggestion for another conversion: one line, with the option to use.
    void suggest(std::string_view line) { suggestions_.push_back(with_option_names(line, style_)); }
    [[nodiscard]] const std::vector<std::string>& suggestions() const { return suggestions_; }

    /// Notes that a file is about to be read; each file once.
    void add_source(const std::filesystem::path& file);
    [[nodiscard]] const std::vector<SourceFile>& sources() const { return sources_; }

    /// Notes that a file's bytes go into the result; each file once.
    void add_embedded(EmbeddedFile file);
    [[nodiscard]] const std::vector<EmbeddedFile>& embedded() const { return embedded_; }

    /// Set after a compact conversion: what was encoded, and with which error. Empty after an exact one.
    std::optional<CompactReport> compact;

private:
    OptionStyle style_ = OptionStyle::program;
    std::vector<Warning> warnings_;
    std::vector<Proposal> proposals_;
    std::vector<std::string> suggestions_;
    std::vector<SourceFile> sources_;
    std::set<std::filesystem::path> known_sources_;
    std::vector<EmbeddedFile> embedded_;
    std::set<std::filesystem::path> known_embedded_;
    std::unordered_map<std::string, std::size_t> place_of_;  // message: index into warnings_
};

}  // namespace bendy::converter
