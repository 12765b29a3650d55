#include "kept.h"

#include <bendy/extensions/renumber_extensions.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace bendy::edit {
namespace {

using extensions::Host;
using Means = extensions::Thing;

/// The new numbers of an object's things, and of HEAD's.
class KeptNumbers {
public:
    KeptNumbers(const Source& source, const Kept& kept, std::size_t object)
        : materials_(renumbered(kept.materials)), textures_(renumbered(kept.textures)) {
        if (object >= kept.objects.size()) return;
        const Kept::Object& here = kept.objects[object];
        joints_ = renumbered(here.joints);
        std::vector<bool> meshes;
        for (const Kept::Mesh& mesh : here.meshes) {
            meshes.push_back(mesh.stays);
            targets_.push_back(renumbered(mesh.targets));
        }
        meshes_ = renumbered(meshes);
        carried_.assign(joints_.size(), kNone);
        const auto& all = source.document.objects[object].meshes;
        for (std::uint32_t mesh = 0; mesh < all.size(); ++mesh) {
            if (all[mesh].joint < carried_.size() && carried_[all[mesh].joint] == kNone)
                carried_[all[mesh].joint] = mesh;
        }
        if (here.stays) return;
        std::fill(joints_.begin(), joints_.end(), kNone);
        std::fill(meshes_.begin(), meshes_.end(), kNone);
    }

    [[nodiscard]] bool are_all_kept() const {
        const auto is_same = [](const std::vector<std::uint32_t>& now) {
            return std::find(now.begin(), now.end(), kNone) == now.end();
        };
        return is_same(joints_) && is_same(meshes_) && is_same(materials_) && is_same(textures_) &&
               std::all_of(targets_.begin(), targets_.end(), is_same);
    }

    std::optional<std::uint32_t> operator()(Means thing, std::uint32_t number, std::uint32_t owner) const {
        switch (thing) {
            case Means::joint:
                return at(joints_, number);
            case Means::mesh:
                return at(meshes_, number);
            case Means::target_of_joint: {
                const auto mesh = at(carried_, owner);
                return mesh ? target_of(*mesh, number) : std::nullopt;
            }
            case Means::target_of_mesh:
                return target_of(owner, number);
            case Means::material:
            case Means::rows_of_materials:
                return at(materials_, number);
            case Means::texture:
            case Means::image:
                return at(textures_, number);
            case Means::element:
                break;
        }
        return std::nullopt;
    }

private:
    static std::optional<std::uint32_t> at(const std::vector<std::uint32_t>& now, std::uint32_t number) {
        return number < now.size() && now[number] != kNone ? std::optional(now[number]) : std::nullopt;
    }

    [[nodiscard]] std::optional<std::uint32_t> target_of(std::uint32_t mesh, std::uint32_t target) const {
        return at(meshes_, mesh) ? at(targets_[mesh], target) : std::nullopt;
    }

    std::vector<std::uint32_t> joints_, meshes_, materials_, textures_;
    std::vector<std::vector<std::uint32_t>> targets_;  ///< by mesh
    std::vector<std::uint32_t> carried_;               ///< by joint: the first of its meshes
};

class ExtensionUpdater {
public:
    ExtensionUpdater(const Source& source, Rewrite& rewrite, Log& log)
        : source_(source), rewrite_(rewrite), log_(log) {}

    void update(std::uint32_t container, Host host, const KeptNumbers& numbers) {
        if (rewrite_.is_removed(container)) return;
        const std::uint32_t chunk = source_.tree.find(container, FourCC("EXTN"));
        if (chunk == kNone || rewrite_.is_removed(chunk)) return;
        const auto made = extensions::renumber_extensions(as_text(source_.tree.payload(chunk)), host, numbers);
        if (!made) {
            log_.warnings.emplace_back("extensions are not a JSON object: numbers in them stay as they are");
            return;
        }
        gone_.insert(gone_.end(), made->gone.begin(), made->gone.end());
        unknown_.insert(made->unknown.begin(), made->unknown.end());
        if (made->json.empty()) {
            rewrite_.remove(chunk);
        } else {
            rewrite_.replace(chunk, as_byte_span(made->json));
        }
    }

    void tell() const {
        constexpr std::size_t kMost = 8;
        if (!gone_.empty()) {
            std::string list;
            for (std::size_t k = 0; k < std::min(gone_.size(), kMost); ++k) list += (k == 0 ? "" : ", ") + gone_[k];
            if (gone_.size() > kMost) list += " and " + std::to_string(gone_.size() - kMost) + " more";
            log_.warnings.push_back("removed from extensions, because the things that they name no longer exist: " +
                                    list);
        }
        for (const std::string& name : unknown_) {
            log_.warnings.push_back("the meaning of numbers in extension \"" + name +
                                    "\" is not known: they stay as they are, and may name other things now");
        }
    }

private:
    const Source& source_;
    Rewrite& rewrite_;
    Log& log_;
    std::vector<std::string> gone_;
    std::set<std::string> unknown_;
};

}  // namespace

void update_extensions(const Source& source, const Kept& kept, Rewrite& rewrite, Log& log) {
    // HEAD's extensions refer to the first object: glTF has only one.
    const KeptNumbers first(source, kept, 0);
    ExtensionUpdater updater(source, rewrite, log);
    bool is_changed = !first.are_all_kept();
    for (std::size_t k = 0; k < source.document.objects.size(); ++k) {
        const KeptNumbers numbers(source, kept, k);
        if (numbers.are_all_kept()) continue;
        is_changed = true;
        for (const JointView& joint : source.document.objects[k].skeleton.joints)
            updater.update(joint.chunk, Host::node, numbers);
    }
    if (!is_changed) return;
    for (const MaterialView& material : source.document.materials)
        updater.update(material.chunk, Host::material, first);
    updater.update(0, Host::root, first);
    updater.tell();
}

std::vector<std::uint32_t> texture_numbers(std::string_view json) {
    std::vector<std::uint32_t> numbers;
    const auto note = [&](Means thing, std::uint32_t number, std::uint32_t) {
        if (thing == Means::texture) numbers.push_back(number);
        return std::optional(number);
    };
    if (!json.empty()) (void)extensions::renumber_extensions(json, Host::material, note);
    return numbers;
}

}  // namespace bendy::edit
