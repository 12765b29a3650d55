#include "losses.h"

#include <utility>

namespace bendy::converter {

void Losses::add(const std::string& kind, std::string which, const std::string& place) {
    constexpr std::size_t kMostShown = 12;
    const auto [known, is_new] = kind_of_.try_emplace(kind, kinds_.size());
    if (is_new) kinds_.push_back({kind, {}, place, 0});
    Kind& entry = kinds_[known->second];
    if (entry.count++ < kMostShown) entry.shown.push_back(std::move(which));
}

void Losses::report(Report& report) const {
    for (const Kind& kind : kinds_) {
        std::string list;
        for (const std::string& which : kind.shown) list.append(list.empty() ? "" : ", ").append(which);
        if (kind.count > kind.shown.size()) list += ", ...";
        report.warn(kind.name + " left out: " + list, kind.first_place, kind.count);
    }
}

}  // namespace bendy::converter
