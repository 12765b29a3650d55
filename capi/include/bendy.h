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
 * Units and spaces: metres, seconds, radians; model space is right-handed, +Y up. Matrices are 16 floats, column after
 * column (OpenGL's order): elements 12 to 14 are the translation. Quaternions are x, y, z, w.
 *
 * Parameters have one order: what the call acts on, what it is given, options, outputs, the error.
 *
 * Errors: a call that can fail takes a bendy_error last, which may be NULL. Where it fails it fills the error, changes
 * nothing else and says so by what it returns: a status that is not BENDY_OK, NULL, or BENDY_NONE. Where it succeeds it
 * leaves the error as it is, so several calls may share one that is looked at after the last. Bad arguments (NULL, an
 * index out of range, memory that is too short) are errors like any other; a handle that has been freed is not found
 * out.
 *
 * Names are UTF-8 with a zero after them; they may be empty, and several things may have one name. A name with a zero
 * byte inside ends there.
 *
 * Ownership: what a bendy_*_new or bendy_open* gives is the caller's, and goes back by bendy_*_free or bendy_close, in
 * any order: a pose keeps what it needs of its model. Pointers that a model gives (names, parents) hold until the model
 * is closed and the last of its poses and levels is freed.
 *
 * Threads: any number may use one model at a time. A pose, or a bendy_lod, is used by one thread at a time.
 *
 * Structs that may grow begin with `size`, the program's sizeof, also those that a call fills: `bendy_joint joint;
 * joint.size = sizeof joint;`. So a library that knows more of a struct than the program leaves alone what is not
 * there, and one that knows less refuses what it would have to ignore. The layout of the others, bendy_error and
 * bendy_transform, is final. */
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

/* Of the library that is in use, which may be newer than this header: major << 16 | minor << 8 | patch. */
BENDY_API uint32_t bendy_version(void);
/* The same as text, "0.1.0". */
BENDY_API const char* bendy_version_string(void);

/* ---- Errors ---------------------------------------------------------------------------------------------- */

/* "None", wherever a function takes or returns an index. */
#define BENDY_NONE 0xffffffffu

typedef enum bendy_status {
    BENDY_OK = 0,
    BENDY_BAD_ARGUMENT = 1,  /* the caller's mistake */
    BENDY_NOT_FOUND = 2,     /* nothing has that name */
    BENDY_OUT_OF_MEMORY = 3, /* what was there before is as it was */
    BENDY_IO = 4,            /* the file cannot be opened or read */
    BENDY_MALFORMED = 5,     /* the file is damaged, or no bendy file */
    BENDY_INVALID = 6,       /* the file's structure is sound, what it says is not */
    BENDY_UNSUPPORTED = 7    /* a good file, of a kind that this version cannot read */
} bendy_status;

typedef struct bendy_error {
    int32_t status;    /* a bendy_status */
    uint32_t reserved; /* 0 */
    uint64_t offset;   /* where in the file, bytes from its start; 0 if the file is not to blame */
    char code[40]; /* one word that does not change, as `bendy validate` prints it: "CHUNK_TOO_LONG"; else the status:
                      "NOT_FOUND" */
    char message[456]; /* one line for people, UTF-8; of a file with the chunk's path */
} bendy_error;

#define BENDY_ERROR_INIT \
    { BENDY_OK, 0, 0, "", "" }

/* ---- Opening --------------------------------------------------------------------------------------------- */

/* A character: its file, checked, and nothing that changes. */
typedef struct bendy_model bendy_model;

typedef struct bendy_open_options {
    uint32_t size;       /* sizeof(bendy_open_options) */
    uint32_t object;     /* which of the file's objects; 0 the first */
    uint32_t sums_later; /* 0: every byte is held against its integrity sums now. 1: not before bendy_check_sums;
                            opening is quicker, and accidents on the disk go unseen until then. Structure is checked,
                            and memory safe, in either case */
} bendy_open_options;

#define BENDY_OPEN_OPTIONS_INIT \
    { sizeof(bendy_open_options), 0, 0 }

/* Maps a file into memory and checks it; NULL, and the first fault, if it is not a good one. The file must not be
 * changed in place while it is open (replacing it is fine, but on Windows, where it fails). `path` is UTF-8 on Windows,
 * and what the system takes for a name elsewhere. `options` may be NULL. */
BENDY_API bendy_model* bendy_open(const char* path, const bendy_open_options* options, bendy_error* error);
/* The same for `size` bytes in memory, which are copied. */
BENDY_API bendy_model* bendy_open_copy(const void* bytes, size_t size, const bendy_open_options* options,
                                       bendy_error* error);
/* The same without a copy: the bytes must start on a 16-byte boundary (BENDY_BAD_ARGUMENT if not), and must neither
 * change nor go until the model is closed and the last of its poses and levels is freed. */
BENDY_API bendy_model* bendy_open_borrowed(const void* bytes, size_t size, const bendy_open_options* options,
                                           bendy_error* error);
/* NULL is no model, and nothing happens. */
BENDY_API void bendy_close(bendy_model* model);

/* Holds all bytes against their sums, for sums_later: the first chunk that differs, with its offset. */
BENDY_API bendy_status bendy_check_sums(const bendy_model* model, bendy_error* error);

/* ---- What is in a model ---------------------------------------------------------------------------------- */

/* Things are numbered from 0; each of these says how many there are, 0 for NULL.
 * A mesh has vertices and an index list; a morph target is counted through all meshes, mesh after mesh; a submesh is
 * what one draw call draws: a range of one mesh' indices with one material. */
BENDY_API uint32_t bendy_joint_count(const bendy_model* model);
BENDY_API uint32_t bendy_clip_count(const bendy_model* model);
BENDY_API uint32_t bendy_chain_count(const bendy_model* model);
BENDY_API uint32_t bendy_morph_target_count(const bendy_model* model);
BENDY_API uint32_t bendy_mesh_count(const bendy_model* model);
BENDY_API uint32_t bendy_submesh_count(const bendy_model* model);
BENDY_API uint32_t bendy_material_count(const bendy_model* model);
/* Vertices of all meshes together. */
BENDY_API uint64_t bendy_vertex_count(const bendy_model* model);

/* The first one of that name; BENDY_NONE, and an error that says which names there are, if there is none. */
BENDY_API uint32_t bendy_find_joint(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_clip(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_chain(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_morph_target(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_mesh(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_material(const bendy_model* model, const char* name, bendy_error* error);

/* Each joint's parent: a smaller number than its own, BENDY_NONE for a root. As many as joints; the model's. NULL for
 * NULL or a model without joints. */
BENDY_API const uint32_t* bendy_joint_parents(const bendy_model* model);

/* Relative to the parent; the matrix is translation * rotation * scale (and a shear that some joints have and nothing
 * changes). */
typedef struct bendy_transform {
    float rotation[4];    /* unit quaternion x, y, z, w */
    float translation[3]; /* metres */
    float scale[3];       /* along the joint's axes; may be negative or zero */
} bendy_transform;

typedef struct bendy_joint {
    uint32_t size;   /* sizeof, in this struct and those below; set before the call that fills it */
    uint32_t parent; /* or BENDY_NONE */
    const char* name;
    bendy_transform rest;
    float shear[3]; /* xy, xz, yz: stand above the diagonal of the scale's matrix */
} bendy_joint;

typedef struct bendy_clip {
    uint32_t size;
    uint32_t loops; /* 1: made to be repeated */
    const char* name;
    float start;      /* seconds: the clip's time line goes from here */
    float end;        /* seconds: to here */
    float frame_rate; /* frames per second, 0 if its keys are not at fixed frames */
} bendy_clip;

typedef struct bendy_chain { /* an IK chain: the joints on the path from the effector up to the start */
    uint32_t size;
    uint32_t start;    /* joint */
    uint32_t effector; /* joint */
    uint32_t links;    /* joints from start to effector, both counted */
    uint32_t target;   /* joint that bendy_reach_all makes it follow, or BENDY_NONE */
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
    uint64_t first_vertex; /* among those of all meshes, where bendy_skin writes them */
    const char* name;
    uint32_t indices;
    uint32_t joint;              /* that carries the mesh, or BENDY_NONE */
    uint32_t first_morph_target; /* among those of all meshes */
    uint32_t targets;
    uint32_t has_normals;        /* 0 or 1; skinned normals are zero where there are none */
    uint32_t has_tangents;       /* 0 or 1 */
    uint32_t texture_coord_sets; /* how many */
    uint32_t bones;              /* matrices for bendy_bone_matrices; 0: rigid */
    uint32_t influences;         /* bones that each vertex follows; 0: rigid */
} bendy_mesh;

typedef enum bendy_topology { BENDY_TRIANGLES = 0, BENDY_LINES = 1, BENDY_POINTS = 2 } bendy_topology;

typedef struct bendy_submesh {
    uint32_t size;
    uint32_t mesh;
    uint32_t material; /* or BENDY_NONE */
    uint32_t topology; /* a bendy_topology: every 3, 2 or 1 indices are one element */
    uint32_t first;    /* in the mesh' indices */
    uint32_t count;    /* of indices */
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

BENDY_API const char* bendy_model_name(const bendy_model* model); /* "" if it has none; NULL for NULL */
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

/* A mesh' index list; `count` is what `indices` holds, at least bendy_mesh.indices. */
BENDY_API bendy_status bendy_get_indices(const bendy_model* model, uint32_t mesh, uint32_t* indices, size_t count,
                                         bendy_error* error);
/* A set of texture coordinates, u and v for each vertex: v 0 is the image's upper edge. `count` is what `uv` holds, in
 * floats, at least 2 * bendy_mesh.vertices. */
BENDY_API bendy_status bendy_get_texture_coords(const bendy_model* model, uint32_t mesh, uint32_t set, float* uv,
                                                size_t count, bendy_error* error);
/* Which bones move each vertex, and by how much, for skinning elsewhere: bendy_mesh.influences numbers for each vertex,
 * bones into bendy_bone_matrices; weights sum to 1. `count` is what each of the two holds, at least vertices *
 * influences. Fails for a rigid mesh. */
BENDY_API bendy_status bendy_get_influences(const bendy_model* model, uint32_t mesh, uint32_t* bones, float* weights,
                                            size_t count, bendy_error* error);

/* ---- Posing ---------------------------------------------------------------------------------------------- */

/* A model in one position: the joints' local transforms and the targets' weights. Nothing allocates after it is made,
 * but the text of an error, and its first bendy_skin by dual quaternions. What is asked of a pose (matrices, vertices)
 * follows from its transforms as they are at that time. */
typedef struct bendy_pose bendy_pose;

/* The rest pose. */
BENDY_API bendy_pose* bendy_pose_new(const bendy_model* model, bendy_error* error);
BENDY_API void bendy_pose_free(bendy_pose* pose); /* NULL: nothing happens */

BENDY_API bendy_status bendy_set_rest(bendy_pose* pose, bendy_error* error);

/* Sets the pose to a clip at `seconds` on its own time line, bendy_clip.start to end: what the clip animates gets
 * its value there, all else is at rest. Times outside are held at the ends: the caller wraps time for clips that loop.
 * NaN is an error. */
BENDY_API bendy_status bendy_sample(bendy_pose* pose, uint32_t clip, float seconds, bendy_error* error);

/* A named curve of a clip: a number that is animated, or up to four, and is neither a joint's transform nor a target's
 * weight: a material's colour, a camera's field of view. A clip's curves are numbered from 0. */
typedef enum bendy_curve_target {
    BENDY_CURVE_NOTHING = 0,
    BENDY_CURVE_JOINT = 1,
    BENDY_CURVE_MATERIAL = 2,
    BENDY_CURVE_MESH = 3,
    BENDY_CURVE_TEXTURE = 4
} bendy_curve_target;

typedef struct bendy_curve {
    uint32_t size;        /* sizeof, set before the call that fills it */
    uint32_t components;  /* numbers: 1 to 4 */
    const char* name;     /* may be empty */
    const char* path;     /* of the property, relative to the target: "pbrMetallicRoughness/baseColorFactor"; a JSON
                             pointer if there is no target */
    uint32_t target_kind; /* a bendy_curve_target */
    uint32_t target;      /* joint, material, mesh or texture; BENDY_NONE if there is none */
    float start;          /* seconds: the first key */
    float end;            /* seconds: the last key */
} bendy_curve;

/* 0 for NULL and for a clip that there is not. */
BENDY_API uint32_t bendy_curve_count(const bendy_model* model, uint32_t clip);
/* The clip's first curve of that name; if none has the name, the first of that path. BENDY_NONE if there is none. */
BENDY_API uint32_t bendy_find_curve(const bendy_model* model, uint32_t clip, const char* name_or_path,
                                    bendy_error* error);
BENDY_API bendy_status bendy_get_curve(const bendy_model* model, uint32_t clip, uint32_t curve, bendy_curve* out,
                                       bendy_error* error);
/* The curve's value at `seconds` on its clip's time line; before its first and after its last key it holds. `count` is
 * what `values` holds, at least bendy_curve.components. NaN is an error. Allocates nothing but the text of an error. */
BENDY_API bendy_status bendy_sample_curve(const bendy_model* model, uint32_t clip, uint32_t curve, double seconds,
                                          float* values, size_t count, bendy_error* error);

/* Moves `pose` towards `other`, a pose of the same model: 0 leaves it, 1 makes it the other; any finite number. `mask`
 * scales the weight joint by joint, or is NULL. */
BENDY_API bendy_status bendy_blend(bendy_pose* pose, const bendy_pose* other, float weight, const float* mask,
                                   bendy_error* error);
/* Turns `pose` into its difference from `reference`, which bendy_add takes. */
BENDY_API bendy_status bendy_make_additive(bendy_pose* pose, const bendy_pose* reference, bendy_error* error);
/* Adds a difference, `weight` of it. */
BENDY_API bendy_status bendy_add(bendy_pose* pose, const bendy_pose* difference, float weight, const float* mask,
                                 bendy_error* error);
/* A mask: `inside` for a joint and all below it, `outside` for the others. `count` is what `mask` holds, at least the
 * joints. */
BENDY_API bendy_status bendy_mask_below(const bendy_model* model, uint32_t joint, float inside, float outside,
                                        float* mask, size_t count, bendy_error* error);

/* `count` joints' local transforms from joint `first` on. Numbers to be set must be finite, rotations unit quaternions.
 */
BENDY_API bendy_status bendy_get_local(const bendy_pose* pose, uint32_t first, uint32_t count,
                                       bendy_transform* transforms, bendy_error* error);
BENDY_API bendy_status bendy_set_local(bendy_pose* pose, uint32_t first, uint32_t count,
                                       const bendy_transform* transforms, bendy_error* error);
/* `count` targets' weights from target `first` on: finite, usually 0 to 1. */
BENDY_API bendy_status bendy_get_weights(const bendy_pose* pose, uint32_t first, uint32_t count, float* weights,
                                         bendy_error* error);
BENDY_API bendy_status bendy_set_weights(bendy_pose* pose, uint32_t first, uint32_t count, const float* weights,
                                         bendy_error* error);

/* Brings every joint inside its constraints. */
BENDY_API bendy_status bendy_constrain(bendy_pose* pose, bendy_error* error);

typedef enum bendy_solver {
    BENDY_SOLVER_ANY = 0, /* the chain's own; where that says nothing, two-bone for two bones, else least squares */
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
    uint32_t iterations; /* at most; 0: the chain's, or the solver's own */
    uint32_t restarts;   /* least squares: other beginnings that it tries when it is stuck */
    float tolerance;     /* metres; 0: the chain's, or 0.0001 of its length */
    float influence;     /* 0 to 1: how much of the solution is mixed into the pose */
    float softness;      /* 0 to 1: two-bone: the share of its length over which the chain slows near full reach */
    float gain;          /* pull: radians per chain length of distance */
    float step_limit;    /* pull: radians per joint and call */
    uint32_t ignore_constraints; /* 1: joints may turn past their limits */
    uint32_t has_pole;           /* 1: `pole` counts; 0: the chain's own pole */
    float pole[3];               /* two-bone, aim: a point in model space to bend towards */
    uint32_t carry_target;       /* 1: afterwards, the joint that the chain follows moves to the tip */
} bendy_reach_options;

#define BENDY_REACH_OPTIONS_INIT \
    { sizeof(bendy_reach_options), BENDY_SOLVER_ANY, 0, 8, 0.0f, 1.0f, 0.0f, 1.0f, 0.2f, 0, 0, {0.0f, 0.0f, 0.0f}, 0 }

typedef enum bendy_reach_status {
    BENDY_REACHED = 0,      /* the tip is at the target, within the tolerance */
    BENDY_OUT_OF_REACH = 1, /* farther than the chain is long: it points at the target */
    BENDY_NOT_REACHED = 2,  /* stopped at the nearest that was found; of aim: the tip does not point at the target */
    BENDY_AIMED = 3         /* of aim alone: the tip's Z axis points at the target, however far that is */
} bendy_reach_status;

typedef struct bendy_reach_result {
    uint32_t size;
    uint32_t status; /* a bendy_reach_status */
    float distance;  /* metres between tip and target */
    float angle;     /* radians left between the tip's orientation and the target's, if it has one; of aim: between the
                        tip's Z axis and the line to the target */
    uint32_t iterations;
} bendy_reach_result;

/* Inverse kinematics: moves an IK chain so that its tip reaches `position` (3 floats, metres, model space), inside its
 * joints' constraints; the pose as it comes is the beginning. `rotation`: the tip's orientation (unit quaternion, 4
 * floats), or NULL. `options` and `result` may be NULL. A target that is not reached is a result, not an error. */
BENDY_API bendy_status bendy_reach(bendy_pose* pose, uint32_t chain, const float* position, const float* rotation,
                                   const bendy_reach_options* options, bendy_reach_result* result, bendy_error* error);
/* Every chain that follows a target joint, by priority. */
BENDY_API bendy_status bendy_reach_all(bendy_pose* pose, bendy_error* error);

/* `count` joints' matrices from joint `first` on, 16 floats each: joint space to model space; or, with `world` (model
 * space to world space, 16 floats), joint space to world space. `world` may be NULL. */
BENDY_API bendy_status bendy_joint_matrices(bendy_pose* pose, uint32_t first, uint32_t count, const float* world,
                                            float* matrices, bendy_error* error);
/* What each bone of a mesh does to its vertices, mesh space to model space, for skinning elsewhere: 16 floats each.
 * `count` is how many matrices there is room for, at least bendy_mesh.bones. Fails for a rigid mesh: its vertices go by
 * bendy_skin. */
BENDY_API bendy_status bendy_bone_matrices(bendy_pose* pose, uint32_t mesh, float* matrices, size_t count,
                                           bendy_error* error);

/* ---- Levels of detail ------------------------------------------------------------------------------------ */

/* A model at one level of detail: which vertices are alive, and what is drawn of them. A model whose file has no levels
 * has one: all. */
typedef struct bendy_lod bendy_lod;

typedef struct bendy_lod_info {
    uint32_t size;
    float error;        /* metres that the surface may be from the full one, by the file; 0 at full detail */
    uint64_t triangles; /* of all meshes */
} bendy_lod_info;

/* At full detail. */
BENDY_API bendy_lod* bendy_lod_new(const bendy_model* model, bendy_error* error);
BENDY_API void bendy_lod_free(bendy_lod* lod); /* NULL: nothing happens */
/* 1 if the file has levels of detail, else 0. */
BENDY_API uint32_t bendy_has_levels(const bendy_model* model);
/* Keeps about this share of the triangles: 1 all, 0 as few as the file's sequence goes. Pointers into `lod` hold until
 * then. */
BENDY_API bendy_status bendy_lod_set_share(bendy_lod* lod, float share, bendy_error* error);
BENDY_API bendy_status bendy_get_lod(const bendy_lod* lod, bendy_lod_info* out, bendy_error* error);
/* The first so many vertices of a mesh are alive; 0 for NULL or a mesh that is not there. */
BENDY_API uint32_t bendy_lod_vertices(const bendy_lod* lod, uint32_t mesh);
/* The mesh' index list at this level, and in `*count` how many there are; the lod's, until it changes. NULL where it
 * fails or the list is empty. */
BENDY_API const uint32_t* bendy_lod_indices(const bendy_lod* lod, uint32_t mesh, size_t* count, bendy_error* error);
/* A submesh at this level: a range of bendy_lod_indices; numbered as those of the model. */
BENDY_API bendy_status bendy_lod_submesh(const bendy_lod* lod, uint32_t submesh, bendy_submesh* out,
                                         bendy_error* error);

/* ---- Vertices -------------------------------------------------------------------------------------------- */

/* The caller's memory for skinned vertices: interleaved or not; only written, so it may be a mapped graphics buffer. */
typedef struct bendy_vertices {
    uint32_t size;
    uint32_t reserved;      /* 0 */
    size_t capacity;        /* vertices that each of the arrays has room for; the last needs no whole stride */
    float* positions;       /* x y z, metres, model space; NULL: not wanted */
    size_t position_stride; /* bytes from vertex to vertex, a multiple of 4; 0: without gaps */
    float* normals;         /* x y z, unit; zero where the file has none. NULL: not wanted */
    size_t normal_stride;
    float* tangents; /* x y z, unit, and w, the handedness, 1 or -1; zero where the file has none. NULL: not wanted */
    size_t tangent_stride;
} bendy_vertices;

#define BENDY_VERTICES_INIT \
    { sizeof(bendy_vertices), 0, 0, NULL, 0, NULL, 0, NULL, 0 }

/* How the bones that a vertex follows are mixed. */
typedef enum bendy_skin_method {
    BENDY_SKIN_LINEAR = 0,
    BENDY_SKIN_DUAL_QUATERNION = 1 /* joints that twist or bend keep the limb's volume */
} bendy_skin_method;

typedef struct bendy_skin_options {
    uint32_t size;
    uint32_t mesh;        /* one mesh, whose vertices begin at 0; BENDY_NONE: all, mesh after mesh
                             (bendy_mesh.first_vertex) */
    const bendy_lod* lod; /* a level of the pose's model: only the vertices alive, of each mesh the first
                             bendy_lod_vertices, in the same places; the others are left as they are. NULL: all */
    uint32_t method;      /* a bendy_skin_method */
    uint32_t reserved;    /* 0 */
} bendy_skin_options;

#define BENDY_SKIN_OPTIONS_INIT \
    { sizeof(bendy_skin_options), BENDY_NONE, NULL, BENDY_SKIN_LINEAR, 0 }

/* Applies morph targets and skins vertices into the caller's memory, whose capacity is at least bendy_vertex_count; of
 * one mesh, at least its vertices, or those alive. `options` may be NULL: all meshes, linear. A pose's first call by
 * dual quaternions allocates memory. */
BENDY_API bendy_status bendy_skin(bendy_pose* pose, const bendy_skin_options* options, const bendy_vertices* out,
                                  bendy_error* error);

/* ---- Kernels --------------------------------------------------------------------------------------------- */

/* How the bulk of the arithmetic is done: "avx2", "sse4", "neon", "plain"; the quickest that the machine runs, unless
 * the environment variable BENDY_KERNEL or bendy_set_kernel name another. With "plain" every machine computes the same
 * bits. */
BENDY_API const char* bendy_kernel(void);
/* From now on, in every thread. */
BENDY_API bendy_status bendy_set_kernel(const char* name, bendy_error* error);

#ifdef __cplusplus
}
#endif

#endif
