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
 * parents, keys, images) are valid until the model is closed and the last object made from it (pose, level of detail,
 * crossfade, ...) is freed.
 *
 * Threads: any number of threads may use one model at a time, or one bendy_bounds or bendy_root_path. Every other
 * object may be used by one thread at a time; the workers of a bendy_crowd are an exception that its section explains.
 *
 * Structs that may grow in later versions begin with `size`, which the program sets to its sizeof, also where a call
 * fills the struct: `bendy_joint joint; joint.size = sizeof joint;`. A library that is newer than the program then
 * leaves alone the fields that the program's struct lacks, and an older one rejects fields that it would have to
 * ignore. The layout of the structs without `size` is final.
 *
 * JSON: `extras` is the application-specific data of the author; `more` is an object with the members of the glTF
 * source that have no field in the format; `extensions` is an object with the source's extensions. Each is "" if there
 * is none. */
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

/* Returns the version of the library in use, which may be newer than this header: major << 16 | minor << 8 | patch. Not
 * in JavaScript: it has the text. */
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
    uint32_t copied; /* for bendy_open; 0: the file is mapped. 1: it is read into memory, so that the program survives
                        if another one makes the file shorter while it is open (docs/embedding.md); added later, as all
                        below */
} bendy_open_options;

#define BENDY_OPEN_OPTIONS_INIT \
    { sizeof(bendy_open_options), 0, 0, 0 }

/* Maps a file into memory and checks it. Returns NULL, and the first fault, if the file is not valid. Unless `copied`
 * is set, the file must not be modified in place while it is open (replacing it is allowed, except on Windows, where it
 * fails). `path` is UTF-8 on Windows, and in the system's encoding elsewhere. `options` may be NULL. Not in
 * JavaScript: it has bytes, not files. */
BENDY_API bendy_model* bendy_open(const char* path, const bendy_open_options* options /* or NULL */,
                                  bendy_error* error);
/* As bendy_open, for `size` bytes in memory, which are copied. Not in JavaScript: it lends its own copy. */
BENDY_API bendy_model* bendy_open_copy(const void* bytes /* or NULL if `size` is 0 */, size_t size,
                                       const bendy_open_options* options /* or NULL */, bendy_error* error);
/* As bendy_open_copy, without the copy: the bytes must start on a 16-byte boundary (BENDY_BAD_ARGUMENT if not), and
 * must stay unchanged and allocated until the model is closed and the last of its poses and levels of detail is
 * freed. */
BENDY_API bendy_model* bendy_open_borrowed(const void* bytes /* or NULL if `size` is 0 */, size_t size,
                                           const bendy_open_options* options /* or NULL */, bendy_error* error);
/* Closes a model. Does nothing for NULL. */
BENDY_API void bendy_close(bendy_model* model);

/* Checks all bytes against their integrity sums, for sums_later. Reports the first chunk that differs, with its
 * offset. */
BENDY_API bendy_status bendy_check_sums(const bendy_model* model, bendy_error* error);

/* ---- Contents of a model --------------------------------------------------------------------------------- */

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
BENDY_API uint32_t bendy_texture_count(const bendy_model* model);
/* Returns the number of vertices of all meshes together. */
BENDY_API uint64_t bendy_vertex_count(const bendy_model* model);

/* Return the index of the first one with that name, or BENDY_NONE and an error that lists the names that exist. Not in
 * JavaScript: its lists find by name. */
BENDY_API uint32_t bendy_find_joint(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_clip(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_chain(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_morph_target(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_mesh(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_material(const bendy_model* model, const char* name, bendy_error* error);
BENDY_API uint32_t bendy_find_texture(const bendy_model* model, const char* name, bendy_error* error);

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

/* What a joint is in the body, whatever it is called: the bones of VRM; then chains, whose joints are in order from the
 * body outwards. left is the character's own left. */
typedef enum bendy_role {
    BENDY_ROLE_NONE = 0,
    BENDY_ROLE_HIPS = 1,
    BENDY_ROLE_SPINE = 2,
    BENDY_ROLE_CHEST = 3,
    BENDY_ROLE_UPPER_CHEST = 4,
    BENDY_ROLE_NECK = 5,
    BENDY_ROLE_HEAD = 6,
    BENDY_ROLE_LEFT_EYE = 7,
    BENDY_ROLE_RIGHT_EYE = 8,
    BENDY_ROLE_JAW = 9,
    BENDY_ROLE_LEFT_UPPER_LEG = 10,
    BENDY_ROLE_LEFT_LOWER_LEG = 11,
    BENDY_ROLE_LEFT_FOOT = 12,
    BENDY_ROLE_LEFT_TOES = 13,
    BENDY_ROLE_RIGHT_UPPER_LEG = 14,
    BENDY_ROLE_RIGHT_LOWER_LEG = 15,
    BENDY_ROLE_RIGHT_FOOT = 16,
    BENDY_ROLE_RIGHT_TOES = 17,
    BENDY_ROLE_LEFT_SHOULDER = 18,
    BENDY_ROLE_LEFT_UPPER_ARM = 19,
    BENDY_ROLE_LEFT_LOWER_ARM = 20,
    BENDY_ROLE_LEFT_HAND = 21,
    BENDY_ROLE_RIGHT_SHOULDER = 22,
    BENDY_ROLE_RIGHT_UPPER_ARM = 23,
    BENDY_ROLE_RIGHT_LOWER_ARM = 24,
    BENDY_ROLE_RIGHT_HAND = 25,
    BENDY_ROLE_LEFT_THUMB_METACARPAL = 26,
    BENDY_ROLE_LEFT_THUMB_PROXIMAL = 27,
    BENDY_ROLE_LEFT_THUMB_DISTAL = 28,
    BENDY_ROLE_LEFT_INDEX_PROXIMAL = 29,
    BENDY_ROLE_LEFT_INDEX_INTERMEDIATE = 30,
    BENDY_ROLE_LEFT_INDEX_DISTAL = 31,
    BENDY_ROLE_LEFT_MIDDLE_PROXIMAL = 32,
    BENDY_ROLE_LEFT_MIDDLE_INTERMEDIATE = 33,
    BENDY_ROLE_LEFT_MIDDLE_DISTAL = 34,
    BENDY_ROLE_LEFT_RING_PROXIMAL = 35,
    BENDY_ROLE_LEFT_RING_INTERMEDIATE = 36,
    BENDY_ROLE_LEFT_RING_DISTAL = 37,
    BENDY_ROLE_LEFT_LITTLE_PROXIMAL = 38,
    BENDY_ROLE_LEFT_LITTLE_INTERMEDIATE = 39,
    BENDY_ROLE_LEFT_LITTLE_DISTAL = 40,
    BENDY_ROLE_RIGHT_THUMB_METACARPAL = 41,
    BENDY_ROLE_RIGHT_THUMB_PROXIMAL = 42,
    BENDY_ROLE_RIGHT_THUMB_DISTAL = 43,
    BENDY_ROLE_RIGHT_INDEX_PROXIMAL = 44,
    BENDY_ROLE_RIGHT_INDEX_INTERMEDIATE = 45,
    BENDY_ROLE_RIGHT_INDEX_DISTAL = 46,
    BENDY_ROLE_RIGHT_MIDDLE_PROXIMAL = 47,
    BENDY_ROLE_RIGHT_MIDDLE_INTERMEDIATE = 48,
    BENDY_ROLE_RIGHT_MIDDLE_DISTAL = 49,
    BENDY_ROLE_RIGHT_RING_PROXIMAL = 50,
    BENDY_ROLE_RIGHT_RING_INTERMEDIATE = 51,
    BENDY_ROLE_RIGHT_RING_DISTAL = 52,
    BENDY_ROLE_RIGHT_LITTLE_PROXIMAL = 53,
    BENDY_ROLE_RIGHT_LITTLE_INTERMEDIATE = 54,
    BENDY_ROLE_RIGHT_LITTLE_DISTAL = 55,
    BENDY_ROLE_SPINE_CHAIN = 56,
    BENDY_ROLE_NECK_CHAIN = 57,
    BENDY_ROLE_TAIL = 58,
    BENDY_ROLE_LEFT_FRONT_LEG = 59,
    BENDY_ROLE_RIGHT_FRONT_LEG = 60,
    BENDY_ROLE_LEFT_HIND_LEG = 61,
    BENDY_ROLE_RIGHT_HIND_LEG = 62,
    BENDY_ROLE_LEFT_WING = 63,
    BENDY_ROLE_RIGHT_WING = 64
} bendy_role;

typedef struct bendy_joint {
    uint32_t size;   /* sizeof, in this struct and those below; set it before the call that fills the struct */
    uint32_t parent; /* or BENDY_NONE */
    const char* name;
    bendy_transform rest;
    float shear[3];      /* xy, xz, yz: the elements above the diagonal of the scale matrix */
    const char* extras;  /* added later, as all below */
    uint32_t role;       /* a bendy_role: what the joint is in the body */
    uint32_t role_place; /* place in the chain, ascending from the body outwards; 0 for the other roles */
} bendy_joint;

typedef struct bendy_clip {
    uint32_t size;
    uint32_t loops; /* 1: meant to be repeated */
    const char* name;
    float start;        /* seconds: start of the clip's time line */
    float end;          /* seconds: end of the clip's time line */
    float frame_rate;   /* frames per second, 0 if its keys are not at fixed frames */
    uint32_t is_packed; /* 1: some of its tracks are stored as quantised frames; they are not among its bendy_track, but
                           bendy_sample plays them; added later, as all below */
    const char* extras;
    const char* more;
} bendy_clip;

/* Methods of inverse kinematics. */
typedef enum bendy_solver {
    BENDY_SOLVER_ANY = 0, /* the chain's own solver; if it has none, two-bone for two bones, otherwise least squares */
    BENDY_SOLVER_PULL = 1,
    BENDY_SOLVER_TWO_BONE = 2,
    BENDY_SOLVER_CCD = 3,
    BENDY_SOLVER_FABRIK = 4,
    BENDY_SOLVER_AIM = 5,
    BENDY_SOLVER_LEAST_SQUARES = 6
} bendy_solver;

/* Bits that tell where a constraint or an IK chain comes from. */
typedef enum bendy_origin {
    BENDY_APPROXIMATED = 1, /* the source contains more than the file can express, or differs */
    BENDY_PROPOSED = 2,     /* guessed by the converter, not authored */
    BENDY_REST_OUTSIDE = 4  /* constraints only: the author knows that the rest pose is outside the limits */
} bendy_origin;

typedef struct bendy_chain { /* an IK chain: the joints on the path from the effector up to the start */
    uint32_t size;
    uint32_t start;    /* joint */
    uint32_t effector; /* joint */
    uint32_t links;    /* number of joints from start to effector, both included */
    uint32_t target;   /* joint that the chain follows in bendy_reach_all, or BENDY_NONE */
    uint32_t pole;     /* joint to bend towards, or BENDY_NONE */
    const char* name;
    uint32_t solver;       /* a bendy_solver; added later, as all below */
    uint32_t flags;        /* a sum of bendy_origin */
    uint32_t iterations;   /* maximum; 0: the solver's default */
    uint32_t priority;     /* chains with a higher one are solved later and override the others */
    float tolerance;       /* metres; 0: the solver's default */
    float pole_vector[3];  /* without a pole joint: the direction to bend towards, in the space of the start's
                              parent; zeros: none */
    float pole_angle;      /* radians from the pole to the bend, about the line from start to target */
    float tip_offset[3];   /* metres: position of the tip in the effector's space */
    float tip_rotation[4]; /* unit quaternion: orientation of the tip in the effector's space */
    float position_weight; /* 0 to 1: weight of the target's position */
    float rotation_weight; /* 0 to 1: weight of the target's orientation */
    float influence;       /* 0 to 1: how far bendy_reach_all blends the solution into the pose; 0: initially off */
    float stretch;         /* 0 or more: the fraction of its length by which the chain may grow to reach the target */
    float compress;        /* 0 to 1: the fraction of its length by which the chain may shrink */
    const char* extras;
} bendy_chain;

typedef struct bendy_morph_target {
    uint32_t size;
    uint32_t mesh;
    const char* name;
    float rest_weight;
    uint32_t vertices; /* number of vertices that it displaces: the capacity that bendy_get_displacements needs; added
                          later, as all below */
    uint32_t has_positions; /* 0 or 1: it displaces positions */
    uint32_t has_normals;   /* 0 or 1 */
    uint32_t has_tangents;  /* 0 or 1 */
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
    uint32_t mover;       /* joint that moves all vertices of a rigid mesh; BENDY_NONE if the mesh is not rigid, if
                             several joints do (bendy_get_movers), or if none does; added later, as all below */
    uint32_t frames;      /* number of whole shapes for bendy_frame_sequence: frame 0 is the mesh itself, frame k
                             is morph target first_frame + k - 1; 1 if there are none */
    uint32_t first_frame; /* index among the targets of the mesh */
    const char* extras;
    const char* more;
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

/* How a material uses a texture. */
typedef struct bendy_texture_use {
    uint32_t texture; /* or BENDY_NONE: not used, and the other fields have their defaults */
    uint32_t set;     /* set of texture coordinates */
    float offset[2];  /* added to the coordinates after scale and rotation */
    float scale[2];   /* factors of the coordinates */
    float rotation;   /* radians, counter-clockwise about the origin */
} bendy_texture_use;

typedef enum bendy_alpha_mode { BENDY_ALPHA_OPAQUE = 0, BENDY_ALPHA_MASK = 1, BENDY_ALPHA_BLEND = 2 } bendy_alpha_mode;

/* The metallic-roughness model of glTF 2.0; colour textures are multiplied with the colours. */
typedef struct bendy_material {
    uint32_t size;
    float metallic;  /* 0 to 1 */
    float roughness; /* 0 to 1 */
    const char* name;
    float base_colour[4];                  /* linear red, green, blue, alpha; 0 to 1 */
    float emissive[3];                     /* linear red, green, blue */
    uint32_t double_sided;                 /* 0 or 1 */
    float normal_scale;                    /* factor of x and y of the normal texture; added later, as all below */
    float occlusion_strength;              /* 0 to 1 */
    float alpha_cutoff;                    /* BENDY_ALPHA_MASK: pixels with less alpha are not drawn */
    uint32_t alpha_mode;                   /* a bendy_alpha_mode */
    uint32_t unlit;                        /* 0 or 1; 1: only the base colour is used, without lights */
    bendy_texture_use base_colour_texture; /* sRGB; alpha is linear */
    bendy_texture_use metallic_roughness_texture; /* linear; green: roughness, blue: metallic */
    bendy_texture_use normal_texture;             /* linear, tangent space */
    bendy_texture_use occlusion_texture;          /* linear; red: occlusion */
    bendy_texture_use emissive_texture;           /* sRGB */
    const char* extensions;
    const char* extras;
    const char* more;
} bendy_material;

typedef enum bendy_filter {
    BENDY_FILTER_UNSPECIFIED = 0,
    BENDY_FILTER_NEAREST = 1,
    BENDY_FILTER_LINEAR = 2,
    BENDY_FILTER_NEAREST_MIPMAP_NEAREST = 3,
    BENDY_FILTER_LINEAR_MIPMAP_NEAREST = 4,
    BENDY_FILTER_NEAREST_MIPMAP_LINEAR = 5,
    BENDY_FILTER_LINEAR_MIPMAP_LINEAR = 6
} bendy_filter;

typedef enum bendy_wrap { BENDY_REPEAT = 0, BENDY_CLAMP_TO_EDGE = 1, BENDY_MIRRORED_REPEAT = 2 } bendy_wrap;

typedef struct bendy_texture { /* a sampler, and one or more encodings of the same image */
    uint32_t size;
    uint32_t images; /* number of encodings, in order of preference */
    const char* name;
    uint32_t mag_filter; /* a bendy_filter: one of the first three */
    uint32_t min_filter; /* a bendy_filter */
    uint32_t wrap_s;     /* a bendy_wrap */
    uint32_t wrap_t;     /* a bendy_wrap */
    const char* extras;
    const char* more;
} bendy_texture;

typedef enum bendy_media {
    BENDY_MEDIA_OTHER = 0,
    BENDY_MEDIA_PNG = 1,
    BENDY_MEDIA_JPEG = 2,
    BENDY_MEDIA_KTX2 = 3,
    BENDY_MEDIA_WEBP = 4,
    BENDY_MEDIA_AVIF = 5
} bendy_media;

typedef struct bendy_image { /* one encoding of a texture's image: embedded bytes or a link */
    uint32_t size;
    uint32_t media;    /* a bendy_media; of a link: BENDY_MEDIA_OTHER */
    const void* bytes; /* the encoded image; NULL for a link. Owned by the model */
    size_t byte_count; /* 0 for a link */
    const char* uri;   /* of a link, relative to the file, as its author wrote it: where it leads is for the reader to
                          check. "" if it has a zero; NULL for embedded bytes */
    uint32_t texture;  /* texture and image where the bytes or the link are stored. Textures may share an image: a
                          program that loads each such pair once loads none twice */
    uint32_t image;    /* number of that image in `texture` */
} bendy_image;

BENDY_API const char* bendy_model_name(const bendy_model* model); /* "" if it has no name; NULL for NULL */
/* JSON: the application-specific data of the object, and of the whole file. "" if there is none; NULL for NULL. */
BENDY_API const char* bendy_model_extras(const bendy_model* model);
BENDY_API const char* bendy_file_extras(const bendy_model* model);
BENDY_API bendy_status bendy_get_joint(const bendy_model* model, uint32_t joint, bendy_joint* out, bendy_error* error);
BENDY_API bendy_status bendy_get_clip(const bendy_model* model, uint32_t clip, bendy_clip* out, bendy_error* error);
BENDY_API bendy_status bendy_get_chain(const bendy_model* model, uint32_t chain, bendy_chain* out, bendy_error* error);
BENDY_API bendy_status bendy_get_morph_target(const bendy_model* model, uint32_t morph_target, bendy_morph_target* out,
                                              bendy_error* error);
BENDY_API bendy_status bendy_get_mesh(const bendy_model* model, uint32_t mesh, bendy_mesh* out, bendy_error* error);
BENDY_API bendy_status bendy_get_submesh(const bendy_model* model, uint32_t submesh, bendy_submesh* out,
                                         bendy_error* error);
BENDY_API bendy_status bendy_get_material(const bendy_model* model, uint32_t material, bendy_material* out,
                                          bendy_error* error);
BENDY_API bendy_status bendy_get_texture(const bendy_model* model, uint32_t texture, bendy_texture* out,
                                         bendy_error* error);
/* Describes encoding `image` (0 to bendy_texture.images - 1) of a texture. */
BENDY_API bendy_status bendy_get_image(const bendy_model* model, uint32_t texture, uint32_t image, bendy_image* out,
                                       bendy_error* error);

/* ---- Geometry -------------------------------------------------------------------------------------------- */

/* Copies the index list of a mesh. `count` is the capacity of `indices`, at least bendy_mesh.indices. */
BENDY_API bendy_status bendy_get_indices(const bendy_model* model, uint32_t mesh,
                                         uint32_t* indices /* or NULL if there are none */, size_t count,
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

/* Copies the bind palette of a mesh: for each bone, its joint and its inverse bind matrix (16 floats), from mesh space
 * to joint space at bind time. Either array may be NULL: not wanted. `count` is the capacity of each in bones, at least
 * bendy_mesh.bones. Fails for a rigid mesh. */
BENDY_API bendy_status bendy_get_bind_palette(const bendy_model* model, uint32_t mesh, uint32_t* joints /* or NULL */,
                                              float* inverse_bind /* or NULL; 16 each */, size_t count,
                                              bendy_error* error);
/* Copies, for each vertex of a rigid mesh, the joint that moves it, or BENDY_NONE. `count` is the capacity of `joints`,
 * at least bendy_mesh.vertices. Fails for a mesh that is not rigid. */
BENDY_API bendy_status bendy_get_movers(const bendy_model* model, uint32_t mesh,
                                        uint32_t* joints /* or NULL if there are none */, size_t count,
                                        bendy_error* error);

/* A stream: one attribute of a mesh's vertices, or its index list. The streams of a mesh are numbered from 0. */
typedef enum bendy_stream_kind {
    BENDY_STREAM_POSITIONS = 0,      /* x y z, metres, mesh space */
    BENDY_STREAM_NORMALS = 1,        /* x y z */
    BENDY_STREAM_TANGENTS = 2,       /* x y z, and w, the handedness, 1 or -1 */
    BENDY_STREAM_TEXTURE_COORDS = 3, /* u v: v = 0 is the top edge of the image */
    BENDY_STREAM_COLOURS = 4,        /* linear red, green, blue and possibly alpha */
    BENDY_STREAM_ATTRIBUTE = 5,      /* application-specific, with a name */
    BENDY_STREAM_BONES = 6,          /* indices into the output of bendy_bone_matrices */
    BENDY_STREAM_WEIGHTS = 7,        /* of the bones; those of a vertex sum to 1 */
    BENDY_STREAM_INDICES = 8
} bendy_stream_kind;

typedef enum bendy_component_type {
    BENDY_U8 = 0,
    BENDY_I8 = 1,
    BENDY_U16 = 2,
    BENDY_I16 = 3,
    BENDY_U32 = 4,
    BENDY_F32 = 5
} bendy_component_type;

typedef struct bendy_stream {
    uint32_t size;
    uint32_t kind;       /* a bendy_stream_kind */
    const char* name;    /* of an attribute; otherwise "" */
    uint32_t set;        /* set of texture coordinates or colours; otherwise 0 */
    uint32_t elements;   /* number of vertices, or of indices */
    uint32_t components; /* numbers per element, as bendy_get_numbers returns them */
    uint32_t type;       /* a bendy_component_type, of the numbers in `data` */
    uint32_t normalised; /* 1: integers in `data` stand for 0 to 1 or, signed, -1 to 1 */
    const void* data; /* elements * components numbers without gaps, as a graphics API takes them; owned by the model.
                         NULL if the file has another encoding: call bendy_get_numbers */
    size_t data_size; /* bytes; 0 if `data` is NULL */
} bendy_stream;

/* Returns the number of streams of a mesh; 0 for NULL or a mesh that does not exist. */
BENDY_API uint32_t bendy_stream_count(const bendy_model* model, uint32_t mesh);
/* Returns the index of the mesh's stream of that kind (a bendy_stream_kind) and set; BENDY_NONE if there is none. Not
 * in JavaScript: it has the list. */
BENDY_API uint32_t bendy_find_stream(const bendy_model* model, uint32_t mesh, uint32_t kind /* a bendy_stream_kind */,
                                     uint32_t set, bendy_error* error);

BENDY_API bendy_status bendy_get_stream(const bendy_model* model, uint32_t mesh, uint32_t stream, bendy_stream* out,
                                        bendy_error* error);
/* Copies the numbers of a stream, decoded. `count` is the capacity of `numbers`, at least elements * components. */
BENDY_API bendy_status bendy_get_numbers(const bendy_model* model, uint32_t mesh, uint32_t stream, float* numbers,
                                         size_t count, bendy_error* error);
/* As bendy_get_numbers, for integers: bones, indices and attributes of an unsigned type that is not normalised. */
BENDY_API bendy_status bendy_get_integers(const bendy_model* model, uint32_t mesh, uint32_t stream, uint32_t* integers,
                                          size_t count, bendy_error* error);

/* Copies the displacements of a morph target at weight 1, for morphing elsewhere: the index of each displaced vertex
 * in the mesh, ascending, and 3 floats per displaced vertex for positions (metres), normals and tangents, zero where
 * the target has none. Each array may be NULL: not wanted. `count` is the capacity of each in vertices, at least
 * bendy_morph_target.vertices. */
BENDY_API bendy_status bendy_get_displacements(const bendy_model* model, uint32_t morph_target,
                                               uint32_t* vertices /* or NULL */, float* positions /* or NULL; 3 each */,
                                               float* normals /* or NULL; 3 each */,
                                               float* tangents /* or NULL; 3 each */, size_t count, bendy_error* error);
/* Applies morph targets to a mesh without skinning it: its vertices plus the weighted displacements, in mesh space.
 * Normals and tangents are not normalised. `weights` has one number per target of the mesh; NULL: all 0. Each array may
 * be NULL: not wanted; positions and normals have 3 floats per vertex, tangents 4. `count` is the number of vertices to
 * write, the first ones, at most bendy_mesh.vertices. Not in JavaScript: its module stays smaller. */
BENDY_API bendy_status bendy_apply_morph_targets(const bendy_model* model, uint32_t mesh,
                                                 const float* weights /* or NULL; bendy_mesh.targets numbers */,
                                                 float* positions /* or NULL; 3 each */,
                                                 float* normals /* or NULL; 3 each */,
                                                 float* tangents /* or NULL; 4 each */, size_t count,
                                                 bendy_error* error);

/* A range of a mesh's index list that belongs to one joint: for hit tests, severed limbs, culling. */
typedef struct bendy_joint_submesh {
    uint32_t size;
    uint32_t joint;
    uint32_t mesh;
    uint32_t material; /* or BENDY_NONE */
    uint32_t topology; /* a bendy_topology */
    uint32_t first;    /* index into the mesh's index list */
    uint32_t count;    /* number of indices */
} bendy_joint_submesh;

BENDY_API uint32_t bendy_joint_submesh_count(const bendy_model* model); /* 0 for NULL */
BENDY_API bendy_status bendy_get_joint_submesh(const bendy_model* model, uint32_t joint_submesh,
                                               bendy_joint_submesh* out, bendy_error* error);

/* ---- Constraints and IK chains --------------------------------------------------------------------------- */

typedef enum bendy_constraint_model {
    BENDY_CONSTRAINT_FREE = 0,
    BENDY_CONSTRAINT_LOCKED = 1,
    BENDY_CONSTRAINT_HINGE = 2,
    BENDY_CONSTRAINT_SWING_TWIST_ELLIPSE = 3,
    BENDY_CONSTRAINT_SWING_TWIST_PYRAMID = 4,
    BENDY_CONSTRAINT_EULER_BOX = 5,
    BENDY_CONSTRAINT_LARGEST_ANGLE = 6
} bendy_constraint_model;

typedef enum bendy_euler_order { /* the axes in the order of their rotations */
                                 BENDY_EULER_XYZ = 0,
                                 BENDY_EULER_XZY = 1,
                                 BENDY_EULER_YXZ = 2,
                                 BENDY_EULER_YZX = 3,
                                 BENDY_EULER_ZXY = 4,
                                 BENDY_EULER_ZYX = 5
} bendy_euler_order;

typedef enum bendy_constraint_scope {
    BENDY_SCOPE_EVERY_POSE = 0,
    BENDY_SCOPE_IK_ONLY = 1,
    BENDY_SCOPE_ALL_BUT_IK = 2
} bendy_constraint_scope;

/* Limits of a joint. R below is the joint's rotation relative to its rest pose, in the constraint's frame C:
 * rotation = rest * C * R * conjugate(C). */
typedef struct bendy_constraint {
    uint32_t size;
    uint32_t joint;
    uint32_t model;        /* a bendy_constraint_model: which rotations R are legal */
    uint32_t euler_order;  /* a bendy_euler_order, for the Euler box */
    uint32_t scope;        /* a bendy_constraint_scope */
    uint32_t flags;        /* a sum of bendy_origin */
    float soft_zone;       /* radians: zone inside the limits in which IK solvers halve steps towards them; 0: none */
    float frame[4];        /* C, unit quaternion: its X is the twist or hinge axis, its Y and Z the swing axes */
    float rotation_min[3]; /* radians about X, Y, Z of the frame; -infinity: free */
    float rotation_max[3]; /* radians; infinity: free. A hinge and the largest angle use only X */
    float translation_min[3]; /* metres from the rest translation, along X, Y, Z of the frame; -infinity: free */
    float translation_max[3]; /* metres; infinity: free */
    float stiffness[3];       /* 0 to 1 about X, Y, Z: how much an IK solver resists turning; 1 locks the axis */
    float preferred[3];       /* radians about X, Y, Z: which way a straight chain bends */
} bendy_constraint;

/* Constraints are numbered from 0, ordered by joint. */
BENDY_API uint32_t bendy_constraint_count(const bendy_model* model); /* 0 for NULL */
BENDY_API bendy_status bendy_get_constraint(const bendy_model* model, uint32_t constraint, bendy_constraint* out,
                                            bendy_error* error);
/* Return the index of the constraint of a joint in poses, and in IK solvers; BENDY_NONE if it has none, for NULL, and
 * for a joint that does not exist. */
BENDY_API uint32_t bendy_joint_constraint(const bendy_model* model, uint32_t joint);
BENDY_API uint32_t bendy_joint_ik_constraint(const bendy_model* model, uint32_t joint);

/* Convert a local rotation of the constraint's joint (unit quaternion, 4 floats) to R (unit quaternion, 4 doubles), and
 * back. */
BENDY_API bendy_status bendy_to_constraint_space(const bendy_model* model, uint32_t constraint, const float rotation[4],
                                                 double R[4], bendy_error* error);
BENDY_API bendy_status bendy_from_constraint_space(const bendy_model* model, uint32_t constraint, const double R[4],
                                                   float rotation[4], bendy_error* error);
/* Finds the legal rotation nearest to R by angle, and the angle between the two in radians: 0 if R is legal. `clamped`
 * (4 doubles, may be R itself) and `violation` may be NULL: not wanted. */
BENDY_API bendy_status bendy_clamp_rotation(const bendy_model* model, uint32_t constraint, const double R[4],
                                            double clamped[4] /* or NULL */, double* violation /* or NULL */,
                                            bendy_error* error);
/* Clamps a local translation of the constraint's joint (3 floats, metres). `clamped` may be `translation` itself. Not
 * in JavaScript: its module stays smaller. */
BENDY_API bendy_status bendy_clamp_translation(const bendy_model* model, uint32_t constraint,
                                               const float translation[3], float clamped[3], bendy_error* error);

/* Copies the joints of an IK chain, from the start to the effector, and the weight of each in the chain, 0 to 1: how
 * much it turns. `weights` may be NULL: not wanted. `count` is the capacity of each array, at least
 * bendy_chain.links. */
BENDY_API bendy_status bendy_get_links(const bendy_model* model, uint32_t chain, uint32_t* joints,
                                       float* weights /* or NULL */, size_t count, bendy_error* error);
/* Returns the chains' indices in the order in which bendy_reach_all solves them. One entry per chain, owned by the
 * model. Returns NULL for NULL or a model without chains. */
BENDY_API const uint32_t* bendy_chain_order(const bendy_model* model);

/* ---- Contents of a clip ---------------------------------------------------------------------------------- */

typedef enum bendy_interpolation {
    BENDY_STEP = 0,   /* the previous key's value */
    BENDY_LINEAR = 1, /* rotations: along the shorter arc */
    BENDY_CUBIC = 2   /* Hermite spline; tangents are multiplied by the distance between the keys */
} bendy_interpolation;

typedef enum bendy_track_path {
    BENDY_PATH_TRANSLATION = 0,
    BENDY_PATH_ROTATION = 1,
    BENDY_PATH_SCALE = 2,
    BENDY_PATH_WEIGHTS = 3
} bendy_track_path;

/* One animated property of a clip. The tracks of a clip are numbered from 0. */
typedef struct bendy_track {
    uint32_t size;
    uint32_t path;          /* a bendy_track_path */
    uint32_t interpolation; /* a bendy_interpolation */
    uint32_t target;        /* joint; for weights: mesh */
    uint32_t components;    /* 3, for rotations 4, for weights the number of targets of the mesh */
    uint32_t keys;
    const float* times;  /* seconds, one per key, ascending; NULL: key k is at clip start + k / frame_rate */
    const float* values; /* keys * components numbers; if cubic, three times as many: in-tangent, value, out-tangent */
} bendy_track;

/* Returns the number of tracks of a clip; 0 for NULL or a clip that does not exist. */
BENDY_API uint32_t bendy_track_count(const bendy_model* model, uint32_t clip);
BENDY_API bendy_status bendy_get_track(const bendy_model* model, uint32_t clip, uint32_t track, bendy_track* out,
                                       bendy_error* error);
/* Evaluates a single track at `seconds` on its clip's time line. `count` is the capacity of `values`, at least
 * bendy_track.components. NaN is an error. Not in JavaScript: its module stays smaller. */
BENDY_API bendy_status bendy_sample_track(const bendy_model* model, uint32_t clip, uint32_t track,
                                          float seconds /* not NaN */, float* values, size_t count, bendy_error* error);

/* The frames of a packed clip: between two of them, translations and scales change linearly, and rotations along the
 * great arc. Returns 0 for NULL, a clip that does not exist, or one that is not packed. */
BENDY_API uint32_t bendy_packed_frame_count(const bendy_model* model, uint32_t clip);
/* Writes the time of each frame, in seconds on the clip's time line, ascending. `count` is the capacity of `times`, at
 * least bendy_packed_frame_count. */
BENDY_API bendy_status bendy_packed_frame_times(const bendy_model* model, uint32_t clip,
                                                float* times /* or NULL if there are none */, size_t count,
                                                bendy_error* error);

/* An event at a time of a clip: a footstep, a hit, a sound to play. The markers of a clip are numbered from 0, in time
 * line order. */
typedef struct bendy_marker {
    uint32_t size;
    float seconds;    /* on the clip's time line */
    const char* name; /* may be empty, need not be unique */
} bendy_marker;

/* Returns the number of markers of a clip; 0 for NULL or a clip that does not exist. */
BENDY_API uint32_t bendy_marker_count(const bendy_model* model, uint32_t clip);
BENDY_API bendy_status bendy_get_marker(const bendy_model* model, uint32_t clip, uint32_t marker, bendy_marker* out,
                                        bendy_error* error);

/* Frames of a mesh that a clip plays one after another: frame k of the sequence has full weight at clip start +
 * k / frame_rate. The sequences of a clip are numbered from 0. */
typedef struct bendy_frame_sequence {
    uint32_t size;
    uint32_t mesh;
    uint32_t first;  /* frame of the mesh: see bendy_mesh.frames */
    uint32_t frames; /* 1 or more */
    uint32_t closed; /* 1: the first frame follows the last one */
} bendy_frame_sequence;

/* Two frames of a mesh, and the weight of the second one. */
typedef struct bendy_frame_mix {
    uint32_t size;
    uint32_t left;
    uint32_t right;
    float fraction; /* 0 to below 1: weight of `right`; `left` has the rest */
} bendy_frame_mix;

/* Returns the number of frame sequences of a clip; 0 for NULL or a clip that does not exist. Not in JavaScript: its
 * module stays smaller. */
BENDY_API uint32_t bendy_frame_sequence_count(const bendy_model* model, uint32_t clip);
BENDY_API bendy_status bendy_get_frame_sequence(const bendy_model* model, uint32_t clip, uint32_t frame_sequence,
                                                bendy_frame_sequence* out, bendy_error* error);
/* Finds the frames around `seconds` on the clip's time line, clamped to the first and last frame. NaN is an error. Not
 * in JavaScript: its module stays smaller. */
BENDY_API bendy_status bendy_mix_frames(const bendy_model* model, uint32_t clip, uint32_t frame_sequence,
                                        float seconds /* not NaN */, bendy_frame_mix* out, bendy_error* error);

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
                             pointer for a curve without a target */
    uint32_t target_kind; /* a bendy_curve_target */
    uint32_t target;      /* index of the joint, material, mesh or texture; BENDY_NONE: no target */
    float start;          /* seconds: time of the first key */
    float end;            /* seconds: time of the last key */
    uint32_t interpolation; /* a bendy_interpolation; added later, as all below */
    uint32_t keys;
    const float* times; /* seconds, one per key, ascending; owned by the model */
    float max_error;    /* largest difference between a stored value and the source's; 0: exact */
} bendy_curve;

/* Returns the number of curves of a clip; 0 for NULL or a clip that does not exist. */
BENDY_API uint32_t bendy_curve_count(const bendy_model* model, uint32_t clip);
/* Returns the clip's first curve with that name or, if none has that name, the first with that path; BENDY_NONE if
 * there is neither. Not in JavaScript: its list finds by name, and `find` by path. */
BENDY_API uint32_t bendy_find_curve(const bendy_model* model, uint32_t clip, const char* name_or_path,
                                    bendy_error* error);
/* Returns the clip's curve of a property of one joint, material, mesh or texture: `target_kind` is a
 * bendy_curve_target; BENDY_NONE if there is none. Not in JavaScript: its list has `find`. */
BENDY_API uint32_t bendy_find_curve_of(const bendy_model* model, uint32_t clip,
                                       uint32_t target_kind /* a bendy_curve_target */, uint32_t target_index,
                                       const char* path, bendy_error* error);

BENDY_API bendy_status bendy_get_curve(const bendy_model* model, uint32_t clip, uint32_t curve, bendy_curve* out,
                                       bendy_error* error);
/* Copies the values of a curve's keys: `components` numbers per key; if it is cubic, the in-tangent, value and
 * out-tangent of each key. `count` is the capacity of `values`. */
BENDY_API bendy_status bendy_get_curve_values(const bendy_model* model, uint32_t clip, uint32_t curve, float* values,
                                              size_t count, bendy_error* error);
/* Evaluates a curve at `seconds` on its clip's time line. Before the first key and after the last one it returns the
 * value of that key. `count` is the capacity of `values`, at least bendy_curve.components. NaN is an error.
 * Allocates nothing except the text of an error. */
BENDY_API bendy_status bendy_sample_curve(const bendy_model* model, uint32_t clip, uint32_t curve,
                                          double seconds /* not NaN */, float* values, size_t count,
                                          bendy_error* error);

/* ---- Posing ---------------------------------------------------------------------------------------------- */

/* A pose of a model: the joints' local transforms and the morph targets' weights. Once it is made, calls allocate no
 * memory, except for the text of an error and in its first bendy_skin with dual quaternions. Matrices and vertices
 * are computed from the transforms at the time of the call. */
typedef struct bendy_pose bendy_pose;

/* Creates a pose, set to the rest pose. */
BENDY_API bendy_pose* bendy_pose_new(const bendy_model* model, bendy_error* error);
/* Creates a copy of a pose. (To copy into an existing pose: bendy_blend with weight 1.) */
BENDY_API bendy_pose* bendy_pose_copy(const bendy_pose* pose, bendy_error* error);
BENDY_API void bendy_pose_free(bendy_pose* pose); /* does nothing for NULL */

BENDY_API bendy_status bendy_set_rest(bendy_pose* pose, bendy_error* error); /* sets the rest pose; elsewhere: reset */

/* Sets the pose in which the body stands, from which retargeting measures it; the rest pose if the file does not say
 * it. Allocates memory. */
BENDY_API bendy_status bendy_stand(bendy_pose* pose, bendy_error* error);

/* Sets the pose to a clip at `seconds` on the clip's time line (bendy_clip.start to end). Whatever the clip does not
 * animate is set to rest. Times outside are clamped to the ends; for clips that loop, bendy_playback has the time. NaN
 * is an error. */
BENDY_API bendy_status bendy_sample(bendy_pose* pose, uint32_t clip, float seconds /* not NaN */, bendy_error* error);

/* Blends `pose` towards `other`, a pose of the same model: weight 0 leaves it unchanged, 1 makes it equal to
 * `other`; any finite weight is allowed. `mask` scales the weight per joint. */
BENDY_API bendy_status bendy_blend(bendy_pose* pose, const bendy_pose* other, float weight,
                                   const float* mask /* or NULL; bendy_joint_count numbers */, bendy_error* error);
/* Turns `pose` into its difference from `reference`, as an input for bendy_add. */
BENDY_API bendy_status bendy_make_additive(bendy_pose* pose, const bendy_pose* reference, bendy_error* error);
/* Adds a difference, scaled by `weight` and per joint by `mask`. */
BENDY_API bendy_status bendy_add(bendy_pose* pose, const bendy_pose* difference,
                                 float weight /* elsewhere: 1 if not given */,
                                 const float* mask /* or NULL; bendy_joint_count numbers */, bendy_error* error);
/* Makes a mask: `inside` for a joint and its descendants, `outside` for all others. `count` is the capacity of
 * `mask`, at least the number of joints. */
BENDY_API bendy_status bendy_mask_below(const bendy_model* model, uint32_t joint, float inside, float outside,
                                        float* mask, size_t count, bendy_error* error);

/* Get and set the local transforms of `count` joints, starting at joint `first`. Values set must be finite, and
 * rotations unit quaternions. */
BENDY_API bendy_status bendy_get_local(const bendy_pose* pose, uint32_t first, uint32_t count,
                                       bendy_transform* transforms /* or NULL if `count` is 0 */, bendy_error* error);
BENDY_API bendy_status bendy_set_local(bendy_pose* pose, uint32_t first, uint32_t count,
                                       const bendy_transform* transforms /* or NULL if `count` is 0 */,
                                       bendy_error* error);
/* Get and set the weights of `count` morph targets, starting at target `first`. Weights are finite, usually 0 to 1. */
BENDY_API bendy_status bendy_get_weights(const bendy_pose* pose, uint32_t first, uint32_t count,
                                         float* weights /* or NULL if `count` is 0 */, bendy_error* error);
BENDY_API bendy_status bendy_set_weights(bendy_pose* pose, uint32_t first, uint32_t count,
                                         const float* weights /* or NULL if `count` is 0 */, bendy_error* error);

/* Computes the matrix of a local transform, 16 floats: translation * rotation * scale with the joint's shear
 * (bendy_joint.shear; NULL: none). Not in JavaScript: libraries that draw make matrices of such parts. */
BENDY_API bendy_status bendy_transform_matrix(const bendy_transform* transform, const float shear[3] /* or NULL */,
                                              float matrix[16], bendy_error* error);

/* Moves every joint into the range that its constraints allow. */
BENDY_API bendy_status bendy_constrain(bendy_pose* pose, bendy_error* error);

/* What the chains of one character did last. With it, chains that reach in frame after frame do not jump: where two
 * poses are about equally good, a chain keeps the one that it has; where another one has been better for a tenth of a
 * second, it goes there at a limited speed. Limits come first, then that speed, then the target. Each chain reaches
 * once a frame. For one thread at a time. */
typedef struct bendy_reach_state bendy_reach_state;

/* Makes a state that knows of no chain: each begins with the pose that it has without a state. */
BENDY_API bendy_reach_state* bendy_reach_state_new(const bendy_model* model, bendy_error* error);
BENDY_API void bendy_reach_state_free(bendy_reach_state* state); /* does nothing for NULL */
/* Forgets what the chains did, as after a cut. */
BENDY_API bendy_status bendy_reach_state_reset(bendy_reach_state* state, bendy_error* error);
/* Forgets what one chain did, which begins to reach after a pause. */
BENDY_API bendy_status bendy_reach_state_forget(bendy_reach_state* state, uint32_t chain, bendy_error* error);

typedef struct bendy_reach_options {
    uint32_t size;
    uint32_t solver;     /* a bendy_solver */
    uint32_t iterations; /* maximum; 0: the chain's, or the solver's default */
    uint32_t restarts;   /* number of other poses to start from, at most 4, where the first one does not reach */
    float tolerance;     /* metres; 0: the chain's, or 0.0001 of its length */
    float influence;     /* 0 to 1: how far the solution is blended into the pose */
    float softness;      /* 0 to 1: the share of its length over which a chain slows near full reach; 0: off */
    float gain;          /* pull: radians per chain length of distance */
    float step_limit;    /* pull: radians per joint and call */
    uint32_t ignore_constraints; /* 1: joints may turn beyond their limits; elsewhere: not obey_constraints */
    uint32_t has_pole;           /* 1: use `pole`; 0: use the chain's own pole */
    float pole[3];               /* two-bone, aim: a point in model space to bend towards */
    uint32_t carry_target; /* 1: afterwards, the joint that the chain follows is moved to the tip with its descendants,
                              unless it is in, above or below the chain: a foot that is not a child of its leg stays at
                              the leg's end */
    float seconds;     /* with a state: since the last call, 0 to 1; not of pull, which takes several frames itself */
    float speed_limit; /* with a state: radians per second, how fast a chain goes from one pose to another, beyond what
                          the pose that comes in and the target turn it */
    bendy_reach_state* state; /* what the chains of this character did last; NULL: each call is by itself */
} bendy_reach_options;

/* The defaults, which differ from zeros: a struct of zeros sets `influence` and `carry_target` to 0, for example. */
#define BENDY_REACH_OPTIONS_INIT                                                                                       \
    {                                                                                                                  \
        sizeof(bendy_reach_options), BENDY_SOLVER_ANY, 0, 4, 0.0f, 1.0f, 0.005f, 1.0f, 0.2f, 0, 0, {0.0f, 0.0f, 0.0f}, \
            1, 0.0f, 4.0f, NULL                                                                                        \
    }

typedef enum bendy_reach_status {
    BENDY_REACHED = 0,      /* the tip is at the target, within the tolerance */
    BENDY_OUT_OF_REACH = 1, /* the target is farther away than the chain is long: it points there, within its limits */
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
BENDY_API bendy_status bendy_reach(bendy_pose* pose, uint32_t chain, const float position[3],
                                   const float rotation[4] /* or NULL */,
                                   const bendy_reach_options* options /* or NULL */,
                                   bendy_reach_result* result /* or NULL */, bendy_error* error);
/* A chain to move, as for bendy_reach. */
typedef struct bendy_reach_request {
    uint32_t size; /* in an array, the same for all requests: the distance from one to the next */
    uint32_t chain;
    float position[3];                  /* metres, model space */
    uint32_t has_rotation;              /* 1: use `rotation` */
    float rotation[4];                  /* unit quaternion: the desired orientation of the tip */
    const bendy_reach_options* options; /* or NULL */
} bendy_reach_request;

#define BENDY_REACH_REQUEST_INIT \
    { sizeof(bendy_reach_request), BENDY_NONE, {0.0f, 0.0f, 0.0f}, 0, {0.0f, 0.0f, 0.0f, 1.0f}, NULL }

/* As bendy_reach for one request after another, with the same pose as the result; faster, since limbs of two bones that
 * do not move one another, such as arms and legs, are solved side by side. If one request has a bad argument, nothing
 * is moved. */
BENDY_API bendy_status bendy_reach_chains(bendy_pose* pose, const bendy_reach_request* requests, size_t count,
                                          bendy_reach_result* results /* or NULL, or one for each request */,
                                          bendy_error* error);
/* Solves every chain that follows a target joint, in order of priority. The joints that are followed stay where they
 * are. `state` and `seconds` are those of bendy_reach_options. */
BENDY_API bendy_status bendy_reach_all(bendy_pose* pose, bendy_reach_state* state /* or NULL */,
                                       float seconds /* elsewhere: 0 if not given */, bendy_error* error);

/* A point of a joint that is to reach for a target. */
typedef struct bendy_effector {
    uint32_t size; /* in an array, the same for all effectors: the distance from one to the next */
    uint32_t joint;
    float tip_offset[3]; /* metres, in the joint's space */
} bendy_effector;

#define BENDY_EFFECTOR_INIT                   \
    {                                         \
        sizeof(bendy_effector), BENDY_NONE, { \
            0.0f, 0.0f, 0.0f                  \
        }                                     \
    }

/* Where an effector is to be. */
typedef struct bendy_effector_target {
    uint32_t size;         /* in an array, the same for all targets: the distance from one to the next */
    float position[3];     /* metres, model space */
    uint32_t has_rotation; /* 1: use `rotation` */
    float rotation[4];     /* unit quaternion, model space: orientation of the effector's joint */
    float weight; /* 0 to 1: beside the other effectors', where not all targets can be reached; 0: anywhere will do */
    float rotation_weight; /* 0 to 1: the same for the rotation */
} bendy_effector_target;

#define BENDY_EFFECTOR_TARGET_INIT \
    { sizeof(bendy_effector_target), {0.0f, 0.0f, 0.0f}, 0, {0.0f, 0.0f, 0.0f, 1.0f}, 1.0f, 1.0f }

typedef struct bendy_body_reach_options {
    uint32_t size;
    uint32_t root; /* joint: the topmost one that moves, at or above all effectors' joints; or BENDY_NONE: the nearest
                      such joint */
    float root_shift[3]; /* metres along the axes of model space, each way: how far the root may move from its place in
                            the pose */
    float root_turn;     /* radians: how far the root may turn from its orientation in the pose */
    uint32_t iterations; /* maximum for each starting point */
    uint32_t restarts;   /* number of other starting points to try when it is stuck */
    float tolerance; /* metres; 0: 0.0001 of the longest way from the root to an effector; for rotations the same part
                        in radians */
    uint32_t obey_constraints; /* 1: joints stay within their constraints */
} bendy_body_reach_options;

#define BENDY_BODY_REACH_OPTIONS_INIT \
    { sizeof(bendy_body_reach_options), BENDY_NONE, {0.0f, 0.0f, 0.0f}, 0.0f, 60, 2, 0.0f, 1 }

/* The joints between a root and 1 to 32 effectors, such as hands, feet and head. Contains work memory, so each thread
 * needs one of its own. */
typedef struct bendy_body_reach bendy_body_reach;

BENDY_API bendy_body_reach* bendy_body_reach_new(const bendy_model* model, const bendy_effector* effectors,
                                                 size_t count, const bendy_body_reach_options* options /* or NULL */,
                                                 bendy_error* error);
BENDY_API void bendy_body_reach_free(bendy_body_reach* body); /* does nothing for NULL */
/* Returns the topmost joint that moves: the one that was given, or the one that was found; BENDY_NONE for NULL. */
BENDY_API uint32_t bendy_body_reach_root(const bendy_body_reach* body);

typedef struct bendy_body_reached {
    uint32_t size;
    uint32_t is_reached; /* 1: every effector is at its target, within the tolerance */
    uint32_t farthest;   /* index of the effector that is farthest from its target; of those with a weight */
    float distance;      /* metres, of that one */
    float angle;         /* radians: largest between an effector's orientation and its target's */
    uint32_t iterations;
} bendy_body_reached;

/* Full-body inverse kinematics: moves the joints between the root and the effectors so that each effector is at its
 * target, one for each effector, or as near to it as all targets, weighted, allow; within the joints' constraints and
 * starting from the current pose. IK chains play no part. `result` may be NULL. A target that is not reached is a
 * result, not an error. Fails for numbers in the pose that are not finite, and leaves it as it is. */
BENDY_API bendy_status bendy_reach_body(bendy_pose* pose, bendy_body_reach* body, const bendy_effector_target* targets,
                                        size_t count, bendy_body_reached* result /* or NULL */, bendy_error* error);

/* Computes the matrices of `count` joints starting at joint `first`, 16 floats each, from joint space to model space
 * or, if `world` is given (model space to world space, 16 floats), to world space. `world` may be NULL. */
BENDY_API bendy_status bendy_joint_matrices(bendy_pose* pose, uint32_t first, uint32_t count,
                                            const float world[16] /* or NULL */,
                                            float* matrices /* or NULL if `count` is 0; 16 each */, bendy_error* error);
/* Computes the skinning palette of a mesh, for skinning elsewhere: for each bone, 16 floats, from mesh space to
 * model space. `count` is the capacity of `matrices` in matrices, at least bendy_mesh.bones. Fails for a rigid mesh:
 * use bendy_skin for its vertices. */
BENDY_API bendy_status bendy_bone_matrices(bendy_pose* pose, uint32_t mesh, float* matrices /* 16 each */, size_t count,
                                           bendy_error* error);

/* ---- Playback -------------------------------------------------------------------------------------------- */

typedef enum bendy_loop_mode {
    BENDY_LOOP_ONCE = 0,     /* stops at the end and stays there; backwards, at the start */
    BENDY_LOOP_REPEAT = 1,   /* continues at the start after the end, which are the same moment */
    BENDY_LOOP_PING_PONG = 2 /* forwards and backwards alternately */
} bendy_loop_mode;

/* A part of the time line, played without a turn or a jump; backwards if `to` is smaller than `from`. */
typedef struct bendy_time_span {
    double from; /* seconds, on the clip's time line; a marker here belongs to the span */
    double to;   /* seconds */
    uint32_t
        has_end; /* 1: a marker exactly at `to` belongs to this span, not to the next: playback jumps or stops there */
    uint32_t reserved; /* 0 */
} bendy_time_span;

/* The interval that one step has played, in order: a first span, whole passes from end to end, a last span. Any of them
 * may be empty. Markers and root motion are computed from it, so none is reported twice or lost. */
typedef struct bendy_played {
    uint32_t size;
    uint32_t turns; /* 1: every second whole pass is in the other direction */
    bendy_time_span first;
    bendy_time_span pass; /* the first whole pass */
    uint64_t passes;      /* number of whole passes */
    bendy_time_span last;
} bendy_played;

/* The clock of a clip: its current time and speed. Time does not drift, however long it plays. Calls on it allocate
 * nothing except the text of an error. */
typedef struct bendy_playback bendy_playback;

typedef struct bendy_playback_info {
    uint32_t size;
    uint32_t mode;    /* a bendy_loop_mode: what happens at the end of the range */
    float seconds;    /* the current time on the clip's time line, as bendy_sample takes it */
    uint32_t is_done; /* 1: stopped at the end that it was heading for; only BENDY_LOOP_ONCE */
    double start;     /* start of the range, seconds */
    double end;       /* end of the range, seconds */
    double share;     /* the current time as a fraction of the length, 0 to 1 */
    double speed;     /* 1: as authored; 0: paused; negative: backwards */
    int64_t passes;   /* number of passes since the last seek, minus those undone backwards; 0 with BENDY_LOOP_ONCE */
} bendy_playback_info;

/* Creates a clock at the start of a clip, which repeats if the clip loops. */
BENDY_API bendy_playback* bendy_playback_new(const bendy_model* model, uint32_t clip, bendy_error* error);
/* Creates a clock for a range of a time line in seconds, with a bendy_loop_mode. If `end` is not after `start`, it
 * stands still. Not in JavaScript: its module stays smaller. */
BENDY_API bendy_playback* bendy_playback_new_range(float start, float end, uint32_t mode /* a bendy_loop_mode */,
                                                   bendy_error* error);

BENDY_API void bendy_playback_free(bendy_playback* playback); /* does nothing for NULL */
BENDY_API bendy_status bendy_get_playback(const bendy_playback* playback, bendy_playback_info* out, bendy_error* error);
/* Advances by `seconds` times the speed, backwards if that is negative. `played` receives the interval played; may be
 * NULL. */
BENDY_API bendy_status bendy_playback_advance(bendy_playback* playback, double seconds,
                                              bendy_played* played /* or NULL */, bendy_error* error);
BENDY_API bendy_status bendy_playback_set_speed(bendy_playback* playback, double speed, bendy_error* error);
/* Sets the bendy_loop_mode; keeps the current time. */
BENDY_API bendy_status bendy_playback_set_mode(bendy_playback* playback, uint32_t mode /* a bendy_loop_mode */,
                                               bendy_error* error);
/* Jumps to a time in seconds, clamped to the range, without playing what lies between. Except in BENDY_LOOP_ONCE, the
 * end counts as the start of the next pass. */
BENDY_API bendy_status bendy_playback_seek(bendy_playback* playback, double seconds, bendy_error* error);
/* As bendy_playback_seek, to a fraction of the length, 0 to 1: to keep a walk and a run in step. */
BENDY_API bendy_status bendy_playback_seek_share(bendy_playback* playback, double share, bendy_error* error);

/* Counts the markers of a clip that an interval passes, each once per pass. Not in JavaScript: it has the list. */
BENDY_API bendy_status bendy_count_markers(const bendy_model* model, uint32_t clip, const bendy_played* played,
                                           uint64_t* count, bendy_error* error);
/* Copies the indices of the markers that an interval passes, in playback order: the first `capacity` of them. `*count`
 * receives how many were written. */
BENDY_API bendy_status bendy_collect_markers(const bendy_model* model, uint32_t clip, const bendy_played* played,
                                             uint32_t* markers /* or NULL if `capacity` is 0 */, size_t capacity,
                                             size_t* count, bendy_error* error);

typedef enum bendy_easing {
    BENDY_EASING_LINEAR = 0,
    BENDY_EASING_SMOOTH = 1 /* 3t^2 - 2t^3: starts and ends smoothly */
} bendy_easing;

/* Returns the eased weight at a fraction of the way, 0 to 1 (clamped; NaN counts as 1). An easing that does not exist
 * counts as linear. */
BENDY_API float bendy_ease(uint32_t easing /* a bendy_easing */, float share);

/* A weight that moves towards another over time: of a layer, of an additive pose. */
typedef struct bendy_fade bendy_fade;

BENDY_API bendy_fade* bendy_fade_new(float weight, bendy_error* error);
BENDY_API void bendy_fade_free(bendy_fade* fade); /* does nothing for NULL */
/* Starts a fade from the current weight that takes `seconds`; immediate if `seconds` is not above 0. */
BENDY_API bendy_status bendy_fade_to(bendy_fade* fade, float weight, float seconds,
                                     uint32_t easing /* a bendy_easing; elsewhere: smooth if not given */,
                                     bendy_error* error);
/* Advances by `seconds`. */
BENDY_API bendy_status bendy_fade_advance(bendy_fade* fade, double seconds, bendy_error* error);
/* Returns the current weight; 0 for NULL. */
BENDY_API float bendy_fade_weight(const bendy_fade* fade);
/* Returns whether the weight has been reached, 1 or 0; 1 for NULL. */
BENDY_API uint32_t bendy_fade_is_done(const bendy_fade* fade);

/* A sequence of clips of one model in which each fades in over those before it. A clip that is interrupted keeps
 * playing beneath the next one, so nothing jumps. Calls on it allocate nothing except the text of an error. */
typedef struct bendy_crossfade bendy_crossfade;

/* The largest number of clips that a crossfade plays at a time. One more drops the oldest at once. */
#define BENDY_CROSSFADE_MOST 4

typedef struct bendy_playing { /* one of the clips of a crossfade */
    uint32_t size;
    uint32_t clip;
    float seconds; /* its current time */
    float weight;  /* 0 to 1: how far it covers the clips that began before it */
    float share;   /* its share of the result; all shares sum to 1 */
} bendy_playing;

BENDY_API bendy_crossfade* bendy_crossfade_new(const bendy_model* model, bendy_error* error);
BENDY_API void bendy_crossfade_free(bendy_crossfade* crossfade); /* does nothing for NULL */
/* Starts a clip, over `fade_seconds`; the first one is visible in full at once. `playback` is the clock to copy
 * (another speed, in step with the clip that plays now), or NULL: the clip's own, as bendy_playback_new makes it. */
BENDY_API bendy_status bendy_crossfade_play(bendy_crossfade* crossfade, uint32_t clip,
                                            const bendy_playback* playback /* or NULL */, float fade_seconds,
                                            uint32_t easing /* a bendy_easing */, bendy_error* error);
/* Advances all clocks and fades; then drops the clips that are completely covered, with their played intervals. */
BENDY_API bendy_status bendy_crossfade_advance(bendy_crossfade* crossfade, double seconds, bendy_error* error);
/* Returns the number of clips that play, numbered from 0, the oldest; 0 for NULL. */
BENDY_API uint32_t bendy_crossfade_count(const bendy_crossfade* crossfade);
BENDY_API bendy_status bendy_get_playing(const bendy_crossfade* crossfade, uint32_t number, bendy_playing* out,
                                         bendy_error* error);
/* Returns the interval that one of the clips played in the last bendy_crossfade_advance. */
BENDY_API bendy_status bendy_get_played(const bendy_crossfade* crossfade, uint32_t number, bendy_played* out,
                                        bendy_error* error);
/* Copies the clock of one of the clips into `playback`. */
BENDY_API bendy_status bendy_crossfade_get_playback(const bendy_crossfade* crossfade, uint32_t number,
                                                    bendy_playback* playback, bendy_error* error);
/* Copies `playback` into the clock of the newest clip: changes its speed or time. Fails if nothing plays. */
BENDY_API bendy_status bendy_crossfade_set_playback(bendy_crossfade* crossfade, const bendy_playback* playback,
                                                    bendy_error* error);
/* Sets the pose to the clips that play, mixed by their shares. `scratch` is another pose of the model, which is
 * overwritten. Fails if nothing plays. */
BENDY_API bendy_status bendy_sample_crossfade(bendy_pose* pose, const bendy_crossfade* crossfade, bendy_pose* scratch,
                                              bendy_error* error);

/* ---- Root motion ----------------------------------------------------------------------------------------- */

/* A rotation followed by a translation. In double precision, since it accumulates over hours. */
typedef struct bendy_root_motion {
    double translation[3]; /* metres */
    double rotation[4];    /* unit quaternion */
} bendy_root_motion;

#define BENDY_ROOT_MOTION_INIT \
    {                          \
        {0.0, 0.0, 0.0}, {     \
            0.0, 0.0, 0.0, 1.0 \
        }                      \
    }

/* Computes the matrix of a motion, 16 doubles. */
BENDY_API bendy_status bendy_root_motion_matrix(const bendy_root_motion* motion, double matrix[16], bendy_error* error);
/* Applies `motion`, given in the axes of `before`, after `before`. Each frame: compose(&character, &motion,
 * &character). `out` may be an input, here and below. */
BENDY_API bendy_status bendy_root_motion_compose(const bendy_root_motion* before, const bendy_root_motion* motion,
                                                 bendy_root_motion* out, bendy_error* error);
/* Computes the motion that undoes another one. Not in JavaScript: its module stays smaller. */
BENDY_API bendy_status bendy_root_motion_inverse(const bendy_root_motion* motion, bendy_root_motion* out,
                                                 bendy_error* error);
/* Interpolates between two motions, weight 0 to 1, along the shorter arc: for crossfades. */
BENDY_API bendy_status bendy_root_motion_blend(const bendy_root_motion* motion, const bendy_root_motion* other,
                                               double weight, bendy_root_motion* out, bendy_error* error);
/* Applies `motion` `times` times. Not in JavaScript: its module stays smaller. */
BENDY_API bendy_status bendy_root_motion_repeat(const bendy_root_motion* motion, uint64_t times, bendy_root_motion* out,
                                                bendy_error* error);

typedef enum bendy_root_turn {
    BENDY_TURN_NONE = 0,
    BENDY_TURN_YAW = 1, /* rotation about the model's y axis, which is up */
    BENDY_TURN_ALL = 2
} bendy_root_turn;

/* Which parts of the root's movement move the character. The rest stays in the pose. */
typedef struct bendy_root_axes {
    uint32_t size;
    uint32_t x;    /* 0 or 1: translation along the model's x axis */
    uint32_t y;    /* 0 or 1: along its y axis, which is up */
    uint32_t z;    /* 0 or 1: along its z axis */
    uint32_t turn; /* a bendy_root_turn */
} bendy_root_axes;

#define BENDY_ROOT_AXES_INIT \
    { sizeof(bendy_root_axes), 1, 0, 1, BENDY_TURN_YAW }

/* The root motion of the joint that carries a character over the ground: a root joint, or the hips. Immutable. */
typedef struct bendy_root_path bendy_root_path;

/* `axes` may be NULL: x, z and yaw. */
BENDY_API bendy_root_path* bendy_root_path_new(const bendy_model* model, uint32_t joint,
                                               const bendy_root_axes* axes /* or NULL */, bendy_error* error);
BENDY_API void bendy_root_path_free(bendy_root_path* path); /* does nothing for NULL */
/* Computes the motion from the root's rest pose to its position in a clip at a time, in model space. */
BENDY_API bendy_status bendy_root_path_at(const bendy_root_path* path, uint32_t clip, double seconds,
                                          bendy_root_motion* out, bendy_error* error);
/* Computes the motion from one time to another, in the axes that the character has at `from`. */
BENDY_API bendy_status bendy_root_path_between(const bendy_root_path* path, uint32_t clip, double from, double to,
                                               bendy_root_motion* out, bendy_error* error);
/* Computes the motion over an interval that was played: across the ends it continues as if the next pass began where
 * the last one ended. Takes the same time for thousands of passes as for one. */
BENDY_API bendy_status bendy_root_path_over(const bendy_root_path* path, uint32_t clip, const bendy_played* played,
                                            bendy_root_motion* out, bendy_error* error);
/* Takes the motion out of a pose: along the chosen axes the root is then at rest. `out` receives it; may be NULL. */
BENDY_API bendy_status bendy_root_path_extract(const bendy_root_path* path, bendy_pose* pose,
                                               bendy_root_motion* out /* or NULL */, bendy_error* error);

/* ---- Sockets and bounds ---------------------------------------------------------------------------------- */

/* An attachment point on a character: a hand that holds a sword, a camera behind a head. */
typedef struct bendy_socket {
    uint32_t size;
    uint32_t joint;      /* or BENDY_NONE: the model's own space */
    float offset[16];    /* matrix from socket space to joint space */
    uint32_t keeps_size; /* 1: attached objects keep their size if joints are scaled */
} bendy_socket;

#define BENDY_SOCKET_INIT                                                                                       \
    {                                                                                                           \
        sizeof(bendy_socket), BENDY_NONE,                                                                       \
            {1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f}, 1 \
    }

/* Computes the matrix from socket space to model space or, if `world` is given (model space to world space, 16 floats),
 * to world space: world * joint * offset, 16 floats. With keeps_size the joint's axes are first made orthonormal and
 * right-handed. `world` may be NULL. */
BENDY_API bendy_status bendy_socket_matrix(bendy_pose* pose, const bendy_socket* socket,
                                           const float world[16] /* or NULL */, float matrix[16], bendy_error* error);

/* An axis-aligned box that includes both corners; empty if a minimum is above its maximum (infinity above -infinity).
 */
typedef struct bendy_box {
    float minimum[3]; /* metres */
    float maximum[3];
} bendy_box;

/* Boxes that contain everything that linear skinning makes of a model in any pose, without skinning it: for culling,
 * level of detail, ray casts. Dual quaternions may bulge out of them. Immutable. */
typedef struct bendy_bounds bendy_bounds;

/* Takes time linear in vertices, influences and displacements. */
BENDY_API bendy_bounds* bendy_bounds_new(const bendy_model* model, bendy_error* error);
BENDY_API void bendy_bounds_free(bendy_bounds* bounds); /* does nothing for NULL */
/* Computes the box of all vertices in a pose, in model space. */
BENDY_API bendy_status bendy_bounds_of_pose(const bendy_bounds* bounds, bendy_pose* pose, bendy_box* out,
                                            bendy_error* error);
/* Computes the box of all vertices that a joint moves, as if that joint alone moved them: in a pose, in model space,
 * or, if `pose` is NULL, in joint space with morph target weights 0. */
BENDY_API bendy_status bendy_bounds_of_joint(const bendy_bounds* bounds, bendy_pose* pose /* or NULL */, uint32_t joint,
                                             bendy_box* out, bendy_error* error);

/* ---- Clips of another file ------------------------------------------------------------------------------- */

typedef enum bendy_bound_translations {
    BENDY_TRANSLATIONS_ALL = 0,      /* every track as it is: for skeletons of the same size */
    BENDY_TRANSLATIONS_ROOT_ONLY = 1 /* only those of the root: limbs keep the lengths of the posed model */
} bendy_bound_translations;

typedef struct bendy_binding_options {
    uint32_t size;
    uint32_t translations; /* a bendy_bound_translations */
    uint32_t root;    /* for ROOT_ONLY: this joint of the posed model and its ancestors take translations; usually the
                         hips. BENDY_NONE: only joints without a matched ancestor do */
    float root_scale; /* for ROOT_ONLY: factor of these translations, such as the ratio of the hip heights */
} bendy_binding_options;

#define BENDY_BINDING_OPTIONS_INIT \
    { sizeof(bendy_binding_options), BENDY_TRANSLATIONS_ALL, BENDY_NONE, 1.0f }

/* Maps the clips of one model (`animated`) to another (`posed`), matching joints and morph targets by name: for files
 * that hold only a skeleton and clips, shared by many characters. Rotations are not corrected: the rest poses should be
 * the same. Contains a pose, so each thread needs a binding of its own. */
typedef struct bendy_binding bendy_binding;

/* `options` may be NULL. */
BENDY_API bendy_binding* bendy_binding_new(const bendy_model* animated, const bendy_model* posed,
                                           const bendy_binding_options* options /* or NULL */, bendy_error* error);
BENDY_API void bendy_binding_free(bendy_binding* binding); /* does nothing for NULL */
/* As bendy_sample, for a clip of the animated model and a pose of the posed model. */
BENDY_API bendy_status bendy_sample_bound(bendy_pose* pose, bendy_binding* binding, uint32_t clip,
                                          float seconds /* not NaN */, bendy_error* error);
/* Return, for each joint or morph target of the animated model, the posed model's, or BENDY_NONE. Owned by the binding;
 * NULL for NULL or an empty list. */
BENDY_API const uint32_t* bendy_binding_joints(const bendy_binding* binding);
BENDY_API const uint32_t* bendy_binding_targets(const bendy_binding* binding);
/* Return the joints or morph targets of the animated model that some clip animates but that have no match, ascending,
 * and their number in `*count`. Owned by the binding; NULL if there are none, and on failure. */
BENDY_API const uint32_t* bendy_binding_unmatched_joints(const bendy_binding* binding, size_t* count,
                                                         bendy_error* error);
BENDY_API const uint32_t* bendy_binding_unmatched_targets(const bendy_binding* binding, size_t* count,
                                                          bendy_error* error);

/* ---- Retargeting ----------------------------------------------------------------------------------------- */

/* What the rest poses of two models have in common. */
typedef enum bendy_rest_poses {
    BENDY_REST_POSES_MEASURED = 0, /* nothing: they are measured, and a limb gets the direction that it has in the
                                      source */
    BENDY_REST_POSES_ALIKE = 1 /* both show the same pose, as VRM demands: joints turn exactly as in the source, and the
                                  hips' travel is scaled by the hips' height */
} bendy_rest_poses;

/* How the target's constraints act. */
typedef enum bendy_limits {
    BENDY_LIMITS_SOFT = 0, /* those that no author gave but a program proposed are soft: a joint that is to be e beyond
                              one is e / (1 + e / 15 degrees) beyond it; all others are hard */
    BENDY_LIMITS_HARD = 1, /* no joint is beyond its constraint */
    BENDY_LIMITS_OFF = 2   /* none acts */
} bendy_limits;

typedef struct bendy_retarget_options {
    uint32_t size;
    uint32_t rest_poses;  /* a bendy_rest_poses */
    uint32_t limits;      /* a bendy_limits: of the target */
    uint32_t plants_feet; /* 1: feet that touch the ground move as far as the source's, times the length of the legs */
} bendy_retarget_options;

#define BENDY_RETARGET_OPTIONS_INIT \
    { sizeof(bendy_retarget_options), BENDY_REST_POSES_MEASURED, BENDY_LIMITS_SOFT, 1 }

/* How poses of one model, `source`, become poses of another of different build, `target`: what corresponds is known
 * from bendy_joint.role, not from names; the rest poses may differ (arms out or down), face other ways and have other
 * sizes. Joints with a role turn as those of the source do. Joints and morph targets with equal names and no role come
 * along, such as props and faces. All others keep their rest relative to their parent. Contains work memory, so each
 * thread needs one of its own; characters of a thread share one. */
typedef struct bendy_retarget bendy_retarget;

/* Both models are humans, animals on four legs, or animals on two. A human needs the roles of hips, head, upper and
 * lower arms and legs, hands and feet; an animal those of hips, and of three joints or more of each leg. Otherwise the
 * error says what is missing. `options` may be NULL. */
BENDY_API bendy_retarget* bendy_retarget_new(const bendy_model* source, const bendy_model* target,
                                             const bendy_retarget_options* options /* or NULL */, bendy_error* error);
BENDY_API void bendy_retarget_free(bendy_retarget* retarget); /* does nothing for NULL */
/* Returns the target's size as a multiple of the source's, by the length of the legs; 0 for NULL. */
BENDY_API float bendy_retarget_scale(const bendy_retarget* retarget);
/* Return, for each joint or morph target of the target, the source's that moves it, or BENDY_NONE. Owned by the
 * retargeting; NULL for NULL or an empty list. */
BENDY_API const uint32_t* bendy_retarget_joints(const bendy_retarget* retarget);
BENDY_API const uint32_t* bendy_retarget_morph_targets(const bendy_retarget* retarget);

/* What a character remembers from one frame to the next: where its feet stand and its hands lie, and how its joints
 * were turned. */
typedef struct bendy_retarget_state bendy_retarget_state;

BENDY_API bendy_retarget_state* bendy_retarget_state_new(bendy_error* error);
BENDY_API void bendy_retarget_state_free(bendy_retarget_state* state); /* does nothing for NULL */
/* Forgets the last frame: for a motion that jumps (another clip, a seek). */
BENDY_API bendy_status bendy_retarget_state_reset(bendy_retarget_state* state, bendy_error* error);

/* What had to give way in a frame. */
typedef struct bendy_retargeted {
    uint32_t size;
    float turned;          /* radians: most that a constraint turned a joint away from where it was to be */
    uint32_t turned_joint; /* of the target, or BENDY_NONE */
    float missed;          /* metres: most that a hand or foot is away from where it was to be */
    uint32_t missed_joint; /* of the target, or BENDY_NONE */
    float lowered;         /* metres: by how much the hips were lowered so that the feet reach the ground */
    float contacts[14];    /* 0 in the air, 1 on the ground: left heel, left toes, right heel, right toes; the same of
                              an animal's front feet; a human's left hand, right hand, and its body, if it sits, lies or
                              kneels; how near its hands are to each other; left and right hand on the own body;
                              as given or, otherwise, as found */
} bendy_retargeted;

/* Sets `pose`, of the target, to a pose of the source. Where neither a constraint nor a contact acts, limbs have the
 * directions of the source's. What a constraint holds back, the joints below make up for as far as theirs allow. Feet
 * and hands on the ground are then brought to their places by IK, and the body of who sits, lies or kneels to its
 * height. `contacts` are as in bendy_retargeted; if NULL, they are found by heights above the ground. `seconds` since
 * the last call with this state, 0 to 1: joints that would jump where the source does not turn quickly, but do not
 * jump; 0: they may. The first call with seconds allocates. `result` may be NULL. Fails for numbers that are not
 * finite, and the pose is then at rest. */
BENDY_API bendy_status bendy_retarget_pose(bendy_pose* pose, bendy_retarget* retarget,
                                           bendy_pose* source /* of another model */, bendy_retarget_state* state,
                                           const float contacts[14] /* or NULL */, float seconds,
                                           bendy_retargeted* result /* or NULL */, bendy_error* error);

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
BENDY_API bendy_status bendy_lod_set_share(bendy_lod* lod, float share /* 0 to 1 */, bendy_error* error);
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
BENDY_API bendy_status bendy_skin(bendy_pose* pose, const bendy_skin_options* options /* or NULL */,
                                  const bendy_vertices* out, bendy_error* error);

/* Allocates the memory that a bendy_skin_method needs in addition to the pose's own, so that no bendy_skin does. */
BENDY_API bendy_status bendy_prepare_skin(bendy_pose* pose, uint32_t method /* a bendy_skin_method */,
                                          bendy_error* error);

/* ---- Crowds ---------------------------------------------------------------------------------------------- */

/* The work memory for many characters of one model, played on the caller's threads: the size of some twenty poses per
 * worker, nothing per member. Palettes of eight members are computed together, so calls for multiples of eight are the
 * fastest. Different workers may be used by different threads at the same time; one worker by one thread at a time. */
typedef struct bendy_crowd bendy_crowd;

typedef struct bendy_crowd_member { /* one character of a crowd; members must not share outputs */
    uint32_t size;                  /* in an array, the same for all members: the distance from one to the next */
    uint32_t clip;                  /* or BENDY_NONE: the rest pose */
    float seconds;                  /* on the clip's time line, as for bendy_sample */
    uint32_t reserved;              /* 0 */
    const bendy_lod* lod;           /* writes only the vertices of that level; members may share one; NULL: all */
    const bendy_vertices* vertices; /* vertices of all meshes, as for bendy_skin; NULL: not wanted */
    float* palette;                 /* bendy_crowd_palette_size matrices, 16 floats each; NULL: not wanted */
} bendy_crowd_member;

#define BENDY_CROWD_MEMBER_INIT \
    { sizeof(bendy_crowd_member), BENDY_NONE, 0.0f, 0, NULL, NULL, NULL }

/* Creates a crowd for at most `workers` threads at a time, 1 to 4096; 0 counts as 1. */
BENDY_API bendy_crowd* bendy_crowd_new(const bendy_model* model, uint32_t workers, bendy_error* error);
BENDY_API void bendy_crowd_free(bendy_crowd* crowd);              /* does nothing for NULL */
BENDY_API uint32_t bendy_crowd_workers(const bendy_crowd* crowd); /* 0 for NULL. Not in JavaScript: one */
/* Return the number of matrices of all meshes together, and the index of a mesh's first one. A skinned mesh has
 * bendy_mesh.bones, as bendy_bone_matrices computes them; neighbouring meshes with the same ones share them. A rigid
 * mesh has one, of the joint that moves its first vertex. 0 for NULL, and for a mesh that does not exist. */
BENDY_API size_t bendy_crowd_palette_size(const bendy_crowd* crowd);
BENDY_API size_t bendy_crowd_first_matrix(const bendy_crowd* crowd, uint32_t mesh);
/* Samples and skins each of `count` members. The output does not depend on how members are split into calls, or on the
 * worker. If one member has a bad argument, nothing is written for any. */
BENDY_API bendy_status bendy_crowd_play(bendy_crowd* crowd, const bendy_crowd_member* members, size_t count,
                                        uint32_t worker, bendy_error* error);
/* Sets the whole pose of a member, which holds values of other members; `user` is what the caller passed. The
 * pose is valid during the call and must not be freed. */
typedef void (*bendy_pose_member)(void* user, size_t member, bendy_pose* pose);
/* As bendy_crowd_play, but the caller sets each pose: blends clips, solves IK chains. The members' clips and times are
 * not used. Only for C: a call back per member into an interpreter takes longer than a pose of its own. */
BENDY_API bendy_status bendy_crowd_play_posed(bendy_crowd* crowd, const bendy_crowd_member* members, size_t count,
                                              uint32_t worker, bendy_pose_member pose_member, void* user,
                                              bendy_error* error);

/* ---- Kernels --------------------------------------------------------------------------------------------- */

/* Returns the name of the kernel that does the bulk of the arithmetic: "avx2", "sse4", "neon", "plain". The default
 * is the fastest that the machine can run, unless the environment variable BENDY_KERNEL or bendy_set_kernel selects
 * another. "plain" computes the same bits on every machine. */
BENDY_API const char* bendy_kernel(void);
/* Returns the number of kernels that this machine can run, and the name of one, the fastest first; NULL for a number
 * that is too large. Not in JavaScript: loadRuntime chooses the module, and so the kernel. */
BENDY_API uint32_t bendy_kernel_count(void);
BENDY_API const char* bendy_kernel_name(uint32_t number);
/* Selects a kernel, with immediate effect in every thread. Not in JavaScript: see bendy_kernel_count. */
BENDY_API bendy_status bendy_set_kernel(const char* name, bendy_error* error);

#ifdef __cplusplus
}
#endif

#endif
