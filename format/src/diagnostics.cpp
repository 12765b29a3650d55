#include <bendy/format/diagnostics.h>

#include <charconv>
#include <system_error>
#include <vector>

namespace bendy {
namespace {

/// Returns the id with its index among its siblings; without "[0]".
std::string step_text(FourCC id, std::uint32_t place) {
    std::string text(id.letters().data());
    if (place != 0) text += '[' + std::to_string(place) + ']';
    return text;
}

/// Joins the steps with slashes, `shown` at either end; all of them if there are hardly more.
std::string join_steps(const std::vector<std::string>& steps, std::size_t shown) {
    std::string path;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (i != 0) path += '/';
        if (i == shown && steps.size() > 2 * shown + 1) {
            const std::size_t left_out = steps.size() - 2 * shown;
            path += "... " + std::to_string(left_out) + " more ...";
            i += left_out - 1;
            continue;
        }
        path += steps[i];
    }
    return path;
}

/// Returns the text of a value that is not simply a number.
std::string value_text(const Error& error, std::uint64_t value) {
    if (error_class(error.code) == ErrorClass::io) return std::generic_category().message(static_cast<int>(value));
    if (error.code == ErrorCode::kChunkMissing) return FourCC(static_cast<std::uint32_t>(value)).letters().data();
    if (error.code == ErrorCode::kSumMismatch || error.code == ErrorCode::kReservedFlags) {
        char digits[16];
        const auto end = std::to_chars(digits, digits + sizeof digits, value, 16).ptr;
        return "0x" + std::string(digits, end);
    }
    return std::to_string(value);
}

/// Returns the steps of the path of the innermost chunk that contains `offset`.
std::vector<std::string> find_steps(Bytes bytes, std::uint64_t offset) {
    std::vector<std::string> steps;
    std::uint64_t at = 0;
    std::uint64_t end = bytes.size();
    std::vector<FourCC> siblings;  // ids seen so far among the children of the current container
    while (end - at >= kChunkHeaderSize && offset >= at) {
        std::uint32_t id = 0;
        std::uint64_t size_and_flags = 0;
        copy_at(bytes, at, id);
        copy_at(bytes, at + kChunkSizeAt, size_and_flags);
        const std::uint64_t size = size_and_flags & kMaxPayload;
        const std::uint64_t payload = at + kChunkHeaderSize;
        const bool fits = size <= end - payload && padded(size) <= end - payload;
        const std::uint64_t chunk_end = fits ? payload + padded(size) : end;
        if (offset >= chunk_end && chunk_end < end) {
            if (at == 0) break;  // nothing after the root is a chunk, whatever the bytes are
            siblings.emplace_back(id);
            at = chunk_end;
            continue;
        }
        std::uint32_t place = 0;
        for (const FourCC sibling : siblings) place += sibling == FourCC(id) ? 1 : 0;
        steps.push_back(step_text(FourCC(id), place));
        const bool is_container = (size_and_flags >> 48 & kContainerFlag) != 0;
        if (!is_container || offset < payload || !FourCC(id).is_readable()) break;
        siblings.clear();
        at = payload;
        end = chunk_end;
    }
    return steps;
}

}  // namespace

std::string describe(const Error& error) {
    std::string text = error_text(error.code);
    const auto fill = [&](std::string_view mark, std::uint64_t value) {
        const std::size_t at = text.find(mark);
        if (at != std::string::npos) text.replace(at, mark.size(), value_text(error, value));
    };
    fill("{v}", error.value);
    fill("{l}", error.limit);
    return text;
}

std::string chunk_path(Bytes bytes, std::uint64_t offset) {
    constexpr std::size_t kShown = 6;
    return join_steps(find_steps(bytes, offset), kShown);
}

std::string whole_chunk_path(Bytes bytes, std::uint64_t offset) {
    return join_steps(find_steps(bytes, offset), kMaxDepth);
}

std::uint32_t find_path(const ChunkTree& tree, std::string_view path) {
    if (path.starts_with('@')) {
        std::uint64_t offset = 0;
        const auto [end, problem] = std::from_chars(path.data() + 1, path.data() + path.size(), offset);
        if (problem != std::errc() || end != path.data() + path.size() || offset >= tree.bytes().size()) return kNone;
        std::uint32_t found = 0;
        for (std::uint32_t number = 0; number < tree.chunks().size();) {
            const Chunk& chunk = tree[number];
            const bool inside = offset >= chunk.offset && offset < chunk.payload_offset() + padded(chunk.size);
            if (inside) found = number;
            number = inside ? number + 1 : chunk.end;
        }
        return found;
    }
    std::uint32_t at = kNone;
    while (true) {
        const std::size_t slash = path.find('/');
        const std::string_view step = path.substr(0, slash);
        std::uint32_t place = 0;
        if (step.size() > 4) {
            const std::string_view index = step.substr(4);
            if (index.size() < 3 || index.front() != '[' || index.back() != ']') return kNone;
            const auto [end, problem] = std::from_chars(index.data() + 1, index.data() + index.size() - 1, place);
            if (problem != std::errc() || end != index.data() + index.size() - 1) return kNone;
        }
        const std::string_view id = step.substr(0, 4);
        const auto is_it = [&](std::uint32_t number) { return id == tree[number].id.letters().data(); };
        if (at == kNone) {
            if (!is_it(0) || place != 0) return kNone;
            at = 0;
        } else {
            std::uint32_t found = kNone;
            for (const std::uint32_t child : tree.children(at)) {
                if (!is_it(child) || place-- != 0) continue;
                found = child;
                break;
            }
            if (found == kNone) return kNone;
            at = found;
        }
        if (slash == std::string_view::npos) return at;
        path.remove_prefix(slash + 1);
    }
}

std::string describe_with_place(const Error& error, Bytes bytes) {
    if (error_class(error.code) == ErrorClass::io) return describe(error);
    const std::string path = chunk_path(bytes, error.offset);
    return describe(error) + " (" + (path.empty() ? "" : path + ", ") + "offset " + std::to_string(error.offset) + ")";
}

}  // namespace bendy
