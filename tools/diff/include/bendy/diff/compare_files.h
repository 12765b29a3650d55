#pragma once

#include <bendy/format/document.h>
#include <bendy/format/pair_chunks.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace bendy::diff {

/// A number, a text or a truth value; monostate if one file has no value.
using Scalar = std::variant<std::monostate, bool, std::uint64_t, double, std::string>;

/// The content of a field: a scalar, or a list of scalars.
struct Value {
    std::vector<Scalar> items{Scalar{}};
    bool is_list = false;

    Value() = default;
    /// Implicit: a scalar is a value of one item.
    Value(Scalar scalar) : items{std::move(scalar)} {}  // NOLINT(google-explicit-constructor): see above
    bool operator==(const Value&) const = default;
};

/// One thing in which two files differ.
struct Difference {
    enum class Kind : std::uint8_t {
        only_in_a,  ///< the chunk, or `part` of it
        only_in_b,
        order,    ///< paired chunks are in a different order among their siblings
        value,    ///< `part` has a_value and b_value: a field of a record, or a text
        numbers,  ///< `count` of `of` numbers of `part` differ
        bytes,    ///< `count` of `of` bytes differ in content that this program cannot interpret
        storage   ///< the same content, stored in a different way
    };
    Kind kind = Kind::value;
    ChunkPair chunks;
    std::string part;        ///< a field, "track joint 3 rotation: values", or empty: the chunk itself
    Value a_value, b_value;  ///< for a value; for numbers and bytes: the first that differs
    std::uint64_t count = 0;
    std::uint64_t of = 0;
    double largest = 0.0;             ///< the largest distance between two numbers
    std::uint64_t first_element = 0;  ///< for bytes: position of the first that differs
    std::uint64_t first_component = 0;
};

/// Collects differences; keeps the first thousand and counts the rest.
class Differences {
public:
    static constexpr std::size_t kMost = 1'000;

    void add(Difference difference) {
        if (list_.size() < kMost) {
            list_.push_back(std::move(difference));
        } else {
            ++left_out_;
        }
    }
    [[nodiscard]] const std::vector<Difference>& list() const { return list_; }
    [[nodiscard]] std::size_t left_out() const { return left_out_; }
    [[nodiscard]] std::size_t count() const { return list_.size() + left_out_; }

private:
    std::vector<Difference> list_;
    std::size_t left_out_ = 0;
};

/// A file that has been read and is valid.
struct ReadFile {
    ChunkTree tree;
    Document document;
    std::vector<UnpackedTrack> unpacked;              ///< the document's packed clips, as ordinary tracks
    std::vector<std::unique_ptr<StreamView>> frames;  ///< the streams of all frames in FRMS
    std::vector<const StreamView*> streams;           ///< by chunk number; null: no stream
    std::vector<const ClipView*> clips;               ///< by chunk number; null: no clip
    std::vector<const ObjectView*> objects;           ///< by chunk number; null: no object
};

/// Reads a file that passes bendy::validate. The views refer to `bytes` and to the result itself.
std::unique_ptr<ReadFile> read_file(Bytes bytes);

/// Thrown if tracks share keys in such a way that comparing them all would take forever; real files never do.
struct TooMuchToCompare {};

/// Returns everything in which two files differ, in A's order. Subtrees with equal sums are not compared further.
Differences compare_files(const ReadFile& a, const ReadFile& b);

}  // namespace bendy::diff
