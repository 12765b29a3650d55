#include "names.h"

#include "x/encoded_text.h"

#include <algorithm>
#include <array>

namespace bendy::converter::x_out {
namespace {

/// Words of the language, and of what lies below a Frame or a Mesh.
constexpr std::array<std::string_view, 22> kTaken{
    "array",  "binary", "binary_resource", "char",      "cstring", "double",    "dword",   "float",
    "sdword", "string", "sword",           "template",  "uchar",   "ulonglong", "unicode", "word",
    "frame",  "mesh",   "material",        "animation", "x",       "header"};

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

}  // namespace

Names::Names(const Scene& scene) {
    for (const std::string_view word : kTaken) times_[std::string(word)] = 1;
    for (std::size_t i = 0; i < scene.joints.size(); ++i) joints.push_back(make(scene.joints[i].name, "joint", i));
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        materials.push_back(make(scene.materials[i].name, "material", i));
    no_material = make("no_material", "material", scene.materials.size());
    for (std::size_t i = 0; i < scene.cycles.size(); ++i) cycles.push_back(make(scene.cycles[i].name, "cycle", i));
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) meshes.push_back(make(scene.meshes[i].name, "mesh", i));
}

std::string Names::make(std::string_view name, const char* kind, std::size_t number) {
    std::string identifier;
    for (const char c : name) identifier += is_letter(c) || is_digit(c) ? c : '_';
    if (std::none_of(identifier.begin(), identifier.end(), [](char c) { return is_letter(c) || is_digit(c); }))
        identifier = kind + ('_' + std::to_string(number));
    if (is_digit(identifier.front())) identifier.insert(0, 1, '_');
    // Some readers do not tell capitals from small letters.
    for (std::uint32_t& times = times_[lower(identifier)];;) {
        if (times++ == 0) return identifier;
        std::string other = identifier + '_' + std::to_string(times);
        if (const auto [known, is_new] = times_.try_emplace(lower(other), 1); is_new) return other;
    }
}

void write_name(std::string_view identifier, std::string_view name, Text& text) {
    if (identifier == name) return;
    text.open("BendyName");
    text.line('"' + x::encode_text(name) + "\";");
    text.close();
}

}  // namespace bendy::converter::x_out
