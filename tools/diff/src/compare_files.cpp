#include "compare_content.h"

#include <bendy/format/chunk_reader.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace bendy::diff {
namespace {

void add_stream(ReadFile& file, const StreamView& stream) {
    if (stream.chunk != 0) file.streams[stream.chunk] = &stream;
}

void add_stream(ReadFile& file, const std::optional<StreamView>& stream) {
    if (stream) add_stream(file, *stream);
}

/// Adds the streams of all frames.
/// \param frame  any of them
void add_frames(ReadFile& file, const MorphTargetView& frame) {
    add_stream(file, frame.places);
    for (const auto* stream : {&frame.positions, &frame.normals}) {
        if (!*stream) continue;
        StreamView& whole = *file.frames.emplace_back(std::make_unique<StreamView>(**stream));
        whole.data = file.tree.payload(whole.chunk).subspan(sizeof(StreamRecord));
        const std::size_t row = std::size_t{whole.components} * component_size(whole.type);
        whole.elements = static_cast<std::uint32_t>(whole.data.size() / row);
        whole.boxes = {};
        add_stream(file, whole);
    }
}

void add_streams(ReadFile& file, const MeshView& mesh) {
    add_stream(file, mesh.positions);
    for (const auto* stream : {&mesh.normals, &mesh.tangents, &mesh.bones, &mesh.weights, &mesh.indices})
        add_stream(file, *stream);
    for (const StreamView& stream : mesh.texture_coords) add_stream(file, stream);
    for (const StreamView& stream : mesh.colours) add_stream(file, stream);
    for (const AttributeView& attribute : mesh.attributes) add_stream(file, attribute.values);
    for (const MorphTargetView& target : mesh.targets) {
        if (target.is_frame()) break;
        for (const auto* stream : {&target.vertices, &target.positions, &target.normals, &target.tangents})
            add_stream(file, *stream);
    }
    if (mesh.frames() > 1) add_frames(file, mesh.targets.back());
}

/// Returns true for chunks whose index among their siblings is meaningful.
bool is_numbered(FourCC id) {
    constexpr std::array kNumbered{FourCC("TEXT"), FourCC("MATE"), FourCC("OBJE"), FourCC("SKIN"), FourCC("IKCH"),
                                   FourCC("VECT"), FourCC("TARG"), FourCC("CYCL"), FourCC("IMAG"), FourCC("LINK")};
    return std::find(kNumbered.begin(), kNumbered.end(), id) != kNumbered.end();
}

/// Reports pairs that come before another of the same id in B, but after it in A.
void compare_order(const ReadFile& a, const std::vector<ChunkPair>& pairs, Differences& differences) {
    std::map<std::uint32_t, std::uint32_t> latest;  // position in B, by id
    for (const ChunkPair& pair : pairs) {
        if (pair.a == kNone || pair.b == kNone || !is_numbered(a.tree[pair.a].id)) continue;
        std::uint32_t& last = latest.try_emplace(a.tree[pair.a].id.value, 0).first->second;
        if (pair.b < last) {
            Difference difference;
            difference.kind = Difference::Kind::order;
            difference.chunks = pair;
            differences.add(std::move(difference));
        }
        last = std::max(last, pair.b);
    }
}

/// Returns true for chunks that are covered when the tracks of their clip are compared: all ways of storing tracks.
bool is_of_tracks(FourCC id) {
    return id == FourCC("TRAK") || id == FourCC("PACK") || id == FourCC("TIME") || id == FourCC("KEYV");
}

/// Adds ordinary tracks to packed clips, beside those that they have.
void add_unpacked(ReadFile& file) {
    struct Place {
        std::size_t object, clip, tracks;
    };
    std::vector<Place> places;
    for (std::size_t o = 0; o < file.document.objects.size(); ++o) {
        const ObjectView& object = file.document.objects[o];
        std::vector<RestRecord> rests;
        for (const JointView& joint : object.skeleton.joints) rests.push_back(joint.rest);
        for (std::size_t c = 0; c < object.clips.size(); ++c) {
            if (!object.clips[c].packed) continue;
            std::vector<UnpackedTrack> tracks = unpack_clip(*object.clips[c].packed, rests);
            places.push_back({o, c, tracks.size()});
            std::move(tracks.begin(), tracks.end(), std::back_inserter(file.unpacked));
        }
    }
    std::size_t next = 0;
    for (const Place& place : places) {
        ClipView& clip = file.document.objects[place.object].clips[place.clip];
        for (std::size_t k = 0; k < place.tracks; ++k) {
            const UnpackedTrack& track = file.unpacked[next++];
            clip.tracks.push_back({track.path, Interpolation::linear, track.joint, track.components,
                                   static_cast<std::uint32_t>(track.times.size()), track.times, track.values});
        }
    }
}

}  // namespace

std::unique_ptr<ReadFile> read_file(Bytes bytes) {
    auto file = std::make_unique<ReadFile>();
    file->tree = *read_chunk_tree(bytes);
    decode_leaves(file->tree);
    Faults faults;
    file->document = read_document(file->tree, faults);
    add_unpacked(*file);
    file->streams.resize(file->tree.chunks().size());
    file->clips.resize(file->tree.chunks().size());
    file->objects.resize(file->tree.chunks().size());
    for (const ObjectView& object : file->document.objects) {
        file->objects[object.chunk] = &object;
        for (const MeshView& mesh : object.meshes) add_streams(*file, mesh);
        for (const ClipView& clip : object.clips) file->clips[clip.chunk] = &clip;
    }
    return file;
}

Differences compare_files(const ReadFile& a, const ReadFile& b) {
    Differences differences;
    ContentComparer content(a, b, differences);
    std::vector<ChunkPair> open{{0, 0}};
    while (!open.empty()) {
        const ChunkPair pair = open.back();
        open.pop_back();
        if (pair.a == kNone || pair.b == kNone) {
            Difference difference;
            difference.kind = pair.b == kNone ? Difference::Kind::only_in_a : Difference::Kind::only_in_b;
            difference.chunks = pair;
            differences.add(std::move(difference));
            continue;
        }
        if (have_equal_sums(a.tree, pair.a, b.tree, pair.b)) continue;
        if (!a.tree[pair.a].is_container() && !b.tree[pair.b].is_container()) {
            content.compare_leaves(pair);
            continue;
        }
        if (a.tree[pair.a].is_container() != b.tree[pair.b].is_container()) {  // an unknown id
            open.push_back({kNone, pair.b});
            open.push_back({pair.a, kNone});
            continue;
        }
        const bool is_clip = a.clips[pair.a] != nullptr && b.clips[pair.b] != nullptr;
        if (is_clip) content.compare_clips(pair);
        std::vector<ChunkPair> children = pair_children(a.tree, pair.a, b.tree, pair.b);
        compare_order(a, children, differences);
        std::reverse(children.begin(), children.end());  // the last one on the stack is processed first
        for (const ChunkPair& child : children) {
            const FourCC id = child.a != kNone ? a.tree[child.a].id : b.tree[child.b].id;
            if (!(is_clip && is_of_tracks(id))) open.push_back(child);
        }
    }
    return differences;
}

}  // namespace bendy::diff
