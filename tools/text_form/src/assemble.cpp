#include <bendy/text_form/text_form.h>

#include "leaf_assembler.h"
#include "leaf_value.h"

#include <bendy/format/chunk_writer.h>
#include <bendy/format/codec.h>
#include <bendy/format/limits.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <cstddef>
#include <optional>

// Lengths of 64 bits: a text may be longer than 4 GiB.
#define RAPIDJSON_NO_SIZETYPEDEFINE
namespace rapidjson {
using SizeType = std::size_t;
}
#include <rapidjson/error/en.h>
#include <rapidjson/reader.h>

namespace bendy::text_form {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

/// The text as RapidJSON's reader takes it: it ends where the view ends.
class TextStream {
public:
    using Ch = char;

    explicit TextStream(std::string_view text) : text_(text) {}
    // NOLINTBEGIN(readability-identifier-naming): RapidJSON's names
    [[nodiscard]] Ch Peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    Ch Take() { return at_ < text_.size() ? text_[at_++] : '\0'; }
    [[nodiscard]] std::size_t Tell() const { return at_; }
    // For output streams only: never called.
    Ch* PutBegin() { return nullptr; }
    void Put(Ch) {}
    std::size_t PutEnd(Ch*) { return 0; }
    // NOLINTEND(readability-identifier-naming)

private:
    std::string_view text_;
    std::size_t at_ = 0;
};

/// A leaf's payload as it is stored: the given encoded bytes if they decode to it, otherwise encoded anew, or plain if
/// the codec cannot encode it.
struct Stored {
    std::vector<std::byte> bytes;
    unsigned codec = 0;
};

bool decodes_to(unsigned codec, Bytes encoded, Bytes payload) {
    CodecHeader header;
    if (check_encoded(codec, encoded, header) || header.size != payload.size()) return false;
    AlignedBytes decoded(payload.size());
    return decode_payload(static_cast<Codec>(codec), encoded, decoded.span()) &&
           std::equal(payload.begin(), payload.end(), decoded.bytes().begin());
}

Stored store(unsigned codec, std::vector<std::byte> encoded, std::vector<std::byte> payload) {
    if (decodes_to(codec, encoded, payload)) return {std::move(encoded), codec};
    CodecHeader header;
    copy_at(Bytes(encoded), 0, header);
    if (codec < kCodecs) {
        auto renewed = encode_payload(static_cast<Codec>(codec), payload, header.head, header.stride);
        if (renewed && decodes_to(codec, *renewed, payload)) return {*std::move(renewed), codec};
    }
    return {std::move(payload), 0};
}

/// Takes the events of RapidJSON's reader and writes chunks. Its functions return false to end the reading.
class Assembler {
public:
    using Ch = char;
    using Length = rapidjson::SizeType;

    Assembler(std::string_view text, const TextStream& stream, const Progress& progress)
        : text_(text), stream_(stream), progress_(progress), leaf_(text, values_, [this](std::uint64_t at) {
              if (progress_) progress_(at, text_.size());
          }) {}

    // NOLINTBEGIN(readability-identifier-naming): RapidJSON's names
    bool Null() { return scalar(ValueKind::null); }
    bool Bool(bool value) {
        boolean_ = value;
        return scalar(ValueKind::boolean);
    }
    bool RawNumber(const Ch*, Length, bool) { return scalar(ValueKind::number); }
    bool String(const Ch* characters, Length length, bool);
    bool Key(const Ch* characters, Length length, bool);
    bool StartObject();
    bool EndObject(Length) { return end_object(); }
    bool StartArray();
    bool EndArray(Length) { return end_array(); }
    // Numbers come as text.
    bool Int(int) { return false; }
    bool Uint(unsigned) { return false; }
    bool Int64(std::int64_t) { return false; }
    bool Uint64(std::uint64_t) { return false; }
    bool Double(double) { return false; }
    // NOLINTEND(readability-identifier-naming)

    [[nodiscard]] const std::optional<FaultAt>& fault() const { return fault_; }
    std::vector<std::byte> finish() && { return std::move(writer_).finish(); }

private:
    /// Which member of a chunk's object the next value belongs to.
    enum class Role : std::uint8_t { content, required, codec, encoded, version, schema };

    /// A chunk whose object has begun.
    struct Frame {
        std::uint64_t offset = 0;
        FourCC id;
        std::uint16_t flags = 0;
        std::uint8_t roles = 0;  ///< that have been seen, one bit each
        Role role = Role::content;
        bool is_container = false;
        bool is_in_array = false;
        std::uint64_t content = 0;  ///< of a leaf, among the values
        std::uint64_t encoded = 0;
        std::uint64_t codec_at = 0;  ///< in the text

        [[nodiscard]] bool has(Role what) const { return (roles >> static_cast<unsigned>(what) & 1u) != 0; }
    };

    bool fail(std::uint64_t offset, std::string what) {
        if (!fault_) fault_ = FaultAt{offset, std::move(what)};
        return false;
    }
    void begin_token();
    void end_token() { passed_ = stream_.Tell(); }
    bool scalar(ValueKind kind);
    bool place_value(ValueKind kind, std::uint64_t value);
    bool begin_container();
    bool end_object();
    bool end_array();
    bool end_chunk();
    bool end_leaf(const Frame& frame);
    bool name_role(Frame& frame, std::string_view name);

    std::string_view text_;
    const TextStream& stream_;
    const Progress& progress_;
    std::uint64_t passed_ = 0;  // the text up to here has been processed
    std::uint64_t token_ = 0;   // where the current token starts
    bool boolean_ = false;

    std::vector<Frame> frames_;
    LeafValues values_;  // of the innermost chunk
    LeafAssembler leaf_;
    ChunkWriter writer_;
    std::uint64_t chunks_ = 0;
    std::optional<FaultAt> fault_;
};

/// Between the last token and this one there is only white space and at most one comma or colon.
void Assembler::begin_token() {
    token_ = std::min<std::uint64_t>(text_.find_first_not_of(" \t\r\n,:", passed_), text_.size());
}

bool Assembler::String(const Ch* characters, Length length, bool) {
    begin_token();
    end_token();
    const std::string_view text(characters, length);
    if (!is_utf8(text)) return fail(token_, "the string has half of a surrogate pair");
    const std::uint64_t value = values_.add_string(token_, text);
    return values_.depth() != 0 || place_value(ValueKind::string, value);
}

bool Assembler::scalar(ValueKind kind) {
    begin_token();
    end_token();
    const std::uint64_t value = values_.add(kind, token_);
    return values_.depth() != 0 || place_value(kind, value);
}

bool Assembler::Key(const Ch* characters, Length length, bool) {
    begin_token();
    end_token();
    const std::string_view name(characters, length);
    if (!is_utf8(name)) return fail(token_, "the name has half of a surrogate pair");
    if (values_.depth() != 0) {
        values_.add_string(token_, name);
        return true;
    }
    return name_role(frames_.back(), name);
}

bool Assembler::name_role(Frame& frame, std::string_view name) {
    const bool is_root = frames_.size() == 1;
    if (name == "required") {
        frame.role = Role::required;
    } else if (name == "codec") {
        frame.role = Role::codec;
    } else if (name == "encoded") {
        frame.role = Role::encoded;
    } else if (is_root && name == "bendy_text") {
        frame.role = Role::version;
    } else if (is_root && name == "$schema") {
        frame.role = Role::schema;
    } else {
        frame.role = Role::content;
    }
    if (frame.role == Role::content) {
        std::uint32_t id = 0;
        if (name.size() == sizeof id) copy_at(as_byte_span(name), 0, id);
        if (!FourCC(id).is_readable()) {
            return fail(token_,
                        "a chunk's name is four capital letters or digits; beside it there may be "
                        "\"required\", \"codec\" and \"encoded\"");
        }
        if (frame.has(Role::content))
            return fail(token_, "one object is one chunk: a second chunk needs an object of its own");
        if (is_root && FourCC(id) != FourCC("HEAD")) return fail(token_, "the outermost chunk must be HEAD");
        frame.id = FourCC(id);
    } else if (frame.has(frame.role)) {
        return fail(token_, '"' + std::string(name) + "\" appears here twice");
    } else if (frame.is_container && (frame.role == Role::codec || frame.role == Role::encoded)) {
        return fail(token_, "a chunk that holds chunks cannot be encoded");
    }
    frame.roles = static_cast<std::uint8_t>(frame.roles | 1u << static_cast<unsigned>(frame.role));
    return true;
}

/// Handles a whole value at the level of a chunk's members.
bool Assembler::place_value(ValueKind kind, std::uint64_t value) {
    const std::uint64_t at = values_.offset(value);
    if (frames_.empty()) return fail(at, "the text should be an object that holds HEAD");
    Frame& frame = frames_.back();
    if (frame.is_in_array) return fail(at, "there should be a chunk's object, not " + std::string(kind_name(kind)));
    std::vector<std::byte> number;
    switch (frame.role) {
        case Role::content:
            frame.content = value;
            return true;
        case Role::encoded:
            frame.encoded = value;
            return true;
        case Role::required:
            if (kind != ValueKind::boolean) return fail(at, "\"required\" is true or false");
            if (boolean_) frame.flags = static_cast<std::uint16_t>(frame.flags | kRequiredFlag);
            return true;
        case Role::codec:
            if (kind != ValueKind::number ||
                parse_number(text_.substr(at), NumberType::u8, number) != NumberFault::none ||
                number.front() == std::byte{0})
                return fail(at, "\"codec\" is a whole number from 1 to 255");
            frame.codec_at = at;
            frame.flags = static_cast<std::uint16_t>(frame.flags | std::to_integer<unsigned>(number.front()) << 8);
            return true;
        case Role::version:
            if (kind != ValueKind::number ||
                parse_number(text_.substr(at), NumberType::u8, number) != NumberFault::none ||
                number.front() != std::byte{1})
                return fail(at, "\"bendy_text\" is the version of the text's form, and must be 1");
            return true;
        case Role::schema:
            break;
    }
    return kind == ValueKind::string || fail(at, "\"$schema\" is a string");
}

bool Assembler::StartObject() {
    begin_token();
    passed_ = token_ + 1;
    const bool is_chunk = values_.depth() == 0 && (frames_.empty() || frames_.back().is_in_array);
    if (!is_chunk) {
        values_.begin(ValueKind::object, token_);
        return true;
    }
    if (++chunks_ > kMaxChunks) return fail(token_, "there are too many chunks for one file");
    values_.clear();
    Frame frame;
    frame.offset = token_;
    frames_.push_back(frame);
    if (progress_) progress_(token_, text_.size());
    return true;
}

bool Assembler::StartArray() {
    begin_token();
    passed_ = token_ + 1;
    const bool is_content =
        values_.depth() == 0 && !frames_.empty() && !frames_.back().is_in_array && frames_.back().role == Role::content;
    if (is_content) return begin_container();
    if (frames_.empty()) return fail(token_, "the text should be an object that holds HEAD");
    if (values_.depth() == 0 && frames_.back().is_in_array)
        return fail(token_, "there should be a chunk's object, not an array");
    values_.begin(ValueKind::array, token_);
    return true;
}

bool Assembler::begin_container() {
    Frame& frame = frames_.back();
    if (frame.has(Role::codec) || frame.has(Role::encoded))
        return fail(token_, "a chunk that holds chunks cannot be encoded");
    if (frames_.size() > kMaxDepth)
        return fail(token_, "chunks are nested deeper than " + std::to_string(kMaxDepth) + " levels");
    writer_.begin(frame.id);
    frame.is_container = true;
    frame.is_in_array = true;
    return true;
}

bool Assembler::end_array() {
    begin_token();
    passed_ = token_ + 1;
    if (values_.depth() == 0) {
        frames_.back().is_in_array = false;
        return true;
    }
    const std::uint64_t value = values_.innermost();
    values_.end();
    return values_.depth() != 0 || place_value(ValueKind::array, value);
}

bool Assembler::end_object() {
    begin_token();
    passed_ = token_ + 1;
    if (values_.depth() == 0) return end_chunk();
    const std::uint64_t value = values_.innermost();
    values_.end();
    return values_.depth() != 0 || place_value(ValueKind::object, value);
}

bool Assembler::end_chunk() {
    const Frame& frame = frames_.back();
    if (!frame.has(Role::content)) return fail(frame.offset, "the object holds no chunk");
    const bool is_root = frames_.size() == 1;
    if (is_root && !frame.is_container) return fail(frame.offset, "HEAD must hold an array of chunks");
    if (is_root && !frame.has(Role::version)) return fail(frame.offset, "\"bendy_text\": 1 is missing");
    if (frame.is_container) {
        writer_.end(frame.flags);
    } else if (!end_leaf(frame)) {
        return false;
    }
    frames_.pop_back();
    return true;
}

bool Assembler::end_leaf(const Frame& frame) {
    std::vector<std::byte> encoded;
    if (frame.has(Role::encoded)) {
        if (!frame.has(Role::codec))
            return fail(values_.offset(frame.encoded), R"("encoded" needs a "codec" beside it)");
        if (auto fault = read_hex(values_, frame.encoded, encoded)) return fail(fault->offset, std::move(fault->what));
    } else if (frame.has(Role::codec)) {
        return fail(frame.codec_at, R"("codec" needs "encoded" beside it; without both the chunk is stored plainly)");
    }
    if (values_.kind(frame.content) == ValueKind::null) {
        if (!frame.has(Role::encoded))
            return fail(values_.offset(frame.content), "null is for a chunk that has only \"encoded\"");
        writer_.leaf(frame.id, encoded, frame.flags);
        return true;
    }
    if (auto fault = leaf_.assemble(frame.id, frame.content)) return fail(fault->offset, std::move(fault->what));
    if (!frame.has(Role::encoded)) {
        writer_.leaf(frame.id, leaf_.payload(), frame.flags);
        return true;
    }
    const Stored stored =
        store(static_cast<unsigned>(frame.flags & kCodecMask) >> 8, std::move(encoded), leaf_.take_payload());
    const auto flags = static_cast<std::uint16_t>((frame.flags & ~kCodecMask) | stored.codec << 8);
    writer_.leaf(frame.id, stored.bytes, flags);
    return true;
}

/// Returns the line and column of a byte of the text.
TextFault place(std::string_view text, FaultAt fault) {
    TextFault placed;
    placed.what = std::move(fault.what);
    for (const char c : text.substr(0, fault.offset)) {
        if (c == '\n') {
            ++placed.line;
            placed.column = 1;
        } else if ((static_cast<unsigned char>(c) & 0xc0u) != 0x80u) {
            ++placed.column;
        }
    }
    return placed;
}

std::string lower_first(std::string text) {
    if (!text.empty() && text.front() >= 'A' && text.front() <= 'Z')
        text.front() = static_cast<char>(text.front() - 'A' + 'a');
    if (!text.empty() && text.back() == '.') text.pop_back();
    return text;
}

/// Rewrites RapidJSON's message in our style.
std::string grammar_text(rapidjson::ParseErrorCode code, std::string_view text, std::uint64_t at) {
    const bool is_control = at < text.size() && static_cast<unsigned char>(text[at]) < 0x20;
    if (code == rapidjson::kParseErrorStringEscapeInvalid && is_control)
        return "a line break or control character in a string: is its closing quotation mark missing?";
    return lower_first(rapidjson::GetParseError_En(code));
}

}  // namespace

Result<std::vector<std::byte>, TextFault> assemble(std::string_view text, const Progress& progress) {
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    constexpr unsigned kFlags =
        rapidjson::kParseIterativeFlag | rapidjson::kParseNumbersAsStringsFlag | rapidjson::kParseValidateEncodingFlag;
    TextStream stream(text);
    Assembler assembler(text, stream, progress);
    rapidjson::Reader reader;
    const rapidjson::ParseResult parsed = reader.Parse<kFlags>(stream, assembler);
    if (assembler.fault()) return place(text, *assembler.fault());
    if (parsed.IsError()) return place(text, {parsed.Offset(), grammar_text(parsed.Code(), text, parsed.Offset())});
    if (stream.Tell() != text.size()) return place(text, {stream.Tell(), "something follows the end of the text"});
    return std::move(assembler).finish();
}

}  // namespace bendy::text_form
