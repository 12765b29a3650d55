#include "keep_only.h"

#include "renumber.h"

#include <bendy/format/records.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <map>
#include <system_error>
#include <utility>

namespace bendy::edit {
namespace {

/// The position of a texture info's number, and of the member whose value is the info: from its name to its end.
struct TextureUse {
    std::size_t number_at = 0, number_end = 0;
    std::size_t member_at = 0, member_end = 0;
    std::uint32_t number = 0;
};

constexpr std::string_view kSpaces = " \t\r\n";

/// Scans JSON in one pass, without recursion. Recognises brackets, strings and names; numbers and words are not
/// checked.
class Scan {
public:
    explicit Scan(std::string_view text) : text_(text) {}

    std::optional<std::vector<TextureUse>> run() {
        while (at_ < text_.size()) {
            if (!step()) return std::nullopt;
        }
        if (!open_.empty()) return std::nullopt;
        std::sort(uses_.begin(), uses_.end(),
                  [](const TextureUse& a, const TextureUse& b) { return a.number_at < b.number_at; });
        return std::move(uses_);
    }

private:
    struct Open {
        bool is_object = false;
        std::size_t member_at = 0;        // start of the member whose value is being read
        std::string_view name;            // its name; empty: a name comes next
        std::optional<TextureUse> use;    // an "index" found in this object
        bool is_texture = false;          // the object is the value of a name that ends in "Texture"
        std::size_t value_member_at = 0;  // start of that member
    };

    bool step() {
        const char c = text_[at_];
        if (c == '"') return take_string();
        if (c == '{' || c == '[') return open(c == '{');
        if (c == '}' || c == ']') return close(c == '}');
        if (c == ',' && !open_.empty()) open_.back().name = {};
        const bool is_mark = c == ',' || c == ':' || kSpaces.find(c) != std::string_view::npos;
        if (is_mark) {
            ++at_;
            return true;
        }
        take_word();
        return true;
    }

    bool take_string() {
        const std::size_t begin = at_++;
        while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
        if (at_ >= text_.size()) return false;
        ++at_;
        if (open_.empty() || !open_.back().is_object || !open_.back().name.empty()) return true;  // a value
        open_.back().member_at = begin;
        open_.back().name = text_.substr(begin, at_ - begin);  // with its quotes, so never empty
        return true;
    }

    bool open(bool is_object) {
        Open opened;
        opened.is_object = is_object;
        if (is_object && !open_.empty() && open_.back().is_object) {
            opened.is_texture = open_.back().name.ends_with("Texture\"");
            opened.value_member_at = open_.back().member_at;
        }
        open_.push_back(opened);
        ++at_;
        return true;
    }

    bool close(bool is_object) {
        if (open_.empty() || open_.back().is_object != is_object) return false;
        const Open closed = open_.back();
        open_.pop_back();
        ++at_;
        if (!closed.is_texture || !closed.use) return true;
        uses_.push_back(*closed.use);
        uses_.back().member_at = closed.value_member_at;
        uses_.back().member_end = at_;
        return true;
    }

    void take_word() {
        const std::size_t begin = at_;
        at_ = std::min(text_.find_first_of(" \t\r\n,:{}[]\"", at_), text_.size());
        if (open_.empty() || !open_.back().is_texture || open_.back().name != "\"index\"") return;
        TextureUse use;
        use.number_at = begin;
        use.number_end = at_;
        const auto [end, fault] = std::from_chars(text_.data() + begin, text_.data() + at_, use.number);
        if (fault == std::errc() && end == text_.data() + at_) open_.back().use = use;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::vector<Open> open_;
    std::vector<TextureUse> uses_;
};

/// Removes a comma with the member that has just been left out: the one after it, or else the one before it.
std::size_t skip_comma(std::string_view json, std::size_t at, std::string& out) {
    const std::size_t next = json.find_first_not_of(kSpaces, at);
    if (next != std::string_view::npos && json[next] == ',') return next + 1;
    const std::size_t last = out.find_last_not_of(kSpaces);
    if (last != std::string::npos && out[last] == ',') out.resize(last);
    return at;
}

/// Returns the text with now[number] in place of each number; a texture info is removed, with its name, if that is
/// kNone. Returns nothing if the text is not JSON, or if a number is out of range.
std::optional<std::string> renumber_textures(std::string_view json, std::span<const std::uint32_t> now) {
    const auto uses = Scan(json).run();
    if (!uses) return std::nullopt;
    std::string out;
    std::size_t at = 0;
    for (const TextureUse& use : *uses) {
        if (use.number >= now.size()) return std::nullopt;
        if (use.number_at < at) continue;  // inside one that has been removed
        if (now[use.number] == kNone) {
            if (use.member_at < at) return std::nullopt;
            out += json.substr(at, use.member_at - at);
            at = skip_comma(json, use.member_end, out);
            continue;
        }
        out += json.substr(at, use.number_at - at);
        out += std::to_string(now[use.number]);
        at = use.number_end;
    }
    return out += json.substr(at);
}

bool is_image(FourCC id) {
    return id == FourCC("IMAG") || id == FourCC("LINK") || id == FourCC("SAME");
}

/// The images of every texture: their chunks.
std::vector<std::vector<std::uint32_t>> image_chunks(const Source& source) {
    std::vector<std::vector<std::uint32_t>> images;
    for (const TextureView& texture : source.document.textures) {
        images.emplace_back();
        for (const std::uint32_t child : source.tree.children(texture.chunk)) {
            if (is_image(source.tree[child].id)) images.back().push_back(child);
        }
    }
    return images;
}

/// A SAME means the image where it is now: the first one that shared an image which goes has it from now on.
void repair_shared_images(const Source& source, const std::vector<bool>& stays, std::span<const std::uint32_t> now,
                          Rewrite& rewrite) {
    const auto images = image_chunks(source);
    std::map<std::uint32_t, SameRecord> moved;  // by the chunk of the image that went
    for (std::uint32_t t = 0; t < images.size(); ++t) {
        if (!stays[t]) continue;
        for (std::uint32_t k = 0; k < images[t].size(); ++k) {
            const std::uint32_t chunk = images[t][k];
            if (!(source.tree[chunk].id == FourCC("SAME"))) continue;
            SameRecord same;
            copy_at(source.tree.payload(chunk), 0, same);
            const std::uint32_t image = images[same.texture][same.image];
            if (!stays[same.texture] && moved.try_emplace(image, SameRecord{now[t], k}).second) {
                const Chunk& there = source.tree[image];
                const Bytes whole = source.tree.bytes().subspan(there.offset, kChunkHeaderSize + padded(there.size));
                rewrite.replace_whole(chunk, {whole.begin(), whole.end()});
                continue;
            }
            const SameRecord updated = stays[same.texture] ? SameRecord{now[same.texture], same.image} : moved[image];
            if (updated.texture == same.texture && updated.image == same.image) continue;
            rewrite.overwrite(chunk, 0, bytes_of(updated));
        }
    }
}

void update_extensions(const ChunkTree& tree, const MaterialView& material, std::span<const std::uint32_t> now,
                       Rewrite& rewrite, Log& log) {
    const std::uint32_t chunk = tree.find(material.chunk, FourCC("EXTN"));
    if (chunk == kNone) return;
    const std::string_view before = as_text(tree.payload(chunk));
    const auto after = renumber_textures(before, now);
    if (!after) {
        log.warnings.push_back("the extensions of material \"" + std::string(material.name) +
                               "\" cannot be read; texture numbers in them stay as they are");
    } else if (*after != before) {
        rewrite.replace(chunk, as_byte_span(*after));
    }
}

}  // namespace

std::optional<std::vector<std::uint32_t>> texture_numbers(std::string_view json) {
    const auto uses = Scan(json).run();
    if (!uses) return std::nullopt;
    std::vector<std::uint32_t> numbers;
    for (const TextureUse& use : *uses) numbers.push_back(use.number);
    return numbers;
}

void update_textures(const Source& source, const Kept& kept, Rewrite& rewrite, Log& log) {
    const auto now = renumbered(kept.textures);
    bool is_changed = false;
    for (std::size_t t = 0; t < now.size(); ++t) {
        if (now[t] == t) continue;
        is_changed = true;
        if (now[t] == kNone) rewrite.remove(source.document.textures[t].chunk);
    }
    if (!is_changed) return;
    repair_shared_images(source, kept.textures, now, rewrite);
    NewNumbers numbers;
    numbers.of(Entity::texture) = now;
    for (const MaterialView& material : source.document.materials) {
        renumber_leaves(source.tree, material.chunk, numbers, nullptr, nullptr, rewrite);
        update_extensions(source.tree, material, now, rewrite, log);
    }
}

}  // namespace bendy::edit
