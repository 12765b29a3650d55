// Made from bendy.h by bindings/make_c.py.
#pragma once
#include <bendy.h>
#include <cstddef>
#include <cstdint>
#include "handles.h"
// The functions of bendy.h after their arguments are checked. A struct has the size that this library gives it, and
// fields that the program does not know have their defaults.
namespace bendy::capi {
bendy_status open(const char* path, const bendy_open_options& options, bendy_model*& made, bendy_error* error);
bendy_status open_copy(const void* bytes, size_t size, const bendy_open_options& options, bendy_model*& made,
                       bendy_error* error);
bendy_status open_borrowed(const void* bytes, size_t size, const bendy_open_options& options, bendy_model*& made,
                           bendy_error* error);
bendy_status check_sums(const bendy_model* model, bendy_error* error);
bendy_status find_joint(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error);
bendy_status find_clip(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error);
bendy_status find_chain(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error);
bendy_status find_morph_target(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error);
bendy_status find_mesh(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error);
bendy_status find_material(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error);
bendy_status find_texture(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error);
bendy_status get_joint(const bendy_model* model, uint32_t joint, bendy_joint& out, bendy_error* error);
bendy_status get_clip(const bendy_model* model, uint32_t clip, bendy_clip& out, bendy_error* error);
bendy_status get_chain(const bendy_model* model, uint32_t chain, bendy_chain& out, bendy_error* error);
bendy_status get_morph_target(const bendy_model* model, uint32_t morph_target, bendy_morph_target& out,
                              bendy_error* error);
bendy_status get_mesh(const bendy_model* model, uint32_t mesh, bendy_mesh& out, bendy_error* error);
bendy_status get_submesh(const bendy_model* model, uint32_t submesh, bendy_submesh& out, bendy_error* error);
bendy_status get_material(const bendy_model* model, uint32_t material, bendy_material& out, bendy_error* error);
bendy_status get_texture(const bendy_model* model, uint32_t texture, bendy_texture& out, bendy_error* error);
bendy_status get_image(const bendy_model* model, uint32_t texture, uint32_t image, bendy_image& out,
                       bendy_error* error);
bendy_status get_indices(const bendy_model* model, uint32_t mesh, uint32_t* indices, size_t count, bendy_error* error);
bendy_status get_texture_coords(const bendy_model* model, uint32_t mesh, uint32_t set, float* uv, size_t count,
                                bendy_error* error);
bendy_status get_influences(const bendy_model* model, uint32_t mesh, uint32_t* bones, float* weights, size_t count,
                            bendy_error* error);
bendy_status get_bind_palette(const bendy_model* model, uint32_t mesh, uint32_t* joints, float* inverse_bind,
                              size_t count, bendy_error* error);
bendy_status get_movers(const bendy_model* model, uint32_t mesh, uint32_t* joints, size_t count, bendy_error* error);
bendy_status find_stream(const bendy_model* model, uint32_t mesh, uint32_t kind, uint32_t set, uint32_t& made,
                         bendy_error* error);
bendy_status get_stream(const bendy_model* model, uint32_t mesh, uint32_t stream, bendy_stream& out,
                        bendy_error* error);
bendy_status get_numbers(const bendy_model* model, uint32_t mesh, uint32_t stream, float* numbers, size_t count,
                         bendy_error* error);
bendy_status get_integers(const bendy_model* model, uint32_t mesh, uint32_t stream, uint32_t* integers, size_t count,
                          bendy_error* error);
bendy_status get_displacements(const bendy_model* model, uint32_t morph_target, uint32_t* vertices, float* positions,
                               float* normals, float* tangents, size_t count, bendy_error* error);
bendy_status apply_morph_targets(const bendy_model* model, uint32_t mesh, const float* weights, float* positions,
                                 float* normals, float* tangents, size_t count, bendy_error* error);
bendy_status get_joint_submesh(const bendy_model* model, uint32_t joint_submesh, bendy_joint_submesh& out,
                               bendy_error* error);
bendy_status get_constraint(const bendy_model* model, uint32_t constraint, bendy_constraint& out, bendy_error* error);
bendy_status to_constraint_space(const bendy_model* model, uint32_t constraint, const float* rotation, double* R,
                                 bendy_error* error);
bendy_status from_constraint_space(const bendy_model* model, uint32_t constraint, const double* R, float* rotation,
                                   bendy_error* error);
bendy_status clamp_rotation(const bendy_model* model, uint32_t constraint, const double* R, double* clamped,
                            double* violation, bendy_error* error);
bendy_status clamp_translation(const bendy_model* model, uint32_t constraint, const float* translation, float* clamped,
                               bendy_error* error);
bendy_status get_links(const bendy_model* model, uint32_t chain, uint32_t* joints, float* weights, size_t count,
                       bendy_error* error);
bendy_status get_track(const bendy_model* model, uint32_t clip, uint32_t track, bendy_track& out, bendy_error* error);
bendy_status sample_track(const bendy_model* model, uint32_t clip, uint32_t track, float seconds, float* values,
                          size_t count, bendy_error* error);
bendy_status packed_frame_times(const bendy_model* model, uint32_t clip, float* times, size_t count,
                                bendy_error* error);
bendy_status get_marker(const bendy_model* model, uint32_t clip, uint32_t marker, bendy_marker& out,
                        bendy_error* error);
bendy_status get_frame_sequence(const bendy_model* model, uint32_t clip, uint32_t frame_sequence,
                                bendy_frame_sequence& out, bendy_error* error);
bendy_status mix_frames(const bendy_model* model, uint32_t clip, uint32_t frame_sequence, float seconds,
                        bendy_frame_mix& out, bendy_error* error);
bendy_status find_curve(const bendy_model* model, uint32_t clip, const char* name_or_path, uint32_t& made,
                        bendy_error* error);
bendy_status find_curve_of(const bendy_model* model, uint32_t clip, uint32_t target_kind, uint32_t target_index,
                           const char* path, uint32_t& made, bendy_error* error);
bendy_status get_curve(const bendy_model* model, uint32_t clip, uint32_t curve, bendy_curve& out, bendy_error* error);
bendy_status get_curve_values(const bendy_model* model, uint32_t clip, uint32_t curve, float* values, size_t count,
                              bendy_error* error);
bendy_status sample_curve(const bendy_model* model, uint32_t clip, uint32_t curve, double seconds, float* values,
                          size_t count, bendy_error* error);
bendy_status pose_new(const bendy_model* model, bendy_pose*& made, bendy_error* error);
bendy_status pose_copy(const bendy_pose* pose, bendy_pose*& made, bendy_error* error);
bendy_status set_rest(bendy_pose* pose, bendy_error* error);
bendy_status stand(bendy_pose* pose, bendy_error* error);
bendy_status sample(bendy_pose* pose, uint32_t clip, float seconds, bendy_error* error);
bendy_status blend(bendy_pose* pose, const bendy_pose* other, float weight, const float* mask, bendy_error* error);
bendy_status make_additive(bendy_pose* pose, const bendy_pose* reference, bendy_error* error);
bendy_status add(bendy_pose* pose, const bendy_pose* difference, float weight, const float* mask, bendy_error* error);
bendy_status mask_below(const bendy_model* model, uint32_t joint, float inside, float outside, float* mask,
                        size_t count, bendy_error* error);
bendy_status get_local(const bendy_pose* pose, uint32_t first, uint32_t count, bendy_transform* transforms,
                       bendy_error* error);
bendy_status set_local(bendy_pose* pose, uint32_t first, uint32_t count, const bendy_transform* transforms,
                       bendy_error* error);
bendy_status get_weights(const bendy_pose* pose, uint32_t first, uint32_t count, float* weights, bendy_error* error);
bendy_status set_weights(bendy_pose* pose, uint32_t first, uint32_t count, const float* weights, bendy_error* error);
bendy_status transform_matrix(const bendy_transform& transform, const float* shear, float* matrix, bendy_error* error);
bendy_status constrain(bendy_pose* pose, bendy_error* error);
bendy_status reach_state_new(const bendy_model* model, bendy_reach_state*& made, bendy_error* error);
bendy_status reach_state_reset(bendy_reach_state* state, bendy_error* error);
bendy_status reach_state_forget(bendy_reach_state* state, uint32_t chain, bendy_error* error);
bendy_status reach(bendy_pose* pose, uint32_t chain, const float* position, const float* rotation,
                   const bendy_reach_options& options, bendy_reach_result& result, bendy_error* error);
bendy_status reach_chains(bendy_pose* pose, const bendy_reach_request* requests, size_t count,
                          bendy_reach_result* results, bendy_error* error);
bendy_status reach_all(bendy_pose* pose, bendy_reach_state* state, float seconds, bendy_error* error);
bendy_status body_reach_new(const bendy_model* model, const bendy_effector* effectors, size_t count,
                            const bendy_body_reach_options& options, bendy_body_reach*& made, bendy_error* error);
bendy_status reach_body(bendy_pose* pose, bendy_body_reach* body, const bendy_effector_target* targets, size_t count,
                        bendy_body_reached& result, bendy_error* error);
bendy_status joint_matrices(bendy_pose* pose, uint32_t first, uint32_t count, const float* world, float* matrices,
                            bendy_error* error);
bendy_status bone_matrices(bendy_pose* pose, uint32_t mesh, float* matrices, size_t count, bendy_error* error);
bendy_status playback_new(const bendy_model* model, uint32_t clip, bendy_playback*& made, bendy_error* error);
bendy_status playback_new_range(float start, float end, uint32_t mode, bendy_playback*& made, bendy_error* error);
bendy_status get_playback(const bendy_playback* playback, bendy_playback_info& out, bendy_error* error);
bendy_status playback_advance(bendy_playback* playback, double seconds, bendy_played& played, bendy_error* error);
bendy_status playback_set_speed(bendy_playback* playback, double speed, bendy_error* error);
bendy_status playback_set_mode(bendy_playback* playback, uint32_t mode, bendy_error* error);
bendy_status playback_seek(bendy_playback* playback, double seconds, bendy_error* error);
bendy_status playback_seek_share(bendy_playback* playback, double share, bendy_error* error);
bendy_status count_markers(const bendy_model* model, uint32_t clip, const bendy_played& played, uint64_t* count,
                           bendy_error* error);
bendy_status collect_markers(const bendy_model* model, uint32_t clip, const bendy_played& played, uint32_t* markers,
                             size_t capacity, size_t* count, bendy_error* error);
bendy_status fade_new(float weight, bendy_fade*& made, bendy_error* error);
bendy_status fade_to(bendy_fade* fade, float weight, float seconds, uint32_t easing, bendy_error* error);
bendy_status fade_advance(bendy_fade* fade, double seconds, bendy_error* error);
bendy_status crossfade_new(const bendy_model* model, bendy_crossfade*& made, bendy_error* error);
bendy_status crossfade_play(bendy_crossfade* crossfade, uint32_t clip, const bendy_playback* playback,
                            float fade_seconds, uint32_t easing, bendy_error* error);
bendy_status crossfade_advance(bendy_crossfade* crossfade, double seconds, bendy_error* error);
bendy_status get_playing(const bendy_crossfade* crossfade, uint32_t number, bendy_playing& out, bendy_error* error);
bendy_status get_played(const bendy_crossfade* crossfade, uint32_t number, bendy_played& out, bendy_error* error);
bendy_status crossfade_get_playback(const bendy_crossfade* crossfade, uint32_t number, bendy_playback* playback,
                                    bendy_error* error);
bendy_status crossfade_set_playback(bendy_crossfade* crossfade, const bendy_playback* playback, bendy_error* error);
bendy_status sample_crossfade(bendy_pose* pose, const bendy_crossfade* crossfade, bendy_pose* scratch,
                              bendy_error* error);
bendy_status root_motion_matrix(const bendy_root_motion& motion, double* matrix, bendy_error* error);
bendy_status root_motion_compose(const bendy_root_motion& before, const bendy_root_motion& motion,
                                 bendy_root_motion& out, bendy_error* error);
bendy_status root_motion_inverse(const bendy_root_motion& motion, bendy_root_motion& out, bendy_error* error);
bendy_status root_motion_blend(const bendy_root_motion& motion, const bendy_root_motion& other, double weight,
                               bendy_root_motion& out, bendy_error* error);
bendy_status root_motion_repeat(const bendy_root_motion& motion, uint64_t times, bendy_root_motion& out,
                                bendy_error* error);
bendy_status root_path_new(const bendy_model* model, uint32_t joint, const bendy_root_axes& axes,
                           bendy_root_path*& made, bendy_error* error);
bendy_status root_path_at(const bendy_root_path* path, uint32_t clip, double seconds, bendy_root_motion& out,
                          bendy_error* error);
bendy_status root_path_between(const bendy_root_path* path, uint32_t clip, double from, double to,
                               bendy_root_motion& out, bendy_error* error);
bendy_status root_path_over(const bendy_root_path* path, uint32_t clip, const bendy_played& played,
                            bendy_root_motion& out, bendy_error* error);
bendy_status root_path_extract(const bendy_root_path* path, bendy_pose* pose, bendy_root_motion& out,
                               bendy_error* error);
bendy_status socket_matrix(bendy_pose* pose, const bendy_socket& socket, const float* world, float* matrix,
                           bendy_error* error);
bendy_status bounds_new(const bendy_model* model, bendy_bounds*& made, bendy_error* error);
bendy_status bounds_of_pose(const bendy_bounds* bounds, bendy_pose* pose, bendy_box& out, bendy_error* error);
bendy_status bounds_of_joint(const bendy_bounds* bounds, bendy_pose* pose, uint32_t joint, bendy_box& out,
                             bendy_error* error);
bendy_status binding_new(const bendy_model* animated, const bendy_model* posed, const bendy_binding_options& options,
                         bendy_binding*& made, bendy_error* error);
bendy_status sample_bound(bendy_pose* pose, bendy_binding* binding, uint32_t clip, float seconds, bendy_error* error);
bendy_status binding_unmatched_joints(const bendy_binding* binding, size_t* count, const uint32_t*& made,
                                      bendy_error* error);
bendy_status binding_unmatched_targets(const bendy_binding* binding, size_t* count, const uint32_t*& made,
                                       bendy_error* error);
bendy_status retarget_new(const bendy_model* source, const bendy_model* target, const bendy_retarget_options& options,
                          bendy_retarget*& made, bendy_error* error);
bendy_status retarget_state_new(bendy_retarget_state*& made, bendy_error* error);
bendy_status retarget_state_reset(bendy_retarget_state* state, bendy_error* error);
bendy_status retarget_pose(bendy_pose* pose, bendy_retarget* retarget, bendy_pose* source, bendy_retarget_state* state,
                           const float* contacts, float seconds, bendy_retargeted& result, bendy_error* error);
bendy_status lod_new(const bendy_model* model, bendy_lod*& made, bendy_error* error);
bendy_status lod_set_share(bendy_lod* lod, float share, bendy_error* error);
bendy_status get_lod(const bendy_lod* lod, bendy_lod_info& out, bendy_error* error);
bendy_status lod_indices(const bendy_lod* lod, uint32_t mesh, size_t* count, const uint32_t*& made, bendy_error* error);
bendy_status lod_submesh(const bendy_lod* lod, uint32_t submesh, bendy_submesh& out, bendy_error* error);
bendy_status skin(bendy_pose* pose, const bendy_skin_options& options, const bendy_vertices& out, bendy_error* error);
bendy_status prepare_skin(bendy_pose* pose, uint32_t method, bendy_error* error);
bendy_status crowd_new(const bendy_model* model, uint32_t workers, bendy_crowd*& made, bendy_error* error);
bendy_status crowd_play(bendy_crowd* crowd, const bendy_crowd_member* members, size_t count, uint32_t worker,
                        bendy_error* error);
bendy_status crowd_play_posed(bendy_crowd* crowd, const bendy_crowd_member* members, size_t count, uint32_t worker,
                              bendy_pose_member pose_member, void* user, bendy_error* error);
bendy_status set_kernel(const char* name, bendy_error* error);
}  // namespace bendy::capi
