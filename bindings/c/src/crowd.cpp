// Many characters of one model.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"
#include "matrices.h"
#include "vertices.h"

#include <bendy/runtime/sample.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

namespace bendy::capi {
namespace {

constexpr std::uint32_t kMostWorkers = 4096;  // each needs the memory of a pose

/// A member's request after its arguments are checked. `palette` is the caller's memory for matrices.
struct Request {
    CrowdMember member;
    float* palette = nullptr;
};

/// \param has_clip  whether the member's clip and time are used
bendy_status take_member(const Character& character, const bendy_crowd_member* members, std::size_t number,
                         bool has_clip, Request& taken, bendy_error* error) {
    bendy_crowd_member values = BENDY_CROWD_MEMBER_INIT;
    if (const bendy_status status = take(at(members, number), "members", values, error)) return status;
    const Model& model = character.model;
    taken = {};
    if (has_clip && values.clip != BENDY_NONE) {
        if (const bendy_status status = check_index(values.clip, Parts(character).clip(), "clip", error)) return status;
        if (const bendy_status status = check_number(values.seconds, "seconds", error)) return status;
        taken.member.clip = &model.clips()[values.clip];
        taken.member.seconds = values.seconds;
    }
    if (values.lod != nullptr) {
        if (values.lod->character.get() != &character)
            return fail(error, BENDY_BAD_ARGUMENT, "lod is of another model than the crowd");
        taken.member.lod = &values.lod->lod;
    }
    taken.palette = values.palette;
    if (values.vertices == nullptr) return BENDY_OK;
    bendy_vertices vertices = BENDY_VERTICES_INIT;
    if (const bendy_status status = take(values.vertices, "out", vertices, error)) return status;
    return take_buffer(vertices, model.vertex_count(), taken.member.out, error);
}

/// Plays the members; set_pose(number, member, pose) sets each one's pose.
template <class SetPose>
bendy_status play(bendy_crowd* crowd, const bendy_crowd_member* members, std::size_t count, std::uint32_t worker,
                  bool has_clips, const SetPose& set_pose, bendy_error* error) {
    if (const bendy_status status = check_index(worker, crowd->crowd.workers(), "worker", error, "the crowd"))
        return status;
    if (const bendy_status status = check_array(members, count, "members", error)) return status;
    Request request;
    const auto take_number = [&](std::size_t number) {
        return take_member(*crowd->character, members, number, has_clips, request, error);
    };
    for (std::size_t number = 0; number < count; ++number) {  // check everything before the first write
        if (const bendy_status status = take_number(number)) return status;
    }
    const std::size_t palette_size = crowd->crowd.palette_size();
    PaletteMatrix* const palettes = crowd->palettes.data() + worker * Crowd::kAtOnce * palette_size;
    std::array<CrowdMember, Crowd::kAtOnce> taken;
    std::array<float*, Crowd::kAtOnce> outputs{};
    for (std::size_t first = 0; first < count; first += Crowd::kAtOnce) {
        const std::size_t size = std::min(Crowd::kAtOnce, count - first);
        for (std::size_t k = 0; k < size; ++k) {
            if (const bendy_status status = take_number(first + k)) return status;
            taken[k] = request.member;
            outputs[k] = request.palette;
            if (outputs[k] != nullptr) taken[k].palette = {palettes + k * palette_size, palette_size};
        }
        const auto played = crowd->crowd.play({taken.data(), size}, worker, [&](const CrowdMember& member, Pose& pose) {
            set_pose(first + static_cast<std::size_t>(&member - taken.data()), member, pose);
        });
        if (!played) return from_call(played, error);
        for (std::size_t k = 0; k < size; ++k) {
            if (outputs[k] == nullptr) continue;
            float* to = outputs[k];
            for (const PaletteMatrix& matrix : taken[k].palette) {
                put_matrix(matrix, to);
                to += kMatrixNumbers;
            }
        }
    }
    return BENDY_OK;
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::crowd_new(const bendy_model* model, uint32_t workers, bendy_crowd*& made,
                                    bendy_error* error) {
    if (workers > kMostWorkers) {
        return fail(error, BENDY_BAD_ARGUMENT,
                    "expected at most " + std::to_string(kMostWorkers) + " workers, found " + std::to_string(workers));
    }
    made = std::make_unique<bendy_crowd>(model->character, workers).release();
    return BENDY_OK;
}

uint32_t bendy_crowd_workers(const bendy_crowd* crowd) {
    return crowd == nullptr ? 0 : static_cast<uint32_t>(crowd->crowd.workers());
}

size_t bendy_crowd_palette_size(const bendy_crowd* crowd) {
    return crowd == nullptr ? 0 : crowd->crowd.palette_size();
}

size_t bendy_crowd_first_matrix(const bendy_crowd* crowd, uint32_t mesh) {
    if (crowd == nullptr || mesh >= crowd->character->model.meshes().size()) return 0;
    return crowd->crowd.first_entry(mesh);
}

bendy_status bendy::capi::crowd_play(bendy_crowd* crowd, const bendy_crowd_member* members, size_t count,
                                     uint32_t worker, bendy_error* error) {
    const auto sample_clip = [](std::size_t, const bendy::CrowdMember& member, bendy::Pose& pose) {
        (void)bendy::sample(pose, member.clip, member.seconds);  // without a clip: the rest pose
    };
    return play(crowd, members, count, worker, true, sample_clip, error);
}

bendy_status bendy::capi::crowd_play_posed(bendy_crowd* crowd, const bendy_crowd_member* members, size_t count,
                                           uint32_t worker, bendy_pose_member pose_member, void* user,
                                           bendy_error* error) {
    const auto call = [&](std::size_t number, const bendy::CrowdMember&, bendy::Pose& pose) {
        bendy_pose handle(crowd->character, std::move(pose));  // lends the worker's pose to the caller
        pose_member(user, number, &handle);
        pose = std::move(handle.pose);
    };
    return play(crowd, members, count, worker, false, call, error);
}
