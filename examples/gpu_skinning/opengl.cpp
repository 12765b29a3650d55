// A character in a window, skinned on the graphics processor by skinning.glsl: GLFW, OpenGL 4.3 and the runtime.
//
//     bendy convert mannequin.glb && bendy_gpu_skinning mannequin.bendy
//
// The streams of each mesh are uploaded once. In each frame a palette is uploaded, the pass `skin` dispatched, and what
// it wrote is drawn. Morph targets stay at 0. With a number of frames and a file name it draws that many frames, a
// thirtieth of a second apart, saves the last as a PPM picture, and exits.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GLFW/glfw3.h>

#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include "../one_view.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr const char* kVertexShader = R"(#version 430 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) uniform mat4 camera;
out vec3 side;
void main() { side = normal; gl_Position = camera * vec4(position, 1.0); })";

constexpr const char* kFragmentShader = R"(#version 430 core
in vec3 side;
layout(location = 1) uniform vec4 base;
out vec4 colour;
void main() { colour = vec4(base.rgb * (0.35 + 0.65 * max(0.0, dot(normalize(side), vec3(0.36, 0.80, 0.48)))), base.a); })";

/// The block `Skinning` of skinning.glsl.
struct Skinning {
    glm::mat4 view_projection{1.0f};
    std::uint32_t vertices = 0, influences = 0, bone_bytes = 0, weight_bytes = 0;
    std::uint32_t first_entry = 0, entries = 0, bones_used = 0, topmost = 0;
    std::uint32_t by_columns = 0, dual = 0, has_normals = 0, has_tangents = 0;
};

constexpr GLsizei kSkinned = 10 * sizeof(float);  // position, normal and tangent of a vertex, as the pass writes them

void add_shader(GLuint program, GLenum stage, const std::string& text) {
    const GLuint shader = glCreateShader(stage);
    const char* const start = text.c_str();
    glShaderSource(shader, 1, &start, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
}

bool link(GLuint program) {
    GLint linked = 0;
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    return linked != 0;
}

/// Makes a buffer of whole words, which is what shaders read; not an empty one, which cannot be bound.
GLuint upload(bendy::Bytes bytes) {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes.size() / 4 * 4 + 4), nullptr, GL_DYNAMIC_DRAW);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    return buffer;
}

/// Uploads positions or normals: as they are stored, or decoded if the file is compact.
GLuint upload_vectors(const bendy::StreamView& stream) {
    if (stream.type == bendy::ComponentType::f32) return upload(stream.data);
    std::vector<glm::vec3> vectors(stream.elements);
    stream.decode(vectors);
    return upload(std::as_bytes(std::span(vectors)));
}

/// A mesh in the memory of the graphics processor.
class GpuMesh {
public:
    GpuMesh(const bendy::Model& model, const bendy::Lod& lod, std::uint32_t number)
        : number_(number), is_rigid_(model.meshes()[number].is_rigid()) {
        const bendy::Mesh& mesh = model.meshes()[number];
        parameters_.vertices = mesh.vertices;
        positions_ = upload_vectors(mesh.positions);
        parameters_.has_normals = mesh.normals ? 1 : 0;
        normals_ = mesh.normals ? upload_vectors(*mesh.normals) : upload({});
        tangents_ = upload({});  // the colours here need none
        is_rigid_ ? upload_movers(model) : upload_influences(mesh);

        skinned_ = upload({});
        glBufferData(GL_SHADER_STORAGE_BUFFER, GLsizeiptr{kSkinned} * mesh.vertices + 4, nullptr, GL_DYNAMIC_COPY);
        palette_ = upload({});
        glGenVertexArrays(1, &array_);
        glBindVertexArray(array_);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, upload(std::as_bytes(lod.indices(number))));
        glBindBuffer(GL_ARRAY_BUFFER, skinned_);
        for (const GLuint attribute : {0u, 1u}) {
            glEnableVertexAttribArray(attribute);
            // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL takes offsets as pointers
            const auto* offset = reinterpret_cast<const void*>(attribute * sizeof(glm::vec3));
            glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, kSkinned, offset);
        }
        glGenBuffers(1, &uniforms_);
        glBindBuffer(GL_UNIFORM_BUFFER, uniforms_);
        glBufferData(GL_UNIFORM_BUFFER, sizeof parameters_, &parameters_, GL_STATIC_DRAW);
    }

    /// Dispatches the pass `skin` for a pose.
    void skin(bendy::Pose& pose) const {
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, palette_);
        if (is_rigid_) {  // what no joint moves has the last matrix
            std::vector<glm::mat4> matrices(pose.model_space().begin(), pose.model_space().end());
            matrices.emplace_back(1.0f);
            set_data(std::as_bytes(std::span(matrices)));
        } else {
            set_data(std::as_bytes(pose.palette(number_)));
        }
        glBindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms_);
        GLuint binding = 1;
        for (const GLuint buffer : {palette_, positions_, normals_, tangents_, bones_, weights_, skinned_})
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding++, buffer);
        constexpr GLuint kGroup = 64;  // local_size_x of the pass
        glDispatchCompute((parameters_.vertices + kGroup - 1) / kGroup, 1, 1);
    }

    void draw(const bendy::Submesh& range) const {
        glBindVertexArray(array_);
        // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL takes offsets as pointers
        const auto* first = reinterpret_cast<const void*>(std::size_t{range.first} * sizeof(std::uint32_t));
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT, first);
    }

private:
    static void set_data(bendy::Bytes bytes) {
        glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STREAM_DRAW);
    }

    void upload_influences(const bendy::Mesh& mesh) {
        parameters_.influences = mesh.bones->components;
        parameters_.bone_bytes = static_cast<std::uint32_t>(bendy::component_size(mesh.bones->type));
        bones_ = upload(mesh.bones->data);
        std::vector<float> decoded;
        if (!mesh.weights->boxes.empty()) {
            decoded.resize(std::size_t{mesh.vertices} * mesh.weights->components);
            mesh.weights->decode(decoded);
        }
        weights_ = upload(decoded.empty() ? mesh.weights->data : std::as_bytes(std::span(decoded)));
        parameters_.weight_bytes =
            decoded.empty() ? static_cast<std::uint32_t>(bendy::component_size(mesh.weights->type)) : 4;
    }

    /// Makes the joint that moves each vertex its only bone.
    void upload_movers(const bendy::Model& model) {
        const auto joints = static_cast<std::uint32_t>(model.joints().size());
        std::vector<std::uint32_t> movers(parameters_.vertices);
        for (std::uint32_t vertex = 0; vertex < parameters_.vertices; ++vertex)
            movers[vertex] = std::min(model.rigid_mover(number_, vertex), joints);
        parameters_.influences = 1;
        parameters_.bone_bytes = 4;
        parameters_.by_columns = 1;
        bones_ = upload(std::as_bytes(std::span(movers)));
        weights_ = upload({});
    }

    std::uint32_t number_;
    bool is_rigid_;
    Skinning parameters_;
    GLuint positions_ = 0, normals_ = 0, tangents_ = 0, bones_ = 0, weights_ = 0, palette_ = 0, skinned_ = 0,
           uniforms_ = 0, array_ = 0;
};

int show(GLFWwindow* window, const bendy::Model& model, int frames, const char* picture) {
    std::ostringstream skinning;
    skinning << "#version 430\n#define BENDY_SKIN\n" << std::ifstream(BENDY_SKINNING_GLSL).rdbuf();
    const GLuint skin = glCreateProgram(), colour = glCreateProgram();
    add_shader(skin, GL_COMPUTE_SHADER, skinning.str());
    add_shader(colour, GL_VERTEX_SHADER, kVertexShader);
    add_shader(colour, GL_FRAGMENT_SHADER, kFragmentShader);
    if (!link(skin) || !link(colour)) return 1;

    bendy::Pose pose(model);
    const bendy::Lod lod(model);  // all of it; set_share draws fewer triangles
    std::vector<GpuMesh> meshes;
    for (std::uint32_t number = 0; number < model.meshes().size(); ++number) meshes.emplace_back(model, lod, number);
    const auto box = bendy::Bounds(model).of(pose);
    if (!box) return 1;
    glUseProgram(colour);
    glUniformMatrix4fv(0, 1, GL_FALSE, glm::value_ptr(see_all(box->minimum, box->maximum)));
    glEnable(GL_DEPTH_TEST);
    glClearColor(0.13f, 0.14f, 0.16f, 1.0f);

    for (int frame = 0; glfwWindowShouldClose(window) == 0 && (frames == 0 || frame < frames); ++frame) {
        if (!model.clips().empty()) {
            const bendy::Clip& clip = model.clips().back();
            const double now = frames > 0 ? frame / 30.0 : glfwGetTime();
            const float length = clip.end - clip.start;
            const float passed = length > 0.0f ? static_cast<float>(std::fmod(now, length)) : 0.0f;
            if (!bendy::sample(pose, &clip, clip.start + passed)) return 1;
        }
        glUseProgram(skin);
        for (const GpuMesh& mesh : meshes) mesh.skin(pose);
        glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
        glUseProgram(colour);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        for (const bendy::Submesh& range : lod.submeshes()) {
            if (range.topology != bendy::Topology::triangles || range.count == 0) continue;
            const glm::vec4 grey(0.7f, 0.7f, 0.7f, 1.0f);
            glUniform4fv(1, 1,
                         range.material == bendy::kNone ? glm::value_ptr(grey)
                                                        : model.materials()[range.material].surface.base_colour.data());
            meshes[range.mesh].draw(range);
        }
        if (frames > 0 && frame + 1 == frames && !write_picture(picture)) return 1;
        glfwSwapBuffers(window);
        glfwPollEvents();
    }
    return glGetError() == GL_NO_ERROR ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    const char* file = argc > 1 ? argv[1] : "mannequin.bendy";
    const auto model = bendy::Model::open(file);
    if (!model) {
        std::fprintf(stderr, "%s: %s\n", file, bendy::describe(model.error()).c_str());
        return 1;
    }
    if (glfwInit() == 0) return 1;
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_RESIZABLE, 0);
    GLFWwindow* window = glfwCreateWindow(kWidth, kHeight, "Bendy", nullptr, nullptr);
    int status = 1;
    if (window != nullptr) {
        glfwMakeContextCurrent(window);
        status = show(window, *model, argc > 3 ? std::atoi(argv[2]) : 0, argc > 3 ? argv[3] : nullptr);
    } else {
        std::fputs("no window with OpenGL 4.3 here\n", stderr);
    }
    glfwTerminate();
    return status;
}
