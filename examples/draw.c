/* A character drawn from C, without a window: fades from one clip to another, lets an IK chain reach, and writes a
 * picture with the materials and textures of the file.
 *
 *     cc -std=c99 draw.c $(pkg-config --cflags --libs bendy libpng) -lm -o draw
 *     ./draw mannequin.bendy picture.ppm Idle Walk IK_LeftArm 0.3 1.2 0.4
 *
 * Textures are PNG images inside the file. A real renderer sends the same arrays to the graphics processor.
 */
#include <bendy.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 480, HEIGHT = 640 };

typedef struct Request {
    const char* file;
    const char* picture;
    const char* from; /* clips */
    const char* to;
    const char* chain;
    float target[3];
} Request;

typedef struct Image {
    uint32_t width, height;
    unsigned char* pixels; /* red, green, blue, alpha; NULL: none */
    bendy_texture sampler;
} Image;

/* What a program needs to draw the character; NULL if it was not made. */
typedef struct Character {
    bendy_model* model;
    bendy_pose* pose;
    bendy_pose* scratch;
    bendy_crossfade* fade;
    float* positions; /* of all meshes */
    float* normals;
    Image* images; /* one per texture */
} Character;

typedef struct Canvas {
    float depth[HEIGHT][WIDTH];
    float light[HEIGHT][WIDTH][3]; /* linear red, green, blue */
    float centre[3];               /* of the view, in model space */
    float pixels_per_metre;
} Canvas;

typedef struct Corner {
    float x, y, z; /* pixels, and metres towards the viewer */
    float normal[3];
    float uv[2];
} Corner;

static void* take(size_t count, size_t size, bendy_error* error) {
    void* memory = calloc(count + 1, size); /* + 1: there may be none */
    if (memory == NULL) {
        error->status = BENDY_OUT_OF_MEMORY;
        strcpy(error->message, "there is not enough memory");
    }
    return memory;
}

/* Decodes the first encoding that is an embedded PNG; others are left out, and the material's colour is used alone. */
static bendy_status load_texture(const bendy_model* model, uint32_t texture, Image* out, bendy_error* error) {
    uint32_t k;
    out->sampler.size = sizeof out->sampler;
    if (bendy_get_texture(model, texture, &out->sampler, error) != BENDY_OK) return (bendy_status)error->status;
    for (k = 0; k < out->sampler.images && out->pixels == NULL; ++k) {
        bendy_image image;
        png_image png;
        image.size = sizeof image;
        if (bendy_get_image(model, texture, k, &image, error) != BENDY_OK) return (bendy_status)error->status;
        memset(&png, 0, sizeof png);
        png.version = PNG_IMAGE_VERSION;
        if (image.media != BENDY_MEDIA_PNG || !png_image_begin_read_from_memory(&png, image.bytes, image.byte_count))
            continue;
        png.format = PNG_FORMAT_RGBA;
        out->pixels = take(PNG_IMAGE_SIZE(png), 1, error);
        if (out->pixels == NULL || !png_image_finish_read(&png, NULL, out->pixels, 0, NULL)) {
            png_image_free(&png);
            free(out->pixels);
            out->pixels = NULL;
            continue;
        }
        out->width = png.width;
        out->height = png.height;
    }
    return BENDY_OK;
}

static bendy_status open_character(const Request* request, Character* character, bendy_error* error) {
    size_t vertices;
    uint32_t k;
    character->model = bendy_open(request->file, NULL, error);
    if (character->model == NULL) return (bendy_status)error->status;
    character->pose = bendy_pose_new(character->model, error);
    character->scratch = bendy_pose_new(character->model, error);
    character->fade = bendy_crossfade_new(character->model, error);
    vertices = (size_t)bendy_vertex_count(character->model);
    character->positions = take(vertices, 3 * sizeof(float), error);
    character->normals = take(vertices, 3 * sizeof(float), error);
    character->images = take(bendy_texture_count(character->model), sizeof(Image), error);
    for (k = 0; character->images != NULL && k < bendy_texture_count(character->model); ++k)
        load_texture(character->model, k, &character->images[k], error);
    return (bendy_status)error->status; /* of the first call that failed, or BENDY_OK */
}

static void close_character(Character* character) {
    uint32_t k;
    for (k = 0; character->images != NULL && k < bendy_texture_count(character->model); ++k)
        free(character->images[k].pixels);
    free(character->images);
    free(character->normals);
    free(character->positions);
    bendy_crossfade_free(character->fade);
    bendy_pose_free(character->scratch);
    bendy_pose_free(character->pose);
    bendy_close(character->model);
}

/* Half a second of the first clip, then half of the way into the second; then the chain reaches. */
static bendy_status pose_character(const Request* request, Character* character, bendy_error* error) {
    const uint32_t from = bendy_find_clip(character->model, request->from, error);
    const uint32_t to = from == BENDY_NONE ? BENDY_NONE : bendy_find_clip(character->model, request->to, error);
    const uint32_t chain = to == BENDY_NONE ? BENDY_NONE : bendy_find_chain(character->model, request->chain, error);
    bendy_reach_result result;
    bendy_vertices out = BENDY_VERTICES_INIT;
    uint32_t k;
    result.size = sizeof result;
    if (chain == BENDY_NONE ||
        bendy_crossfade_play(character->fade, from, NULL, 0.0f, BENDY_EASING_SMOOTH, error) != BENDY_OK ||
        bendy_crossfade_advance(character->fade, 0.5, error) != BENDY_OK ||
        bendy_crossfade_play(character->fade, to, NULL, 0.4f, BENDY_EASING_SMOOTH, error) != BENDY_OK ||
        bendy_crossfade_advance(character->fade, 0.2, error) != BENDY_OK ||
        bendy_sample_crossfade(character->pose, character->fade, character->scratch, error) != BENDY_OK ||
        bendy_reach(character->pose, chain, request->target, NULL, NULL, &result, error) != BENDY_OK)
        return (bendy_status)error->status;
    for (k = 0; k < bendy_crossfade_count(character->fade); ++k) {
        bendy_playing playing;
        bendy_clip clip;
        playing.size = sizeof playing;
        clip.size = sizeof clip;
        bendy_get_playing(character->fade, k, &playing, error);
        bendy_get_clip(character->model, playing.clip, &clip, error);
        printf("%s at %.9g s: %.9g of the pose\n", clip.name, (double)playing.seconds, (double)playing.share);
    }
    printf("%s: %.9g m from the target\n", request->chain, (double)result.distance);
    out.capacity = (size_t)bendy_vertex_count(character->model);
    out.positions = character->positions;
    out.normals = character->normals;
    return bendy_skin(character->pose, NULL, &out, error);
}

static float wrapped(float at, uint32_t wrap) {
    if (wrap == BENDY_CLAMP_TO_EDGE) return fminf(fmaxf(at, 0.0f), 1.0f);
    if (wrap == BENDY_MIRRORED_REPEAT) {
        at = fabsf(fmodf(at, 2.0f));
        return at > 1.0f ? 2.0f - at : at;
    }
    return at - floorf(at);
}

/* Multiplies `colour` (linear, 4 numbers) by the nearest pixel of the texture. */
static void apply_texture(const Image* image, const bendy_texture_use* use, const float* uv, float* colour) {
    const float u = use->scale[0] * uv[0];
    const float v = use->scale[1] * uv[1];
    const float turned_u = cosf(use->rotation) * u + sinf(use->rotation) * v + use->offset[0];
    const float turned_v = cosf(use->rotation) * v - sinf(use->rotation) * u + use->offset[1];
    uint32_t x = (uint32_t)(wrapped(turned_u, image->sampler.wrap_s) * (float)image->width);
    uint32_t y = (uint32_t)(wrapped(turned_v, image->sampler.wrap_t) * (float)image->height);
    const unsigned char* pixel;
    int c;
    if (x >= image->width) x = image->width - 1;
    if (y >= image->height) y = image->height - 1;
    pixel = image->pixels + 4 * ((size_t)y * image->width + x);
    for (c = 0; c < 3; ++c) colour[c] *= powf((float)pixel[c] / 255.0f, 2.2f); /* sRGB, nearly */
    colour[3] *= (float)pixel[3] / 255.0f;
}

/* Where a point is relative to a line, as an area. */
static float side(const Corner* a, const Corner* b, float x, float y) {
    return (b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x);
}

static void shade(Canvas* canvas, int x, int y, const Corner* at, const bendy_material* material, const Image* image) {
    const float towards_light[3] = {0.36f, 0.80f, 0.48f};
    const float length =
        sqrtf(at->normal[0] * at->normal[0] + at->normal[1] * at->normal[1] + at->normal[2] * at->normal[2]);
    float colour[4];
    float facing = 0.0f;
    int c;
    memcpy(colour, material->base_colour, sizeof colour);
    if (image != NULL) apply_texture(image, &material->base_colour_texture, at->uv, colour);
    if (material->alpha_mode == BENDY_ALPHA_MASK && colour[3] < material->alpha_cutoff) return;
    for (c = 0; length > 0.0f && c < 3; ++c) facing += towards_light[c] * at->normal[c] / length;
    facing = 0.35f + 0.65f * fmaxf(facing, 0.0f);
    canvas->depth[y][x] = at->z;
    for (c = 0; c < 3; ++c) canvas->light[y][x][c] = material->emissive[c] + colour[c] * facing;
}

static void draw_triangle(Canvas* canvas, const Corner* t, const bendy_material* material, const Image* image) {
    const float area = side(&t[0], &t[1], t[2].x, t[2].y);
    const int left = (int)fmaxf(0.0f, fminf(t[0].x, fminf(t[1].x, t[2].x)));
    const int right = (int)fminf(WIDTH - 1.0f, fmaxf(t[0].x, fmaxf(t[1].x, t[2].x)));
    const int top = (int)fmaxf(0.0f, fminf(t[0].y, fminf(t[1].y, t[2].y)));
    const int bottom = (int)fminf(HEIGHT - 1.0f, fmaxf(t[0].y, fmaxf(t[1].y, t[2].y)));
    int x, y, c;
    if (area == 0.0f) return;
    for (y = top; y <= bottom; ++y) {
        for (x = left; x <= right; ++x) {
            const float px = (float)x + 0.5f, py = (float)y + 0.5f;
            const float a = side(&t[1], &t[2], px, py) / area;
            const float b = side(&t[2], &t[0], px, py) / area;
            const float d = 1.0f - a - b;
            Corner at;
            if (a < 0.0f || b < 0.0f || d < 0.0f) continue;
            at.z = a * t[0].z + b * t[1].z + d * t[2].z;
            if (at.z <= canvas->depth[y][x]) continue;
            for (c = 0; c < 3; ++c) at.normal[c] = a * t[0].normal[c] + b * t[1].normal[c] + d * t[2].normal[c];
            for (c = 0; c < 2; ++c) at.uv[c] = a * t[0].uv[c] + b * t[1].uv[c] + d * t[2].uv[c];
            shade(canvas, x, y, &at, material, image);
        }
    }
}

/* Draws one submesh, seen along -Z. `uv` is NULL if the mesh has no texture coordinates. */
static void draw_submesh(Canvas* canvas, const Character* character, const bendy_mesh* mesh,
                         const bendy_submesh* submesh, const bendy_material* material, const uint32_t* indices,
                         const float* uv) {
    const uint32_t texture = material->base_colour_texture.texture;
    const Image* image = texture == BENDY_NONE || uv == NULL ? NULL : &character->images[texture];
    uint32_t k;
    int corner;
    if (image != NULL && image->pixels == NULL) image = NULL;
    for (k = submesh->first; k < submesh->first + submesh->count; k += 3) {
        Corner triangle[3];
        for (corner = 0; corner < 3; ++corner) {
            const size_t vertex = indices[k + (uint32_t)corner];
            const float* position = character->positions + 3 * (mesh->first_vertex + vertex);
            Corner* out = &triangle[corner];
            out->x = WIDTH / 2.0f + (position[0] - canvas->centre[0]) * canvas->pixels_per_metre;
            out->y = HEIGHT / 2.0f - (position[1] - canvas->centre[1]) * canvas->pixels_per_metre;
            out->z = position[2];
            memcpy(out->normal, character->normals + 3 * (mesh->first_vertex + vertex), sizeof out->normal);
            out->uv[0] = uv == NULL ? 0.0f : uv[2 * vertex];
            out->uv[1] = uv == NULL ? 0.0f : uv[2 * vertex + 1];
        }
        draw_triangle(canvas, triangle, material, image);
    }
}

/* The material of a submesh; white if it has none. */
static bendy_status get_material(const bendy_model* model, uint32_t material, bendy_material* out, bendy_error* error) {
    memset(out, 0, sizeof *out);
    out->size = sizeof *out;
    if (material != BENDY_NONE) return bendy_get_material(model, material, out, error);
    out->base_colour[0] = out->base_colour[1] = out->base_colour[2] = out->base_colour[3] = 1.0f;
    out->base_colour_texture.texture = BENDY_NONE;
    return BENDY_OK;
}

static bendy_status draw_character(Canvas* canvas, const Character* character, bendy_error* error) {
    uint32_t d;
    for (d = 0; d < bendy_submesh_count(character->model) && error->status == BENDY_OK; ++d) {
        bendy_submesh submesh;
        bendy_mesh mesh;
        bendy_material material;
        uint32_t* indices;
        float* uv = NULL;
        submesh.size = sizeof submesh;
        mesh.size = sizeof mesh;
        bendy_get_submesh(character->model, d, &submesh, error);
        bendy_get_mesh(character->model, submesh.mesh, &mesh, error);
        get_material(character->model, submesh.material, &material, error);
        indices = take(mesh.indices, sizeof *indices, error);
        bendy_get_indices(character->model, submesh.mesh, indices, mesh.indices, error);
        if (mesh.texture_coord_sets != 0) {
            uv = take(mesh.vertices, 2 * sizeof *uv, error);
            bendy_get_texture_coords(character->model, submesh.mesh, material.base_colour_texture.set, uv,
                                     (size_t)2 * mesh.vertices, error);
        }
        if (error->status == BENDY_OK && submesh.topology == BENDY_TRIANGLES)
            draw_submesh(canvas, character, &mesh, &submesh, &material, indices, uv);
        free(indices);
        free(uv);
    }
    return (bendy_status)error->status;
}

/* Makes the whole character fit the picture at rest, with room for its arms. */
static bendy_status look_at(Canvas* canvas, const Character* character, bendy_error* error) {
    bendy_bounds* bounds = bendy_bounds_new(character->model, error);
    bendy_box box = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    int x, y, c;
    bendy_bounds_of_pose(bounds, character->pose, &box, error);
    bendy_bounds_free(bounds);
    for (c = 0; c < 3; ++c) canvas->centre[c] = (box.minimum[c] + box.maximum[c]) / 2.0f;
    canvas->pixels_per_metre =
        0.9f * fminf(WIDTH / (box.maximum[0] - box.minimum[0]), HEIGHT / (box.maximum[1] - box.minimum[1]));
    for (y = 0; y < HEIGHT; ++y) {
        for (x = 0; x < WIDTH; ++x) canvas->depth[y][x] = -INFINITY;
    }
    return (bendy_status)error->status;
}

static int write_picture(const Canvas* canvas, const char* path) {
    FILE* file = fopen(path, "wb");
    int x, y, c;
    if (file == NULL) return 0;
    fprintf(file, "P6 %d %d 255\n", WIDTH, HEIGHT);
    for (y = 0; y < HEIGHT; ++y) {
        for (x = 0; x < WIDTH; ++x) {
            for (c = 0; c < 3; ++c) {
                const float light = canvas->depth[y][x] > -INFINITY ? canvas->light[y][x][c] : 0.8f;
                fputc((int)(255.0f * powf(fminf(light, 1.0f), 1.0f / 2.2f) + 0.5f), file);
            }
        }
    }
    return fclose(file) == 0;
}

/* So that a test can hold the vertices against those of C++. */
static void print_sums(const Character* character) {
    const size_t numbers = 3 * (size_t)bendy_vertex_count(character->model);
    double sums[2] = {0.0, 0.0};
    size_t k;
    for (k = 0; k < numbers; ++k) {
        sums[0] += (double)(k % 7 + 1) * (double)character->positions[k];
        sums[1] += (double)(k % 7 + 1) * (double)character->normals[k];
    }
    printf("weighted sums of positions and normals: %.17g %.17g\n", sums[0], sums[1]);
}

int main(int argc, char** argv) {
    static Canvas canvas;
    bendy_error error = BENDY_ERROR_INIT;
    Character character = {NULL, NULL, NULL, NULL, NULL, NULL, NULL};
    Request request;
    int c, failed;
    if (argc != 9) {
        fprintf(stderr, "usage: draw FILE.bendy PICTURE.ppm CLIP CLIP CHAIN X Y Z\n");
        return 2;
    }
    request.file = argv[1];
    request.picture = argv[2];
    request.from = argv[3];
    request.to = argv[4];
    request.chain = argv[5];
    for (c = 0; c < 3; ++c) request.target[c] = (float)atof(argv[6 + c]);
    failed = open_character(&request, &character, &error) != BENDY_OK ||
             look_at(&canvas, &character, &error) != BENDY_OK ||
             pose_character(&request, &character, &error) != BENDY_OK ||
             draw_character(&canvas, &character, &error) != BENDY_OK;
    if (failed) {
        fprintf(stderr, "%s: %s\n", request.file, error.message);
    } else {
        print_sums(&character);
        failed = !write_picture(&canvas, request.picture);
        if (failed) fprintf(stderr, "%s: cannot be written\n", request.picture);
    }
    close_character(&character);
    return failed;
}
