#pragma once

#include <bendy/runtime/model.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

// Models that are made for measuring, of any size.
namespace bendy::bench {

struct MadeModel {
    std::vector<std::byte> bytes;  // in which the model lies
    Model model;
};

/// A pool of vertices with four influences among 64 joints, near ones together, as characters have them.
std::unique_ptr<const MadeModel> make_pool(std::uint32_t vertices);

/// A chain with a pole: two bones, or for Solver::aim one joint.
/// \param is_limited  the middle joint is a hinge
std::unique_ptr<const MadeModel> make_chain(Solver solver, bool is_limited);

}  // namespace bendy::bench
