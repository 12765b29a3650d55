#include <bendy/runtime/transform.h>

#include <gtest/gtest.h>
