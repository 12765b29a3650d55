#include <bendy/converter/report.h>

#include "scene/failure.h"

#include <bendy/format/chunk_reader.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <system_error>
#include <utility>

namespace bendy::converter {

void Report::warn(std::string message, std::string place, std::uint64_t count) {
    if (style_ != OptionStyle::program) message = with_option_names(message, style_);
    const auto [known, is_new] = place_of_.try_emplace(message, warnings_.size());
    if (!is_new) {
        warnings_[known->second].count += count;
        return;
    }
    warnings_.push_back({std::move(message), std::move(place), count});
}

void Report::add_source(const std::filesystem::path& file) {
    if (known_sources_.insert(file).second) sources_.push_back({file, stamp_of(file)});
}

void Report::add_embedded(EmbeddedFile file) {
    if (known_embedded_.insert(file.file).second) embedded_.push_back(std::move(file));
}

FileStamp stamp_of(const std::filesystem::path& file) {
    std::error_code no_size;
    std::error_code no_time;
    const std::uintmax_t size = std::filesystem::file_size(file, no_size);
    const std::filesystem::file_time_type modified = std::filesystem::last_write_time(file, no_time);
    if (no_size || no_time) return {};
    return {true, size, static_cast<std::int64_t>(modified.time_since_epoch().count())};
}

std::string key(const std::string& name) {
    const bool plain = !name.empty() && name.size() < 80 && std::all_of(name.begin(), name.end(), [](char c) {
        return c == '_' || (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    });
    return plain ? name : quote(name);
}

std::string quote(std::string_view name) {
    constexpr std::size_t kMaxBytes = 80;
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string text = "'";
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto byte = static_cast<unsigned char>(name[i]);
        const bool starts_character = (byte & 0xc0u) != 0x80u;  // never cut inside a UTF-8 sequence
        if (i >= kMaxBytes && starts_character) {
            text += "...";
            break;
        }
        if (byte < 0x20 || byte == 0x7f) {
            text += "\\x";
            text += kHex[byte >> 4];
            text += kHex[byte & 0xfu];
        } else {
            text += name[i];
        }
    }
    return text + '\'';
}

std::string with_option_names(std::string_view message, OptionStyle style) {
    if (style == OptionStyle::program) return std::string(message);
    const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
    std::string text;
    char quoted_by = 0;
    for (std::size_t at = 0; at < message.size(); ++at) {
        const char c = message[at];
        const bool begins_word = at == 0 || message[at - 1] == ' ' || message[at - 1] == '(';
        const bool is_option = quoted_by == 0 && begins_word && message.substr(at, 2) == "--" &&
                               at + 2 < message.size() && is_letter(message[at + 2]);
        if (!is_option) {
            text += c;
            if (quoted_by == 0 && begins_word && (c == '"' || c == '\'')) {
                quoted_by = c;
            } else if (quoted_by == '"' && c == '\\' && at + 1 < message.size()) {
                text += message[++at];
            } else if (c == quoted_by) {
                quoted_by = 0;
            }
            continue;
        }
        for (at += 2; at < message.size() && (is_letter(message[at]) || message[at] == '-'); ++at) {
            if (message[at] != '-') {
                text += message[at];
            } else if (style == OptionStyle::python) {
                text += '_';
            } else if (at + 1 < message.size() && is_letter(message[at + 1])) {
                text += static_cast<char>(message[++at] - 'a' + 'A');
            }
        }
        --at;
    }
    return text;
}

namespace {

struct KindOfChunk {
    FourCC id;
    std::string_view kind;
};
/// Chunk ids by kind. A chunk belongs to the kind of its nearest listed ancestor, itself included.
constexpr std::array kKinds{KindOfChunk{FourCC("SKIN"), "skeleton"}, KindOfChunk{FourCC("JNTS"), "skeleton"},
                            KindOfChunk{FourCC("JNAM"), "skeleton"}, KindOfChunk{FourCC("ROLE"), "skeleton"},
                            KindOfChunk{FourCC("IKCH"), "skeleton"}, KindOfChunk{FourCC("PALT"), "PALT"},
                            KindOfChunk{FourCC("POSI"), "POSI"},     KindOfChunk{FourCC("NORM"), "NORM"},
                            KindOfChunk{FourCC("TANG"), "TANG"},     KindOfChunk{FourCC("TEXC"), "TEXC"},
                            KindOfChunk{FourCC("COLR"), "COLR"},     KindOfChunk{FourCC("BONE"), "BONE"},
                            KindOfChunk{FourCC("WGHT"), "WGHT"},     KindOfChunk{FourCC("INDX"), "indices"},
                            KindOfChunk{FourCC("TARG"), "targets"},  KindOfChunk{FourCC("FRMS"), "frames"},
                            KindOfChunk{FourCC("NLST"), "NORM"},     KindOfChunk{FourCC("LODD"), "LODD"},
                            KindOfChunk{FourCC("CYCL"), "clips"},    KindOfChunk{FourCC("TEXT"), "textures"},
                            KindOfChunk{FourCC("HEAD"), "other"}};

}  // namespace

std::vector<ByteCount> count_bytes(Bytes file) {
    std::vector<ByteCount> counts;
    std::array<std::size_t, kKinds.size()> place{};
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
        const auto known = std::find_if(counts.begin(), counts.end(),
                                        [&](const ByteCount& count) { return count.kind == kKinds[k].kind; });
        place[k] = static_cast<std::size_t>(known - counts.begin());
        if (known == counts.end()) counts.push_back({std::string(kKinds[k].kind), 0});
    }
    const auto tree = read_chunk_tree(file);
    if (!tree) return counts;
    std::vector<std::size_t> kind_of(tree->chunks().size(), counts.size() - 1);
    for (std::uint32_t number = 0; number < kind_of.size(); ++number) {
        const Chunk& chunk = (*tree)[number];
        const auto known =
            std::find_if(kKinds.begin(), kKinds.end(), [&](const KindOfChunk& k) { return k.id == chunk.id; });
        const std::string_view above = number == 0 ? std::string_view() : counts[kind_of[chunk.parent]].kind;
        const bool in_target = above == "targets" || above == "frames";
        if (known != kKinds.end() && !in_target) {
            kind_of[number] = place[static_cast<std::size_t>(known - kKinds.begin())];
        } else if (number != 0) {
            kind_of[number] = kind_of[chunk.parent];
        }
        counts[kind_of[number]].bytes += kChunkHeaderSize + (chunk.is_container() ? 0 : padded(chunk.size));
    }
    return counts;
}

}  // namespace bendy::converter
