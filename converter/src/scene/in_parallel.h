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

/// Calls work(k, worker) for each k from 0 to count - 1, on up to `threads` threads including the caller's; fewer if no
/// more can be created. `worker` is less than `threads` and unique among concurrent calls. Returns when all calls have
/// returned. Rethrows an exception from a call; calls that have not started are then skipped.
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
    } catch (const std::exception&) {  // no more threads, or out of memory: continue with the existing ones
    }
    take_turns(0);
    for (std::thread& other : others) other.join();
    if (thrown) std::rethrow_exception(thrown);
}

/// Sums the progress of several threads and reports it from one thread at a time, in steps of at least a hundredth; the
/// reported value never decreases.
class SharedProgress {
public:
    /// \param tell  receives the fraction done, 0 to 1; may be empty
    SharedProgress(const std::function<void(double)>& tell, double all) : tell_(tell), all_(all) {}

    [[nodiscard]] bool is_heard() const { return static_cast<bool>(tell_); }

    /// \param more  amount of work done; 0 is ignored
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
