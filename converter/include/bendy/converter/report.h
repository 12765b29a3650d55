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

/// Bytes of a file by what they are for, headers and padding included.
struct ByteCount {
    std::string kind;  ///< skeleton, POSI, ..., indices, targets, LODD, clips, textures, other
    std::uint64_t bytes = 0;
};

/// Every kind, in the order in which they are shown; the bytes must be a well-formed file.
std::vector<ByteCount> count_bytes(Bytes file);

/// What compact encodings have done to a character.
struct CompactReport {
    double max_error = 0.0;       ///< metres: what was asked for
    double height = 0.0;          ///< metres, at rest
    double measured_error = 0.0;  ///< metres: the worst that was met
    std::string place;            ///< where: mesh, vertex, pose; empty if nothing moved
    std::vector<ByteCount> exact, compact;
    std::uint64_t curves = 0;         ///< of all clips
    std::uint64_t packed_curves = 0;  ///< of these; the others are exact
    double curve_error = 0.0;         ///< of packed values, the largest, as a share of their component's range
};

/// What tells without reading a file whether it is still the same.
struct FileStamp {
    bool is_there = false;
    std::uint64_t size = 0;     ///< bytes
    std::int64_t modified = 0;  ///< ticks of the file system's clock, as std::filesystem counts them

    bool operator==(const FileStamp&) const = default;
};

/// Of the file as it is now; of one that cannot be seen: not there.
FileStamp stamp_of(const std::filesystem::path& file);

/// A file that a conversion has read, or has looked for in vain.
struct SourceFile {
    std::filesystem::path file;
    FileStamp stamp;  ///< from before it was read
};

/// A file that a source names and whose bytes are in the result.
struct EmbeddedFile {
    std::filesystem::path file;
    std::uint64_t size = 0;  ///< bytes
    std::string media_type;  ///< as its first bytes show; may be empty
};

/// Why an import failed: what is wrong and where in the source, e.g. place
/// `meshes[2].primitives[0].attributes.JOINTS_0`.
struct ImportError {
    std::string place;                ///< JSON path in the source, or empty where the whole file is meant
    std::string message;              ///< one line, no trailing full stop
    std::filesystem::path file = {};  ///< the file that is meant where it is another than the one to import
};

/// Something that the result does not hold, or holds otherwise than the source: said by name, and counted.
struct Warning {
    std::string message;      ///< what; one line, the same text for the same kind of loss
    std::string first_place;  ///< where it was met first (JSON path), may be empty
    std::uint64_t count = 1;  ///< how many times
};

/// How an interface writes an option's name: `--merge-clips`, `merge_clips`, `mergeClips`.
enum class OptionStyle : std::uint8_t { program, python, javascript };

/// A message of the converter, which names options as the program does, with them as the interface writes them. Texts
/// in quotes, which are a file's, stay.
std::string with_option_names(std::string_view message, OptionStyle style);

/// Gathers warnings during a conversion; equal messages are counted together, in the order in which they first came.
/// And what was proposed, which files were read, and which of them are in the result.
class Report {
public:
    Report() = default;
    /// \param style  in which messages name options
    explicit Report(OptionStyle style) : style_(style) {}

    void warn(std::string message, std::string place = {}, std::uint64_t count = 1);
    [[nodiscard]] const std::vector<Warning>& warnings() const { return warnings_; }

    /// Notes what was guessed and put into the result: one line, as `chain LeftArm: ...`.
    void propose(std::string line) { proposals_.push_back(std::move(line)); }
    [[nodiscard]] const std::vector<std::string>& proposals() const { return proposals_; }

    /// Notes what the user may want to do another time: one line, with the option that does it.
    void suggest(std::string_view line) { suggestions_.push_back(with_option_names(line, style_)); }
    [[nodiscard]] const std::vector<std::string>& suggestions() const { return suggestions_; }

    /// Notes that a file is about to be read; once for each.
    void add_source(const std::filesystem::path& file);
    [[nodiscard]] const std::vector<SourceFile>& sources() const { return sources_; }

    /// Notes that a file's bytes go into the result; once for each.
    void add_embedded(EmbeddedFile file);
    [[nodiscard]] const std::vector<EmbeddedFile>& embedded() const { return embedded_; }

    /// What was made smaller, at which error; nothing after an exact conversion.
    std::optional<CompactReport> compact;

private:
    OptionStyle style_ = OptionStyle::program;
    std::vector<Warning> warnings_;
    std::vector<std::string> proposals_;
    std::vector<std::string> suggestions_;
    std::vector<SourceFile> sources_;
    std::set<std::filesystem::path> known_sources_;
    std::vector<EmbeddedFile> embedded_;
    std::set<std::filesystem::path> known_embedded_;
    std::unordered_map<std::string, std::size_t> place_of_;  // message: index into warnings_
};

}  // namespace bendy::converter
