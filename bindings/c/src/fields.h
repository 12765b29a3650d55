// Made from bendy.h by bindings/make_c.py.
#pragma once
#include <bendy.h>
#include <cstddef>
#include "assign.h"
#include "fail.h"
namespace bendy::capi {
template <>
inline constexpr std::size_t kFirstSize<bendy_open_options> = offsetof(bendy_open_options, copied);
template <>
inline constexpr std::size_t kFirstSize<bendy_joint> = offsetof(bendy_joint, extras);
template <>
inline constexpr std::size_t kFirstSize<bendy_clip> = offsetof(bendy_clip, is_packed);
template <>
inline constexpr std::size_t kFirstSize<bendy_chain> = offsetof(bendy_chain, solver);
template <>
inline constexpr std::size_t kFirstSize<bendy_morph_target> = offsetof(bendy_morph_target, vertices);
template <>
inline constexpr std::size_t kFirstSize<bendy_mesh> = offsetof(bendy_mesh, mover);
template <>
inline constexpr std::size_t kFirstSize<bendy_material> = offsetof(bendy_material, normal_scale);
template <>
inline constexpr std::size_t kFirstSize<bendy_curve> = offsetof(bendy_curve, interpolation);
template <>
struct Fields<bendy_open_options> {
    template <class To>
    static void from_c(const bendy_open_options& from, To& to) {
        assign(from.object, to.object);
        assign(from.sums_later, to.sums_later);
        assign(from.copied, to.copied);
    }
};

template <>
struct Fields<bendy_transform> {
    static bendy_status check(const bendy_transform& from, bendy_error* error) {
        if (const bendy_status status = check_rotation(from.rotation, error)) return status;
        if (const bendy_status status = check_finite(from.translation, "translation", error)) return status;
        if (const bendy_status status = check_finite(from.scale, "scale", error)) return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_transform& from, To& to) {
        assign(from.rotation, to.rotation);
        assign(from.translation, to.translation);
        assign(from.scale, to.scale);
    }
    template <class From>
    static void to_c(const From& from, bendy_transform& to) {
        if constexpr (requires { from.rotation; }) assign(from.rotation, to.rotation);
        if constexpr (requires { from.translation; }) assign(from.translation, to.translation);
        if constexpr (requires { from.scale; }) assign(from.scale, to.scale);
    }
};

template <>
struct Fields<bendy_joint> {
    template <class From>
    static void to_c(const From& from, bendy_joint& to) {
        if constexpr (requires { from.parent; }) assign(from.parent, to.parent);
        if constexpr (requires { from.rest; }) assign(from.rest, to.rest);
        if constexpr (requires { from.shear; }) assign(from.shear, to.shear);
        if constexpr (requires { from.role; }) assign(from.role, to.role);
        if constexpr (requires { from.role_place; }) assign(from.role_place, to.role_place);
    }
};

template <>
struct Fields<bendy_clip> {
    template <class From>
    static void to_c(const From& from, bendy_clip& to) {
        if constexpr (requires { from.loops; }) assign(from.loops, to.loops);
        if constexpr (requires { from.start; }) assign(from.start, to.start);
        if constexpr (requires { from.end; }) assign(from.end, to.end);
        if constexpr (requires { from.frame_rate; }) assign(from.frame_rate, to.frame_rate);
        if constexpr (requires { from.is_packed; }) assign(from.is_packed, to.is_packed);
    }
};

template <>
struct Fields<bendy_chain> {
    template <class From>
    static void to_c(const From& from, bendy_chain& to) {
        if constexpr (requires { from.start; }) assign(from.start, to.start);
        if constexpr (requires { from.effector; }) assign(from.effector, to.effector);
        if constexpr (requires { from.links; }) assign(from.links, to.links);
        if constexpr (requires { from.target; }) assign(from.target, to.target);
        if constexpr (requires { from.pole; }) assign(from.pole, to.pole);
        if constexpr (requires { from.solver; }) assign(from.solver, to.solver);
        if constexpr (requires { from.flags; }) assign(from.flags, to.flags);
        if constexpr (requires { from.iterations; }) assign(from.iterations, to.iterations);
        if constexpr (requires { from.priority; }) assign(from.priority, to.priority);
        if constexpr (requires { from.tolerance; }) assign(from.tolerance, to.tolerance);
        if constexpr (requires { from.pole_vector; }) assign(from.pole_vector, to.pole_vector);
        if constexpr (requires { from.pole_angle; }) assign(from.pole_angle, to.pole_angle);
        if constexpr (requires { from.tip_offset; }) assign(from.tip_offset, to.tip_offset);
        if constexpr (requires { from.tip_rotation; }) assign(from.tip_rotation, to.tip_rotation);
        if constexpr (requires { from.position_weight; }) assign(from.position_weight, to.position_weight);
        if constexpr (requires { from.rotation_weight; }) assign(from.rotation_weight, to.rotation_weight);
        if constexpr (requires { from.influence; }) assign(from.influence, to.influence);
        if constexpr (requires { from.stretch; }) assign(from.stretch, to.stretch);
        if constexpr (requires { from.compress; }) assign(from.compress, to.compress);
    }
};

template <>
struct Fields<bendy_morph_target> {
    template <class From>
    static void to_c(const From& from, bendy_morph_target& to) {
        if constexpr (requires { from.mesh; }) assign(from.mesh, to.mesh);
        if constexpr (requires { from.rest_weight; }) assign(from.rest_weight, to.rest_weight);
        if constexpr (requires { from.vertices; }) assign(from.vertices, to.vertices);
        if constexpr (requires { from.has_positions; }) assign(from.has_positions, to.has_positions);
        if constexpr (requires { from.has_normals; }) assign(from.has_normals, to.has_normals);
        if constexpr (requires { from.has_tangents; }) assign(from.has_tangents, to.has_tangents);
    }
};

template <>
struct Fields<bendy_mesh> {
    template <class From>
    static void to_c(const From& from, bendy_mesh& to) {
        if constexpr (requires { from.vertices; }) assign(from.vertices, to.vertices);
        if constexpr (requires { from.first_vertex; }) assign(from.first_vertex, to.first_vertex);
        if constexpr (requires { from.indices; }) assign(from.indices, to.indices);
        if constexpr (requires { from.joint; }) assign(from.joint, to.joint);
        if constexpr (requires { from.first_morph_target; }) assign(from.first_morph_target, to.first_morph_target);
        if constexpr (requires { from.targets; }) assign(from.targets, to.targets);
        if constexpr (requires { from.has_normals; }) assign(from.has_normals, to.has_normals);
        if constexpr (requires { from.has_tangents; }) assign(from.has_tangents, to.has_tangents);
        if constexpr (requires { from.texture_coord_sets; }) assign(from.texture_coord_sets, to.texture_coord_sets);
        if constexpr (requires { from.bones; }) assign(from.bones, to.bones);
        if constexpr (requires { from.influences; }) assign(from.influences, to.influences);
        if constexpr (requires { from.mover; }) assign(from.mover, to.mover);
        if constexpr (requires { from.frames; }) assign(from.frames, to.frames);
        if constexpr (requires { from.first_frame; }) assign(from.first_frame, to.first_frame);
    }
};

template <>
struct Fields<bendy_submesh> {
    template <class From>
    static void to_c(const From& from, bendy_submesh& to) {
        if constexpr (requires { from.mesh; }) assign(from.mesh, to.mesh);
        if constexpr (requires { from.material; }) assign(from.material, to.material);
        if constexpr (requires { from.topology; }) assign(from.topology, to.topology);
        if constexpr (requires { from.first; }) assign(from.first, to.first);
        if constexpr (requires { from.count; }) assign(from.count, to.count);
    }
};

template <>
struct Fields<bendy_texture_use> {
    template <class From>
    static void to_c(const From& from, bendy_texture_use& to) {
        if constexpr (requires { from.texture; }) assign(from.texture, to.texture);
        if constexpr (requires { from.set; }) assign(from.set, to.set);
        if constexpr (requires { from.offset; }) assign(from.offset, to.offset);
        if constexpr (requires { from.scale; }) assign(from.scale, to.scale);
        if constexpr (requires { from.rotation; }) assign(from.rotation, to.rotation);
    }
};

template <>
struct Fields<bendy_material> {
    template <class From>
    static void to_c(const From& from, bendy_material& to) {
        if constexpr (requires { from.metallic; }) assign(from.metallic, to.metallic);
        if constexpr (requires { from.roughness; }) assign(from.roughness, to.roughness);
        if constexpr (requires { from.base_colour; }) assign(from.base_colour, to.base_colour);
        if constexpr (requires { from.emissive; }) assign(from.emissive, to.emissive);
        if constexpr (requires { from.double_sided; }) assign(from.double_sided, to.double_sided);
        if constexpr (requires { from.normal_scale; }) assign(from.normal_scale, to.normal_scale);
        if constexpr (requires { from.occlusion_strength; }) assign(from.occlusion_strength, to.occlusion_strength);
        if constexpr (requires { from.alpha_cutoff; }) assign(from.alpha_cutoff, to.alpha_cutoff);
        if constexpr (requires { from.alpha_mode; }) assign(from.alpha_mode, to.alpha_mode);
        if constexpr (requires { from.unlit; }) assign(from.unlit, to.unlit);
        if constexpr (requires { from.base_colour_texture; }) assign(from.base_colour_texture, to.base_colour_texture);
        if constexpr (requires { from.metallic_roughness_texture; })
            assign(from.metallic_roughness_texture, to.metallic_roughness_texture);
        if constexpr (requires { from.normal_texture; }) assign(from.normal_texture, to.normal_texture);
        if constexpr (requires { from.occlusion_texture; }) assign(from.occlusion_texture, to.occlusion_texture);
        if constexpr (requires { from.emissive_texture; }) assign(from.emissive_texture, to.emissive_texture);
    }
};

template <>
struct Fields<bendy_texture> {
    template <class From>
    static void to_c(const From& from, bendy_texture& to) {
        if constexpr (requires { from.images; }) assign(from.images, to.images);
        if constexpr (requires { from.mag_filter; }) assign(from.mag_filter, to.mag_filter);
        if constexpr (requires { from.min_filter; }) assign(from.min_filter, to.min_filter);
        if constexpr (requires { from.wrap_s; }) assign(from.wrap_s, to.wrap_s);
        if constexpr (requires { from.wrap_t; }) assign(from.wrap_t, to.wrap_t);
    }
};

template <>
struct Fields<bendy_image> {
    template <class From>
    static void to_c(const From& from, bendy_image& to) {
        if constexpr (requires { from.media; }) assign(from.media, to.media);
        if constexpr (requires { from.byte_count; }) assign(from.byte_count, to.byte_count);
        if constexpr (requires { from.texture; }) assign(from.texture, to.texture);
        if constexpr (requires { from.image; }) assign(from.image, to.image);
    }
};

template <>
struct Fields<bendy_stream> {
    template <class From>
    static void to_c(const From& from, bendy_stream& to) {
        if constexpr (requires { from.kind; }) assign(from.kind, to.kind);
        if constexpr (requires { from.set; }) assign(from.set, to.set);
        if constexpr (requires { from.elements; }) assign(from.elements, to.elements);
        if constexpr (requires { from.components; }) assign(from.components, to.components);
        if constexpr (requires { from.type; }) assign(from.type, to.type);
        if constexpr (requires { from.normalised; }) assign(from.normalised, to.normalised);
        if constexpr (requires { from.data_size; }) assign(from.data_size, to.data_size);
    }
};

template <>
struct Fields<bendy_joint_submesh> {
    template <class From>
    static void to_c(const From& from, bendy_joint_submesh& to) {
        if constexpr (requires { from.joint; }) assign(from.joint, to.joint);
        if constexpr (requires { from.mesh; }) assign(from.mesh, to.mesh);
        if constexpr (requires { from.material; }) assign(from.material, to.material);
        if constexpr (requires { from.topology; }) assign(from.topology, to.topology);
        if constexpr (requires { from.first; }) assign(from.first, to.first);
        if constexpr (requires { from.count; }) assign(from.count, to.count);
    }
};

template <>
struct Fields<bendy_constraint> {
    template <class From>
    static void to_c(const From& from, bendy_constraint& to) {
        if constexpr (requires { from.joint; }) assign(from.joint, to.joint);
        if constexpr (requires { from.model; }) assign(from.model, to.model);
        if constexpr (requires { from.euler_order; }) assign(from.euler_order, to.euler_order);
        if constexpr (requires { from.scope; }) assign(from.scope, to.scope);
        if constexpr (requires { from.flags; }) assign(from.flags, to.flags);
        if constexpr (requires { from.soft_zone; }) assign(from.soft_zone, to.soft_zone);
        if constexpr (requires { from.frame; }) assign(from.frame, to.frame);
        if constexpr (requires { from.rotation_min; }) assign(from.rotation_min, to.rotation_min);
        if constexpr (requires { from.rotation_max; }) assign(from.rotation_max, to.rotation_max);
        if constexpr (requires { from.translation_min; }) assign(from.translation_min, to.translation_min);
        if constexpr (requires { from.translation_max; }) assign(from.translation_max, to.translation_max);
        if constexpr (requires { from.stiffness; }) assign(from.stiffness, to.stiffness);
        if constexpr (requires { from.preferred; }) assign(from.preferred, to.preferred);
    }
};

template <>
struct Fields<bendy_track> {
    template <class From>
    static void to_c(const From& from, bendy_track& to) {
        if constexpr (requires { from.path; }) assign(from.path, to.path);
        if constexpr (requires { from.interpolation; }) assign(from.interpolation, to.interpolation);
        if constexpr (requires { from.target; }) assign(from.target, to.target);
        if constexpr (requires { from.components; }) assign(from.components, to.components);
        if constexpr (requires { from.keys; }) assign(from.keys, to.keys);
    }
};

template <>
struct Fields<bendy_marker> {
    template <class From>
    static void to_c(const From& from, bendy_marker& to) {
        if constexpr (requires { from.seconds; }) assign(from.seconds, to.seconds);
    }
};

template <>
struct Fields<bendy_frame_sequence> {
    template <class From>
    static void to_c(const From& from, bendy_frame_sequence& to) {
        if constexpr (requires { from.mesh; }) assign(from.mesh, to.mesh);
        if constexpr (requires { from.first; }) assign(from.first, to.first);
        if constexpr (requires { from.frames; }) assign(from.frames, to.frames);
        if constexpr (requires { from.closed; }) assign(from.closed, to.closed);
    }
};

template <>
struct Fields<bendy_frame_mix> {
    template <class From>
    static void to_c(const From& from, bendy_frame_mix& to) {
        if constexpr (requires { from.left; }) assign(from.left, to.left);
        if constexpr (requires { from.right; }) assign(from.right, to.right);
        if constexpr (requires { from.fraction; }) assign(from.fraction, to.fraction);
    }
};

template <>
struct Fields<bendy_curve> {
    template <class From>
    static void to_c(const From& from, bendy_curve& to) {
        if constexpr (requires { from.components; }) assign(from.components, to.components);
        if constexpr (requires { from.target_kind; }) assign(from.target_kind, to.target_kind);
        if constexpr (requires { from.target; }) assign(from.target, to.target);
        if constexpr (requires { from.start; }) assign(from.start, to.start);
        if constexpr (requires { from.end; }) assign(from.end, to.end);
        if constexpr (requires { from.interpolation; }) assign(from.interpolation, to.interpolation);
        if constexpr (requires { from.keys; }) assign(from.keys, to.keys);
        if constexpr (requires { from.max_error; }) assign(from.max_error, to.max_error);
    }
};

template <>
struct Fields<bendy_reach_options> {
    static bendy_status check(const bendy_reach_options& from, bendy_error* error) {
        if (const bendy_status status =
                check_value(from.solver, BENDY_SOLVER_LEAST_SQUARES + 1, "solver", "bendy_solver", error))
            return status;
        if (const bendy_status status = check_finite(from.tolerance, "tolerance", error)) return status;
        if (const bendy_status status = check_fraction(from.influence, "influence", error)) return status;
        if (const bendy_status status = check_fraction(from.softness, "softness", error)) return status;
        if (const bendy_status status = check_finite(from.gain, "gain", error)) return status;
        if (const bendy_status status = check_finite(from.step_limit, "step_limit", error)) return status;
        if (const bendy_status status = from.has_pole == 0 ? BENDY_OK : check_finite(from.pole, "pole", error))
            return status;
        if (const bendy_status status = check_finite(from.seconds, "seconds", error)) return status;
        if (const bendy_status status = check_finite(from.speed_limit, "speed_limit", error)) return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_reach_options& from, To& to) {
        assign(from.solver, to.solver);
        assign(from.iterations, to.iterations);
        assign(from.restarts, to.restarts);
        assign(from.tolerance, to.tolerance);
        assign(from.influence, to.influence);
        assign(from.softness, to.softness);
        assign(from.gain, to.gain);
        assign(from.step_limit, to.step_limit);
        to.obey_constraints = from.ignore_constraints == 0;
        if (from.has_pole != 0) assign(from.pole, to.pole.emplace());
        assign(from.carry_target, to.carry_target);
        assign(from.seconds, to.seconds);
        assign(from.speed_limit, to.speed_limit);
    }
};

template <>
struct Fields<bendy_reach_result> {
    template <class From>
    static void to_c(const From& from, bendy_reach_result& to) {
        if constexpr (requires { from.status; }) assign(from.status, to.status);
        if constexpr (requires { from.distance; }) assign(from.distance, to.distance);
        if constexpr (requires { from.angle; }) assign(from.angle, to.angle);
        if constexpr (requires { from.iterations; }) assign(from.iterations, to.iterations);
    }
};

template <>
struct Fields<bendy_reach_request> {
    static bendy_status check(const bendy_reach_request& from, bendy_error* error) {
        if (const bendy_status status = check_finite(from.position, "position", error)) return status;
        if (const bendy_status status = from.has_rotation == 0 ? BENDY_OK : check_rotation(from.rotation, error))
            return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_reach_request& from, To& to) {
        assign(from.chain, to.chain);
        assign(from.position, to.position);
        if (from.has_rotation != 0) assign(from.rotation, to.rotation.emplace());
    }
};

template <>
struct Fields<bendy_effector> {
    static bendy_status check(const bendy_effector& from, bendy_error* error) {
        if (const bendy_status status = check_finite(from.tip_offset, "tip_offset", error)) return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_effector& from, To& to) {
        assign(from.joint, to.joint);
        assign(from.tip_offset, to.tip_offset);
    }
};

template <>
struct Fields<bendy_effector_target> {
    static bendy_status check(const bendy_effector_target& from, bendy_error* error) {
        if (const bendy_status status = check_finite(from.position, "position", error)) return status;
        if (const bendy_status status = from.has_rotation == 0 ? BENDY_OK : check_rotation(from.rotation, error))
            return status;
        if (const bendy_status status = check_fraction(from.weight, "weight", error)) return status;
        if (const bendy_status status = check_fraction(from.rotation_weight, "rotation_weight", error)) return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_effector_target& from, To& to) {
        assign(from.position, to.position);
        if (from.has_rotation != 0) assign(from.rotation, to.rotation.emplace());
        assign(from.weight, to.weight);
        assign(from.rotation_weight, to.rotation_weight);
    }
};

template <>
struct Fields<bendy_body_reach_options> {
    static bendy_status check(const bendy_body_reach_options& from, bendy_error* error) {
        if (const bendy_status status = check_finite(from.root_shift, "root_shift", error)) return status;
        if (const bendy_status status = check_finite(from.root_turn, "root_turn", error)) return status;
        if (const bendy_status status = check_finite(from.tolerance, "tolerance", error)) return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_body_reach_options& from, To& to) {
        assign(from.root, to.root);
        assign(from.root_shift, to.root_shift);
        assign(from.root_turn, to.root_turn);
        assign(from.iterations, to.iterations);
        assign(from.restarts, to.restarts);
        assign(from.tolerance, to.tolerance);
        assign(from.obey_constraints, to.obey_constraints);
    }
};

template <>
struct Fields<bendy_body_reached> {
    template <class From>
    static void to_c(const From& from, bendy_body_reached& to) {
        if constexpr (requires { from.is_reached; }) assign(from.is_reached, to.is_reached);
        if constexpr (requires { from.farthest; }) assign(from.farthest, to.farthest);
        if constexpr (requires { from.distance; }) assign(from.distance, to.distance);
        if constexpr (requires { from.angle; }) assign(from.angle, to.angle);
        if constexpr (requires { from.iterations; }) assign(from.iterations, to.iterations);
    }
};

template <>
struct Fields<bendy_time_span> {
    static bendy_status check(const bendy_time_span& from, bendy_error* error) {
        if (const bendy_status status = check_finite(from.from, "from", error)) return status;
        if (const bendy_status status = check_finite(from.to, "to", error)) return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_time_span& from, To& to) {
        assign(from.from, to.from);
        assign(from.to, to.to);
        assign(from.has_end, to.has_end);
    }
    template <class From>
    static void to_c(const From& from, bendy_time_span& to) {
        if constexpr (requires { from.from; }) assign(from.from, to.from);
        if constexpr (requires { from.to; }) assign(from.to, to.to);
        if constexpr (requires { from.has_end; }) assign(from.has_end, to.has_end);
    }
};

template <>
struct Fields<bendy_played> {
    static bendy_status check(const bendy_played& from, bendy_error* error) {
        if (const bendy_status status = check_fields(from.first, error)) return status;
        if (const bendy_status status = check_fields(from.pass, error)) return status;
        if (const bendy_status status = check_fields(from.last, error)) return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_played& from, To& to) {
        assign(from.turns, to.turns);
        assign(from.first, to.first);
        assign(from.pass, to.pass);
        assign(from.passes, to.passes);
        assign(from.last, to.last);
    }
    template <class From>
    static void to_c(const From& from, bendy_played& to) {
        if constexpr (requires { from.turns; }) assign(from.turns, to.turns);
        if constexpr (requires { from.first; }) assign(from.first, to.first);
        if constexpr (requires { from.pass; }) assign(from.pass, to.pass);
        if constexpr (requires { from.passes; }) assign(from.passes, to.passes);
        if constexpr (requires { from.last; }) assign(from.last, to.last);
    }
};

template <>
struct Fields<bendy_playback_info> {
    template <class From>
    static void to_c(const From& from, bendy_playback_info& to) {
        if constexpr (requires { from.mode; }) assign(from.mode, to.mode);
        if constexpr (requires { from.seconds; }) assign(from.seconds, to.seconds);
        if constexpr (requires { from.is_done; }) assign(from.is_done, to.is_done);
        if constexpr (requires { from.start; }) assign(from.start, to.start);
        if constexpr (requires { from.end; }) assign(from.end, to.end);
        if constexpr (requires { from.share; }) assign(from.share, to.share);
        if constexpr (requires { from.speed; }) assign(from.speed, to.speed);
        if constexpr (requires { from.passes; }) assign(from.passes, to.passes);
    }
};

template <>
struct Fields<bendy_playing> {
    template <class From>
    static void to_c(const From& from, bendy_playing& to) {
        if constexpr (requires { from.clip; }) assign(from.clip, to.clip);
        if constexpr (requires { from.seconds; }) assign(from.seconds, to.seconds);
        if constexpr (requires { from.weight; }) assign(from.weight, to.weight);
        if constexpr (requires { from.share; }) assign(from.share, to.share);
    }
};

template <>
struct Fields<bendy_root_motion> {
    static bendy_status check(const bendy_root_motion& from, bendy_error* error) {
        if (const bendy_status status = check_finite(from.translation, "translation", error)) return status;
        if (const bendy_status status = check_rotation(from.rotation, error)) return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_root_motion& from, To& to) {
        assign(from.translation, to.translation);
        assign(from.rotation, to.rotation);
    }
    template <class From>
    static void to_c(const From& from, bendy_root_motion& to) {
        if constexpr (requires { from.translation; }) assign(from.translation, to.translation);
        if constexpr (requires { from.rotation; }) assign(from.rotation, to.rotation);
    }
};

template <>
struct Fields<bendy_root_axes> {
    static bendy_status check(const bendy_root_axes& from, bendy_error* error) {
        if (const bendy_status status = check_value(from.turn, BENDY_TURN_ALL + 1, "turn", "bendy_root_turn", error))
            return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_root_axes& from, To& to) {
        assign(from.x, to.x);
        assign(from.y, to.y);
        assign(from.z, to.z);
        assign(from.turn, to.turn);
    }
};

template <>
struct Fields<bendy_socket> {
    static bendy_status check(const bendy_socket& from, bendy_error* error) {
        if (const bendy_status status = check_finite(from.offset, "offset", error)) return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_socket& from, To& to) {
        assign(from.joint, to.joint);
        assign(from.offset, to.offset);
        assign(from.keeps_size, to.keeps_size);
    }
};

template <>
struct Fields<bendy_binding_options> {
    static bendy_status check(const bendy_binding_options& from, bendy_error* error) {
        if (const bendy_status status = check_value(from.translations, BENDY_TRANSLATIONS_ROOT_ONLY + 1, "translations",
                                                    "bendy_bound_translations", error))
            return status;
        if (const bendy_status status = check_finite(from.root_scale, "root_scale", error)) return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_binding_options& from, To& to) {
        assign(from.translations, to.translations);
        assign(from.root, to.root);
        assign(from.root_scale, to.root_scale);
    }
};

template <>
struct Fields<bendy_retarget_options> {
    static bendy_status check(const bendy_retarget_options& from, bendy_error* error) {
        if (const bendy_status status =
                check_value(from.rest_poses, BENDY_REST_POSES_ALIKE + 1, "rest_poses", "bendy_rest_poses", error))
            return status;
        if (const bendy_status status = check_value(from.limits, BENDY_LIMITS_OFF + 1, "limits", "bendy_limits", error))
            return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_retarget_options& from, To& to) {
        assign(from.rest_poses, to.rest_poses);
        assign(from.limits, to.limits);
        assign(from.plants_feet, to.plants_feet);
    }
};

template <>
struct Fields<bendy_retargeted> {
    template <class From>
    static void to_c(const From& from, bendy_retargeted& to) {
        if constexpr (requires { from.turned; }) assign(from.turned, to.turned);
        if constexpr (requires { from.turned_joint; }) assign(from.turned_joint, to.turned_joint);
        if constexpr (requires { from.missed; }) assign(from.missed, to.missed);
        if constexpr (requires { from.missed_joint; }) assign(from.missed_joint, to.missed_joint);
        if constexpr (requires { from.lowered; }) assign(from.lowered, to.lowered);
        if constexpr (requires { from.contacts; }) assign(from.contacts, to.contacts);
    }
};

template <>
struct Fields<bendy_lod_info> {
    template <class From>
    static void to_c(const From& from, bendy_lod_info& to) {
        if constexpr (requires { from.error; }) assign(from.error, to.error);
        if constexpr (requires { from.triangles; }) assign(from.triangles, to.triangles);
    }
};

template <>
struct Fields<bendy_vertices> {
    template <class To>
    static void from_c(const bendy_vertices& from, To& to) {
        assign(from.capacity, to.capacity);
        assign(from.position_stride, to.position_stride);
        assign(from.normal_stride, to.normal_stride);
        assign(from.tangent_stride, to.tangent_stride);
    }
};

template <>
struct Fields<bendy_skin_options> {
    static bendy_status check(const bendy_skin_options& from, bendy_error* error) {
        if (const bendy_status status =
                check_value(from.method, BENDY_SKIN_DUAL_QUATERNION + 1, "method", "bendy_skin_method", error))
            return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_skin_options& from, To& to) {
        assign(from.mesh, to.mesh);
        assign(from.method, to.method);
    }
};

template <>
struct Fields<bendy_crowd_member> {
    static bendy_status check(const bendy_crowd_member& from, bendy_error* error) {
        if (const bendy_status status = check_finite(from.seconds, "seconds", error)) return status;
        return BENDY_OK;
    }
    template <class To>
    static void from_c(const bendy_crowd_member& from, To& to) {
        assign(from.clip, to.clip);
        assign(from.seconds, to.seconds);
    }
};

}  // namespace bendy::capi
