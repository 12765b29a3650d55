/* Bendy's runtime for C: opens animated characters, poses them and skins their vertices.
 *
 *     bendy_error error = BENDY_ERROR_INIT;
 *     bendy_model* model = bendy_open("fox.bendy", NULL, &error);
 *     if (model == NULL) return fail(error.message);
 *     bendy_pose* pose = bendy_pose_new(model, &error);
 *     bendy_sample(pose, bendy_find_clip(model, "Run", &error), seconds, &error);
 *     bendy_reach(pose, bendy_find_chain(model, "LeftArm", &error), target, NULL, NULL, NULL, &error);
 *     bendy_skin(pose, NULL, &vertices, &error);
 *
 * Units and spaces: metres, seconds, radians; model space is right-handed, +Y up. Matrices are 16 floats in
 * column-major order (as in OpenGL): elements 12 to 14 are the translation. Quaternions are x, y, z, w.
 *
 * Parameter order: the object that the call acts on, inputs, options, outputs, the error.
 *
 * Errors: a call that can fail takes a bendy_error last, which may be NULL. On failure it fills in the error, changes
 * nothing else and returns a status other than BENDY_OK, or NULL, or BENDY_NONE. On success it leaves the error
 * unchanged, so several calls may share one error that is checked after the last. Bad arguments (NULL, an index out
 * of range, a buffer that is too small) are reported like any other error; use of a freed handle is not detected.
 *
 * Names are zero-terminated UTF-8; they may be empty, and need not be unique. A name that contains a zero byte ends
 * there.
 *
 * Ownership: the caller owns what bendy_*_new and bendy_open* return, and releases it with bendy_*_free or
 * bendy_close, in any order: a pose keeps what it needs of its model alive. Pointers returned by a model (names,
 * parents) are valid until the model is closed and the last of its poses and levels of detail is freed.
 *
 * Threads: any number of threads may use one model at a time. A pose, or a bendy_lod, may be used by one thread at a
 * time.
 *
 * Structs that may grow in later versions begin with `size`, which the program sets to its sizeof, also where a call
 * fills the struct: `bendy_joint joint; joint.size = sizeof joint;`. A library that is newer than the program then
 * leaves alone the fields that the program's struct lacks, and an older one rejects fields that it would have to
 * ignore. The layout of the other structs, bendy_error and bendy_transform, is final. */
#ifndef BENDY_H
#define BENDY_H

#include <stddef.h>
#include <stdint.h>

#if defined(BENDY_C_BUILD) && defined(_WIN32)
#define BENDY_API __declspec(dllexport)
#elif defined(BENDY_C_BUILD) && defined(__GNUC__)
#define BENDY_API __attribute__((visibility("default")))
#else
#define BENDY_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Version --------------------------------------------------------------------------------------------- */

#define BENDY_VERSION_MAJOR 0
#define BENDY_VERSION_MINOR 1
#define BENDY_VERSION_PATCH 0

/* Returns the version of the library in use, which may be newer than this header: major << 16 | minor << 8 | patch. */
BENDY_API uint32_t bendy_version(void);
/* Returns the same version as text: "0.1.0". */
BENDY_API const char* bendy_version_string(void);

/* ---- Errors ---------------------------------------------------------------------------------------------- */

/* "None", for any index that a function takes or returns. */
#define BENDY_NONE 0xffffffffu

typedef enum bendy_status {
    BENDY_OK = 0,
    BENDY_BAD_ARGUMENT = 1,  /* the caller passed a bad argument */
    BENDY_NOT_FOUND = 2,     /* nothing has that name */
    BENDY_OUT_OF_MEMORY = 3, /* the state is as before the call */
    BENDY_IO = 4,            /* the file cannot be opened or read */
    BENDY_MALFORMED = 5,     /* the file is damaged, or is not a bendy file */
    BENDY_INVALID = 6,       /* the file's structure is sound, its content is not */
    BENDY_UNSUPPORTED = 7    /* a valid file of a kind that this version cannot read */
} bendy_status;

typedef struct bendy_error {
    int32_t status;    /* a bendy_status */
    uint32_t reserved; /* 0 */
    uint64_t offset;   /* bytes from the start of the file; 0 if the file is not the cause */
    char code[40]; /* a word that never changes, as `bendy validate` prints it: "CHUNK_TOO_LONG"; otherwise the status:
                      "NOT_FOUND" */
    char message[456]; /* one line for people, UTF-8; for a file, includes the chunk's path */
} bendy_error;

#define BENDY_ERROR_INIT \
    { BENDY_OK, 0, 0, "", "" }

/* ---- Opening --------------------------------------------------------------------------------------------- */

/* A character: an opened and checked file. Immutable. */
typedef struct bendy_model bendy_model;

typedef struct bendy_open_options {
    uint32_t size;       /* sizeof(bendy_open_options) */
    uint32_t object;     /* index of the object in the file; 0: the first */
    uint32_t sums_later; /* 0: all bytes are checked against their integrity sums on opening. 1: only by
                            bendy_check_sums; opening is faster, and corruption on disk goes unnoticed until then.
                            Structure is checked, and access is memory safe, in either case */
} bendy_open_options;

#define BENDY_OPEN_OPTIONS_INIT \
    { sizeof(bendy_open_options), 0, 0 }

/* Maps a file into memory and checks it. Returns NULL, and the first fault, if the file is not valid. The file must
 * not be modified in place while it is open (replacing it is allowed, except on Windows, where it fails). `path` is
 * UTF-8 on Windows, and in the system's encoding elsewhere. `options` may be NULL. */
BENDY_API bendy_model* bendy_open(const char* path, const bendy_open_options* options, bendy_error* error);
/* As bendy_open, for `size` bytes in memory, which are copied. */
BENDY_API bendy_model* bendy_open_copy(const void* bytes, size_t size, const bendy_open_options* options,
                                       bendy_error* error);
/* As bendy_open_copy, without the copy: the bytes must start on a 16-byte boundary (BENDY_BAD_ARGUMENT if not), and
 * must stay unchanged and allocated until the model is closed and the last of its poses and levels of detail is
 * freed. */
BENDY_API bendy_model* bendy_open_borrowed(const void* bytes, size_t size, const bendy_open_options* options,
                                           bendy_error* error);
/* Closes a model. Does nothing for NULL. */
BENDY_API void bendy_close(bendy_model* model);

/* Checks all bytes against their integrity sums, for sums_later. Reports the first chunk that differs, with its
 * offset. */
BENDY_API bendy_status bendy_check_sums(const bendy_model* model, bendy_error* error);

/* ---- What is in a model ---------------------------------------------------------------------------------- */

/* Return the number of joints, clips and so on, which are numbered from 0. All return 0 for NULL.
 * A mesh has vertices and an index list. Morph targets are numbered through all meshes, mesh after mesh. A submesh is
 * one draw call: a range of a mesh's indices with one material. */
BENDY_API uint32_t bendy_joint_count(const bendy_model* model);
BENDY_API uint32_t bendy_clip_count(const bendy_model* model);
BENDY_API uint32_t bendy_chain_count(const bendy_model* model);
BENDY_API uint32_t bendy_morph_target_count(const bendy_model* model);
BENDY_API uint32_t bendy_mesh_count(const bendy_model* model);
BENDY_API uint32_t bendy_submesh_count(const bendy_model* model);
BENDY_API uint32_t bendy_material_count(const bendy_model* model);
/* Returns the number of vertices of all meshes together. */
BENDY_API uint64_t bendy_vertex_count(const bendy_model* model);

/* Return the index of the first one with that name, or BENDY_NONE and an error that lists the names that exist. */
BENDY_API uint32_t bendy_find_joint(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_clip(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_chain(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_morph_target(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_mesh(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_material(const bendy_model* model, const char* name, bendy_error* error);

/* Returns each joint's parent: smaller than the joint's own index, or BENDY_NONE for a root. One entry per joint,
 * owned by the model. Returns NULL for NULL or a model without joints. */
BENDY_API const uint32_t* bendy_joint_parents(const bendy_model* model);

/* A transform relative to the parent. The matrix is translation * rotation * scale (some joints also have a shear,
 * which never changes). */
typedef struct bendy_transform {
    float rotation[4];    /* unit quaternion x, y, z, w */
    float translation[3]; /* metres */
    float scale[3];       /* along the joint's axes; may be negative or zero */
} bendy_transform;

typedef struct bendy_joint {
    uint32_t size;   /* sizeof, in this struct and those below; set it before the call that fills the struct */
    uint32_t parent; /* or BENDY_NONE */
    const char* name;
    bendy_transform rest;
    float shear[3]; /* xy, xz, yz: the elements above the diagonal of the scale matrix */
} bendy_joint;

typedef struct bendy_clip {
    uint32_t size;
    uint32_t loops; /* 1: meant to be repeated */
    const char* name;
    float start;      /* seconds: start of the clip's time line */
    float end;        /* seconds: end of the clip's time line */
    float frame_rate; /* frames per second, 0 if its keys are not at fixed frames */
} bendy_clip;

typedef struct bendy_chain { /* an IK chain: the joints on the path from the effector up to the start */
    uint32_t size;
    uint32_t start;    /* joint */
    uint32_t effector; /* joint */
    uint32_t links;    /* number of joints from start to effector, both included */
    uint32_t target;   /* joint that the chain follows in bendy_reach_all, or BENDY_NONE */
    uint32_t pole;     /* joint to bend towards, or BENDY_NONE */
    const char* name;
} bendy_chain;

typedef struct bendy_morph_target {
    uint32_t size;
    uint32_t mesh;
    const char* name;
    float rest_weight;
} bendy_morph_target;

typedef struct bendy_mesh {
    uint32_t size;
    uint32_t vertices;
    uint64_t first_vertex; /* index among the vertices of all meshes, as bendy_skin writes them */
    const char* name;
    uint32_t indices;
    uint32_t joint;              /* joint that carries the mesh, or BENDY_NONE */
    uint32_t first_morph_target; /* index among the targets of all meshes */
    uint32_t targets;
    uint32_t has_normals;        /* 0 or 1; if 0, skinned normals are zero */
    uint32_t has_tangents;       /* 0 or 1 */
    uint32_t texture_coord_sets; /* number of sets */
    uint32_t bones;              /* number of matrices for bendy_bone_matrices; 0: rigid */
    uint32_t influences;         /* number of bones per vertex; 0: rigid */
} bendy_mesh;

typedef enum bendy_topology { BENDY_TRIANGLES = 0, BENDY_LINES = 1, BENDY_POINTS = 2 } bendy_topology;

typedef struct bendy_submesh {
    uint32_t size;
    uint32_t mesh;
    uint32_t material; /* or BENDY_NONE */
    uint32_t topology; /* a bendy_topology: 3, 2 or 1 indices per element */
    uint32_t first;    /* index into the mesh's index list */
    uint32_t count;    /* number of indices */
} bendy_submesh;

typedef struct bendy_material {
    uint32_t size;
    float metallic;  /* 0 to 1 */
    float roughness; /* 0 to 1 */
    const char* name;
    float base_colour[4];  /* linear red, green, blue, alpha; 0 to 1 */
    float emissive[3];     /* linear red, green, blue */
    uint32_t double_sided; /* 0 or 1 */
} bendy_material;

BENDY_API const char* bendy_model_name(const bendy_model* model); /* "" if it has no name; NULL for NULL */
BENDY_API bendy_status bendy_get_joint(const bendy_model* model, uint32_t joint, bendy_joint* out, bendy_error* error);
BENDY_API bendy_status bendy_get_clip(const bendy_model* model, uint32_t clip, bendy_clip* out, bendy_error* error);
BENDY_API bendy_status bendy_get_chain(const bendy_model* model, uint32_t chain, bendy_chain* out, bendy_error* error);
BENDY_API bendy_status bendy_get_morph_target(const bendy_model* model, uint32_t target, bendy_morph_target* out,
                                              bendy_error* error);
BENDY_API bendy_status bendy_get_mesh(const bendy_model* model, uint32_t mesh, bendy_mesh* out, bendy_error* error);
BENDY_API bendy_status bendy_get_submesh(const bendy_model* model, uint32_t submesh, bendy_submesh* out,
                                         bendy_error* error);
BENDY_API bendy_status bendy_get_material(const bendy_model* model, uint32_t material, bendy_material* out,
                                          bendy_error* error);

/* Copies the index list of a mesh. `count` is the capacity of `indices`, at least bendy_mesh.indices. */
BENDY_API bendy_status bendy_get_indices(const bendy_model* model, uint32_t mesh, uint32_t* indices, size_t count,
                                         bendy_error* error);
/* Copies a set of texture coordinates, u and v per vertex: v = 0 is the top edge of the image. `count` is the
 * capacity of `uv` in floats, at least 2 * bendy_mesh.vertices. */
BENDY_API bendy_status bendy_get_texture_coords(const bendy_model* model, uint32_t mesh, uint32_t set, float* uv,
                                                size_t count, bendy_error* error);
/* Copies the bones and weights of each vertex, for skinning elsewhere: bendy_mesh.influences entries per vertex.
 * Bones are indices into the output of bendy_bone_matrices; the weights of a vertex sum to 1. `count` is the
 * capacity of each of the two arrays, at least vertices * influences. Fails for a rigid mesh. */
BENDY_API bendy_status bendy_get_influences(const bendy_model* model, uint32_t mesh, uint32_t* bones, float* weights,
                                            size_t count, bendy_error* error);

/* ---- Posing ---------------------------------------------------------------------------------------------- */

/* A pose of a model: the joints' local transforms and the morph targets' weights. Once it is made, calls allocate no
 * memory, except for the text of an error and in its first bendy_skin with dual quaternions. Matrices and vertices
 * are computed from the transforms at the time of the call. */
typedef struct bendy_pose bendy_pose;

/* Creates a pose, set to the rest pose. */
BENDY_API bendy_pose* bendy_pose_new(const bendy_model* model, bendy_error* error);
BENDY_API void bendy_pose_free(bendy_pose* pose); /* does nothing for NULL */

BENDY_API bendy_status bendy_set_rest(bendy_pose* pose, bendy_error* error);

/* Sets the pose to a clip at `seconds` on the clip's time line (bendy_clip.start to end). Whatever the clip does not
 * animate is set to rest. Times outside are clamped to the ends: the caller wraps time for clips that loop. NaN is
 * an error. */
BENDY_API bendy_status bendy_sample(bendy_pose* pose, uint32_t clip, float seconds, bendy_error* error);

/* A named curve of a clip: one to four animated numbers other than a joint's transform or a morph target's weight,
 * such as a material's colour or a camera's field of view. The curves of a clip are numbered from 0. */
typedef enum bendy_curve_target {
    BENDY_CURVE_NOTHING = 0,
    BENDY_CURVE_JOINT = 1,
    BENDY_CURVE_MATERIAL = 2,
    BENDY_CURVE_MESH = 3,
    BENDY_CURVE_TEXTURE = 4
} bendy_curve_target;

typedef struct bendy_curve {
    uint32_t size;        /* sizeof; set it before the call that fills the struct */
    uint32_t components;  /* number of components: 1 to 4 */
    const char* name;     /* may be empty */
    const char* path;     /* path of the property relative to the target: "pbrMetallicRoughness/baseColorFactor"; a JSON
                             pointer if there is no target */
    uint32_t target_kind; /* a bendy_curve_target */
    uint32_t target;      /* index of the joint, material, mesh or texture; BENDY_NONE if there is no target */
    float start;          /* seconds: time of the first key */
    float end;            /* seconds: time of the last key */
} bendy_curve;

/* Returns the number of curves of a clip; 0 for NULL or a clip that does not exist. */
BENDY_API uint32_t bendy_curve_count(const bendy_model* model, uint32_t clip);
/* Returns the clip's first curve with that name or, if none has that name, the first with that path; BENDY_NONE if
 * there is neither. */
BENDY_API uint32_t bendy_find_curve(const bendy_model* model, uint32_t clip, const char* name_or_path,
                                    bendy_error* error);
BENDY_API bendy_status bendy_get_curve(const bendy_model* model, uint32_t clip, uint32_t curve, bendy_curve* out,
                                       bendy_error* error);
/* Evaluates a curve at `seconds` on its clip's time line. Before the first key and after the last one it returns the
 * value of that key. `count` is the capacity of `values`, at least bendy_curve.components. NaN is an error.
 * Allocates nothing except the text of an error. */
BENDY_API bendy_status bendy_sample_curve(const bendy_model* model, uint32_t clip, uint32_t curve, double seconds,
                                          float* values, size_t count, bendy_error* error);

/* Blends `pose` towards `other`, a pose of the same model: weight 0 leaves it unchanged, 1 makes it equal to
 * `other`; any finite weight is allowed. `mask` scales the weight per joint, or is NULL. */
BENDY_API bendy_status bendy_blend(bendy_pose* pose, const bendy_pose* other, float weight, const float* mask,
                                   bendy_error* error);
/* Turns `pose` into its difference from `reference`, as an input for bendy_add. */
BENDY_API bendy_status bendy_make_additive(bendy_pose* pose, const bendy_pose* reference, bendy_error* error);
/* Adds a difference, scaled by `weight`. */
BENDY_API bendy_status bendy_add(bendy_pose* pose, const bendy_pose* difference, float weight, const float* mask,
                                 bendy_error* error);
/* Makes a mask: `inside` for a joint and its descendants, `outside` for all others. `count` is the capacity of
 * `mask`, at least the number of joints. */
BENDY_API bendy_status bendy_mask_below(const bendy_model* model, uint32_t joint, float inside, float outside,
                                        float* mask, size_t count, bendy_error* error);

/* Get and set the local transforms of `count` joints, starting at joint `first`. Values set must be finite, and
 * rotations unit quaternions. */
BENDY_API bendy_status bendy_get_local(const bendy_pose* pose, uint32_t first, uint32_t count,
                                       bendy_transform* transforms, bendy_error* error);
BENDY_API bendy_status bendy_set_local(bendy_pose* pose, uint32_t first, uint32_t count,
                                       const bendy_transform* transforms, bendy_error* error);
/* Get and set the weights of `count` morph targets, starting at target `first`. Weights are finite, usually 0 to 1. */
BENDY_API bendy_status bendy_get_weights(const bendy_pose* pose, uint32_t first, uint32_t count, float* weights,
                                         bendy_error* error);
BENDY_API bendy_status bendy_set_weights(bendy_pose* pose, uint32_t first, uint32_t count, const float* weights,
                                         bendy_error* error);

/* Moves every joint into the range that its constraints allow. */
BENDY_API bendy_status bendy_constrain(bendy_pose* pose, bendy_error* error);

typedef enum bendy_solver {
    BENDY_SOLVER_ANY = 0, /* the chain's own solver; if it has none, two-bone for two bones, otherwise least squares */
    BENDY_SOLVER_PULL = 1,
    BENDY_SOLVER_TWO_BONE = 2,
    BENDY_SOLVER_CCD = 3,
    BENDY_SOLVER_FABRIK = 4,
    BENDY_SOLVER_AIM = 5,
    BENDY_SOLVER_LEAST_SQUARES = 6
} bendy_solver;

typedef struct bendy_reach_options {
    uint32_t size;
    uint32_t solver;     /* a bendy_solver */
    uint32_t iterations; /* maximum; 0: the chain's, or the solver's default */
    uint32_t restarts;   /* least squares: number of other starting points to try when it is stuck */
    float tolerance;     /* metres; 0: the chain's, or 0.0001 of its length */
    float influence;     /* 0 to 1: how far the solution is blended into the pose */
    float softness;      /* 0 to 1: two-bone: the fraction of its length over which the chain slows near full reach */
    float gain;          /* pull: radians per chain length of distance */
    float step_limit;    /* pull: radians per joint and call */
    uint32_t ignore_constraints; /* 1: joints may turn beyond their limits */
    uint32_t has_pole;           /* 1: use `pole`; 0: use the chain's own pole */
    float pole[3];               /* two-bone, aim: a point in model space to bend towards */
    uint32_t carry_target;       /* 1: afterwards, the joint that the chain follows is moved to the tip */
} bendy_reach_options;

#define BENDY_REACH_OPTIONS_INIT \
    { sizeof(bendy_reach_options), BENDY_SOLVER_ANY, 0, 8, 0.0f, 1.0f, 0.0f, 1.0f, 0.2f, 0, 0, {0.0f, 0.0f, 0.0f}, 0 }

typedef enum bendy_reach_status {
    BENDY_REACHED = 0,      /* the tip is at the target, within the tolerance */
    BENDY_OUT_OF_REACH = 1, /* the target is farther away than the chain is long: the chain points at it */
    BENDY_NOT_REACHED = 2,  /* stopped at the nearest solution found; aim: the tip does not point at the target */
    BENDY_AIMED = 3         /* only aim: the tip's Z axis points at the target, at any distance */
} bendy_reach_status;

typedef struct bendy_reach_result {
    uint32_t size;
    uint32_t status; /* a bendy_reach_status */
    float distance;  /* metres between tip and target */
    float angle; /* radians between the tip's orientation and the target's, if it has one; aim: between the tip's Z axis
                    and the line to the target */
    uint32_t iterations;
} bendy_reach_result;

/* Inverse kinematics: moves an IK chain so that its tip reaches `position` (3 floats, metres, model space) within
 * its joints' constraints, starting from the current pose. `rotation` is the desired orientation of the tip (unit
 * quaternion, 4 floats), or NULL. `options` and `result` may be NULL. A target that is not reached is a result, not
 * an error. */
BENDY_API bendy_status bendy_reach(bendy_pose* pose, uint32_t chain, const float* position, const float* rotation,
                                   const bendy_reach_options* options, bendy_reach_result* result, bendy_error* error);
/* Solves every chain that follows a target joint, in order of priority. */
BENDY_API bendy_status bendy_reach_all(bendy_pose* pose, bendy_error* error);

/* Computes the matrices of `count` joints starting at joint `first`, 16 floats each, from joint space to model space
 * or, if `world` is given (model space to world space, 16 floats), to world space. `world` may be NULL. */
BENDY_API bendy_status bendy_joint_matrices(bendy_pose* pose, uint32_t first, uint32_t count, const float* world,
                                            float* matrices, bendy_error* error);
/* Computes the skinning palette of a mesh, for skinning elsewhere: for each bone, 16 floats, from mesh space to
 * model space. `count` is the capacity of `matrices` in matrices, at least bendy_mesh.bones. Fails for a rigid mesh:
 * use bendy_skin for its vertices. */
BENDY_API bendy_status bendy_bone_matrices(bendy_pose* pose, uint32_t mesh, float* matrices, size_t count,
                                           bendy_error* error);

/* ---- Levels of detail ------------------------------------------------------------------------------------ */

/* A model at one level of detail: which vertices are in use, and which triangles are drawn. A model whose file
 * stores no levels of detail has a single level: everything. */
typedef struct bendy_lod bendy_lod;

typedef struct bendy_lod_info {
    uint32_t size;
    float error;        /* maximum deviation from the full surface in metres, as stated in the file; 0 at full detail */
    uint64_t triangles; /* of all meshes together */
} bendy_lod_info;

/* Creates a level at full detail. */
BENDY_API bendy_lod* bendy_lod_new(const bendy_model* model, bendy_error* error);
BENDY_API void bendy_lod_free(bendy_lod* lod); /* does nothing for NULL */
/* Returns 1 if the file has levels of detail, otherwise 0. */
BENDY_API uint32_t bendy_has_levels(const bendy_model* model);
/* Keeps about this share of the triangles: 1 keeps all, 0 as few as the file's sequence allows. Invalidates pointers
 * into `lod`. */
BENDY_API bendy_status bendy_lod_set_share(bendy_lod* lod, float share, bendy_error* error);
BENDY_API bendy_status bendy_get_lod(const bendy_lod* lod, bendy_lod_info* out, bendy_error* error);
/* Returns how many vertices of a mesh are in use at this level: the first ones. 0 for NULL or a mesh that does not
 * exist. */
BENDY_API uint32_t bendy_lod_vertices(const bendy_lod* lod, uint32_t mesh);
/* Returns a mesh's index list at this level, and its length in `*count`. The list belongs to `lod` and is valid
 * until the level changes. Returns NULL on failure or if the list is empty. */
BENDY_API const uint32_t* bendy_lod_indices(const bendy_lod* lod, uint32_t mesh, size_t* count, bendy_error* error);
/* Describes a submesh at this level: a range of bendy_lod_indices. Submeshes are numbered as in the model. */
BENDY_API bendy_status bendy_lod_submesh(const bendy_lod* lod, uint32_t submesh, bendy_submesh* out,
                                         bendy_error* error);

/* ---- Vertices -------------------------------------------------------------------------------------------- */

/* The caller's memory for skinned vertices, interleaved or not. It is only written to, so it may be a mapped
 * graphics buffer. */
typedef struct bendy_vertices {
    uint32_t size;
    uint32_t reserved; /* 0 */
    size_t capacity;  /* number of vertices that each array has room for; the last one needs no padding to the stride */
    float* positions; /* x y z, metres, model space; NULL: not wanted */
    size_t position_stride; /* bytes from one vertex to the next, a multiple of 4; 0: tightly packed */
    float* normals;         /* x y z, unit length; zero if the file has none. NULL: not wanted */
    size_t normal_stride;
    float*
        tangents; /* x y z, unit length, and w, the handedness, 1 or -1; zero if the file has none. NULL: not wanted */
    size_t tangent_stride;
} bendy_vertices;

#define BENDY_VERTICES_INIT \
    { sizeof(bendy_vertices), 0, 0, NULL, 0, NULL, 0, NULL, 0 }

/* How the bones of a vertex are blended. */
typedef enum bendy_skin_method {
    BENDY_SKIN_LINEAR = 0,
    BENDY_SKIN_DUAL_QUATERNION = 1 /* preserves the volume of limbs at joints that twist or bend */
} bendy_skin_method;

typedef struct bendy_skin_options {
    uint32_t size;
    uint32_t mesh;        /* index of one mesh, written from vertex 0 on; BENDY_NONE: all, mesh after mesh
                             (bendy_mesh.first_vertex) */
    const bendy_lod* lod; /* a level of the pose's model: writes only the first bendy_lod_vertices of each mesh, at
                             their usual places, and leaves the others unchanged. NULL: all vertices */
    uint32_t method;      /* a bendy_skin_method */
    uint32_t reserved;    /* 0 */
} bendy_skin_options;

#define BENDY_SKIN_OPTIONS_INIT \
    { sizeof(bendy_skin_options), BENDY_NONE, NULL, BENDY_SKIN_LINEAR, 0 }

/* Applies morph targets and skins vertices into the caller's memory. Its capacity must be at least
 * bendy_vertex_count or, for one mesh, the mesh's vertices, or those in use at the level of detail. `options` may be
 * NULL: all meshes, linear. A pose's first call with dual quaternions allocates memory. */
BENDY_API bendy_status bendy_skin(bendy_pose* pose, const bendy_skin_options* options, const bendy_vertices* out,
                                  bendy_error* error);

/* ---- Kernels --------------------------------------------------------------------------------------------- */

/* Returns the name of the kernel that does the bulk of the arithmetic: "avx2", "sse4", "neon", "plain". The default
 * is the fastest that the machine can run, unless the environment variable BENDY_KERNEL or bendy_set_kernel selects
 * another. "plain" computes the same bits on every machine. */
BENDY_API const char* bendy_kernel(void);
/* Selects a kernel, with immediate effect in every thread. */
BENDY_API bendy_status bendy_set_kernel(const char* name, bendy_error* error);

#ifdef __cplusplus
}
#endif

#endif
