#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Measures Bendy and its peers by turns, in one process.
namespace bendy::bench {

struct Contestant {
    std::string name;
    std::function<void()> run;
};

/// What a row of the table is about.
struct Race {
    std::string subject;  ///< the character
    std::string what;
    std::string unit;    ///< what the times are per: "joint", "vertex"
    double items = 1.0;  ///< number of units in one run
};

/// Runs the contestants of one race after another and prints a row of a Markdown table for each.
class Table {
public:
    /// \param rounds  at most; fewer, but at least nine, where they would take more than six seconds
    explicit Table(int rounds) : rounds_(rounds) {}

    static void print_head();
    /// Runs every contestant once a round, in an order that is reversed from one round to the next. The first one is
    /// ours. Prints a row for each of the others: the shortest time of each in nanoseconds, their ratio, and the median
    /// over the rounds of ours / theirs.
    void compare(const Race& race, const std::vector<Contestant>& contestants);

    /// A line to be printed below the table.
    void add_note(std::string note) { notes_.push_back(std::move(note)); }
    void print_notes() const;

private:
    int rounds_;
    std::vector<std::string> notes_;
};

/// Ends the program with status 1 and a message.
[[noreturn]] void fail(std::string_view message);

/// The same, unless is_good. `what` has failed.
void check(bool is_good, std::string_view what);

}  // namespace bendy::bench
