// An outside witness: assimp opens the X-files that we write, and its world positions are held against evaluate(),
// which knows nothing of X-files.
#include "converter/posed_scene.h"
#include "scene/evaluate.h"
#include "scene/frame_shapes.h"
#include "source_folder.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/convert.h>
#include <bendy/converter/export.h>
#include <bendy/converter/import.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace bendy::converter::assimp_test {
namespace {

const std::filesystem::path kSource = source_folder();
constexpr double kTolerance = 1e-5;  // of the size of what is drawn

glm::dmat4 to_matrix(const aiMatrix4x4& m) {
    glm::dmat4 matrix(1.0);
    for (unsigned row = 0; row < 4; ++row) {
        for (unsigned column = 0; column < 4; ++column)
            matrix[static_cast<int>(column)][static_cast<int>(row)] = static_cast<double>(m[row][column]);
    }
    return matrix;
}

glm::dvec3 to_vector(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

/// Where a time lies between keys.
template <class Key>
std::pair<unsigned, double> find_key(const Key* keys, unsigned count, double tick) {
    unsigned left = 0;
    while (left + 1 < count && keys[left + 1].mTime <= tick) ++left;
    if (left + 1 == count || tick <= keys[left].mTime) return {left, 0.0};
    return {left, (tick - keys[left].mTime) / (keys[left + 1].mTime - keys[left].mTime)};
}

glm::dvec3 sample(const aiVectorKey* keys, unsigned count, double tick) {
    const auto [left, share] = find_key(keys, count, tick);
    const glm::dvec3 value = to_vector(keys[left].mValue);
    return share == 0.0 ? value : glm::mix(value, to_vector(keys[left + 1].mValue), share);
}

glm::dquat sample(const aiQuatKey* keys, unsigned count, double tick) {
    const auto to_quaternion = [](const aiQuaternion& q) { return glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)); };
    const auto [left, share] = find_key(keys, count, tick);
    const glm::dquat value = to_quaternion(keys[left].mValue);
    return share == 0.0 ? value : glm::slerp(value, to_quaternion(keys[left + 1].mValue), share);
}

glm::dmat4 sample(const aiNodeAnim& channel, double tick) {
    const glm::dvec3 scale = sample(channel.mScalingKeys, channel.mNumScalingKeys, tick);
    glm::dmat4 matrix = glm::mat4_cast(sample(channel.mRotationKeys, channel.mNumRotationKeys, tick));
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= scale[axis];
    matrix[3] = glm::dvec4(sample(channel.mPositionKeys, channel.mNumPositionKeys, tick), 1.0);
    return matrix;
}

/// A file of ours as assimp sees it.
struct Opened {
    Assimp::Importer importer;
    const aiScene* scene = nullptr;
    std::vector<const aiNode*> nodes;  ///< in the file's order, without a root that assimp has added
    std::map<std::string, glm::dmat4> world;

    void gather(const aiNode* node) {
        if (std::string(node->mName.C_Str()) != "$dummy_root") nodes.push_back(node);
        for (unsigned i = 0; i < node->mNumChildren; ++i) gather(node->mChildren[i]);
    }
    void pose(const aiAnimation* animation, double tick) {
        std::map<std::string, const aiNodeAnim*> channels;
        for (unsigned i = 0; animation != nullptr && i < animation->mNumChannels; ++i)
            channels[animation->mChannels[i]->mNodeName.C_Str()] = animation->mChannels[i];
        world.clear();
        place(scene->mRootNode, glm::dmat4(1.0), channels, tick);
    }
    void place(const aiNode* node, const glm::dmat4& parent, const std::map<std::string, const aiNodeAnim*>& channels,
               double tick) {
        const auto channel = channels.find(node->mName.C_Str());
        const glm::dmat4 local =
            channel == channels.end() ? to_matrix(node->mTransformation) : sample(*channel->second, tick);
        const glm::dmat4 here = parent * local;
        world[node->mName.C_Str()] = here;
        for (unsigned i = 0; i < node->mNumChildren; ++i) place(node->mChildren[i], here, channels, tick);
    }
    /// Every corner of every triangle, in the order of nodes, their meshes and faces.
    [[nodiscard]] std::vector<glm::dvec3> corners() const {
        std::vector<glm::dvec3> all;
        std::vector<const aiNode*> drawn = nodes;
        if (drawn.empty() || drawn.front() != scene->mRootNode) drawn.push_back(scene->mRootNode);
        for (const aiNode* node : drawn) {
            for (unsigned i = 0; i < node->mNumMeshes; ++i) add(*scene->mMeshes[node->mMeshes[i]], *node, all);
        }
        return all;
    }
    void add(const aiMesh& mesh, const aiNode& node, std::vector<glm::dvec3>& all) const {
        std::vector<glm::dvec3> moved(mesh.mNumVertices, glm::dvec3(0.0));
        const glm::dmat4& own = world.at(node.mName.C_Str());
        for (unsigned v = 0; v < mesh.mNumVertices && mesh.mNumBones == 0; ++v)
            moved[v] = glm::dvec3(own * glm::dvec4(to_vector(mesh.mVertices[v]), 1.0));
        for (unsigned b = 0; b < mesh.mNumBones; ++b) {
            const aiBone& bone = *mesh.mBones[b];
            const glm::dmat4 matrix = world.at(bone.mName.C_Str()) * to_matrix(bone.mOffsetMatrix);
            for (unsigned w = 0; w < bone.mNumWeights; ++w) {
                const unsigned v = bone.mWeights[w].mVertexId;
                moved[v] += static_cast<double>(bone.mWeights[w].mWeight) *
                            glm::dvec3(matrix * glm::dvec4(to_vector(mesh.mVertices[v]), 1.0));
            }
        }
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            // assimp turns the faces round: the first corner comes last.
            for (const unsigned corner : {2u, 0u, 1u}) all.push_back(moved[mesh.mFaces[f].mIndices[corner]]);
        }
    }
};

std::unique_ptr<Opened> open(const std::vector<std::byte>& bendy) {
    Report report;
    const auto asset = export_x(bendy, "image", report);
    EXPECT_TRUE(asset) << (asset ? "" : asset.error().message);
    auto opened = std::make_unique<Opened>();
    if (!asset) return opened;
    opened->scene = opened->importer.ReadFileFromMemory(asset->text.data(), asset->text.size(), 0, "x");
    EXPECT_NE(opened->scene, nullptr) << opened->importer.GetErrorString();
    if (opened->scene != nullptr) opened->gather(opened->scene->mRootNode);
    return opened;
}

/// The same corners by our own account: meshes by their joints, triangles by material in the order of first use.
std::vector<glm::dvec3> corners_of(const Scene& scene, const EvaluatedPose& pose) {
    std::vector<const Mesh*> meshes;
    for (const Mesh& mesh : scene.meshes) meshes.push_back(&mesh);
    std::stable_sort(meshes.begin(), meshes.end(), [](const Mesh* a, const Mesh* b) { return a->joint < b->joint; });
    std::vector<glm::dvec3> all;
    for (const Mesh* mesh : meshes) {
        std::vector<double> at_rest;  // an X-file has no targets: the mesh is as it rests
        for (const MorphTarget& target : mesh->targets) at_rest.push_back(target.rest_weight);
        const std::vector<glm::dvec3> vertices = evaluate_vertices(*mesh, at_rest, pose.joints);
        std::vector<std::uint32_t> materials;
        for (const Submesh& submesh : mesh->submeshes) {
            if (submesh.topology == Topology::triangles &&
                std::find(materials.begin(), materials.end(), submesh.material) == materials.end())
                materials.push_back(submesh.material);
        }
        for (const std::uint32_t material : materials) {
            for (const Submesh& submesh : mesh->submeshes) {
                if (submesh.topology != Topology::triangles || submesh.material != material) continue;
                for (const std::uint32_t index : submesh.indices) all.push_back(vertices[index]);
            }
        }
    }
    return all;
}

double size_of(const std::vector<glm::dvec3>& points) {
    glm::dvec3 low(1e300);
    glm::dvec3 high(-1e300);
    for (const glm::dvec3& point : points) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    return points.empty() ? 0.0 : glm::length(high - low);
}

/// The largest distance, as a share of the size; and says what was compared.
double worst_distance(const std::vector<glm::dvec3>& ours, const std::vector<glm::dvec3>& theirs, double size) {
    EXPECT_EQ(ours.size(), theirs.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < std::min(ours.size(), theirs.size()); ++i)
        worst = std::max(worst, glm::distance(ours[i], theirs[i]));
    return worst / size;
}

bool is_linear(const Clip& clip) {
    return std::all_of(clip.tracks.begin(), clip.tracks.end(),
                       [](const Track& track) { return track.interpolation == Interpolation::linear; });
}

/// Seconds of an animation: anywhere where keys are linear, else where the file has keys.
std::vector<double> times_of(const Clip& clip, const aiAnimation& animation) {
    const ClipSpan span = span_of(clip);
    if (is_linear(clip)) return {span.at(0.0), span.at(0.31), span.at(0.5), span.at(0.77), span.at(1.0)};
    std::vector<double> times;
    const aiNodeAnim& channel = *animation.mChannels[0];
    for (unsigned key = 0; key < channel.mNumRotationKeys; key += 1 + channel.mNumRotationKeys / 8)
        times.push_back(channel.mRotationKeys[key].mTime / animation.mTicksPerSecond);
    return times;
}

void compare(const std::vector<std::byte>& bendy, double& worst, int& poses) {
    Report report;
    const auto imported = import_bendy(bendy, report);
    ASSERT_TRUE(imported);
    const Scene& scene = *imported;
    const std::unique_ptr<Opened> opened = open(bendy);
    ASSERT_NE(opened->scene, nullptr);

    ASSERT_EQ(opened->nodes.size(), scene.joints.size());
    for (std::size_t joint = 0; joint < scene.joints.size(); ++joint) {
        const aiNode* parent = opened->nodes[joint]->mParent;
        const bool is_root = parent == nullptr || std::string(parent->mName.C_Str()) == "$dummy_root";
        ASSERT_EQ(is_root, scene.joints[joint].parent == kNone);
        if (!is_root) {
            ASSERT_EQ(parent, opened->nodes[scene.joints[joint].parent]);
        }
    }
    EvaluatedPose pose;
    evaluate_rest(scene, pose);
    const std::vector<glm::dvec3> rest = corners_of(scene, pose);
    const double size = size_of(rest);
    ASSERT_GT(size, 0.0);
    opened->pose(nullptr, 0.0);
    worst = std::max(worst, worst_distance(rest, opened->corners(), size));
    ++poses;

    std::vector<const Clip*> clips;
    for (const Clip& clip : scene.clips) {
        if (std::any_of(clip.tracks.begin(), clip.tracks.end(),
                        [](const Track& track) { return track.path != TrackPath::weights; }))
            clips.push_back(&clip);
    }
    ASSERT_EQ(opened->scene->mNumAnimations, clips.size());
    for (std::size_t i = 0; i < clips.size(); ++i) {
        const aiAnimation& animation = *opened->scene->mAnimations[i];
        for (const double seconds : times_of(*clips[i], animation)) {
            evaluate(scene, *clips[i], seconds, pose);
            opened->pose(&animation, seconds * animation.mTicksPerSecond);
            worst = std::max(worst, worst_distance(corners_of(scene, pose), opened->corners(), size));
            ++poses;
        }
    }
}

void compare_source(const std::filesystem::path& source) {
    SCOPED_TRACE(source.filename().string());
    Report report;
    const auto bendy = convert(source, {}, report);
    ASSERT_TRUE(bendy) << bendy.error().message;
    double worst = 0.0;
    int poses = 0;
    compare(*bendy, worst, poses);
    EXPECT_LE(worst, kTolerance);
    std::cout << source.filename().string() << ": " << poses << " poses, worst " << worst << " of the size\n";
}

TEST(XFileByAssimp, ExamplesStandAndMove) {
    for (const char* name : {"mannequin.glb", "tentacle.glb"}) compare_source(kSource / "examples" / name);
}

TEST(XFileByAssimp, FilesOfTheCorpusStandAndMove) {
    const std::filesystem::path models = kSource / "../shared/corpus/visible/models";
    if (!std::filesystem::exists(models)) GTEST_SKIP() << "there is no corpus";
    for (const char* name : {"fox.glb", "cesium_man.gltf", "rigged_simple.gltf", "simple_skin.gltf",
                             "box_animated.gltf", "left_hand_high.glb", "kenney_tile.glb"})
        compare_source(models / name);
}

TEST(XFileByAssimp, MadeUpScenesStandAndMove) {
    double worst = 0.0;
    int poses = 0;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        test::Numbers numbers(seed);
        Scene scene;
        for (std::uint32_t joint = 0; joint < 6; ++joint) {
            Joint& added = scene.joints.emplace_back();
            added.name = "Joint " + std::to_string(joint);
            added.parent = joint == 0 ? kNone : joint - 1;
            added.rest = {numbers.vector(1.0f), numbers.rotation(), glm::vec3(1.0f) + numbers.vector(0.3f), {}};
            if (seed % 2 == 0) added.rest.scale.x = -added.rest.scale.x;
        }
        for (const std::uint32_t influences : {0u, 2u}) {
            Mesh& mesh = scene.meshes.emplace_back();
            mesh.joint = 1 + influences;
            mesh.influences = influences;
            for (int vertex = 0; vertex < 12; ++vertex) mesh.positions.push_back(numbers.vector(1.0f));
            Submesh submesh;
            for (std::uint32_t index = 0; index < 12; ++index) submesh.indices.push_back(index);
            mesh.submeshes.push_back(submesh);
            if (influences == 0) continue;
            for (std::uint32_t bone = 0; bone < 3; ++bone) {
                mesh.palette.joints.push_back(5 - bone);
                glm::mat4 matrix(1.0f);
                for (int column = 0; column < 4; ++column) matrix[column] += glm::vec4(numbers.vector(0.4f), 0.0f);
                mesh.palette.inverse_bind.push_back(matrix);
            }
            for (std::uint32_t vertex = 0; vertex < 12; ++vertex) {
                mesh.bones.insert(mesh.bones.end(), {vertex % 3, (vertex + 1) % 3});
                mesh.weights.insert(mesh.weights.end(), {0.75f, 0.25f});
            }
        }
        Clip& clip = scene.clips.emplace_back();
        clip.name = "Move";
        for (std::uint32_t joint = 0; joint < 5; ++joint) {
            for (const TrackPath path : {TrackPath::translation, TrackPath::rotation, TrackPath::scale}) {
                if (numbers.below(4) != 0)
                    clip.tracks.push_back(test::random_track(numbers, path, Interpolation::linear, joint));
            }
        }
        Report report;
        compare(build_chunks(scene, "test", report), worst, poses);
    }
    EXPECT_LE(worst, kTolerance);
    std::cout << poses << " poses, worst " << worst << " of the size\n";
}

TEST(XFileByAssimp, NodesBonesAndClipsHaveTheirNames) {
    Report report;
    const auto bendy = convert(kSource / "examples/tentacle.glb", {}, report);
    ASSERT_TRUE(bendy);
    const auto imported = import_bendy(*bendy, report);
    ASSERT_TRUE(imported);
    const std::unique_ptr<Opened> opened = open(*bendy);
    ASSERT_NE(opened->scene, nullptr);
    const auto plain = [](std::string name) {
        std::replace_if(
            name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
        return name;
    };
    ASSERT_EQ(opened->nodes.size(), imported->joints.size());
    for (std::size_t i = 0; i < opened->nodes.size(); ++i)
        EXPECT_EQ(opened->nodes[i]->mName.C_Str(), plain(imported->joints[i].name));
    ASSERT_GT(opened->scene->mNumMeshes, 0u);
    for (unsigned m = 0; m < opened->scene->mNumMeshes; ++m) {
        const aiMesh& mesh = *opened->scene->mMeshes[m];
        for (unsigned b = 0; b < mesh.mNumBones; ++b)
            EXPECT_NE(opened->scene->mRootNode->FindNode(mesh.mBones[b]->mName), nullptr)
                << mesh.mBones[b]->mName.C_Str();
    }
    ASSERT_EQ(opened->scene->mNumAnimations, imported->clips.size());
    for (unsigned a = 0; a < opened->scene->mNumAnimations; ++a)
        EXPECT_EQ(opened->scene->mAnimations[a]->mName.C_Str(), plain(imported->clips[a].name));
}

}  // namespace
}  // namespace bendy::converter::assimp_test
