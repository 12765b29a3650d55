#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/codec.h>
#include <bendy/format/file.h>

#include "format/edit_file.h"
#include "source_folder.h"

#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

// The good files that the mutation tests damage.
namespace bendy::test {

/// Files of tests/seeds and spec/examples, and one that is made here.
inline constexpr std::array kSeeds{
    "spec/examples/smallest",
    "spec/examples/one_joint",
    "spec/examples/unknown_chunks",
    "spec/examples/every_chunk",
    "tests/seeds/rope",
    "tests/seeds/rope_compact",
    "tests/seeds/rope_lod",
    "tests/seeds/rope_compact_lod",
    "tests/seeds/tangle",
    "tests/seeds/rope_rigged",
    "tests/seeds/rope_rigged_compact",
    "tests/seeds/plate",
    "tests/seeds/plate_compact",
    "tests/seeds/plate_lod",
    "tests/seeds/robot",
    "tests/seeds/robot_compact",
    "tests/seeds/long_exact",
    "tests/seeds/long_compact",
    "tests/seeds/chain_compact",
    "tests/seeds/two_objects",
    "every_codec",
};

/// The seed's name as a test's name may be.
inline std::string test_name(const std::string& seed) {
    return std::filesystem::path(seed).filename().string();
}

/// A leaf encoded with the first of these codecs that takes it.
inline void encode(Node& leaf, std::initializer_list<Codec> codecs, std::uint16_t head, std::uint16_t stride) {
    for (const Codec codec : codecs) {
        const auto encoded = encode_payload(codec, leaf.payload, head, stride);
        if (!encoded) continue;
        leaf.payload = *encoded;
        leaf.flags = static_cast<std::uint16_t>(leaf.flags | static_cast<unsigned>(codec) << 8);
        return;
    }
    throw std::invalid_argument(std::string("no codec takes ") + leaf.id.letters().data());
}

/// A strip of vertices with leaves of every codec.
inline Buffer every_codec() {
    constexpr std::uint32_t kVertices = 24;
    std::vector<float> positions;
    std::vector<std::uint16_t> weights;
    std::vector<std::uint8_t> bones;
    for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) {
        for (const float number : {0.25f * static_cast<float>(vertex / 2), static_cast<float>(vertex % 2), 0.0f})
            positions.push_back(number);
        const auto share = static_cast<std::uint16_t>(vertex * 2000);
        weights.insert(weights.end(), {static_cast<std::uint16_t>(65535 - share), share});
        bones.insert(bones.end(), {0, 1});
    }
    std::vector<std::uint32_t> corners;
    for (std::uint32_t vertex = 0; vertex + 3 < kVertices; vertex += 2)
        corners.insert(corners.end(), {vertex, vertex + 1, vertex + 2, vertex + 2, vertex + 1, vertex + 3});
    const auto triangles = canonical_triangles(corners).value();
    constexpr std::uint16_t kHead = sizeof(StreamRecord);

    Node root = sample();
    Node& object = child(root, "OBJE");
    Node& mesh = child(object, "VECT");
    Node made = make_container(FourCC("VECT"));
    made.children.push_back(make_leaf(FourCC("VINF"), bytes_of(MeshRecord{kVertices, kNone})));
    made.children.push_back(make_leaf(FourCC("POSI"), stream_payload<float>(3, positions)));
    encode(made.children.back(), {Codec::vertices}, kHead, 12);
    made.children.push_back(make_leaf(FourCC("NORM"), stream_payload<float>(3, positions)));
    encode(made.children.back(), {Codec::vertices_zstd}, kHead, 12);
    made.children.push_back(make_leaf(FourCC("TEXC"), stream_payload<std::uint16_t>(2, weights, true)));
    encode(made.children.back(), {Codec::zstd}, 0, 2);
    made.children.push_back(make_leaf(FourCC("BONE"), stream_payload<std::uint8_t>(2, bones)));
    encode(made.children.back(), {Codec::zstd}, 0, 0);
    made.children.push_back(make_leaf(FourCC("WGHT"), stream_payload<std::uint16_t>(2, weights, true)));
    encode(made.children.back(), {Codec::sums}, kHead, 4);
    made.children.push_back(child(mesh, "PALT"));
    made.children.push_back(make_leaf(FourCC("INDX"), stream_payload<std::uint32_t>(1, triangles)));
    encode(made.children.back(), {Codec::indices_zstd}, kHead, 4);
    // The targets, the collapse sequence and the clip were those of the mesh that this one replaces.
    mesh = made;
    remove(object, "LODD");
    remove(object, "CYCL");
    edit<VersionRecord>(child(root, "VERS"), [](VersionRecord& version) {
        version.vertices += kVertices - 4;
        version.clips = 0;
    });
    return to_file(root);
}

inline Buffer read_seed(const std::string& name) {
    if (name == "every_codec") return every_codec();
    const auto file = MappedFile::open(source_folder() / (name + ".bendy"));
    if (!file) throw std::runtime_error("no seed " + name);
    return {file->bytes().begin(), file->bytes().end()};
}

/// The same file with every leaf as it decodes, so that a field of an encoded leaf can be set.
inline Buffer without_codecs(const Buffer& file) {
    auto tree = read_chunk_tree(file);
    if (!tree) throw std::runtime_error(describe(tree.error()));
    decode_leaves(*tree);
    const auto plain = [&](const auto& self, std::uint32_t number) -> Node {
        Node node = to_node(*tree, number);
        if (tree->encoding_fault(number)) return node;  // a codec that nobody knows, of a chunk that nobody knows
        if (!node.is_container()) node.flags = static_cast<std::uint16_t>(node.flags & ~kCodecMask);
        std::size_t place = 0;
        for (const std::uint32_t child : tree->children(number)) node.children[place++] = self(self, child);
        return node;
    };
    return to_file(plain(plain, 0));
}

}  // namespace bendy::test
