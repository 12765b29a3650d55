/* A character posed from C: opens a file, samples a clip, lets an IK chain reach, skins the vertices and writes them
 * as OBJ.
 *
 *     cc -std=c99 pose.c $(pkg-config --cflags --libs bendy) -o pose
 *     ./pose mannequin.bendy Walk 0.3 IK_LeftArm 0.3 1.2 0.4 > posed.obj
 */
#include <bendy.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct Request {
    const char* file;
    const char* clip;
    float seconds;
    const char* chain; /* NULL: no IK */
    float target[3];
} Request;

/* Everything that a program needs to display the character; NULL if it was not made. */
typedef struct Character {
    bendy_model* model;
    bendy_pose* pose;
    float* positions;
    float* normals;
    uint32_t* indices;
} Character;

static bendy_status open_character(const Request* request, Character* character, bendy_error* error) {
    size_t vertices;
    uint32_t most_indices = 0;
    uint32_t mesh;
    character->model = bendy_open(request->file, NULL, error);
    if (character->model == NULL) return (bendy_status)error->status;
    character->pose = bendy_pose_new(character->model, error);
    if (character->pose == NULL) return (bendy_status)error->status;
    for (mesh = 0; mesh < bendy_mesh_count(character->model); ++mesh) {
        bendy_mesh info;
        info.size = sizeof info;
        if (bendy_get_mesh(character->model, mesh, &info, error) != BENDY_OK) return (bendy_status)error->status;
        if (info.indices > most_indices) most_indices = info.indices;
    }
    vertices = (size_t)bendy_vertex_count(character->model);
    character->positions = malloc((vertices + 1) * 3 * sizeof(float)); /* + 1: a model may have none */
    character->normals = malloc((vertices + 1) * 3 * sizeof(float));
    character->indices = malloc(((size_t)most_indices + 1) * sizeof(uint32_t));
    if (character->positions != NULL && character->normals != NULL && character->indices != NULL) return BENDY_OK;
    error->status = BENDY_OUT_OF_MEMORY;
    snprintf(error->message, sizeof error->message, "there is not enough memory");
    return BENDY_OUT_OF_MEMORY;
}

static void close_character(Character* character) {
    free(character->indices);
    free(character->normals);
    free(character->positions);
    bendy_pose_free(character->pose);
    bendy_close(character->model);
}

/* What a game does in every frame. */
static bendy_status pose_character(const Request* request, Character* character, bendy_error* error) {
    bendy_vertices vertices = BENDY_VERTICES_INIT;
    uint32_t clip = bendy_find_clip(character->model, request->clip, error);
    if (clip == BENDY_NONE) return (bendy_status)error->status;
    if (bendy_sample(character->pose, clip, request->seconds, error) != BENDY_OK) return (bendy_status)error->status;
    if (request->chain != NULL) {
        bendy_reach_result result;
        uint32_t chain = bendy_find_chain(character->model, request->chain, error);
        if (chain == BENDY_NONE) return (bendy_status)error->status;
        result.size = sizeof result;
        if (bendy_reach(character->pose, chain, request->target, NULL, NULL, &result, error) != BENDY_OK)
            return (bendy_status)error->status;
        fprintf(stderr, "%s: %.1f mm from the target\n", request->chain, (double)result.distance * 1000.0);
    }
    vertices.capacity = (size_t)bendy_vertex_count(character->model);
    vertices.positions = character->positions;
    vertices.normals = character->normals;
    return bendy_skin(character->pose, NULL, &vertices, error);
}

static void write_triangles(const Character* character, const bendy_submesh* submesh, const bendy_mesh* mesh) {
    uint32_t k;
    for (k = submesh->first; submesh->topology == BENDY_TRIANGLES && k < submesh->first + submesh->count; k += 3) {
        int corner;
        printf("f");
        for (corner = 0; corner < 3; ++corner) {
            unsigned long number = (unsigned long)(mesh->first_vertex + character->indices[k + (uint32_t)corner] + 1);
            printf(" %lu//%lu", number, number);
        }
        printf("\n");
    }
}

static bendy_status write_obj(const Character* character, bendy_error* error) {
    size_t vertices = (size_t)bendy_vertex_count(character->model);
    size_t v;
    uint32_t d;
    for (v = 0; v < vertices; ++v) {
        const float* p = character->positions + 3 * v;
        printf("v %.9g %.9g %.9g\n", (double)p[0], (double)p[1], (double)p[2]);
    }
    for (v = 0; v < vertices; ++v) {
        const float* n = character->normals + 3 * v;
        printf("vn %.9g %.9g %.9g\n", (double)n[0], (double)n[1], (double)n[2]);
    }
    for (d = 0; d < bendy_submesh_count(character->model); ++d) {
        bendy_submesh submesh;
        bendy_mesh mesh;
        submesh.size = sizeof submesh;
        mesh.size = sizeof mesh;
        if (bendy_get_submesh(character->model, d, &submesh, error) != BENDY_OK ||
            bendy_get_mesh(character->model, submesh.mesh, &mesh, error) != BENDY_OK ||
            bendy_get_indices(character->model, submesh.mesh, character->indices, mesh.indices, error) != BENDY_OK)
            return (bendy_status)error->status;
        write_triangles(character, &submesh, &mesh);
    }
    return BENDY_OK;
}

int main(int argc, char** argv) {
    bendy_error error = BENDY_ERROR_INIT;
    Character character = {NULL, NULL, NULL, NULL, NULL};
    Request request = {NULL, NULL, 0.0f, NULL, {0.0f, 0.0f, 0.0f}};
    int failed;
    if (argc != 4 && argc != 8) {
        fprintf(stderr, "usage: pose FILE.bendy CLIP SECONDS [CHAIN X Y Z]\n");
        return 2;
    }
    request.file = argv[1];
    request.clip = argv[2];
    request.seconds = (float)atof(argv[3]);
    if (argc == 8) {
        int c;
        request.chain = argv[4];
        for (c = 0; c < 3; ++c) request.target[c] = (float)atof(argv[5 + c]);
    }
    failed = open_character(&request, &character, &error) != BENDY_OK ||
             pose_character(&request, &character, &error) != BENDY_OK || write_obj(&character, &error) != BENDY_OK;
    if (failed) fprintf(stderr, "%s: %s\n", request.file, error.message);
    close_character(&character);
    return failed;
}
