#include "mutators.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace {

using Json = nlohmann::ordered_json;
using bendy::fuzz::below;
using bendy::fuzz::Random;

constexpr std::uint32_t kMagic = 0x46546c67;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;
constexpr std::uint32_t kBinChunk = 0x004e4942;

/// A source in two parts; a text has no second.
struct Parts {
    Json json;
    std::string bin;
    bool is_glb = false;
};

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
    std::uint32_t word = 0;
    if (at + 4 <= bytes.size()) std::memcpy(&word, bytes.data() + at, 4);
    return word;
}

bool split(std::string_view bytes, Parts& parts) {
    std::string_view text = bytes;
    parts.is_glb = word_at(bytes, 0) == kMagic;
    if (parts.is_glb) {
        const std::size_t length = word_at(bytes, 12);
        if (bytes.size() < 20 || length > bytes.size() - 20) return false;
        text = bytes.substr(20, length);
        const std::string_view rest = bytes.substr(20 + length);
        if (rest.size() > 8) parts.bin = rest.substr(8);
    }
    parts.json = Json::parse(text, nullptr, false);
    return !parts.json.is_discarded();
}

void put_word(std::string& out, std::size_t word) {
    const auto value = static_cast<std::uint32_t>(word);
    out.append(reinterpret_cast<const char*>(&value), 4);
}

std::string join(const Parts& parts) {
    std::string text = parts.json.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (!parts.is_glb) return text;
    text.append((4 - text.size() % 4) % 4, ' ');
    std::string bin = parts.bin;
    bin.append((4 - bin.size() % 4) % 4, '\0');
    std::string out;
    put_word(out, kMagic);
    put_word(out, 2);
    put_word(out, 20 + text.size() + (bin.empty() ? 0 : 8 + bin.size()));
    put_word(out, text.size());
    put_word(out, kJsonChunk);
    out += text;
    if (bin.empty()) return out;
    put_word(out, bin.size());
    put_word(out, kBinChunk);
    return out + bin;
}

/// All values but the root, each of them behind its parent. Not by recursion: texts may be deep.
std::vector<Json*> all_values(Json& root) {
    std::vector<Json*> all;
    std::vector<Json*> open{&root};
    while (!open.empty()) {
        Json& value = *open.back();
        open.pop_back();
        if (!value.is_structured()) continue;
        for (Json& child : value) {
            all.push_back(&child);
            open.push_back(&child);
        }
    }
    return all;
}

Json awkward_number(Random& random) {
    switch (random() % 14) {
        case 0:
            return -1;
        case 1:
            return 0;
        case 2:
            return 1;
        case 3:
            return 255;
        case 4:
            return 65'536;
        case 5:
            return 2'147'483'647;
        case 6:
            return 4'294'967'295u;
        case 7:
            return 4'294'967'296;
        case 8:
            return std::numeric_limits<std::int64_t>::max();
        case 9:
            return 0.5;
        case 10:
            return -1e-30;
        case 11:
            return 3e38;
        case 12:
            return 1e300;
        default:
            return below(random, 40);
    }
}

void change_number(Json& number, Random& random) {
    if (random() % 3 != 0 && number.is_number_integer()) {
        const auto value = number.get<std::int64_t>();
        const std::array<std::int64_t, 4> near{value + (value < 1'000'000'000), value - (value > -1'000'000'000),
                                               value / 2, static_cast<std::int64_t>(below(random, 16))};
        number = near[below(random, near.size())];
        return;
    }
    // What a glTF file's constants are: types of components, of topologies, of targets.
    constexpr std::array<int, 12> kConstants{5120, 5121, 5122, 5123, 5125, 5126, 34962, 34963, 9728, 10497, 4, 6};
    number = random() % 2 == 0 ? Json(kConstants[below(random, kConstants.size())]) : awkward_number(random);
}

void change_text(Json& text, const std::vector<Json*>& all, Random& random) {
    const Json& other = *all[below(random, all.size())];
    constexpr std::array<const char*, 12> kWords{"SCALAR", "VEC2",        "VEC3",     "VEC4",  "MAT4",    "STEP",
                                                 "LINEAR", "CUBICSPLINE", "rotation", "scale", "weights", ""};
    if (other.is_string() && random() % 2 == 0) {
        text = std::string(other.get_ref<const std::string&>());
    } else {
        text = kWords[below(random, kWords.size())];
    }
}

void change_structure(Json& value, const std::vector<Json*>& all, Random& random) {
    if (value.empty()) return;
    const auto at = static_cast<Json::difference_type>(below(random, value.size()));
    const auto place = std::next(value.begin(), at);
    switch (random() % 4) {
        case 0:
            value.erase(place);
            break;
        case 1:
            if (value.is_array()) value.push_back(Json(*place));
            break;
        case 2:
            *place = Json(*all[below(random, all.size())]);
            break;
        default:
            std::swap(*place, *value.begin());
    }
}

void change_json(Json& root, Random& random) {
    const std::vector<Json*> all = all_values(root);
    if (all.empty()) return;
    Json& value = *all[below(random, all.size())];
    if (value.is_number()) return change_number(value, random);
    if (value.is_string()) return change_text(value, all, random);
    if (value.is_boolean()) {
        value = !value.get<bool>();
        return;
    }
    if (value.is_structured()) change_structure(value, all, random);
}

void change_bin(std::string& bin, Random& random) {
    if (bin.empty()) return;
    const std::size_t begin = below(random, bin.size());
    const std::size_t length = std::min<std::size_t>(bin.size() - begin, 1 + below(random, 64));
    LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bin.data()) + begin, length, length);
}

}  // namespace

namespace bendy::fuzz {

std::size_t mutate_gltf(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed) {
    Random random(seed);
    Parts parts;
    if (random() % 8 == 0 || !split({reinterpret_cast<const char*>(data), size}, parts))
        return LLVMFuzzerMutate(data, size, max_size);
    for (auto changes = 1 + random() % 3; changes > 0; --changes) {
        if (random() % 3 == 0) {
            change_bin(parts.bin, random);
        } else {
            change_json(parts.json, random);
        }
    }
    const std::string made = join(parts);
    if (made.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
    std::memcpy(data, made.data(), made.size());
    return made.size();
}

}  // namespace bendy::fuzz
