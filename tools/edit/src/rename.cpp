#include <bendy/edit/edit.h>

#include "rewrite.h"

#include <bendy/extensions/rename_materials.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace bendy::edit {
namespace {

constexpr std::array<std::string_view, 8> kKinds{"joint",  "clip",     "chain",   "mesh",
                                                 "target", "material", "texture", "object"};

std::string_view kind_of(Named kind) {
    return kKinds[static_cast<std::size_t>(kind)];
}

struct Thing {
    std::string_view name;
    std::uint32_t chunk = 0;  // that contains, or could contain, the NAME
    std::size_t group = 0;    // things of one object, whose names should differ
};

class Renamer {
public:
    Renamer(const Source& source, const Rename& what, Log& log)
        : source_(source), what_(what), log_(log), rewrite_(source.tree) {
        find_things();
        for (std::size_t k = 0; k < what.names.size(); ++k) {
            const std::string& before = what.names[k].first;
            note_key(before, k);
            if (!before.starts_with('=') && before.find('*') != std::string::npos) patterns_.push_back(k);
        }
    }

    Edited rename() {
        if (ambiguous_ != nullptr) return not_found(*ambiguous_);
        std::vector<std::string> names;
        std::vector<std::size_t> uses(what_.names.size());
        std::size_t changed = 0;
        for (const Thing& thing : things_) {
            names.emplace_back(thing.name);
            const std::size_t pair = find_pair(thing.name, names.size() - 1);
            if (pair == what_.names.size()) continue;
            ++uses[pair];
            std::string name = renamed(what_.names[pair], thing.name).value_or(what_.names[pair].second);
            if (const auto wrong = check(thing.name, name)) return *wrong;
            changed += name != thing.name ? 1 : 0;
            names.back() = std::move(name);
        }
        std::vector<std::size_t> unused;
        for (std::size_t k = 0; k < uses.size(); ++k) {
            if (uses[k] == 0) unused.push_back(k);
        }
        if (!unused.empty() && what_.all_must_match) return not_found(what_.names[unused.front()].first);
        if (!unused.empty()) {
            std::vector<std::string_view> wanted;
            for (const auto& pair : what_.names) wanted.push_back(pair.first);
            log_.warnings.push_back("no " + std::string(kind_of(what_.kind)) + " is called " +
                                    list_names(wanted, unused));
        }
        warn_of_duplicates(names);
        put(names);
        if (what_.kind == Named::material) put_in_extensions(names);
        log_.done.push_back("renamed " + std::to_string(changed) + ' ' + std::string(kind_of(what_.kind)) +
                            (changed == 1                ? ""
                             : what_.kind == Named::mesh ? "es"
                                                         : "s"));
        return finish(rewrite_);
    }

private:
    /// Returns the first pair that matches a thing; the number of pairs if none does.
    [[nodiscard]] std::size_t find_pair(std::string_view name, std::size_t number) const {
        std::size_t first = what_.names.size();
        if (const auto numbered = numbered_.find(number); numbered != numbered_.end()) first = numbered->second;
        if (name.empty()) return first;
        if (const auto exact = exact_.find(name); exact != exact_.end()) first = std::min(first, exact->second);
        for (const std::size_t k : patterns_) {
            if (k > first) break;
            if (renamed(what_.names[k], name)) return k;
        }
        return first;
    }

    /// Notes which name and which number a pair is for. A text that may be either is the name if something has that
    /// name.
    void note_key(const std::string& before, std::size_t pair) {
        const ThingKey key = read_key(before);
        const bool is_number = key.number && *key.number < things_.size();
        if (is_number && called_.empty()) {
            for (std::size_t k = 0; k < things_.size(); ++k) called_[things_[k].name].push_back(k);
        }
        const auto named = is_number && key.name ? called_.find(*key.name) : called_.end();
        if (named != called_.end() && named->second != std::vector{*key.number}) ambiguous_ = &before;
        if (key.name) exact_.try_emplace(*key.name, pair);
        if (is_number && named == called_.end()) numbered_.try_emplace(*key.number, pair);
    }

    void find_things() {
        const Document& document = source_.document;
        const auto add = [&](std::string_view name, std::uint32_t chunk, std::size_t group) {
            things_.push_back({name, chunk, group});
        };
        if (what_.kind == Named::texture) {
            for (const TextureView& texture : document.textures) add(texture.name, texture.chunk, 0);
        }
        if (what_.kind == Named::material) {
            for (const MaterialView& material : document.materials) add(material.name, material.chunk, 0);
        }
        std::size_t meshes = 0;
        for (std::size_t o = 0; o < document.objects.size(); ++o) {
            const ObjectView& object = document.objects[o];
            if (what_.kind == Named::object) add(object.name, object.chunk, 0);
            if (what_.kind == Named::joint) {
                for (const JointView& joint : object.skeleton.joints) add(joint.name, joint.chunk, o);
            }
            if (what_.kind == Named::clip) {
                for (const ClipView& clip : object.clips) add(clip.name, clip.chunk, o);
            }
            if (what_.kind == Named::chain) {
                for (const ChainView& chain : object.chains) add(chain.name, chain.chunk, o);
            }
            for (const MeshView& mesh : object.meshes) {
                if (what_.kind == Named::mesh) add(mesh.name, mesh.chunk, o);
                if (what_.kind == Named::target) add_targets(mesh, meshes);
                ++meshes;
            }
        }
    }

    void add_targets(const MeshView& mesh, std::size_t group) {
        std::size_t target = 0;
        for (const std::uint32_t child : source_.tree.children(mesh.chunk)) {
            if (!(source_.tree[child].id == FourCC("TARG"))) continue;
            things_.push_back({mesh.targets[target++].name, child, group});
        }
        for (; target < mesh.targets.size(); ++target)
            things_.push_back({mesh.targets[target].name, mesh.targets[target].chunk, group});
    }

    [[nodiscard]] static std::optional<Problem> check(std::string_view before, const std::string& after) {
        const std::string what = "the new name of \"" + std::string(before) + '"';
        if (after.empty()) return Problem{what + " would be empty"};
        if (!is_utf8(after)) return Problem{what + " is not UTF-8"};
        if (after.find('\0') != std::string::npos) return Problem{what + " has a zero in it"};
        return std::nullopt;
    }

    /// Explains a text that matches nothing, is ambiguous, or was already renamed by another pair.
    [[nodiscard]] Problem not_found(const std::string& wanted) const {
        std::vector<std::string_view> names;
        for (const Thing& thing : things_) names.push_back(thing.name);
        if (wanted.find('*') != std::string::npos)
            return {"no " + std::string(kind_of(what_.kind)) + " is called like \"" + wanted + '"'};
        const auto found = find_all_by_key(names, wanted, kind_of(what_.kind));
        if (!found) return {found.error().message};
        return {'"' + wanted + "\" is left over: an earlier name or pattern of the same renaming takes " +
                list_names(names, *found)};
    }

    /// Warns about things that now share a name; lists some of the names if there are many.
    void warn_of_duplicates(const std::vector<std::string>& names) {
        constexpr std::size_t kMostTold = 4;
        std::map<std::pair<std::size_t, std::string_view>, std::size_t> seen;
        std::size_t duplicates = 0;
        for (std::size_t k = 0; k < names.size(); ++k) {
            const auto [first, is_new] = seen.try_emplace({things_[k].group, names[k]}, k);
            const bool were_duplicates = things_[k].name == things_[first->second].name;
            if (is_new || names[k].empty() || were_duplicates || ++duplicates > kMostTold) continue;
            log_.warnings.push_back("two " + plural() + " are called \"" + names[k] + "\" now: \"" +
                                    std::string(things_[first->second].name) + "\" and \"" +
                                    std::string(things_[k].name) + '"');
        }
        if (duplicates > kMostTold) {
            log_.warnings.push_back(std::to_string(duplicates - kMostTold) + " more " + plural() +
                                    " have another one's name now");
        }
    }

    [[nodiscard]] std::string plural() const {
        return std::string(kind_of(what_.kind)) + (what_.kind == Named::mesh ? "es" : "s");
    }

    void put(const std::vector<std::string>& names) {
        std::size_t next = 0;
        for (const ObjectView& object : source_.document.objects) {
            const std::uint32_t table = source_.tree.find(object.chunk, FourCC("JNAM"));
            if (what_.kind == Named::joint && table != kNone)
                put_table(table, object.skeleton, std::span(names).subspan(next, object.skeleton.joints.size()));
            next += what_.kind == Named::joint ? object.skeleton.joints.size() : 0;
        }
        for (std::size_t k = 0; k < names.size(); ++k) {
            if (is_frame(things_[k])) {
                k = put_frames(names, k);
                continue;
            }
            if (names[k] == things_[k].name) continue;
            const std::uint32_t chunk = source_.tree.find(things_[k].chunk, FourCC("NAME"));
            if (chunk != kNone && as_text(source_.tree.payload(chunk)) == things_[k].name) {
                rewrite_.replace(chunk, as_byte_span(names[k]));
            } else if (chunk == kNone && !is_in_table(things_[k])) {
                rewrite_.prepend(things_[k].chunk, whole_leaf(FourCC("NAME"), as_byte_span(names[k])));
            }
        }
    }

    /// Puts the new names of materials into the extensions that say them; not that of several of which some keep it.
    void put_in_extensions(const std::vector<std::string>& names) {
        std::map<std::string, std::string, std::less<>> now;
        std::set<std::string_view> unclear;
        for (std::size_t k = 0; k < names.size(); ++k) {
            if (k >= source_.document.global_materials) break;  // those of joints come after those of HEAD
            const auto [known, is_new] = now.try_emplace(std::string(things_[k].name), names[k]);
            if (!is_new && known->second != names[k]) unclear.insert(things_[k].name);
        }
        std::erase_if(now, [&](const auto& pair) { return pair.first == pair.second || unclear.contains(pair.first); });
        const std::uint32_t chunk = source_.tree.find(0, FourCC("EXTN"));
        if (chunk == kNone) return;
        const auto text = extensions::rename_materials(as_text(source_.tree.payload(chunk)), now);
        if (text) rewrite_.replace(chunk, as_byte_span(*text));
    }

    [[nodiscard]] bool is_frame(const Thing& thing) const {
        return what_.kind == Named::target && source_.tree[thing.chunk].id == FourCC("FRMS");
    }

    /// Changes the FNAM of the frames that begin with thing `first`.
    /// \return the number of the last one
    std::size_t put_frames(const std::vector<std::string>& names, std::size_t first) {
        std::string text;
        bool is_changed = false;
        std::size_t k = first;
        for (; k < names.size() && things_[k].chunk == things_[first].chunk; ++k) {
            is_changed = is_changed || names[k] != things_[k].name;
            text += names[k];
            text += '\0';
        }
        const std::uint32_t frames = things_[first].chunk;
        const std::uint32_t chunk = source_.tree.find(frames, FourCC("FNAM"));
        if (is_changed && chunk != kNone) rewrite_.replace(chunk, as_byte_span(text));
        if (is_changed && chunk == kNone) rewrite_.prepend(frames, whole_leaf(FourCC("FNAM"), as_byte_span(text)));
        return k - 1;
    }

    [[nodiscard]] bool is_in_table(const Thing& thing) const {
        return what_.kind == Named::joint &&
               source_.tree.find(source_.document.objects[thing.group].chunk, FourCC("JNAM")) != kNone;
    }

    /// Changes JNAM: its own names, wherever they equal the joints' names.
    void put_table(std::uint32_t chunk, const SkeletonView& skeleton, std::span<const std::string> names) {
        std::string_view before = as_text(source_.tree.payload(chunk));
        std::string after;
        for (std::size_t j = 0; j < names.size(); ++j) {
            const std::size_t end = before.find('\0');
            const std::string_view own = before.substr(0, end);
            const std::uint32_t name = source_.tree.find(skeleton.joints[j].chunk, FourCC("NAME"));
            const bool is_used = name == kNone || source_.tree.payload(name).empty();
            after += is_used ? std::string_view(names[j]) : own;
            after += '\0';
            before.remove_prefix(end + 1);
        }
        rewrite_.replace(chunk, as_byte_span(after));
    }

    const Source& source_;
    const Rename& what_;
    Log& log_;
    Rewrite rewrite_;
    std::vector<Thing> things_;
    std::map<std::string_view, std::size_t> exact_;                // pairs by their first names
    std::map<std::string_view, std::vector<std::size_t>> called_;  // things by name, built when a number first needs it
    std::map<std::size_t, std::size_t> numbered_;                  // pairs by the numbers that they mean
    std::vector<std::size_t> patterns_;                            // pairs with a `*`
    const std::string* ambiguous_ = nullptr;                       // the name of one thing and the number of another
};

}  // namespace

Result<std::pair<std::string, std::string>, Problem> parse_pair(std::string_view text) {
    const std::size_t sign = text.find('=', text.starts_with('=') ? 2 : 1);
    if (sign == std::string_view::npos) return Problem{"\"" + std::string(text) + "\" is not OLD=NEW"};
    const std::pair pair(std::string(text.substr(0, sign)), std::string(text.substr(sign + 1)));
    for (const std::string& name : {pair.first, pair.second}) {
        if (std::count(name.begin(), name.end(), '*') > 1) return Problem{"\"" + name + "\" has more than one *"};
    }
    if (pair.second.empty()) return Problem{"\"" + std::string(text) + "\" has no new name"};
    return pair;
}

Result<Named, Problem> parse_named(std::string_view word) {
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
        if (word == kKinds[k]) return static_cast<Named>(k);
    }
    std::string all;
    for (const std::string_view kind : kKinds) all += (all.empty() ? "" : ", ") + std::string(kind);
    return Problem{"\"" + std::string(word) + "\" has no names to change: one of " + all};
}

Edited rename(Bytes file, const Rename& what, Log& log) {
    const auto source = open_source(file);
    if (!source) return source.error();
    return Renamer(*source, what, log).rename();
}

}  // namespace bendy::edit
