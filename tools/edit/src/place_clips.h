#pragma once

#include "clip_tracks.h"
#include "renumber.h"
#include "rewrite.h"

#include <bendy/edit/edit.h>
#include <bendy/extensions/pointed_lists.h>
#include <bendy/format/document.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::edit {

/// For each of `there`, finds the one here with the same name; several of one name are paired in order. kNone: no
/// match.
std::vector<std::uint32_t> pair_names(std::span<const std::string_view> there, std::span<const std::string_view> here);

/// Two files, and the object there whose clips come here.
struct ClipFiles {
    Source here, there;
    std::size_t object = 0;  ///< there; here it is the first one

    [[nodiscard]] const ObjectView& to() const { return here.document.objects.front(); }
    [[nodiscard]] const ObjectView& from() const { return there.document.objects[object]; }
};

Result<ClipFiles, Problem> open_clip_files(Bytes file, Bytes other, Log& log);

/// Brings clips of one file into another.
class ClipPlacer {
public:
    /// \param joints, meshes  for each one there, the one here, or kNone: where curves go
    ClipPlacer(const ClipFiles& files, std::vector<std::uint32_t> joints, std::vector<std::uint32_t> meshes,
               SameName same_name, Log& log);

    /// Changes a clip for this file.
    Result<TrackCounts, Problem> change(const ClipView& clip, const TrackMap& map);
    void add_curve(const ClipView& clip, Bytes payload);
    /// Returns true if more than tracks is left of a clip that has been changed.
    [[nodiscard]] bool has_more(const ClipView& clip) const;
    [[nodiscard]] std::size_t curves(const ClipView& clip) const;

    struct Placed {
        std::string name;
        bool replaces = false;
    };
    /// Puts a clip that has been changed into this file.
    Result<Placed, Problem> put(const ClipView& clip);
    /// Returns the file. Its stated error becomes that of the clips too, if these are not exact.
    Edited finish();

private:
    void point_here(const CurveView& curve);
    void put_bound();

    const ClipFiles& files_;
    std::vector<std::uint32_t> joints_, meshes_, materials_, textures_;  // numbers here, by number there
    extensions::PointedLists lists_here_, lists_there_;
    NewNumbers numbers_;
    SameName same_name_;
    Log& log_;
    Rewrite rewrite_, sending_;
    std::set<std::string, std::less<>> taken_;
    std::map<std::string, std::uint32_t, std::less<>> places_;  // of the existing clips, by name
    std::map<std::string, unsigned, std::less<>> last_numbers_;
};

}  // namespace bendy::edit
