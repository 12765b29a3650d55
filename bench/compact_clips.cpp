// bendy_bench_compact_clips [--shell] [--error MM] [--peers PEERS.tsv] [--unit METRES] FILE...: the sizes of packed
// clips, compared with those of other programs. --unit gives the length of one unit in the files that follow it.
#include "optimise/compact/pack_clips.h"

#include <bendy/converter/import.h>
#include <bendy/format/packed_clip.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace bendy;
using namespace bendy::converter;

namespace {

/// The columns of the table of other programs' sizes, by asset and clip.
class Peers {
public:
    void read(const char* path) {
        std::ifstream file(path);
        std::string line;
        while (std::getline(file, line)) {
            std::vector<std::string> cells;
            std::istringstream row(line);
            for (std::string cell; std::getline(row, cell, '\t');) cells.push_back(cell);
            if (columns_.empty()) {
                for (std::size_t c = 0; c < cells.size(); ++c) columns_[cells[c]] = c;
            } else {
                rows_.push_back(std::move(cells));
            }
        }
    }
    long number(std::string_view clip, const std::string& column) const {
        for (const auto& row : rows_) {
            if (row[1] == clip || rows_of_unnamed(row, clip)) return std::atol(row[columns_.at(column)].c_str());
        }
        return -1;
    }

private:
    static bool rows_of_unnamed(const std::vector<std::string>& row, std::string_view clip) {
        return clip.empty() && row[1] == "clip";
    }
    std::map<std::string, std::size_t> columns_;
    std::vector<std::vector<std::string>> rows_;
};

}  // namespace

int main(int argc, char** argv) {
    Probes probes = Probes::skin_and_shell;
    double error = 1e-4;
    double unit = 1.0;
    Peers peers;
    std::uint64_t source = 0;
    std::uint64_t memory = 0;
    std::uint64_t disk = 0;
    std::printf("%-14s %7s %8s %8s %8s %9s %8s %8s\n", "clip", "source", "memory", "disk", "worst mm", "ACL", "probe",
                "seconds");
    for (int a = 1; a < argc; ++a) {
        const std::string_view argument = argv[a];
        const auto value = [&] { return a + 1 < argc ? argv[++a] : ""; };
        if (argument == "--shell") {
            probes = Probes::shell;
        } else if (argument == "--error") {
            error = std::atof(value()) * 1e-3;
        } else if (argument == "--unit") {
            unit = std::atof(value());
        } else if (argument == "--peers") {
            peers.read(value());
        } else {
            Report report;
            auto scene = import_gltf(argument, {}, report);
            if (!scene) {
                std::fprintf(stderr, "%s: %s\n", argv[a], scene.error().message.c_str());
                return 1;
            }
            std::vector<double> seconds;
            std::vector<PackedReport> reports;
            std::vector<std::uint64_t> stored;
            for (std::size_t number = 0; number < scene->clips.size(); ++number) {  // one at a time, to time each
                std::vector<double> bounds(scene->clips.size(), 0.0);
                bounds[number] = error / unit;
                const auto before = std::chrono::steady_clock::now();
                reports.push_back(pack_clips(*scene, bounds, {.probes = probes})[number]);
                seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count());
                const std::vector<std::byte>& packed = scene->clips[number].packed;
                const auto encoded = encode_payload(Codec::clip, packed, 0, 0);
                stored.push_back(encoded ? std::min(encoded->size(), packed.size()) : packed.size());
            }
            std::size_t number = 0;
            for (const PackedReport& row : reports) {
                std::printf("%-14s %7llu %8llu %8llu %8.5f %9ld %4ld/%ld %7.2f%s\n", row.name.c_str(),
                            static_cast<unsigned long long>(row.source_bytes),
                            static_cast<unsigned long long>(row.packed_bytes),
                            static_cast<unsigned long long>(stored[number]), row.worst_error * unit * 1e3,
                            peers.number(row.name, "acl_bytes"), peers.number(row.name, "probe_memory_bytes"),
                            peers.number(row.name, "probe_disk_bytes"), seconds[number],
                            row.kept_bytes > 0 ? " (keys kept)" : "");
                std::fflush(stdout);
                source += row.source_bytes;
                memory += row.packed_bytes;
                disk += stored[number];
                ++number;
            }
        }
    }
    std::printf("%-14s %7llu %8llu %8llu\n", "all", static_cast<unsigned long long>(source),
                static_cast<unsigned long long>(memory), static_cast<unsigned long long>(disk));
    return 0;
}
