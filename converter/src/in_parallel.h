#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace bendy::converter {

/// Calls work(k, worker) for each k from 0 to count - 1, on up to `threads` threads, the caller's own among them; fewer
/// where no more can be had. `worker` is less than `threads`, and no two calls have the same at a time. Returns when
/// all calls have. What one of them throws is thrown here, and calls that have not begun are left out.
template <class Work>
void in_parallel(std::size_t threads, std::size_t count, const Work& work) {
    std::atomic<std::size_t> next{0};
    std::mutex guard;
    std::exception_ptr thrown;
    const auto take_turns = [&](std::size_t worker) {
        for (std::size_t k = next++; k < count; k = next++) {
            try {
                work(k, worker);
            } catch (...) {
                next = count;
                const std::lock_guard lock(guard);
                thrown = std::current_exception();
            }
        }
    };
    std::vector<std::thread> others;
    others.reserve(std::min(threads, count));
    try {
        while (others.size() + 1 < std::min(threads, count)) others.emplace_back(take_turns, others.size() + 1);
    } catch (const std::exception&) {  // no more threads, or no memory for one: those that there are do the rest
    }
    take_turns(0);
    for (std::thread& other : others) other.join();
    if (thrown) std::rethrow_exception(thrown);
}

/// Adds up what is done by several threads, and tells it one call at a time, in steps of a hundredth at least; what is
/// told never falls.
class SharedProgress {
public:
    /// \param tell  takes the part that is done, 0 to 1; may be empty
    SharedProgress(const std::function<void(double)>& tell, double all) : tell_(tell), all_(all) {}

    [[nodiscard]] bool is_heard() const { return static_cast<bool>(tell_); }

    /// \param more  of what there is to do: nothing if that is 0
    void add(double more) {
        if (!tell_ || !(more > 0.0)) return;
        const std::lock_guard lock(guard_);
        done_ += more;
        constexpr double kRounding = 1e-9;
        const double part = done_ / all_ > 1.0 - kRounding ? 1.0 : done_ / all_;
        constexpr double kStep = 0.01;
        if (part < told_ + kStep && !(part == 1.0 && told_ < 1.0)) return;
        told_ = part;
        tell_(part);
    }

private:
    const std::function<void(double)>& tell_;
    double all_;
    double done_ = 0.0;
    double told_ = 0.0;
    std::mutex guard_;
};

}  // namespace bendy::converter
