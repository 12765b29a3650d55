#include "parts.h"

#include "formats/x/conventions.h"

#include <bendy/format/charconv.h>

#include <algorithm>
#include <cmath>

namespace bendy::converter::x_out {
namespace {

/// Maximum indentation: indenting a long chain of frames fully would take quadratic space.
constexpr std::size_t kDeepest = 20;

template <class Number>
void append(std::string& text, Number number) {
    constexpr auto kHandy = Number(1e15);
    std::array<char, 400> digits{};
    char* const end = digits.data() + digits.size();
    const bool is_huge = std::abs(number) >= kHandy;
    const auto written =
        is_huge ? to_chars(digits.data(), end, number) : to_chars(digits.data(), end, number, std::chars_format::fixed);
    const std::string_view shortest(digits.data(), static_cast<std::size_t>(written.ptr - digits.data()));
    text += shortest;
    if (shortest.find_first_of(".e") == std::string_view::npos) text += ".0";
}

}  // namespace

void Text::begin_line() {
    text_.append(std::min(depth_, kDeepest), ' ');
}

void Text::line(std::string_view text) {
    begin_line();
    add(text);
    end_line();
}

void Text::open(std::string_view type, std::string_view name) {
    begin_line();
    add(type).add(" ");
    if (!name.empty()) add(name).add(" ");
    add("{");
    end_line();
    ++depth_;
}

void Text::close() {
    --depth_;
    line("}");
}

Text& Text::add(float number) {
    append(text_, number);
    return *this;
}

Text& Text::add(double number) {
    append(text_, number);
    return *this;
}

template <class Number>
void Text::write_matrix(const std::array<Number, 16>& matrix) {
    for (std::size_t row = 0; row < 4; ++row) {
        begin_line();
        for (std::size_t i = 0; i < 4; ++i) add(matrix[4 * row + i]).add(row < 3 || i < 3 ? "," : ";;");
        end_line();
    }
}

void Text::matrix(const std::array<double, 16>& matrix) {
    write_matrix(matrix);
}

void Text::matrix(const std::array<float, 16>& matrix) {
    write_matrix(matrix);
}

namespace {

/// Keywords of the language, and of what occurs inside a Frame or a Mesh.
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
    for (std::size_t i = 0; i < scene.clips.size(); ++i) clips.push_back(make(scene.clips[i].name, "clip", i));
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) meshes.push_back(make(scene.meshes[i].name, "mesh", i));
}

std::string Names::make(std::string_view name, const char* kind, std::size_t number) {
    std::string identifier;
    for (const char c : name) identifier += is_letter(c) || is_digit(c) ? c : '_';
    if (std::none_of(identifier.begin(), identifier.end(), [](char c) { return is_letter(c) || is_digit(c); }))
        identifier = kind + ('_' + std::to_string(number));
    if (is_digit(identifier.front())) identifier.insert(0, 1, '_');
    // Some readers ignore case.
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
