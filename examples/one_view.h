#pragma once

#include <GL/gl.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdio>
#include <vector>

// Shared by the OpenGL programs: a camera, and a picture of the window.

constexpr int kWidth = 640;
constexpr int kHeight = 480;

/// Returns a camera in front of a character (which faces +Z) that sees all of the box that it is in.
inline glm::mat4 see_all(const glm::vec3& low, const glm::vec3& high) {
    const glm::vec3 middle = (low + high) * 0.5f;
    const float size = glm::length(high - low);
    const glm::vec3 eye = middle + size * glm::vec3(0.36f, 0.2f, 0.95f);
    return glm::perspective(glm::radians(45.0f), float{kWidth} / kHeight, size * 0.01f, size * 10.0f) *
           glm::lookAt(eye, middle, glm::vec3(0.0f, 1.0f, 0.0f));
}

/// Writes what is drawn as a PPM picture.
inline bool write_picture(const char* path) {
    std::vector<unsigned char> pixels(std::size_t{3} * kWidth * kHeight);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    std::FILE* file = std::fopen(path, "wb");
    if (file == nullptr) return false;
    std::fprintf(file, "P6 %d %d 255\n", kWidth, kHeight);
    for (int row = kHeight - 1; row >= 0; --row) {
        std::fwrite(pixels.data() + std::size_t{3} * kWidth * static_cast<std::size_t>(row), 3, kWidth, file);
    }
    return std::fclose(file) == 0;
}
