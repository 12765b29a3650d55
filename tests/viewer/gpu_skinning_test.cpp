// examples/gpu_skinning/skinning.glsl, run by OpenGL, held against the runtime's own skinning.
#include "opengl.h"
#include "runtime/build_model.h"
#include "viewer/example_model.h"

#include <bendy/viewer/picture.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>

namespace bendy::viewer::gpu_skinning_test {
namespace {

constexpr std::size_t kFloats = 10;  // position, normal and tangent of a vertex
constexpr GLuint kGroup = 64;        // invocations of a work group, as in the shaders
constexpr float kTolerance = 1e-5f;  // of the longer of 1 and the character's diagonal

/// The uniform block of the same name.
struct Skinning {
    glm::mat4 view_projection{1.0f};
    std::uint32_t vertices = 0;
    std::uint32_t influences = 0;
    std::uint32_t bone_bytes = 0;
    std::uint32_t weight_bytes = 0;
    std::uint32_t first_entry = 0;
    std::uint32_t entries = 0;
    std::uint32_t bones_used = 0;
    std::uint32_t topmost = 0;
    std::uint32_t by_columns = 0;
    std::uint32_t dual = 0;
    std::uint32_t has_normals = 0;
    std::uint32_t has_tangents = 0;
};

struct Morph {
    std::uint32_t elements = 0;
    std::uint32_t index_bytes = 0;
    std::uint32_t components = 0;
    float weight = 0.0f;
};

void check_status(GLint is_good, const char* log) {
    if (is_good != GL_TRUE) throw ViewerError(log);
}

/// A pass of skinning.glsl.
class Pass {
public:
    Pass(const char* name, GLenum stage) : program_(glCreateProgram()) {
        std::ifstream file(test::example("gpu_skinning/skinning.glsl"));
        std::ostringstream text;
        text << "#version 430\n#define BENDY_" << name << "\n" << file.rdbuf();
        const std::string source = text.str();
        const char* const start = source.c_str();
        const GLuint shader = glCreateShader(stage);
        glShaderSource(shader, 1, &start, nullptr);
        glCompileShader(shader);
        std::array<char, 2000> log{};
        GLint is_good = GL_FALSE;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &is_good);
        glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
        check_status(is_good, log.data());
        glAttachShader(program_, shader);
        constexpr std::array<const char*, 3> kOutputs{"position", "normal", "tangent"};
        if (stage == GL_VERTEX_SHADER)
            glTransformFeedbackVaryings(program_, kOutputs.size(), kOutputs.data(), GL_INTERLEAVED_ATTRIBS);
        glLinkProgram(program_);
        glDeleteShader(shader);
        glGetProgramiv(program_, GL_LINK_STATUS, &is_good);
        glGetProgramInfoLog(program_, log.size(), nullptr, log.data());
        check_status(is_good, log.data());
    }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;
    Pass(Pass&&) = delete;
    Pass& operator=(Pass&&) = delete;
    ~Pass() { glDeleteProgram(program_); }

    template <class Parameters>
    void use(const Parameters& parameters) {
        glUseProgram(program_);
        glBindBufferBase(GL_UNIFORM_BUFFER, 0, parameters_.name());
        glBufferData(GL_UNIFORM_BUFFER, sizeof parameters, &parameters, GL_STREAM_DRAW);
    }
    template <class Parameters>
    void run(const Parameters& parameters, std::uint32_t invocations, std::uint32_t characters = 1) {
        use(parameters);
        glDispatchCompute((invocations + kGroup - 1) / kGroup, characters, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }

private:
    GLuint program_;
    Buffer parameters_;
};

struct Passes {
    Pass morph{"MORPH", GL_COMPUTE_SHADER};
    Pass motions{"MOTIONS", GL_COMPUTE_SHADER};
    Pass skin{"SKIN", GL_COMPUTE_SHADER};
    Pass draw{"DRAW", GL_VERTEX_SHADER};
};

/// Fills a storage buffer, whose size must be a multiple of four, and is not zero.
void fill(const Buffer& buffer, const void* from, std::size_t bytes) {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.name());
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>((bytes + 7) / 4 * 4), nullptr, GL_STATIC_DRAW);
    if (bytes > 0) glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), from);
}

template <class Numbers>
void fill(const Buffer& buffer, const Numbers& numbers) {
    fill(buffer, numbers.data(), numbers.size() * sizeof numbers[0]);
}

void bind(GLuint binding, const Buffer& buffer) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.name());
}

bool is_plain(const StreamView& stream) {
    return stream.boxes.empty() && stream.list.empty() && !stream.is_octahedral;
}

/// Uploads a stream of floats as it is stored, or decoded.
void fill_floats(const Buffer& buffer, const StreamView& stream, std::size_t components) {
    if (stream.type == ComponentType::f32 && is_plain(stream)) return fill(buffer, stream.data);
    std::vector<float> numbers(stream.elements * components);
    for (std::uint32_t k = 0; k < stream.elements; ++k) {
        const glm::vec4 value = components == 4 ? stream.vec4(k) : glm::vec4(stream.vec3(k), 0.0f);
        std::memcpy(&numbers[k * components], &value, components * sizeof(float));
    }
    fill(buffer, numbers);
}

PaletteMatrix rows_of(const glm::mat4& matrix) {
    PaletteMatrix entry{};
    for (int row = 0; row < 3; ++row) {
        for (int c = 0; c < 4; ++c) entry.rows[row][c] = matrix[c][row];
    }
    return entry;
}

std::vector<glm::mat4> by_columns(std::span<const PaletteMatrix> palette) {
    std::vector<glm::mat4> matrices(palette.size(), glm::mat4(1.0f));
    for (std::size_t k = 0; k < palette.size(); ++k) {
        for (int row = 0; row < 3; ++row) {
            for (int c = 0; c < 4; ++c) matrices[k][c][row] = palette[k].rows[row][c];
        }
    }
    return matrices;
}

/// A mesh in buffers.
class GpuMesh {
public:
    GpuMesh(Passes& passes, const Model& model, std::uint32_t number)
        : passes_(passes), model_(model), mesh_(model.meshes()[number]), number_(number) {
        parameters.vertices = mesh_.vertices;
        fill_floats(positions_, mesh_.positions, 3);
        if (mesh_.normals) fill_floats(normals_, *mesh_.normals, 3);
        if (mesh_.tangents) fill_floats(tangents_, *mesh_.tangents, 4);
        parameters.has_normals = mesh_.normals ? 1 : 0;
        parameters.has_tangents = mesh_.tangents ? 1 : 0;
        if (mesh_.is_rigid()) {
            fill_movers();
        } else {
            fill_influences();
        }
    }

    /// Adds the morph targets of a pose to positions, normals and tangents.
    void morph(const Pose& pose) {
        for (std::size_t k = 0; k < mesh_.targets.size(); ++k) {
            const MorphTargetView& target = mesh_.targets[k];
            const float weight = pose.morph_weights()[model_.first_morph_target(number_) + k];
            if (weight == 0.0f) continue;
            add(target, target.positions, weight, positions_, 3);
            if (mesh_.normals) add(target, target.normals, weight, normals_, 3);
            if (mesh_.tangents) add(target, target.tangents, weight, tangents_, 4);
        }
    }

    /// The palette of a pose, and one more set of parameters.
    void use_palette(Pose& pose, bool columns = false) {
        std::vector<PaletteMatrix> palette;
        if (!mesh_.is_rigid()) {
            const auto entries = pose.palette(number_);
            palette.assign(entries.begin(), entries.end());
        } else {
            for (const glm::mat4& matrix : pose.model_space()) palette.push_back(rows_of(matrix));
            palette.push_back(rows_of(glm::mat4(1.0f)));
            const std::uint32_t mover = model_.rigid_mover(number_, 0);
            if (model_.has_one_mover(number_)) palette = {mover == kNone ? palette.back() : palette[mover]};
        }
        parameters.by_columns = columns ? 1 : 0;
        parameters.first_entry = 0;
        parameters.entries = static_cast<std::uint32_t>(palette.size());
        columns ? fill(transforms_, by_columns(palette)) : fill(transforms_, palette);
    }
    /// The palettes of the members of a crowd, one after another.
    void use_palettes(const Crowd& crowd, std::span<const PaletteMatrix> palettes) {
        parameters.first_entry = static_cast<std::uint32_t>(crowd.first_entry(number_));
        parameters.entries = static_cast<std::uint32_t>(crowd.palette_size());
        fill(transforms_, palettes);
    }

    void make_motions(std::uint32_t characters) {
        const PaletteView& palette = mesh_.palette;
        std::vector<glm::vec3> places;
        for (const glm::mat4& matrix : palette.inverse_bind()) places.emplace_back(glm::inverse(matrix)[3]);
        const auto topmost = std::min_element(palette.joints.begin(), palette.joints.end());
        parameters.topmost = static_cast<std::uint32_t>(topmost - palette.joints.begin());
        parameters.bones_used = static_cast<std::uint32_t>(palette.joints.size());
        parameters.dual = 1;
        const Buffer place_buffer;
        Buffer motions;
        fill(place_buffer, places);
        fill(motions, nullptr, std::size_t{characters} * parameters.entries * 20 * sizeof(float));
        bind(1, transforms_);
        bind(2, place_buffer);
        bind(3, motions);
        passes_.motions.run(parameters, parameters.bones_used, characters);
        transforms_ = std::move(motions);
    }

    [[nodiscard]] std::vector<float> skin(std::uint32_t characters) {
        std::vector<float> numbers(std::size_t{characters} * mesh_.vertices * kFloats);
        const Buffer skinned;
        fill(skinned, numbers);
        bind_streams();
        bind(7, skinned);
        passes_.skin.run(parameters, parameters.vertices, characters);
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, skinned.name());
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(numbers.size() * sizeof(float)),
                           numbers.data());
        return numbers;
    }

    /// The outputs of the vertex shader, and no picture.
    [[nodiscard]] std::vector<float> draw(std::uint32_t characters) {
        std::vector<float> numbers(std::size_t{characters} * mesh_.vertices * kFloats);
        const Buffer outputs;
        const VertexArray vertex_array;
        const Framebuffer framebuffer;  // of one pixel and no image; there is no other one without a window
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
        glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, 1);
        glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, 1);
        const auto bytes = static_cast<GLsizeiptr>(numbers.size() * sizeof(float));
        bind_streams();
        passes_.draw.use(parameters);
        glBindVertexArray(vertex_array.name());
        glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, outputs.name());
        glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, nullptr, GL_STATIC_READ);
        glEnable(GL_RASTERIZER_DISCARD);
        glBeginTransformFeedback(GL_POINTS);
        glDrawArraysInstanced(GL_POINTS, 0, static_cast<GLsizei>(mesh_.vertices), static_cast<GLsizei>(characters));
        glEndTransformFeedback();
        glDisable(GL_RASTERIZER_DISCARD);
        glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, bytes, numbers.data());
        return numbers;
    }

    Skinning parameters;

private:
    void fill_influences() {
        const StreamView& bones = *mesh_.bones;
        const StreamView& weights = *mesh_.weights;
        parameters.influences = bones.components;
        parameters.bone_bytes = bones.type == ComponentType::u8 ? 1 : 2;
        fill(bones_, bones.data);
        if (is_plain(weights)) {
            parameters.weight_bytes =
                static_cast<std::uint32_t>(weights.data.size() / weights.elements / weights.components);
            return fill(weights_, weights.data);
        }
        std::vector<float> numbers(std::size_t{weights.elements} * weights.components);
        weights.decode(numbers);
        parameters.weight_bytes = 4;
        fill(weights_, numbers);
    }
    /// Of a rigid mesh: its joints as bones, unless there is only one.
    void fill_movers() {
        if (model_.has_one_mover(number_)) return;
        parameters.influences = 1;
        parameters.bone_bytes = 4;
        std::vector<std::uint32_t> movers;
        for (std::uint32_t vertex = 0; vertex < mesh_.vertices; ++vertex)
            movers.push_back(
                std::min(model_.rigid_mover(number_, vertex), static_cast<std::uint32_t>(model_.joints().size())));
        fill(bones_, movers);
    }
    void add(const MorphTargetView& target, const std::optional<StreamView>& stream, float weight, const Buffer& sums,
             std::uint32_t components) {
        if (!stream) return;
        const Buffer displaced;
        const Buffer displacements;
        Morph values{target.touched(mesh_.vertices), 0, components, weight};
        if (target.vertices) {
            values.index_bytes = target.vertices->type == ComponentType::u16 ? 2 : 4;
            fill(displaced, target.vertices->data);
        } else {
            fill(displaced, nullptr, 0);
        }
        fill_floats(displacements, *stream, 3);
        bind(1, displaced);
        bind(2, displacements);
        bind(3, sums);
        passes_.morph.run(values, values.elements);
    }
    void bind_streams() const {
        bind(1, transforms_);
        const std::array streams{&positions_, &normals_, &tangents_, &bones_, &weights_};
        GLuint binding = 2;
        for (const Buffer* stream : streams) bind(binding++, *stream);
    }

    Passes& passes_;
    const Model& model_;
    const Mesh& mesh_;
    std::uint32_t number_;
    Buffer transforms_, positions_, normals_, tangents_, bones_, weights_;
};

class GpuSkinning : public testing::Test {
protected:
    void SetUp() override {
        try {
            context = std::make_unique<OffscreenContext>();
        } catch (const ViewerError& problem) {
            GTEST_SKIP() << problem.what();
        }
        passes = std::make_unique<Passes>();
    }

    /// What `skin` writes, as the shader lays it out.
    static std::vector<float> reference(Pose& pose, std::uint32_t mesh, SkinningMethod method) {
        const std::size_t vertices = pose.model().meshes()[mesh].vertices;
        std::vector<float> numbers(vertices * kFloats);
        const std::span<float> all(numbers);
        const VertexBuffer out{{all, kFloats}, {all.subspan(3), kFloats}, {all.subspan(6), kFloats}};
        EXPECT_TRUE(bendy::skin(pose, {.mesh = mesh, .method = method, .out = out}));
        return numbers;
    }

    /// Compares numbers, positions by the size of the character.
    static void expect_near(std::span<const float> found, std::span<const float> wanted, float size,
                            const std::string& what) {
        ASSERT_EQ(found.size(), wanted.size());
        float worst = 0.0f;
        for (std::size_t k = 0; k < found.size(); ++k) {
            const float error = std::abs(found[k] - wanted[k]) / (k % kFloats < 3 ? size : 1.0f);
            if (!(error <= worst)) worst = std::isnan(error) ? INFINITY : error;
        }
        EXPECT_LE(worst, kTolerance) << what;
    }

    static float size_of(Pose& pose) {
        std::vector<glm::vec3> positions(pose.model().vertex_count());
        EXPECT_TRUE(bendy::skin(pose, {.out = {.positions = positions}}));
        glm::vec3 least(INFINITY);
        glm::vec3 most(-INFINITY);
        for (const glm::vec3& at : positions) {
            least = glm::min(least, at);
            most = glm::max(most, at);
        }
        return std::max(1.0f, glm::length(most - least));
    }

    void check(Pose& pose, const std::string& what) const {
        const Model& model = pose.model();
        const float size = size_of(pose);
        for (std::uint32_t mesh = 0; mesh < model.meshes().size(); ++mesh) {
            const std::string name = what + ", mesh " + std::to_string(mesh);
            GpuMesh gpu(*passes, model, mesh);
            gpu.morph(pose);
            gpu.use_palette(pose);
            const std::vector<float> linear = gpu.skin(1);
            expect_near(linear, reference(pose, mesh, SkinningMethod::linear), size, name);
            gpu.use_palette(pose, true);
            EXPECT_EQ(gpu.skin(1), linear) << name << ", the palette by columns";
            if (model.meshes()[mesh].is_rigid()) continue;
            gpu.make_motions(1);
            expect_near(gpu.skin(1), reference(pose, mesh, SkinningMethod::dual_quaternion), size,
                        name + ", dual quaternions");
        }
    }

    /// The rest pose with all morph targets, the middle of each clip, and a pose whose joints are scaled.
    void check(const Model& model) const {
        Pose pose(model);
        float weight = 0.2f;
        for (float& morph : pose.change_morph_weights()) morph = weight += 0.3f;
        check(pose, "rest");
        for (const Clip& clip : model.clips()) {
            ASSERT_TRUE(sample(pose, &clip, 0.37f * clip.start + 0.63f * clip.end));
            check(pose, std::string(clip.name));
        }
        // All of them; then stretched, mirrored, and to a point.
        constexpr std::array<glm::vec3, 4> kScales{glm::vec3(1.5f), glm::vec3(1.3f, 0.8f, 1.1f),
                                                   glm::vec3(-1.0f, 1.0f, 1.0f), glm::vec3(0.0f)};
        const auto joints = static_cast<std::uint32_t>(model.joints().size());
        for (std::uint32_t k = 0; k < kScales.size(); ++k)
            scale(pose, joints * k / static_cast<std::uint32_t>(kScales.size()), kScales.at(k));
        check(pose, "scaled");
    }
    static void scale(Pose& pose, std::uint32_t joint, const glm::vec3& by) {
        JointTransform transform = pose.local(joint);
        transform.scale = by;
        pose.set_local(joint, transform);
    }
    void check_file(const std::filesystem::path& file, const converter::ConvertOptions& options = {}) const {
        if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
        const test::ExampleModel model(file, options);
        check(*model);
    }

    std::unique_ptr<OffscreenContext> context;
    std::unique_ptr<Passes> passes;
};

TEST_F(GpuSkinning, Mannequin) {
    check_file(test::example("mannequin.glb"));
}
TEST_F(GpuSkinning, MannequinFromACompactFile) {
    converter::ConvertOptions options;
    options.compact = converter::ErrorBound{};
    check_file(test::example("mannequin.glb"), options);
}
TEST_F(GpuSkinning, Tentacle) {
    check_file(test::example("tentacle.glb"));
}
TEST_F(GpuSkinning, Fox) {
    check_file(test::corpus("models/fox.glb"));
}
TEST_F(GpuSkinning, CesiumMan) {
    check_file(test::corpus("models/cesium_man.gltf"));
}
TEST_F(GpuSkinning, RobotOfRigidMeshes) {
    check_file(test::corpus("models/robot.glb"));
}
TEST_F(GpuSkinning, EightInfluences) {
    check_file(test::corpus("generated/joints8.glb"));
}
TEST_F(GpuSkinning, ThreeHundredJoints) {
    check_file(test::corpus("generated/joints_300.glb"));
}
TEST_F(GpuSkinning, TargetsAndSkin) {
    check_file(test::corpus("generated/morph_and_skin.glb"));
}

TEST_F(GpuSkinning, Tangents) {
    check_file(test::corpus("generated/attributes_zoo.glb"));
}
TEST_F(GpuSkinning, WeightsOfOneByte) {
    check_file(test::corpus("generated/weights_u8_joints_u8.glb"));
}
TEST_F(GpuSkinning, TwoBytesATangentThatIsDisplacedAndAFlatBone) {
    constexpr std::uint16_t kWhole = 65535;
    test::ModelSpec spec;
    spec.joints.push_back({kNone, test::turned(70.0, 2), {test::submesh(0, 0, 3)}, "a"});
    spec.joints.push_back({0, test::turned(-40.0, 1), {}, "b"});
    test::MeshSpec mesh;
    mesh.positions = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    mesh.normals = {{0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
    mesh.tangents = {{1.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 1.0f, 0.0f, -1.0f}, {1.0f, 0.0f, 0.0f, 1.0f}};
    mesh.indices = {0, 1, 2};
    const std::vector<std::uint16_t> bones{1, 0, 0, 1, 1, 0};
    const std::vector<std::uint16_t> weights{kWhole, 0, 20000, kWhole - 20000, 31, kWhole - 31};
    const std::vector<std::uint16_t> displaced{1, 2};
    const std::vector<glm::vec3> displacements{{0.5f, 0.1f, 0.0f}, {0.0f, 0.3f, 0.4f}};
    mesh.more = {
        test::make_container(FourCC("TARG"), {test::make_leaf(FourCC("TINF"), bytes_of(MorphTargetRecord{})),
                                              test::make_leaf(FourCC("INDX"), test::stream_payload(1, displaced)),
                                              test::vector_stream(FourCC("POSI"), displacements),
                                              test::vector_stream(FourCC("NORM"), displacements),
                                              test::vector_stream(FourCC("TANG"), displacements)}),
        test::palette_leaf({0, 1}, {glm::mat4(1.0f), glm::mat4(1.0f)}),
        test::make_leaf(FourCC("BONE"), test::stream_payload(2, bones)),
        test::make_leaf(FourCC("WGHT"), test::stream_payload(2, weights, true))};
    spec.meshes.push_back(mesh);
    const test::Owned model(test::build_file(spec));
    check(*model);
    Pose pose(*model);
    scale(pose, 1, {1.0f, 0.0f, 1.0f});  // flat: elsewhere rounding decides on which side the normals are
    check(pose, "flat");
}

TEST_F(GpuSkinning, ACrowdIsDrawnByOneCall) {
    const test::ExampleModel model(test::example("mannequin.glb"));
    const Clip* const walk = model->clip("Walk");
    Crowd crowd(*model);
    constexpr std::uint32_t kMembers = 3;
    std::vector<PaletteMatrix> palettes(kMembers * crowd.palette_size());
    std::vector<CrowdMember> members(kMembers);
    for (std::uint32_t k = 0; k < kMembers; ++k) {
        members[k].clip = walk;
        members[k].seconds = 0.3f * static_cast<float>(k);
        members[k].palette = std::span(palettes).subspan(k * crowd.palette_size(), crowd.palette_size());
    }
    ASSERT_TRUE(crowd.play(members));
    for (const SkinningMethod method : {SkinningMethod::linear, SkinningMethod::dual_quaternion}) {
        for (std::uint32_t mesh = 0; mesh < model->meshes().size(); ++mesh) {
            const bool is_dual = method == SkinningMethod::dual_quaternion && !model->meshes()[mesh].is_rigid();
            GpuMesh gpu(*passes, *model, mesh);
            gpu.use_palettes(crowd, palettes);
            if (is_dual) gpu.make_motions(kMembers);
            std::vector<float> wanted;
            for (const CrowdMember& member : members) {
                Pose pose(*model);
                ASSERT_TRUE(sample(pose, walk, member.seconds));
                const std::vector<float> one = reference(pose, mesh, method);
                wanted.insert(wanted.end(), one.begin(), one.end());
            }
            const std::string name = "crowd, mesh " + std::to_string(mesh) + (is_dual ? ", dual quaternions" : "");
            expect_near(gpu.draw(kMembers), wanted, 1.0f, name + ", drawn");
            expect_near(gpu.skin(kMembers), wanted, 1.0f, name);
        }
    }
}

}  // namespace
}  // namespace bendy::viewer::gpu_skinning_test
