#pragma once

#include <stdexcept>

namespace bendy::viewer {

/// No picture can be made: no OpenGL, no display, not enough memory. what() is a line for the user.
class ViewerError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace bendy::viewer
