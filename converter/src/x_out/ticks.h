#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <vector>

namespace bendy::converter::x_out {

/// Key times of X-files are whole numbers; one file has one number of ticks in a second.
class Ticks {
public:
    /// Cycles that take longer are left out.
    static constexpr float kLongest = 1e6f;  ///< seconds

    /// Takes a frame rate that gives every key time of the scene back to the bit, if there is one; else as many ticks
    /// as the longest cycle lets 31 bits count, a power of two, which rounds times that are small beside it only.
    explicit Ticks(const Scene& scene);

    [[nodiscard]] std::uint32_t per_second() const { return per_second_; }
    [[nodiscard]] double seconds(std::uint64_t tick) const { return static_cast<double>(tick) / per_second_; }
    /// The ticks of ascending times from 0 on, strictly ascending.
    /// \param rounded  counts the times that do not come back
    [[nodiscard]] std::vector<std::uint64_t> of(const std::vector<float>& times, float shift,
                                                std::uint64_t& rounded) const;

private:
    [[nodiscard]] bool is_exact(const Scene& scene) const;

    std::uint32_t per_second_ = 4800;
};

/// By how much a cycle's times are moved, so that none is below 0; seconds.
float shift_of(const Cycle& cycle);

}  // namespace bendy::converter::x_out
