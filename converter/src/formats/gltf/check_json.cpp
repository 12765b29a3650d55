#include "check_json.h"

#include "extensions.h"
#include "scene/failure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace bendy::converter::gltf {
namespace {

// ---------------------------------------------------------------------------------------------- rules

enum class Kind : std::uint8_t { object, array, string, boolean, number, integer, index, numbers, choice };

/// A requirement on every value at a path. In a path, `[]` means each element of an array, `{}` each member of an
/// object. If something on the path is missing, there is nothing to check.
struct Rule {
    std::string_view path;
    Kind kind;
    bool required = false;     ///< the last member must exist if its object does
    double low = 0, high = 0;  ///< integer, number: range; numbers, array: element count
    std::string_view of = {};  ///< index: the root's array that it indexes; choice: "a|b|c"
};

constexpr bool kRequired = true;
constexpr bool kOptional = false;
constexpr double kMaxInt = 2147483647.0;         // tinygltf stores these in an int
constexpr double kMaxSize = 9007199254740991.0;  // 2^53 - 1: the integers that JSON numbers hold exactly
constexpr double kMaxFloat = std::numeric_limits<float>::max();
constexpr double kMany = kMaxSize;

constexpr Rule object(std::string_view path, bool required = kOptional) {
    return {path, Kind::object, required};
}
constexpr Rule array(std::string_view path, bool required = kOptional, double low = 0) {
    return {path, Kind::array, required, low, kMany};
}
constexpr Rule string(std::string_view path, bool required = kOptional) {
    return {path, Kind::string, required};
}
constexpr Rule boolean(std::string_view path) {
    return {path, Kind::boolean};
}
constexpr Rule number(std::string_view path) {
    return {path, Kind::number, kOptional, -kMaxFloat, kMaxFloat};
}
constexpr Rule integer(std::string_view path, double low, double high, bool required = kOptional) {
    return {path, Kind::integer, required, low, high};
}
constexpr Rule index(std::string_view path, std::string_view of, bool required = kOptional) {
    return {path, Kind::index, required, 0, 0, of};
}
constexpr Rule numbers(std::string_view path, double low = 0, double high = kMany) {
    return {path, Kind::numbers, kOptional, low, high};
}
constexpr Rule choice(std::string_view path, std::string_view of, bool required = kOptional) {
    return {path, Kind::choice, required, 0, 0, of};
}

constexpr std::string_view kComponentTypes = "5120|5121|5122|5123|5125|5126";

constexpr std::array kRules = {
    // First every array of the root, and that its elements are objects: the rules below rely on it.
    array("accessors"),
    object("accessors[]"),
    array("animations"),
    object("animations[]"),
    array("buffers"),
    object("buffers[]"),
    array("bufferViews"),
    object("bufferViews[]"),
    array("cameras"),
    object("cameras[]"),
    array("images"),
    object("images[]"),
    array("materials"),
    object("materials[]"),
    array("meshes"),
    object("meshes[]"),
    array("nodes"),
    object("nodes[]"),
    array("samplers"),
    object("samplers[]"),
    array("scenes"),
    object("scenes[]"),
    array("skins"),
    object("skins[]"),
    array("textures"),
    object("textures[]"),
    array("extensionsUsed"),
    string("extensionsUsed[]"),

    index("scene", "scenes"),
    string("scenes[].name"),
    array("scenes[].nodes"),
    index("scenes[].nodes[]", "nodes"),

    string("nodes[].name"),
    array("nodes[].children"),
    index("nodes[].children[]", "nodes"),
    index("nodes[].mesh", "meshes"),
    index("nodes[].skin", "skins"),
    index("nodes[].camera", "cameras"),
    numbers("nodes[].matrix", 16, 16),
    numbers("nodes[].translation", 3, 3),
    numbers("nodes[].rotation", 4, 4),
    numbers("nodes[].scale", 3, 3),
    numbers("nodes[].weights"),

    string("skins[].name"),
    array("skins[].joints", kRequired, 1),
    index("skins[].joints[]", "nodes"),
    index("skins[].inverseBindMatrices", "accessors"),
    index("skins[].skeleton", "nodes"),

    string("buffers[].name"),
    string("buffers[].uri"),
    integer("buffers[].byteLength", 0, kMaxSize, kRequired),

    string("bufferViews[].name"),
    index("bufferViews[].buffer", "buffers", kRequired),
    integer("bufferViews[].byteOffset", 0, kMaxSize),
    integer("bufferViews[].byteLength", 0, kMaxSize, kRequired),
    integer("bufferViews[].byteStride", 1, 65536),

    string("accessors[].name"),
    index("accessors[].bufferView", "bufferViews"),
    integer("accessors[].byteOffset", 0, kMaxSize),
    choice("accessors[].componentType", kComponentTypes, kRequired),
    boolean("accessors[].normalized"),
    integer("accessors[].count", 1, kMaxSize, kRequired),
    choice("accessors[].type", "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4", kRequired),
    object("accessors[].sparse"),
    integer("accessors[].sparse.count", 1, kMaxInt, kRequired),
    object("accessors[].sparse.indices", kRequired),
    object("accessors[].sparse.values", kRequired),
    index("accessors[].sparse.indices.bufferView", "bufferViews", kRequired),
    integer("accessors[].sparse.indices.byteOffset", 0, kMaxInt),
    choice("accessors[].sparse.indices.componentType", "5121|5123|5125", kRequired),
    index("accessors[].sparse.values.bufferView", "bufferViews", kRequired),
    integer("accessors[].sparse.values.byteOffset", 0, kMaxInt),

    string("meshes[].name"),
    numbers("meshes[].weights"),
    array("meshes[].primitives", kRequired),
    object("meshes[].primitives[]"),
    object("meshes[].primitives[].attributes", kRequired),
    index("meshes[].primitives[].attributes{}", "accessors"),
    index("meshes[].primitives[].indices", "accessors"),
    index("meshes[].primitives[].material", "materials"),
    integer("meshes[].primitives[].mode", 0, 6),
    array("meshes[].primitives[].targets"),
    object("meshes[].primitives[].targets[]"),
    index("meshes[].primitives[].targets[]{}", "accessors"),

    string("animations[].name"),
    array("animations[].channels", kRequired),
    object("animations[].channels[]"),
    integer("animations[].channels[].sampler", 0, kMaxInt, kRequired),
    object("animations[].channels[].target", kRequired),
    index("animations[].channels[].target.node", "nodes"),
    string("animations[].channels[].target.path", kRequired),
    array("animations[].samplers", kRequired),
    object("animations[].samplers[]"),
    index("animations[].samplers[].input", "accessors", kRequired),
    index("animations[].samplers[].output", "accessors", kRequired),
    choice("animations[].samplers[].interpolation", "LINEAR|STEP|CUBICSPLINE"),

    string("images[].name"),
    string("images[].uri"),
    string("images[].mimeType"),
    index("images[].bufferView", "bufferViews"),
    string("textures[].name"),
    index("textures[].source", "images"),
    index("textures[].sampler", "samplers"),
    choice("samplers[].magFilter", "9728|9729"),
    choice("samplers[].minFilter", "9728|9729|9984|9985|9986|9987"),
    choice("samplers[].wrapS", "10497|33071|33648"),
    choice("samplers[].wrapT", "10497|33071|33648"),

    string("materials[].name"),
    choice("materials[].alphaMode", "OPAQUE|MASK|BLEND"),
    number("materials[].alphaCutoff"),
    boolean("materials[].doubleSided"),
    numbers("materials[].emissiveFactor", 3, 3),
    object("materials[].pbrMetallicRoughness"),
    numbers("materials[].pbrMetallicRoughness.baseColorFactor", 4, 4),
    number("materials[].pbrMetallicRoughness.metallicFactor"),
    number("materials[].pbrMetallicRoughness.roughnessFactor"),
    object("materials[].pbrMetallicRoughness.baseColorTexture"),
    index("materials[].pbrMetallicRoughness.baseColorTexture.index", "textures", kRequired),
    integer("materials[].pbrMetallicRoughness.baseColorTexture.texCoord", 0, kMaxInt),
    object("materials[].pbrMetallicRoughness.metallicRoughnessTexture"),
    index("materials[].pbrMetallicRoughness.metallicRoughnessTexture.index", "textures", kRequired),
    integer("materials[].pbrMetallicRoughness.metallicRoughnessTexture.texCoord", 0, kMaxInt),
    object("materials[].normalTexture"),
    index("materials[].normalTexture.index", "textures", kRequired),
    integer("materials[].normalTexture.texCoord", 0, kMaxInt),
    number("materials[].normalTexture.scale"),
    object("materials[].occlusionTexture"),
    index("materials[].occlusionTexture.index", "textures", kRequired),
    integer("materials[].occlusionTexture.texCoord", 0, kMaxInt),
    number("materials[].occlusionTexture.strength"),
    object("materials[].emissiveTexture"),
    index("materials[].emissiveTexture.index", "textures", kRequired),
    integer("materials[].emissiveTexture.texCoord", 0, kMaxInt),

    // Extensions that the importer decodes; others are not checked.
    object("bufferViews[].extensions.EXT_meshopt_compression"),
    index("bufferViews[].extensions.EXT_meshopt_compression.buffer", "buffers", kRequired),
    integer("bufferViews[].extensions.EXT_meshopt_compression.byteOffset", 0, kMaxSize),
    integer("bufferViews[].extensions.EXT_meshopt_compression.byteLength", 1, kMaxSize, kRequired),
    integer("bufferViews[].extensions.EXT_meshopt_compression.byteStride", 1, 256, kRequired),
    integer("bufferViews[].extensions.EXT_meshopt_compression.count", 1, kMaxInt, kRequired),
    choice("bufferViews[].extensions.EXT_meshopt_compression.mode", "ATTRIBUTES|TRIANGLES|INDICES", kRequired),
    choice("bufferViews[].extensions.EXT_meshopt_compression.filter", "NONE|OCTAHEDRAL|QUATERNION|EXPONENTIAL"),
    object("bufferViews[].extensions.KHR_meshopt_compression"),
    index("bufferViews[].extensions.KHR_meshopt_compression.buffer", "buffers", kRequired),
    integer("bufferViews[].extensions.KHR_meshopt_compression.byteOffset", 0, kMaxSize),
    integer("bufferViews[].extensions.KHR_meshopt_compression.byteLength", 1, kMaxSize, kRequired),
    integer("bufferViews[].extensions.KHR_meshopt_compression.byteStride", 1, 256, kRequired),
    integer("bufferViews[].extensions.KHR_meshopt_compression.count", 1, kMaxInt, kRequired),
    choice("bufferViews[].extensions.KHR_meshopt_compression.mode", "ATTRIBUTES|TRIANGLES|INDICES", kRequired),
    choice("bufferViews[].extensions.KHR_meshopt_compression.filter", "NONE|OCTAHEDRAL|QUATERNION|EXPONENTIAL|COLOR"),
    object("meshes[].primitives[].extensions.KHR_draco_mesh_compression"),
    index("meshes[].primitives[].extensions.KHR_draco_mesh_compression.bufferView", "bufferViews", kRequired),
    object("meshes[].primitives[].extensions.KHR_draco_mesh_compression.attributes", kRequired),
    integer("meshes[].primitives[].extensions.KHR_draco_mesh_compression.attributes{}", 0, kMaxInt),
    object("animations[].channels[].target.extensions.KHR_animation_pointer"),
    string("animations[].channels[].target.extensions.KHR_animation_pointer.pointer", kRequired),
    object("textures[].extensions.KHR_texture_basisu"),
    index("textures[].extensions.KHR_texture_basisu.source", "images"),
    object("textures[].extensions.EXT_texture_webp"),
    index("textures[].extensions.EXT_texture_webp.source", "images"),
    object("textures[].extensions.EXT_texture_avif"),
    index("textures[].extensions.EXT_texture_avif.source", "images"),
};

// ---------------------------------------------------------------------------------------------- checks

bool is_one_of(std::string_view value, std::string_view choices) {
    while (!choices.empty()) {
        const std::size_t bar = std::min(choices.find('|'), choices.size());
        if (choices.substr(0, bar) == value) return true;
        choices.remove_prefix(std::min(bar + 1, choices.size()));
    }
    return false;
}

std::string shown(const Json& value) {
    if (value.is_string()) return quote(value.text());
    if (value.is_number() || value.is_boolean()) return value.dump();
    return value.type_name();
}

/// Converts `1.0` to an integer; true if the value is one now.
bool make_integer(Json& value) {
    if (value.is_number_integer()) return true;
    if (!value.is_number_float()) return false;
    const auto number = value.get<double>();
    if (!(std::abs(number) <= kMaxSize) || number != std::floor(number)) return false;
    if (number < 0) {
        value = static_cast<std::int64_t>(number);
    } else {
        value = static_cast<std::uint64_t>(number);
    }
    return true;
}

class Checker {
public:
    explicit Checker(Json& root) : root_(root) {}

    void check(const Rule& rule) {
        place_.clear();
        walk(root_, rule.path, rule);
    }

private:
    // NOLINTNEXTLINE(misc-no-recursion): as deep as the rule is long
    void walk(Json& node, std::string_view path, const Rule& rule) {
        if (path.empty()) return check_value(node, rule);
        const std::size_t length = place_.size();
        if (path.substr(0, 2) == "[]") {
            if (!node.is_array()) return;  // a separate rule checks this
            for (std::size_t i = 0; i < node.size(); ++i) {
                place_ += at("", i);
                walk(node[i], path.substr(2), rule);
                place_.resize(length);
            }
        } else if (path.substr(0, 2) == "{}") {
            if (!node.is_object()) return;
            for (auto member = node.begin(); member != node.end(); ++member) {
                place_ += '.' + key(member.key());
                walk(member.value(), path.substr(2), rule);
                place_.resize(length);
            }
        } else {
            if (!node.is_object()) return;
            if (path.front() == '.') path.remove_prefix(1);
            const std::size_t end = std::min(path.find_first_of(".[{"), path.size());
            const std::string name(path.substr(0, end));
            place_ += (place_.empty() ? "" : ".") + name;
            if (const auto member = node.find(name); member != node.end()) {
                walk(*member, path.substr(end), rule);
            } else if (rule.required && end == path.size()) {
                fail(place_, "it is required and missing");
            }
            place_.resize(length);
        }
    }

    void check_value(Json& value, const Rule& rule) const {
        switch (rule.kind) {
            case Kind::object:
                if (!value.is_object()) fail_type(value, "an object");
                break;
            case Kind::array:
                if (!value.is_array()) fail_type(value, "an array");
                if (static_cast<double>(value.size()) < rule.low) fail(place_, "it must not be empty");
                break;
            case Kind::string:
                if (!value.is_string()) fail_type(value, "a string");
                break;
            case Kind::boolean:
                if (!value.is_boolean()) fail_type(value, "true or false");
                break;
            case Kind::number:
                check_number(value, place_);
                break;
            case Kind::integer: {
                if (!make_integer(value)) fail_type(value, "an integer");
                const auto number = value.get<double>();
                if (number < rule.low || number > rule.high) fail(place_, shown(value) + " is out of range");
                break;
            }
            case Kind::index: {
                if (!make_integer(value)) fail_type(value, "an index");
                const Json& target = array_of(root_, std::string(rule.of).c_str());
                if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= target.size()) {
                    fail(place_, std::string(rule.of) + '[' + shown(value) + "] does not exist (there are " +
                                     std::to_string(target.size()) + ")");
                }
                break;
            }
            case Kind::numbers:
                if (!value.is_array()) fail_type(value, "an array of numbers");
                if (const auto size = static_cast<double>(value.size()); size < rule.low || size > rule.high) {
                    fail(place_, "expected " + std::to_string(static_cast<std::uint64_t>(rule.low)) +
                                     " numbers, found " + std::to_string(value.size()));
                }
                for (std::size_t i = 0; i < value.size(); ++i) {
                    if (!value[i].is_number() || !(std::abs(value[i].get<double>()) <= kMaxFloat)) {
                        check_number(value[i], at(place_, i));
                    }
                }
                break;
            case Kind::choice:
                make_integer(value);
                if (!is_one_of(value.is_string() ? value.text() : shown(value), rule.of)) {
                    fail(place_, shown(value) + " is not one of " + std::string(rule.of));
                }
                break;
        }
    }

    static void check_number(const Json& value, const std::string& place) {
        if (!value.is_number()) fail(place, "expected a number, found " + shown(value));
        if (!(std::abs(value.get<double>()) <= kMaxFloat)) fail(place, shown(value) + " does not fit a 32-bit float");
    }

    [[noreturn]] void fail_type(const Json& value, const char* due) const {
        fail(place_, std::string("it must be ") + due + ", not " + shown(value));
    }

    Json& root_;
    std::string place_;
};

bool is_version(std::string_view text, std::string_view major) {
    return text.size() > major.size() + 1 && text.substr(0, major.size()) == major && text[major.size()] == '.' &&
           text.find_first_not_of("0123456789", major.size() + 1) == std::string_view::npos;
}

void check_asset(const Json& root) {
    const Json* asset = find(root, "asset");
    if (asset == nullptr) fail("asset", "it is required and missing: this is not glTF 2.0");
    if (!asset->is_object()) fail("asset", "it must be an object, not " + shown(*asset));
    const Json* version = find(*asset, "version");
    if (version == nullptr) fail("asset.version", "it is required and missing");
    if (!version->is_string()) fail("asset.version", "it must be a string, not " + shown(*version));
    if (!is_version(version->text(), "2")) {
        fail("asset.version", "glTF version " + shown(*version) + " is not supported, only 2.x");
    }
    const Json* minimum = find(*asset, "minVersion");
    if (minimum != nullptr && *minimum != "2.0") {
        fail("asset.minVersion", "the file demands glTF version " + shown(*minimum) + ", only 2.0 is supported");
    }
}

void check_required_extensions(const Json& root, bool with_instances) {
    const Json* required = find(root, "extensionsRequired");
    if (required == nullptr) return;
    if (!required->is_array()) fail("extensionsRequired", "it must be an array, not " + shown(*required));
    for (std::size_t i = 0; i < required->size(); ++i) {
        const Json& name = (*required)[i];
        if (!name.is_string()) fail(at("extensionsRequired", i), "it must be a string, not " + shown(name));
        const bool is_instancing = name == kInstancing;
        if (is_instancing && with_instances) continue;
        if (!is_known_extension(name.text())) {
            fail(at("extensionsRequired", i), "the file requires extension " + shown(name) +
                                                  ", which is not supported" +
                                                  (is_instancing ? " unless instances are made (--instances)" : ""));
        }
    }
}

/// Checks indices into arrays outside the root.
void check_channels(const Json& root) {
    const Json& animations = array_of(root, "animations");
    for (std::size_t a = 0; a < animations.size(); ++a) {
        const std::size_t samplers = animations[a]["samplers"].size();
        const Json& channels = animations[a]["channels"];
        for (std::size_t c = 0; c < channels.size(); ++c) {
            if (const auto sampler = channels[c]["sampler"].get<std::uint64_t>(); sampler >= samplers) {
                fail(at("animations", a) + '.' + at("channels", c) + ".sampler", "sampler " + std::to_string(sampler) +
                                                                                     " does not exist (there are " +
                                                                                     std::to_string(samplers) + ")");
            }
        }
    }
}

/// Removes members that are not accessors from a morph target, which may only have accessors: some exporters of VRM 0
/// wrote the target's name there, as `"extra": {"name": ...}`. \return the name, or empty
std::string take_target_name(Json& target, const std::string& place, Report& report) {
    std::string name;
    for (const char* member : {"extra", "extras", "extensions", "name"}) {
        const auto found = target.find(member);
        if (found == target.end() || found->is_number()) continue;
        const Json* said = found->is_object()                   ? find(*found, "name")
                           : std::string_view(member) == "name" ? &*found
                                                                : nullptr;
        const bool is_name = said != nullptr && said->is_string() && name.empty();
        if (is_name) name = said->get<std::string>();
        if (!is_name || found->size() > 1) {
            report.warn("members of a morph target that are neither accessors nor its name are left out",
                        place + '.' + member);
        }
        target.erase(found);
    }
    return name;
}

/// Moves names of morph targets to where the specification has them, in the extras of their primitive.
void move_target_names(Json& root, Report& report) {
    const auto each = [](Json& owner, const char* name, const auto& work) {
        const auto list = owner.is_object() ? owner.find(name) : owner.end();
        if (list == owner.end() || !list->is_array()) return;
        for (std::size_t i = 0; i < list->size(); ++i) work((*list)[i], i);
    };
    each(root, "meshes", [&](Json& mesh, std::size_t m) {
        each(mesh, "primitives", [&](Json& primitive, std::size_t p) {
            Json names = Json::array();
            bool has_names = false;
            each(primitive, "targets", [&](Json& target, std::size_t t) {
                const std::string place = at("meshes", m) + '.' + at("primitives", p) + '.' + at("targets", t);
                names.push_back(target.is_object() ? take_target_name(target, place, report) : std::string());
                has_names = has_names || !names.back().text().empty();
            });
            if (!has_names) return;
            Json& extras = primitive["extras"];
            if (extras.is_null()) extras = Json::object();
            if (extras.is_object() && !extras.contains("targetNames")) extras["targetNames"] = std::move(names);
        });
    });
}

}  // namespace

Json parse_json(std::string_view text, bool with_instances, Report& report) {
    constexpr std::size_t kShownBytes = 16;
    const std::size_t first = text.find_first_not_of("\xef\xbb\xbf \t\r\n");
    if (first != std::string_view::npos && text[first] != '{' && text[first] != '[') {
        fail({}, "not a glTF file: it starts with neither 'glTF' (GLB) nor a JSON object, but with " +
                     quote(text.substr(first, kShownBytes)));
    }
    Json root = parse_json_text<Json>(text, report);
    if (!root.is_object()) fail({}, "the JSON root must be an object, not " + shown(root));
    check_asset(root);
    check_required_extensions(root, with_instances);
    move_target_names(root, report);
    Checker checker(root);
    for (const Rule& rule : kRules) checker.check(rule);
    check_channels(root);
    return root;
}

const Json* find(const Json& object, const char* key) {
    const auto member = object.find(key);
    return member == object.end() ? nullptr : &*member;
}

const Json& array_of(const Json& root, const char* key) {
    static const Json empty = Json::array();
    const Json* array = find(root, key);
    return array == nullptr ? empty : *array;
}

std::string extras_text(const Json& object) {
    const Json* extras = find(object, "extras");
    return extras == nullptr || extras->is_null() ? std::string() : extras->dump();
}

}  // namespace bendy::converter::gltf
