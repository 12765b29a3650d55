// Good files with something broken in them: whatever it is, it is noticed, or it is harmless.
#include <bendy/format/document.h>

#include "edit_file.h"
#include "mutation/allocations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace bendy::damage_test {
namespace {

using namespace test;

/// The sum of all numbers of a stream, in its own type or as glTF reads it.
double sum_of(const StreamView& stream) {
    double sum = 0.0;
    for (std::uint32_t element = 0; element < stream.elements; ++element) {
        for (std::uint32_t component = 0; component < stream.components; ++component) {
            sum += double{stream.number(element, component)} + stream.index(element, component);
        }
    }
    return sum;
}

double sum_of(const std::optional<StreamView>& stream) {
    return stream ? sum_of(*stream) : 0.0;
}

/// Reads everything that a document without faults promises can be read, so that a sanitizer sees it.
double read_everything(const ChunkTree& tree, const Document& document) {
    double sum = 0.0;
    const auto look_at = [&](std::string_view text) {
        for (const char letter : text) sum += letter;
    };
    look_at(document.extensions);
    for (const TextureView& texture : document.textures) {
        look_at(texture.name);
        for (const ImageView& image : texture.images) {
            look_at(image.uri);
            look_at(as_text(image.bytes));
            if (image.same) look_at(document.textures[image.same->texture].images[image.same->image].uri);
        }
    }
    for (const MaterialView& material : document.materials) {
        look_at(material.extensions);
        const std::uint32_t texture = material.surface.base_colour_texture.texture;
        if (texture != kNone) look_at(document.textures[texture].name);
    }
    for (const ObjectView& object : document.objects) {
        const auto& joints = object.skeleton.joints;
        for (std::uint32_t joint = 0; joint < joints.size(); ++joint) {
            look_at(joints[joint].name);
            const std::uint32_t parent = joints[joint].parent;
            EXPECT_TRUE(parent == kNone || parent < joint);
        }
        for (const JointView& joint : joints) look_at(joint.extensions);
        for (const ConstraintView& constraint : object.skeleton.constraints) {
            sum += joints[constraint.joint].rest.scale[0];
            EXPECT_LT(constraint.record.model, kConstraintModels);
            EXPECT_LT(constraint.record.euler_order, kEulerOrders);
            EXPECT_LT(constraint.record.scope, kConstraintScopes);
        }
        for (const ChainView& chain : object.chains) {
            look_at(chain.name);
            look_at(chain.extras);
            EXPECT_LT(chain.record.solver, kSolvers);
            for (const std::uint32_t joint : {chain.record.target, chain.record.pole})
                sum += joint == kNone ? 0.0f : joints[joint].rest.scale[0];
            std::uint32_t link = chain.record.effector;
            while (link != chain.record.start) link = joints[link].parent;  // ends at start, never past a root
        }
        for (const ChainWeightView& chain_weight : object.skeleton.chain_weights) {
            const ChainRecord& chain = object.chains[chain_weight.chain].record;
            std::uint32_t link = chain.effector;
            while (link != chain_weight.joint && link != chain.start) link = joints[link].parent;
            EXPECT_EQ(link, chain_weight.joint);
        }
        for (const MeshView& mesh : object.meshes) {
            if (mesh.joint != kNone) sum += joints[mesh.joint].rest.scale[0];
            sum += sum_of(mesh.positions) + sum_of(mesh.normals) + sum_of(mesh.tangents) + sum_of(mesh.weights);
            for (const StreamView& stream : mesh.texture_coords) sum += sum_of(stream);
            for (const StreamView& stream : mesh.colours) sum += sum_of(stream);
            for (const AttributeView& attribute : mesh.attributes) sum += sum_of(attribute.values);
            for (std::uint32_t vertex = 0; mesh.bones && vertex < mesh.vertices; ++vertex) {
                for (std::uint32_t k = 0; k < mesh.bones->components; ++k) {
                    const std::uint32_t bone = mesh.bones->index(vertex, k);
                    sum += joints[mesh.palette.joints[bone]].rest.scale[1] +
                           mesh.palette.inverse_bind()[bone][3][1] * mesh.weights->number(vertex, k);
                }
            }
            for (const MorphTargetView& target : mesh.targets) {
                const std::uint32_t touched = target.vertices ? target.vertices->elements : mesh.vertices;
                for (std::uint32_t entry = 0; entry < touched; ++entry) {
                    const std::uint32_t vertex = target.vertices ? target.vertices->index(entry, 0) : entry;
                    sum += mesh.positions.number(vertex, 0);
                    for (const auto& stream : {target.positions, target.normals, target.tangents})
                        sum += stream ? stream->number(entry, 2) : 0.0f;
                }
            }
        }
        for (const SubmeshView& submesh : object.skeleton.submeshes) {
            const MeshView& mesh = object.meshes[submesh.mesh];
            sum += joints[submesh.joint].rest.scale[2];
            if (submesh.material != kNone) look_at(document.materials[submesh.material].name);
            for (std::uint32_t k = 0; k < submesh.count; ++k)
                sum += mesh.positions.number(mesh.indices->index(submesh.first + k, 0), 2);
        }
        for (const ClipView& clip : object.clips) {
            look_at(clip.name);
            for (const TrackView& track : clip.tracks) {
                const std::uint32_t values =
                    track.keys * track.components * (track.interpolation == Interpolation::cubic ? 3 : 1);
                EXPECT_EQ(track.values.size(), values);
                EXPECT_TRUE(track.times.empty() || track.times.size() == track.keys);
                if (track.path == TrackPath::weights) {
                    EXPECT_EQ(object.meshes[track.target].targets.size(), track.components);
                } else {
                    sum += joints[track.target].rest.scale[0];
                }
                for (const float value : track.values) sum += value;
                for (const float time : track.times) sum += time;
            }
        }
    }
    for (std::uint32_t number = 0; number < tree.chunks().size(); ++number) look_at(as_text(tree.payload(number)));
    return sum;
}

/// Validates, reads and, if nothing is wrong in shape, reads everything; nothing may allocate out of proportion.
void expect_harmless(const Buffer& file) {
    restart_count();
    const Faults faults = validate(file);
    const auto tree = read_chunk_tree(file);
    if (tree) {
        Faults shape;
        const Document document = read_document(*tree, shape);
        if (shape.empty()) {
            [[maybe_unused]] volatile const double sum = read_everything(*tree, document);
        }
    } else {
        EXPECT_EQ(faults.list().size(), 1u);
    }
    EXPECT_LE(allocations().largest, 16 * file.size() + sizeof(Error) * 2 * Faults::kMost);
}

TEST(Damage, EveryPrefixIsRefused) {
    const Buffer whole = sample_file();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const Buffer prefix(whole.begin(),
                            whole.begin() + static_cast<std::ptrdiff_t>(size));  // its own, so that reading on is seen
        const Faults faults = validate(prefix);
        ASSERT_EQ(faults.list().size(), 1u) << size;
        ASSERT_EQ(faults.list()[0].code, size < kChunkHeaderSize ? ErrorCode::kNotABendyFile : ErrorCode::kTruncated)
            << size;
    }
}

TEST(Damage, EverySingleBitFlipIsRefused) {
    Buffer file = sample_file();
    for (std::size_t at = 0; at < file.size(); ++at) {
        for (int bit = 0; bit < 8; ++bit) {
            file[at] ^= std::byte{1} << bit;
            ASSERT_FALSE(validate(file).empty())
                << "bit " << bit << " of byte " << at << " in " << chunk_path(file, at);
            file[at] ^= std::byte{1} << bit;
        }
    }
    EXPECT_EQ(file, sample_file());
}

TEST(Damage, EverySingleBitFlipWithItsSumsRepairedIsHarmless) {
    const Buffer good = sample_file();
    std::size_t resummed = 0;
    for (std::size_t at = 0; at < good.size(); ++at) {
        for (int bit = 0; bit < 8; ++bit) {
            Buffer file = good;
            file[at] ^= std::byte{1} << bit;
            resummed += resum(file) ? 1 : 0;
            expect_harmless(file);
            if (HasFatalFailure() || HasNonfatalFailure())
                FAIL() << "bit " << bit << " of byte " << at << " in " << chunk_path(good, at);
        }
    }
    EXPECT_GT(resummed, good.size() * 4);  // most of them are well-formed
}

/// Every number of type T that stands on its own boundary in the file, set to each of the awkward values.
template <class T>
void set_every_number_to_awkward_values() {
    const Buffer good = sample_file();
    for (std::size_t at = 0; at + sizeof(T) <= good.size(); at += sizeof(T)) {
        T before = 0;
        copy_at(good, at, before);
        std::set<T> values{0,
                           1,
                           static_cast<T>(before - 1),
                           static_cast<T>(before + 1),
                           static_cast<T>(before - 16),
                           static_cast<T>(before + 16),
                           std::numeric_limits<T>::max(),
                           std::numeric_limits<T>::max() - 15};
        for (unsigned shift = 7; shift < sizeof(T) * 8; shift += 8) values.insert(static_cast<T>(T{1} << shift));
        if (sizeof(T) == 8) {  // a chunk header's size, its flags left alone
            const T flags = before & ~static_cast<T>(kMaxPayload);
            for (const std::uint64_t size :
                 {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{16}, std::uint64_t{1} << 31, std::uint64_t{1} << 47,
                  kMaxPayload, kMaxPayload - 15}) {
                values.insert(flags | static_cast<T>(size));
            }
        }
        for (const T value : values) {
            Buffer file = good;
            patch(file, at, value);
            resum(file);
            expect_harmless(file);
            if (testing::Test::HasFailure()) FAIL() << value << " at byte " << at << " in " << chunk_path(good, at);
        }
    }
}

TEST(Damage, EveryWordSetToAwkwardValuesIsHarmless) {
    set_every_number_to_awkward_values<std::uint32_t>();
}

TEST(Damage, EveryLongWordSetToAwkwardValuesIsHarmless) {
    set_every_number_to_awkward_values<std::uint64_t>();
}

TEST(Damage, EveryByteSetToAwkwardValuesIsHarmless) {
    const Buffer good = sample_file();
    for (std::size_t at = 0; at < good.size(); ++at) {
        for (const unsigned value : {0u, 1u, 0x7fu, 0x80u, 0xffu}) {
            Buffer file = good;
            file[at] = static_cast<std::byte>(value);
            resum(file);
            expect_harmless(file);
            if (HasFailure()) FAIL() << value << " at byte " << at << " in " << chunk_path(good, at);
        }
    }
}

TEST(Damage, EveryPairOfSiblingsMayChangePlaces) {
    const Loaded good(sample_file());
    for (std::uint32_t parent = 0; parent < good.tree.chunks().size(); ++parent) {
        const std::string path = chunk_path(good.file, good.tree[parent].offset);
        Node root = sample();
        const std::size_t children = at(root, path).children.size();
        for (std::size_t a = 0; a < children; ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                Node changed = root;
                std::swap(at(changed, path).children[a], at(changed, path).children[b]);
                expect_harmless(to_file(changed));
            }
        }
    }
}

TEST(Damage, EveryChunkMayBeGoneOrThereTwice) {
    const Loaded good(sample_file());
    for (std::uint32_t number = 1; number < good.tree.chunks().size(); ++number) {
        const std::string parent = chunk_path(good.file, good.tree[good.tree[number].parent].offset);
        const std::string path = chunk_path(good.file, good.tree[number].offset);
        for (const bool twice : {false, true}) {
            Node root = sample();
            auto& siblings = at(root, parent).children;
            const auto place = siblings.begin() + (&at(root, path) - siblings.data());
            if (twice) {
                siblings.insert(place, Node(*place));
            } else {
                siblings.erase(place);
            }
            expect_harmless(to_file(root));
        }
    }
}

TEST(Damage, EveryLeafMayBeOfAnyLength) {
    const Loaded good(sample_file());
    for (std::uint32_t number = 1; number < good.tree.chunks().size(); ++number) {
        if (good.tree[number].is_container()) continue;
        const std::string path = chunk_path(good.file, good.tree[number].offset);
        for (std::size_t size = 0; size <= good.tree[number].size + 33; ++size) {
            Node root = sample();
            at(root, path).payload.resize(size);
            expect_harmless(to_file(root));
        }
    }
}

}  // namespace
}  // namespace bendy::damage_test
