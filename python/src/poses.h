#pragma once

#include "bindings.h"

#include <bendy/runtime/lod.h>
#include <bendy/runtime/palette_matrix.h>

#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

// Pose as Python has it, and calls without the GIL: for the sources that pose.
namespace bendy::python {

struct PyPose {
    SharedCharacter character;
    Pose pose;
    bool is_busy = false;  // in a call that has released the GIL; read and written with the GIL held
};

/// A level of detail of a model. It never changes, so that threads may share it.
struct PyLod {
    SharedCharacter character;
    float share = 1.0f;
    Lod lod;
};

/// Raises RuntimeError if another thread uses the pose.
inline void check_free(const PyPose& pose) {
    if (pose.is_busy) throw std::runtime_error("the pose is in use by another thread: give each thread its own");
}

/// For a call that releases the GIL: no other thread may use the pose meanwhile.
class Use {
public:
    explicit Use(PyPose& pose) : pose_(pose) {
        check_free(pose);
        pose.is_busy = true;
    }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    Use(Use&&) = delete;
    Use& operator=(Use&&) = delete;
    ~Use() { pose_.is_busy = false; }

    [[nodiscard]] Pose& operator*() const { return pose_.pose; }

private:
    PyPose& pose_;
};

/// Does work that takes no Python object without the GIL.
template <class Work>
auto without_gil(const Work& work) {
    const py::gil_scoped_release released;
    return work();
}

inline float check_finite(double number, const char* name) {
    const auto value = static_cast<float>(number);
    if (!std::isfinite(value)) throw py::value_error(std::string(name) + " must be a finite number");
    return value;
}

/// Matrices by row and column; `out` has 16 numbers for each.
inline void write_matrices(std::span<const glm::mat4> matrices, float* out) {
    for (const glm::mat4& matrix : matrices) {
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column) *out++ = matrix[column][row];
        }
    }
}

/// Rows of palette matrices; `out` has 12 numbers for each.
inline void write_palette(std::span<const PaletteMatrix> entries, float* out) {
    for (const PaletteMatrix& entry : entries) {
        for (const auto& row : entry.rows) out = std::copy(std::begin(row), std::end(row), out);
    }
}

/// Of (4, 4) numbers, [row, column]. Raises TypeError, ValueError.
glm::mat4 matrix_of(const py::handle& numbers, const char* name);

}  // namespace bendy::python
