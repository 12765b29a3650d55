#include "further_members.h"

#include "parts.h"
#include "pointer.h"
#include "primitive.h"
#include "scene/failure.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <utility>

namespace bendy::converter::gltf {

void Losses::add(const std::string& kind, std::string which, const std::string& place) {
    constexpr std::size_t kMostShown = 12;
    const auto [known, is_new] = kind_of_.try_emplace(kind, kinds_.size());
    if (is_new) kinds_.push_back({kind, {}, place, 0});
    Kind& entry = kinds_[known->second];
    if (entry.count++ < kMostShown) entry.shown.push_back(std::move(which));
}

void Losses::report(Report& report) const {
    for (const Kind& kind : kinds_) {
        std::string list;
        for (const std::string& which : kind.shown) list.append(list.empty() ? "" : ", ").append(which);
        if (kind.count > kind.shown.size()) list += ", ...";
        report.warn(kind.name + " left out: " + list, kind.first_place, kind.count);
    }
}

namespace {

struct Shape;

/// A member that is a nested object.
struct Inner {
    std::string_view member;
    const Shape* shape;
};

/// The members that the specification defines for an object. `known` lists `extras` and `name` if the Scene holds them,
/// and `extensions` if other code reports the dropped ones.
struct Shape {
    std::string_view known;  ///< names, space-separated
    std::span<const Inner> inner = {};
    bool is_open = false;         ///< may have unlisted members: extensions without a shape
    std::string_view draft = {};  ///< members that only glTF 2.1 has: KhronosGroup/glTF, specification/2.1/schema
};

constexpr Shape kPlain{""};

constexpr Shape kTextureTransform{"offset rotation scale texCoord"};
constexpr std::array kUseExtensionsInner{Inner{"KHR_texture_transform", &kTextureTransform}};
constexpr Shape kUseExtensions{"", kUseExtensionsInner};
constexpr std::array kUseInner{Inner{"extensions", &kUseExtensions}};
constexpr Shape kUse{"index texCoord", kUseInner};
constexpr Shape kNormalUse{"index texCoord scale", kUseInner};
constexpr Shape kOcclusionUse{"index texCoord strength", kUseInner};
constexpr std::array kPbrInner{Inner{"baseColorTexture", &kUse}, Inner{"metallicRoughnessTexture", &kUse}};
constexpr Shape kPbr{"baseColorFactor metallicFactor roughnessFactor", kPbrInner};
constexpr std::array kMaterialExtensionsInner{Inner{"KHR_materials_unlit", &kPlain}};
constexpr Shape kMaterialExtensions{"", kMaterialExtensionsInner, true};
constexpr std::array kMaterialInner{
    Inner{"extensions", &kMaterialExtensions}, Inner{"pbrMetallicRoughness", &kPbr},
    Inner{"normalTexture", &kNormalUse},       Inner{"occlusionTexture", &kOcclusionUse},
    Inner{"emissiveTexture", &kUse},
};
constexpr Shape kMaterial{"name extras emissiveFactor alphaMode alphaCutoff doubleSided", kMaterialInner};

constexpr Shape kTextureSource{"source"};
constexpr std::array kTextureExtensionsInner{
    Inner{"KHR_texture_basisu", &kTextureSource},
    Inner{"EXT_texture_avif", &kTextureSource},
    Inner{"EXT_texture_webp", &kTextureSource},
};
constexpr Shape kTextureExtensions{"", kTextureExtensionsInner, true};
constexpr std::array kTextureInner{Inner{"extensions", &kTextureExtensions}};
constexpr Shape kTexture{"name extras source sampler", kTextureInner};

constexpr Shape kDraco{"bufferView attributes"};
constexpr std::array kPrimitiveExtensionsInner{Inner{"KHR_draco_mesh_compression", &kDraco}};
constexpr Shape kPrimitiveExtensions{"", kPrimitiveExtensionsInner, true};
constexpr std::array kPrimitiveInner{Inner{"extensions", &kPrimitiveExtensions}};
constexpr Shape kPrimitive{"attributes indices material mode targets", kPrimitiveInner};

constexpr Shape kPointer{"pointer"};
constexpr std::array kTargetExtensionsInner{Inner{"KHR_animation_pointer", &kPointer}};
constexpr Shape kTargetExtensions{"", kTargetExtensionsInner, true};
constexpr std::array kTargetInner{Inner{"extensions", &kTargetExtensions}};
constexpr Shape kChannelTarget{"node path", kTargetInner};
constexpr std::array kChannelInner{Inner{"target", &kChannelTarget}};
constexpr Shape kChannel{"sampler extensions", kChannelInner};

constexpr Shape kSparseIndices{"bufferView byteOffset componentType extensions"};
constexpr Shape kSparseValues{"bufferView byteOffset extensions"};
constexpr std::array kSparseInner{Inner{"indices", &kSparseIndices}, Inner{"values", &kSparseValues}};
constexpr Shape kSparse{"count extensions", kSparseInner};
constexpr std::array kAccessorInner{Inner{"sparse", &kSparse}};
constexpr Shape kAccessor{"bufferView byteOffset componentType normalized count type max min extensions",
                          kAccessorInner};

constexpr Shape kMeshopt{"buffer byteOffset byteLength byteStride count mode filter"};
constexpr std::array kViewExtensionsInner{Inner{"EXT_meshopt_compression", &kMeshopt},
                                          Inner{"KHR_meshopt_compression", &kMeshopt}};
constexpr Shape kViewExtensions{"", kViewExtensionsInner, true};
constexpr std::array kViewInner{Inner{"extensions", &kViewExtensions}};
constexpr Shape kView{"buffer byteOffset byteLength byteStride target", kViewInner};

constexpr Shape kFallback{"fallback"};
constexpr std::array kBufferExtensionsInner{Inner{"EXT_meshopt_compression", &kFallback},
                                            Inner{"KHR_meshopt_compression", &kFallback}};
constexpr Shape kBufferExtensions{"", kBufferExtensionsInner, true};
constexpr std::array kBufferInner{Inner{"extensions", &kBufferExtensions}};
constexpr Shape kBuffer{"uri byteLength", kBufferInner, false, "chunk"};

constexpr Shape kPerspective{"aspectRatio yfov zfar znear extensions"};
constexpr Shape kOrthographic{"xmag ymag zfar znear extensions"};
constexpr std::array kCameraInner{Inner{"perspective", &kPerspective}, Inner{"orthographic", &kOrthographic}};
constexpr Shape kCamera{"type extensions", kCameraInner};

constexpr Shape kRoot{
    "accessors animations asset buffers bufferViews cameras extensions extensionsRequired extensionsUsed extras images "
    "materials meshes nodes samplers scene scenes skins textures",
    {},
    false,
    "externalAssets files shapes"};
constexpr Shape kAsset{"copyright extensions extras generator minVersion version", {}, false, "thumbnail"};
constexpr Shape kScene{"name extras extensions nodes"};
constexpr Shape kNode{"name extras extensions camera children matrix mesh rotation scale skin translation weights",
                      {},
                      false,
                      "boundingVolume externalAsset"};
constexpr Shape kImage{"uri mimeType bufferView extensions"};
constexpr Shape kSampler{"magFilter minFilter wrapS wrapT extensions"};
constexpr Shape kSkin{"inverseBindMatrices joints skeleton extensions"};
constexpr Shape kMesh{"name extras extensions primitives weights"};
constexpr Shape kAnimation{"name extras extensions channels samplers"};
constexpr Shape kAnimationSampler{"input interpolation output extensions"};

/// In the order of Element.
constexpr std::array kShapes{&kRoot,     &kScene,  &kNode,   &kMaterial,  &kTexture,   &kImage,   &kSampler,
                             &kSkin,     &kCamera, &kMesh,   &kPrimitive, &kAnimation, &kChannel, &kAnimationSampler,
                             &kAccessor, &kView,   &kBuffer, &kAsset};
static_assert(kShapes.size() == static_cast<std::size_t>(Element::asset) + 1);

const Shape& shape_of(Element element) {
    return *kShapes[static_cast<std::size_t>(element)];
}

bool lists(std::string_view names, std::string_view member) {
    while (!names.empty()) {
        const std::size_t end = std::min(names.find(' '), names.size());
        if (names.substr(0, end) == member) return true;
        names.remove_prefix(std::min(end + 1, names.size()));
    }
    return false;
}

const Shape* inner_shape(const Shape& shape, std::string_view member) {
    for (const Inner& inner : shape.inner) {
        if (inner.member == member) return inner.shape;
    }
    return nullptr;
}

// NOLINTNEXTLINE(misc-no-recursion): as deep as the shapes
Json collect(const Json& object, const Shape& shape) {
    Json further = Json::object();
    if (!object.is_object()) return further;
    for (auto member = object.begin(); member != object.end(); ++member) {
        const Shape* inner = inner_shape(shape, member.key());
        if (inner != nullptr && member->is_object()) {
            if (Json deeper = collect(*member, *inner); !deeper.empty()) further[member.key()] = std::move(deeper);
        } else if (inner == nullptr && !shape.is_open && !lists(shape.known, member.key())) {
            further[member.key()] = *member;
        }
    }
    return further;
}

}  // namespace

std::string_view known_members(Element element) {
    return shape_of(element).known;
}

Json further_members(const Json& object, Element element) {
    return collect(object, shape_of(element));
}

std::vector<std::string> take_drafts(Json& object, Element element) {
    std::vector<std::string> taken;
    for (auto member = object.begin(); member != object.end(); ++member) {
        if (lists(shape_of(element).draft, member.key())) taken.push_back(member.key());
    }
    object.erase_members(taken);
    return taken;
}

void lose_members(const Json& object, Element element, std::string_view nouns, const std::string& place,
                  Losses& losses) {
    struct Open {
        Json further;
        const Shape* shape;
        std::string place;
    };
    std::vector<Open> pending;
    pending.push_back({further_members(object, element), &shape_of(element), place});
    const std::string of = " of " + std::string(nouns);
    while (!pending.empty()) {
        const Open open = std::move(pending.back());
        pending.pop_back();
        for (auto member = open.further.begin(); member != open.further.end(); ++member) {
            const std::string here = open.place + '.' + key(member.key());
            if (const Shape* inner = inner_shape(*open.shape, member.key()); inner != nullptr) {
                pending.push_back({*member, inner, here});
            } else if (member.key() == "extras") {
                losses.add("extras" + of, here, here);
            } else if (member.key() == "name" && member->is_string() && open.place == place) {
                losses.add("names" + of, quote(member->text()), here);
            } else {
                losses.add("members that glTF does not define" + of, here, here);
            }
        }
    }
}

std::string call(const Json& element, std::string_view array, std::size_t index) {
    const Json* name = find(element, "name");
    const bool is_named = name != nullptr && name->is_string() && !name->text().empty();
    return is_named ? quote(name->text()) : at(array, index);
}

namespace {

class MemberKeeper {
public:
    MemberKeeper(const Document& document, const Skeleton& skeleton, Scene& scene)
        : document_(document),
          root_(document.json),
          skeleton_(skeleton),
          scene_(scene),
          is_image_said_(scene.images.size()) {}

    void run() {
        Json more = further_members(root_, Element::root);
        if (const auto files = more.find("files"); files != more.end() && files->is_array()) {
            for (Json& file : *files) {
                if (file.is_object()) file.erase("bufferView");  // there are none
            }
        }
        scene_.source_more = text_of(more, {});
        for (std::size_t joint = 0; joint < scene_.joints.size(); ++joint) {
            if (skeleton_.instance_of_joint[joint] == kNone) keep_node(joint);
        }
        for (std::size_t i = 0; i < scene_.materials.size(); ++i)
            scene_.materials[i].more = text_of(further_members(root_["materials"][i], Element::material), "materials");
        for (std::size_t i = 0; i < scene_.textures.size(); ++i) keep_texture(i);
        for (std::size_t i = 0; i < scene_.clips.size(); ++i)
            scene_.clips[i].more = text_of(further_members(root_["animations"][i], Element::animation), "animations");
    }

private:
    std::string text_of(const Json& members, const std::string& place) const {
        if (members.empty()) return {};
        std::string text = members.dump();
        document_.budget.take(text.size(), 1, place);
        return text;
    }

    void keep_node(std::size_t joint) {
        const std::uint32_t number = skeleton_.node_of_joint[joint];
        const Json& node = root_["nodes"][number];
        Json more = further_members(node, Element::node);
        if (const Json* skin = find(node, "skin");
            skin != nullptr && skeleton_.is_drawn[joint] && node.contains("mesh")) {
            add(more, "skin", further_members(root_["skins"][skin->get<std::size_t>()], Element::skin));
        }
        if (const Json* camera = find(node, "camera"); camera != nullptr) {
            document_.report.warn("camera kept as JSON, not interpreted", at("nodes", number) + ".camera");
            more["camera"] = root_["cameras"][camera->get<std::size_t>()];
        }
        scene_.joints[joint].more = text_of(more, "nodes");
    }

    void keep_texture(std::size_t index) {
        const Json no_members = Json::object();  // for a texture that was added for its image
        const Json& textures = array_of(root_, "textures");
        const Json& texture = index < textures.size() ? textures[index] : no_members;
        Json more = further_members(texture, Element::texture);
        if (const Json* sampler = find(texture, "sampler"); sampler != nullptr)
            add(more, "sampler", further_members(root_["samplers"][sampler->get<std::size_t>()], Element::sampler));
        Json images = Json::array();
        bool any = false;
        for (const std::uint32_t image : scene_.textures[index].images) {
            Json members;
            if (!is_image_said_[image]) members = further_members(root_["images"][image], Element::image);
            is_image_said_[image] = true;
            any = any || !members.empty();
            images.push_back(members.empty() ? Json() : std::move(members));
        }
        if (any) more["source"] = std::move(images);
        scene_.textures[index].more = text_of(more, "textures");
    }

    static void add(Json& more, const char* member, Json members) {
        if (!members.empty()) more[member] = std::move(members);
    }

    const Document& document_;
    const Json& root_;
    const Skeleton& skeleton_;
    Scene& scene_;
    std::vector<bool> is_image_said_;
};

constexpr const char* kExternal = "external assets of glTF 2.1, which are not read,";

class Reporter {
public:
    Reporter(const Document& document, const Skeleton& skeleton) : document_(document), root_(document.json) {
        for (const auto* kind : {"meshes", "skins", "cameras", "samplers"})
            used_.emplace(kind, std::vector<bool>(array_of(root_, kind).size()));
        for (std::size_t joint = 0; joint < skeleton.node_of_joint.size(); ++joint) mark_node(skeleton, joint);
        for (const Json& texture : array_of(root_, "textures")) mark("samplers", texture, "sampler");
        for (const std::uint32_t node : skeleton.node_of_joint) nodes_.insert(node);
    }

    void run() {
        add_unused("meshes", "meshes that no node of the scene draws");
        add_unused("skins", "skins that no mesh of the scene uses");
        add_unused("cameras", "cameras that no node of the scene has");
        add_unused("samplers", "samplers that no texture uses");
        add_external_assets();
        const Json& meshes = array_of(root_, "meshes");
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            if (!used_["meshes"][i]) continue;
            const Json& primitives = array_of(meshes[i], "primitives");
            for (std::size_t p = 0; p < primitives.size(); ++p) {
                lose_members(without_target_names(primitives[p], array_of(primitives[p], "targets").size()),
                             Element::primitive, "primitives", at("meshes", i) + '.' + at("primitives", p), losses_);
            }
        }
        const Json& animations = array_of(root_, "animations");
        for (std::size_t i = 0; i < animations.size(); ++i) {
            const Json& channels = array_of(animations[i], "channels");
            for (std::size_t c = 0; c < channels.size(); ++c) {
                lose_members(without_curve_name(channels[c]), Element::channel, "animation channels",
                             at("animations", i) + '.' + at("channels", c), losses_);
            }
            lose_list(animations[i], "samplers", Element::animation_sampler, "animation samplers", at("animations", i));
        }
        lose_list(root_, "accessors", Element::accessor, "accessors", {});
        lose_list(root_, "bufferViews", Element::buffer_view, "bufferViews", {});
        lose_list(root_, "buffers", Element::buffer, "buffers", {});
        losses_.report(document_.report);
    }

private:
    void mark_node(const Skeleton& skeleton, std::size_t joint) {
        const Json& node = root_["nodes"][skeleton.node_of_joint[joint]];
        mark("cameras", node, "camera");
        if (!skeleton.is_drawn[joint] || !node.contains("mesh")) return;
        mark("meshes", node, "mesh");
        mark("skins", node, "skin");
    }

    void mark(const char* kind, const Json& user, const char* member) {
        if (const Json* index = find(user, member); index != nullptr) used_[kind][index->get<std::size_t>()] = true;
    }

    void add_unused(const char* kind, const std::string& message) {
        const Json& all = array_of(root_, kind);
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (!used_[kind][i]) losses_.add(message, call(all[i], kind, i), at(kind, i));
        }
    }

    /// glTF 2.1: files that nodes place in the scene.
    void add_external_assets() {
        const Json& assets = list_of("externalAssets");
        const Json& files = list_of("files");
        std::vector<bool> is_placed(assets.size());
        const auto call_asset = [&](std::size_t asset) {
            const Json* file = assets[asset].is_object() ? find(assets[asset], "file") : nullptr;
            const bool is_there =
                file != nullptr && file->is_number_unsigned() && file->get<std::uint64_t>() < files.size();
            const Json* uri = is_there && files[file->get<std::size_t>()].is_object()
                                  ? find(files[file->get<std::size_t>()], "uri")
                                  : nullptr;
            const std::string name =
                assets[asset].is_object() ? call(assets[asset], "externalAssets", asset) : at("externalAssets", asset);
            return uri == nullptr || !uri->is_string() ? name : name + " (" + quote(uri->text()) + ')';
        };
        for (const std::uint32_t node : nodes_) {
            const Json* asset = find(root_["nodes"][node], "externalAsset");
            if (asset == nullptr) continue;
            const bool is_there = asset->is_number_unsigned() && asset->get<std::uint64_t>() < assets.size();
            if (is_there) is_placed[asset->get<std::size_t>()] = true;
            losses_.add(kExternal,
                        (is_there ? call_asset(asset->get<std::size_t>()) : "externalAssets[" + asset->dump() + ']') +
                            " at " + call(root_["nodes"][node], "nodes", node),
                        at("nodes", node) + ".externalAsset");
        }
        for (std::size_t i = 0; i < assets.size(); ++i) {
            if (!is_placed[i]) losses_.add(kExternal, call_asset(i), at("externalAssets", i));
        }
        for (std::size_t i = 0; i < files.size(); ++i) {
            if (!files[i].is_object() || !files[i].contains("bufferView")) continue;
            losses_.add("the bytes of files of glTF 2.1 in buffer views", call(files[i], "files", i), at("files", i));
        }
    }

    /// A list of the root that nothing has checked.
    [[nodiscard]] const Json& list_of(const char* member) const {
        static const Json none = Json::array();
        const auto found = root_.find(member);
        return found != root_.end() && found->is_array() ? *found : none;
    }

    void lose_list(const Json& owner, const char* member, Element element, const char* nouns,
                   const std::string& place) {
        const Json& list = array_of(owner, member);
        for (std::size_t i = 0; i < list.size(); ++i)
            lose_members(list[i], element, nouns, place.empty() ? at(member, i) : place + '.' + at(member, i), losses_);
    }

    const Document& document_;
    const Json& root_;
    std::map<std::string, std::vector<bool>> used_;
    std::set<std::uint32_t> nodes_;  ///< of the scene
    Losses losses_;
};

}  // namespace

void keep_members(const Document& document, const Skeleton& skeleton, Scene& scene) {
    MemberKeeper(document, skeleton, scene).run();
}

void report_left_out(const Document& document, const Skeleton& skeleton) {
    Reporter(document, skeleton).run();
}

}  // namespace bendy::converter::gltf
