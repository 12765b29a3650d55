#include <bendy/edit/clips.h>

#include "rewrite.h"

#include <bendy/format/codec.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <utility>

namespace bendy::edit {
namespace {

class InfluenceLimiter {
public:
    InfluenceLimiter(const Source& source, const MeshView& mesh, std::uint32_t most, Rewrite& rewrite)
        : tree_(source.tree), mesh_(mesh), most_(most), rewrite_(rewrite) {}

    void limit(Log& log) {
        const std::uint32_t n = mesh_.weights->components;
        for (std::uint32_t vertex = 0; vertex < mesh_.vertices; ++vertex) choose(vertex);
        put(mesh_.bones->chunk, mesh_.bones->type, false, bones_);
        put_weights();
        if (changed_ == 0) {
            log.done.push_back("mesh \"" + std::string(mesh_.name) + "\": no vertex has more than " +
                               std::to_string(most_) + " influences; " + std::to_string(n) + " were stored");
            return;
        }
        std::array<char, 16> lost{};
        std::snprintf(lost.data(), lost.size(), "%.3g", most_lost_);
        log.done.push_back("mesh \"" + std::string(mesh_.name) + "\": " + std::to_string(changed_) + " of " +
                           std::to_string(mesh_.vertices) + " vertices had more than " + std::to_string(most_) +
                           " influences; the largest sum of weights that one loses is " + lost.data());
    }

private:
    /// Chooses the largest weights of a vertex, in the order that they have.
    void choose(std::uint32_t vertex) {
        const std::uint32_t n = mesh_.weights->components;
        std::vector<std::uint32_t> order(n);
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return mesh_.weights->number(vertex, a) > mesh_.weights->number(vertex, b);
        });
        order.resize(most_);
        std::sort(order.begin(), order.end());
        double all = 0.0;
        double kept = 0.0;
        for (std::uint32_t k = 0; k < n; ++k) all += mesh_.weights->number(vertex, k);
        for (const std::uint32_t k : order) kept += mesh_.weights->number(vertex, k);
        const bool is_changed = kept < all;
        changed_ += is_changed ? 1 : 0;
        most_lost_ = std::max(most_lost_, all - kept);
        for (const std::uint32_t k : order) {
            bones_.push_back(mesh_.bones->index(vertex, k));
            const double weight = mesh_.weights->number(vertex, k);
            weights_.push_back(static_cast<float>(is_changed ? weight * (all / kept) : weight));
        }
    }

    void put_weights() {
        const StreamView& stream = *mesh_.weights;
        // Boxed weights have the boxes of the old order, and become numbers.
        if (stream.type == ComponentType::f32 || !stream.boxes.empty())
            return put(stream.chunk, ComponentType::f32, false, weights_);
        const double steps = stream.type == ComponentType::u8 ? 255.0 : 65'535.0;
        std::vector<std::uint32_t> whole;
        whole.reserve(weights_.size());
        for (std::size_t at = 0; at < weights_.size(); at += most_) {
            // Rounded down; what is missing goes to the numbers that lost most.
            std::vector<std::pair<double, std::size_t>> rests;
            double sum = 0.0;
            double used = 0.0;
            for (std::size_t k = 0; k < most_; ++k) {
                const double exact = weights_[at + k] * steps;
                const double below = std::floor(exact + 1e-3);
                whole.push_back(static_cast<std::uint32_t>(below));
                rests.emplace_back(below - exact, k);
                sum += exact;
                used += below;
            }
            std::sort(rests.begin(), rests.end());
            for (std::size_t k = 0; k < most_ && used + 0.5 < sum; ++k, used += 1.0) ++whole[at + rests[k].second];
        }
        put(stream.chunk, stream.type, true, whole);
    }

    template <class Number>
    void put(std::uint32_t chunk, ComponentType type, bool is_normalised, const std::vector<Number>& numbers) {
        StreamRecord record;
        copy_at(tree_.payload(chunk), 0, record);
        record.component_type = static_cast<std::uint8_t>(type);
        record.normalised = is_normalised ? 1 : 0;
        record.components = static_cast<std::uint16_t>(most_);
        Buffer payload;
        append(payload, record);
        const std::size_t size = component_size(type);
        for (const Number& number : numbers) {
            const Bytes bytes = bytes_of(number);
            payload.insert(payload.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        }
        const Chunk& before = tree_[chunk];
        rewrite_.replace_whole(chunk, encode_leaf(before.id, before.flags, static_cast<Codec>(before.codec()),
                                                  sizeof record, static_cast<std::uint16_t>(size * most_), payload));
    }

    const ChunkTree& tree_;
    const MeshView& mesh_;
    std::uint32_t most_;
    Rewrite& rewrite_;
    std::vector<std::uint32_t> bones_;
    std::vector<float> weights_;
    std::size_t changed_ = 0;
    double most_lost_ = 0.0;
};

}  // namespace

Edited limit_influences(Bytes file, std::uint32_t most, Log& log) {
    if (most == 0) return Problem{"a vertex needs at least 1 influence"};
    const auto source = open_source(file);
    if (!source) return source.error();
    Rewrite rewrite(source->tree);
    bool is_changed = false;
    for (const ObjectView& object : source->document.objects) {
        for (const MeshView& mesh : object.meshes) {
            if (mesh.is_rigid() || mesh.weights->components <= most) continue;
            InfluenceLimiter(*source, mesh, most, rewrite).limit(log);
            is_changed = true;
        }
    }
    if (!is_changed) log.done.push_back("no mesh has more than " + std::to_string(most) + " influences per vertex");
    if (is_changed && source->document.bound)
        log.warnings.emplace_back("the error that the file states was measured with all influences");
    return finish(rewrite);
}

}  // namespace bendy::edit
