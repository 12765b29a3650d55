#include <bendy/edit/edit.h>

#include "keep_only.h"
#include "rewrite.h"

#include <bendy/format/chunk_reader.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace bendy::edit {
namespace {

struct Word {
    Part part;
    std::string_view one;  // the singular, which takes a name; empty: the part has none
    std::string_view many;
};
constexpr std::array kWords{Word{Part::textures, "texture", "textures"},
                            Word{Part::materials, "material", "materials"},
                            Word{Part::meshes, "mesh", "meshes"},
                            Word{Part::targets, "target", "targets"},
                            Word{Part::clips, "clip", "clips"},
                            Word{Part::markers, "", "markers"},
                            Word{Part::chains, "chain", "chains"},
                            Word{Part::roles, "", "roles"},
                            Word{Part::standing_pose, "", "standing-pose"},
                            Word{Part::constraints, "constraint", "constraints"},
                            Word{Part::lod, "", "lod"},
                            Word{Part::tangents, "", "tangents"},
                            Word{Part::colours, "", "colours"},
                            Word{Part::attributes, "", "attributes"},
                            Word{Part::extras, "", "extras"},
                            Word{Part::extensions, "", "extensions"},
                            Word{Part::unknown, "chunk", "unknown"}};

const Word& word_of(Part part) {
    return *std::find_if(kWords.begin(), kWords.end(), [&](const Word& word) { return word.part == part; });
}

/// Things of one kind, in all objects, by name.
struct Things {
    std::vector<std::string_view> names;
    std::vector<std::vector<bool>::reference> stay;

    void add(std::string_view name, std::vector<bool>::reference stays) {
        names.push_back(name);
        stay.push_back(stays);
    }
};

class Stripper {
public:
    Stripper(const Source& source, const Strip& what, Log& log)
        : source_(source), what_(what), log_(log), rewrite_(source.tree), kept_(everything(source.document)) {}

    Edited strip() {
        const auto done = strip_part();
        if (!done) return done.error();
        if (const auto updated = keep_only(source_, kept_, rewrite_, log_); !updated) return updated.error();
        return finish(rewrite_);
    }

private:
    Result<void, Problem> strip_part() {
        switch (what_.part) {
            case Part::textures:
                return strip_textures();
            case Part::materials:
                return strip_materials();
            case Part::meshes:
                return strip_meshes();
            case Part::targets:
                return strip_targets();
            case Part::clips:
                return strip_clips();
            case Part::chains:
                return strip_chains();
            case Part::constraints:
                return strip_constraints();
            case Part::unknown:
                return strip_unknown();
            case Part::markers:
                return strip_leaves(FourCC("MARK"));
            case Part::roles:
                return strip_leaves(FourCC("ROLE"));
            case Part::standing_pose:
                return strip_leaves(FourCC("STND"));
            case Part::lod:
                return strip_leaves(FourCC("LODD"));
            case Part::tangents:
                return strip_leaves(FourCC("TANG"));
            case Part::colours:
                return strip_leaves(FourCC("COLR"));
            case Part::attributes:
                return strip_leaves(FourCC("USER"));
            case Part::extras:
                return strip_leaves(FourCC("EXTR"), FourCC("MORE"));
            case Part::extensions:
                return strip_leaves(FourCC("EXTN"));
        }
        return {};
    }

    void tell(std::size_t count) {
        const Word& word = word_of(what_.part);
        if (count == 0) {
            log_.done.push_back("nothing to strip: " + std::string(word.many));
            return;
        }
        const std::string_view noun = word.one.empty() || count != 1 ? word.many : word.one;
        log_.done.push_back("stripped " + std::to_string(count) + ' ' + std::string(noun) +
                            (what_.name.empty() ? "" : " \"" + what_.name + '"'));
    }

    /// Returns the numbers of those that are removed.
    Result<std::vector<std::size_t>, Problem> choose(std::span<const std::string_view> names) {
        std::vector<std::size_t> all;
        if (!what_.name.empty()) {
            auto found = find_named(names, what_.name, word_of(what_.part).one);
            if (found) tell(found->size());
            return found;
        }
        for (std::size_t k = 0; k < names.size(); ++k) all.push_back(k);
        tell(all.size());
        return all;
    }

    Result<void, Problem> extract(Things things) {
        const auto chosen = choose(things.names);
        if (!chosen) return chosen.error();
        for (const std::size_t k : *chosen) things.stay[k] = false;
        return {};
    }

    Result<void, Problem> strip_textures() {
        Things things;
        for (std::size_t t = 0; t < kept_.textures.size(); ++t)
            things.add(source_.document.textures[t].name, kept_.textures[t]);
        return extract(std::move(things));
    }

    Result<void, Problem> strip_materials() {
        Things things;
        for (std::size_t m = 0; m < kept_.materials.size(); ++m)
            things.add(source_.document.materials[m].name, kept_.materials[m]);
        if (what_.name.empty()) kept_.local_materials = false;
        return extract(std::move(things));
    }

    /// Calls visit(object, the parts of it that stay).
    template <class Visit>
    void each_object(const Visit& visit) {
        for (std::size_t k = 0; k < kept_.objects.size(); ++k) visit(source_.document.objects[k], kept_.objects[k]);
    }

    Result<void, Problem> strip_meshes() {
        std::vector<std::string_view> names;
        std::vector<Kept::Mesh*> meshes;
        each_object([&](const ObjectView& object, Kept::Object& here) {
            for (std::size_t p = 0; p < object.meshes.size(); ++p) {
                names.push_back(object.meshes[p].name);
                meshes.push_back(&here.meshes[p]);
            }
        });
        const auto chosen = choose(names);
        if (!chosen) return chosen.error();
        for (const std::size_t k : *chosen) meshes[k]->stays = false;
        return {};
    }

    Result<void, Problem> strip_targets() {
        Things things;
        each_object([&](const ObjectView& object, Kept::Object& here) {
            for (std::size_t p = 0; p < object.meshes.size(); ++p) {
                for (std::size_t t = 0; t < object.meshes[p].targets.size(); ++t)
                    things.add(object.meshes[p].targets[t].name, here.meshes[p].targets[t]);
            }
        });
        if (auto done = extract(std::move(things)); !done) return done;
        for (std::size_t k = 0; k < kept_.objects.size(); ++k) {
            const ObjectView& object = source_.document.objects[k];
            for (std::size_t p = 0; p < object.meshes.size(); ++p) {
                if (const auto split = find_split_frames(object.meshes[p], kept_.objects[k].meshes[p])) return *split;
            }
        }
        return {};
    }

    /// Frames are one block, and clips refer to them by number.
    static std::optional<Problem> find_split_frames(const MeshView& mesh, const Kept::Mesh& here) {
        const auto first = here.targets.begin() + static_cast<std::ptrdiff_t>(mesh.first_frame);
        const auto gone = std::find(first, here.targets.end(), false);
        if (gone == here.targets.end() || std::find(first, here.targets.end(), true) == here.targets.end())
            return std::nullopt;
        return Problem{"target \"" +
                       std::string(mesh.targets[static_cast<std::size_t>(gone - here.targets.begin())].name) +
                       "\" is one of " + std::to_string(here.targets.end() - first) + " frames of mesh \"" +
                       std::string(mesh.name) + "\": they can only be stripped together, with all targets"};
    }

    Result<void, Problem> strip_clips() {
        Things things;
        each_object([&](const ObjectView& object, Kept::Object& here) {
            for (std::size_t k = 0; k < object.clips.size(); ++k) things.add(object.clips[k].name, here.clips[k]);
        });
        return extract(std::move(things));
    }

    Result<void, Problem> strip_chains() {
        Things things;
        each_object([&](const ObjectView& object, Kept::Object& here) {
            for (std::size_t k = 0; k < object.chains.size(); ++k) things.add(object.chains[k].name, here.chains[k]);
        });
        return extract(std::move(things));
    }

    /// Selects by the names of the joints.
    Result<void, Problem> strip_constraints() {
        std::vector<std::string_view> names;
        std::vector<std::uint32_t> chunks;
        for (const ObjectView& object : source_.document.objects) {
            for (const ConstraintView& constraint : object.skeleton.constraints) {
                names.push_back(object.skeleton.joints[constraint.joint].name);
                chunks.push_back(constraint.chunk);
            }
        }
        const auto chosen = choose(names);
        if (!chosen) return chosen.error();
        for (const std::size_t k : *chosen) rewrite_.remove(chunks[k]);
        return {};
    }

    /// Calls visit(chunk) for all chunks in known containers; if it returns false, the content of the chunk is skipped.
    template <class Visit>
    void walk(const Visit& visit) {
        for (std::uint32_t number = 1; number < source_.tree.chunks().size();) {
            const Chunk& chunk = source_.tree[number];
            number = visit(number, chunk) && is_known(chunk.id) ? number + 1 : chunk.end;
        }
    }

    Result<void, Problem> strip_leaves(FourCC id) { return strip_leaves(id, id); }

    Result<void, Problem> strip_leaves(FourCC id, FourCC other) {
        std::size_t count = 0;
        walk([&](std::uint32_t number, const Chunk& chunk) {
            if (!(chunk.id == id || chunk.id == other)) return true;
            rewrite_.remove(number);
            ++count;
            return false;
        });
        tell(count);
        return {};
    }

    Result<void, Problem> strip_unknown() {
        std::vector<std::string> ids;
        std::vector<std::uint32_t> chunks;
        walk([&](std::uint32_t number, const Chunk& chunk) {
            if (is_known(chunk.id)) return true;
            ids.emplace_back(chunk.id.letters().data(), 4);
            chunks.push_back(number);
            return false;
        });
        const std::vector<std::string_view> names(ids.begin(), ids.end());
        const auto chosen = choose(names);
        if (!chosen) return chosen.error();
        for (const std::size_t k : *chosen) rewrite_.remove(chunks[k]);
        return {};
    }

    const Source& source_;
    const Strip& what_;
    Log& log_;
    Rewrite rewrite_;
    Kept kept_;
};

}  // namespace

std::string strip_words() {
    std::string words;
    for (const Word& word : kWords) words += (words.empty() ? "" : ", ") + std::string(word.many);
    return words;
}

Result<Strip, Problem> parse_strip(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string_view asked = text.substr(0, colon);
    const bool is_named = colon != std::string_view::npos;
    std::vector<std::string_view> words;
    for (const Word& word : kWords) {
        words.push_back(word.many);
        if (asked != word.one && asked != word.many) continue;
        if (is_named && word.one.empty()) return Problem{"\"" + std::string(word.many) + "\" takes no name"};
        if (is_named && colon + 1 == text.size())
            return Problem{"a name is missing behind \"" + std::string(text) + '"'};
        if (!is_named && asked == word.one) {
            return Problem{"\"" + std::string(word.one) + "\" wants a name: " + std::string(word.one) +
                           ":NAME; all of them: " + std::string(word.many)};
        }
        return Strip{word.part, std::string(is_named ? text.substr(colon + 1) : "")};
    }
    const std::string suggestion = did_you_mean(words, asked);
    return Problem{"\"" + std::string(asked) + "\" cannot be stripped" +
                   (suggestion.empty() ? ": one of " + strip_words() : suggestion)};
}

Edited strip(Bytes file, const Strip& what, Log& log) {
    const auto source = open_source(file);
    if (!source) return source.error();
    return Stripper(*source, what, log).strip();
}

}  // namespace bendy::edit
