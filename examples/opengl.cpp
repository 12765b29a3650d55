// A character in a window, with only GLFW, OpenGL 3.3 and the runtime.
//
//     bendy convert mannequin.glb && bendy_opengl mannequin.bendy
//
// The up and down arrows change the level of detail, space selects the next clip. With a number of frames and a file
// name it draws that many frames, a thirtieth of a second apart, saves the last as a PPM picture, and exits.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GLFW/glfw3.h>

#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include "one_view.h"

#include <glm/gtc/type_ptr.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 camera;
out vec3 side;
void main() { side = normal; gl_Position = camera * vec4(position, 1.0); })";

constexpr const char* kFragmentShader = R"(#version 330 core
in vec3 side;
uniform vec4 base;
out vec4 colour;
void main() { colour = vec4(base.rgb * (0.35 + 0.65 * max(0.0, dot(normalize(side), vec3(0.36, 0.80, 0.48)))), base.a); })";

GLuint compile(GLenum kind, const char* text) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    return shader;
}

GLuint make_program() {
    const GLuint program = glCreateProgram();
    glAttachShader(program, compile(GL_VERTEX_SHADER, kVertexShader));
    glAttachShader(program, compile(GL_FRAGMENT_SHADER, kFragmentShader));
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    return linked != 0 ? program : 0;
}

/// Returns a camera that sees all of the character at rest.
glm::mat4 camera_for(const std::vector<glm::vec3>& positions) {
    glm::vec3 low(INFINITY);
    glm::vec3 high(-INFINITY);
    for (const glm::vec3& position : positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    return see_all(low, high);
}

/// The model's vertices in one buffer, positions first, then normals; its index lists, mesh after mesh, in another.
struct Buffers {
    GLuint vertices = 0;
    GLuint indices = 0;
    std::vector<glm::vec3> positions, normals;

    explicit Buffers(const bendy::Model& model) : positions(model.vertex_count()), normals(model.vertex_count()) {
        GLuint array = 0;
        glGenVertexArrays(1, &array);
        glBindVertexArray(array);
        glGenBuffers(1, &vertices);
        glGenBuffers(1, &indices);
        glBindBuffer(GL_ARRAY_BUFFER, vertices);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
        glEnableVertexAttribArray(0);
        glEnableVertexAttribArray(1);
        const auto bytes = static_cast<GLsizeiptr>(positions.size() * sizeof(glm::vec3));
        glBufferData(GL_ARRAY_BUFFER, 2 * bytes, nullptr, GL_STREAM_DRAW);
        glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
        // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL takes offsets as pointers
        glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 0, reinterpret_cast<const void*>(bytes));
    }

    void send_vertices() const {
        const auto bytes = static_cast<GLsizeiptr>(positions.size() * sizeof(glm::vec3));
        glBufferSubData(GL_ARRAY_BUFFER, 0, bytes, positions.data());
        glBufferSubData(GL_ARRAY_BUFFER, bytes, bytes, normals.data());
    }

    /// Uploads the index list of a mesh; indices are relative to the mesh's first vertex.
    static void send_indices(const bendy::Lod& lod, std::uint32_t mesh) {
        const auto list = lod.indices(mesh);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(list.size_bytes()), list.data(), GL_STREAM_DRAW);
    }
};

void draw(const bendy::Model& model, const bendy::Lod& lod, GLint base) {
    std::uint32_t sent = bendy::kNone;
    for (const bendy::Submesh& range : lod.submeshes()) {
        if (range.topology != bendy::Topology::triangles || range.count == 0) continue;
        if (range.mesh != sent) Buffers::send_indices(lod, sent = range.mesh);
        const std::array grey{0.7f, 0.7f, 0.7f, 1.0f};
        const std::array colour =
            range.material == bendy::kNone ? grey : model.materials()[range.material].surface.base_colour;
        glUniform4fv(base, 1, colour.data());
        // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL takes offsets as pointers
        const auto* first = reinterpret_cast<const void*>(std::size_t{range.first} * sizeof(std::uint32_t));
        glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT, first,
                                 static_cast<GLint>(model.first_vertex(range.mesh)));
    }
}

bool was_pressed(GLFWwindow* window, int key) {
    static std::vector<bool> held(GLFW_KEY_LAST + 1);
    const bool is_down = glfwGetKey(window, key) == GLFW_PRESS;
    const bool was_down = held[static_cast<std::size_t>(key)];
    held[static_cast<std::size_t>(key)] = is_down;
    return is_down && !was_down;
}

int show(GLFWwindow* window, const bendy::Model& model, int frames, const char* picture) {
    const GLuint program = make_program();
    if (program == 0) return 1;
    glUseProgram(program);
    glEnable(GL_DEPTH_TEST);
    glClearColor(0.13f, 0.14f, 0.16f, 1.0f);

    Buffers buffers(model);
    bendy::Pose pose(model);
    bendy::Lod lod(model);
    if (!bendy::skin(pose, {.out = {.positions = buffers.positions}})) return 1;
    glUniformMatrix4fv(glGetUniformLocation(program, "camera"), 1, GL_FALSE,
                       glm::value_ptr(camera_for(buffers.positions)));
    const GLint base = glGetUniformLocation(program, "base");

    std::size_t clip = 0;
    float share = 1.0f;
    for (int frame = 0; glfwWindowShouldClose(window) == 0 && (frames == 0 || frame < frames); ++frame) {
        if (!model.clips().empty()) {
            if (was_pressed(window, GLFW_KEY_SPACE)) clip = (clip + 1) % model.clips().size();
            const bendy::Clip& played = model.clips()[clip];
            const double now = frames > 0 ? frame / 30.0 : glfwGetTime();
            const float length = played.end - played.start;
            const float passed = length > 0.0f ? static_cast<float>(std::fmod(now, length)) : 0.0f;
            if (!bendy::sample(pose, &played, played.start + passed)) return 1;
        }
        if (was_pressed(window, GLFW_KEY_UP)) lod.set_share(share = std::fmin(1.0f, share * 2.0f));
        if (was_pressed(window, GLFW_KEY_DOWN)) lod.set_share(share *= 0.5f);
        if (!bendy::skin(pose, {.lod = &lod, .out = {.positions = buffers.positions, .normals = buffers.normals}}))
            return 1;

        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        buffers.send_vertices();
        draw(model, lod, base);
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
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_RESIZABLE, 0);
    GLFWwindow* window = glfwCreateWindow(kWidth, kHeight, "Bendy", nullptr, nullptr);
    int status = 1;
    if (window != nullptr) {
        glfwMakeContextCurrent(window);
        status = show(window, *model, argc > 3 ? std::atoi(argv[2]) : 0, argc > 3 ? argv[3] : nullptr);
    } else {
        std::fputs("no window with OpenGL 3.3 here\n", stderr);
    }
    glfwTerminate();
    return status;
}
