#pragma once

#include <bendy/converter/report.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace bendy::converter {

/// Gathers what is left out, and says each kind of it in one warning: which, at least the first of them, and how many.
class Losses {
public:
    /// `kind` in the plural, as `meshes that no node draws`; `which` one line, as `'helmet'` or `meshes[3]`.
    void add(const std::string& kind, std::string which, const std::string& place);
    void report(Report& report) const;

private:
    struct Kind {
        std::string name;
        std::vector<std::string> shown;
        std::string first_place;
        std::uint64_t count = 0;
    };
    std::vector<Kind> kinds_;                     ///< in the order in which they came
    std::map<std::string, std::size_t> kind_of_;  ///< by name, into kinds_
};

}  // namespace bendy::converter
