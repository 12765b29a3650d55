// Reads an exact Bendy file as spec/quick.md describes it, and prints its first object, as that page says:
//     cc -std=c99 -O1 quick_reader.c -lm -o quick_reader && ./quick_reader FILE [CLIP [TIME ...]]
// CLIP is the number of a clip, TIME is in seconds; without them, the pose is the rest pose. A file that is damaged or holds
// what the page leaves out gives one line of error and exit status 1. It needs the standard library only.
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#define NONE 0xFFFFFFFFu
#define EACH(c, parent, id) for (const Chunk* c = find((parent)->child, id); c; c = find(c->next, id))
#define KEY(k, part, i) real(values, 4 * (value + (k)*step + (part)*width + (i)))
#define TIME(k) (first == NONE ? real(info, 0) + (double)(k) / real(info, 8) : real(one(clip, "TIME"), 4 * (first + (k))))
typedef struct {
    char id[5];
    int known;
    uint32_t sum, crc;
    uint64_t at, size, parent;         // the payload, in bytes; the number of a chunk, 0 stands for the file
    int64_t next, child, last, number;  // chunks, or -1, where only known ones count; the number of a joint, or -1
    double *rest, *pose, *world;       // of a joint: its parent, rotation, translation, scale, shear; a matrix, column by column
    double* weights;                   // of a mesh: those of the morph targets
    int64_t* owners;                   // of a rigid mesh: the joint that moves each vertex, or -1
    uint64_t vertices, targets, left;  // of a mesh; left: entries of INDX that no submesh has taken
} Chunk;
static const char kCodecs[9][16] = {"raw", "zstd", "vertices", "vertices, zstd", "indices", "indices, zstd", "clip", "sums", "unknown"};
static const char kKnown[] = "HEAD VERS BNDS TEXT SAMP IMAG LINK SAME MATE SURF EXTN OBJE NAME EXTR MORE SKIN PIVO REST LIMT PULL POLY "
    "JNTS JNAM ROLE STND IKCH KINF VECT VINF PALT TARG TINF FRMS FNAM GRID NLST POSI NORM TANG TEXC COLR BONE WGHT USER VALS INDX LODD CYCL "
    "CINF TRAK PACK PLAY TIME KEYV MARK CURV";
static const double kIdentity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
static unsigned char* file;
static uint64_t file_size, chunk_count, joint_count, mesh_count;
static Chunk *chunks, **joints, **meshes;

static void need(int condition, const Chunk* c, const char* message) {
    if (!condition) fprintf(stderr, "quick_reader: %s at %llu: %s\n", c ? c->id : "file", c && c->at ? c->at - 16ull : 0, message);
    if (!condition) exit(1);
}
static void* make(void* old, uint64_t count, size_t size) {
    void* made = count < SIZE_MAX / size ? realloc(old, (size_t)(count + 1) * size) : NULL;
    need(made != NULL, NULL, "not enough memory");
    return made;
}
static uint32_t crc32c(uint32_t crc, const unsigned char* bytes, uint64_t size) {
    for (uint64_t bit = 0; bit < 8 * size; bit++) crc ^= bit % 8 ? 0 : bytes[bit / 8], crc = crc >> 1 ^ (crc & 1 ? 0x82F63B78u : 0);
    return crc;
}
static uint64_t number(const Chunk* c, uint64_t at, unsigned bytes) {
    uint64_t value = 0;
    need(c->size >= bytes && at <= c->size - bytes, c, "it is too short");
    while (bytes--) value = value << 8 | file[c->at + at + bytes];
    return value;
}
static double real(const Chunk* c, uint64_t at) {
    union { uint32_t bits; float value; } both = {(uint32_t)number(c, at, 4)};
    need(isfinite(both.value), c, "a number is not finite");
    return both.value;
}
static const double* reals(const Chunk* c, uint64_t at, unsigned count) {
    static double found[16];
    for (unsigned k = 0; k < count; k++) found[k] = real(c, at + 4 * k);
    return found;
}
static const Chunk* find(int64_t k, const char* id) {
    while (k >= 0 && strcmp(chunks[k].id, id)) k = chunks[k].next;
    return k < 0 ? NULL : &chunks[k];
}
static const Chunk* one(const Chunk* parent, const char* id) {
    need(find(parent->child, id) != NULL, parent, "a chunk that belongs into it is missing");
    return find(parent->child, id);
}
static void read_tree(void) {
    uint64_t at = 0, depth = 0, parent = 0, left;
    chunks = make(NULL, 1, sizeof(Chunk)), chunks[0] = (Chunk){.id = "file", .known = 1, .size = file_size, .child = -1, .number = -1};
    need(file_size >= 16 && !memcmp(file, "HEAD", 4), NULL, "this is not a Bendy file");
    for (chunk_count = 1; at < file_size || parent; chunk_count++) {
        if ((chunk_count & (chunk_count - 1)) == 0) chunks = make(chunks, 2 * chunk_count, sizeof(Chunk));
        Chunk *up = &chunks[parent], *c = &chunks[chunk_count];
        if ((left = up->at + up->size - at) == 0) {
            need((up->crc ^ NONE) == up->sum, up, "its sum is wrong");
            parent = up->parent, depth--, chunk_count--;
            continue;
        }
        need(left >= 16 && depth < 65536, up, "it ends within a header, or is too deep");
        unsigned flags = (unsigned)number(chunks, at + 14, 2), codec = flags >> 8;
        *c = (Chunk){.at = at + 16, .size = number(chunks, at + 8, 6), .parent = parent, .next = -1, .child = -1, .number = -1};
        memcpy(c->id, file + at, 4);
        c->known = up->known && strstr(kKnown, c->id), c->sum = (uint32_t)number(chunks, at + 4, 4);
        need(strspn(c->id, "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789") == 4, up, "an id in it is not letters and digits");
        need(!(flags & 0xFC) && (!(flags & 1) || (!codec && c->size % 16 == 0)), c, "its size or flags are wrong");
        need(parent ? c->size <= left - 16 : (flags & 1 && c->size == left - 16), c, "it does not fit into its container or file");
        need(c->known || !(flags & 2) || !up->known, c, "it is required and unknown");
        if (c->known && codec) fprintf(stderr, "quick_reader: codec %u (%s): ", codec, kCodecs[codec < 8 ? codec : 8]);
        need(!c->known || (!codec && !strstr("JNTS JNAM FRMS PACK PLAY", c->id)), c, "this reader does not read it");
        up->crc = crc32c(up->crc, file + at + 4, 4), c->crc = crc32c(crc32c(NONE, file + at, 4), file + at + 8, 8);
        if (c->known) *(up->child < 0 ? &up->child : &chunks[up->last].next) = (int64_t)chunk_count;
        if (c->known) up->last = (int64_t)chunk_count;
        at += 16;
        if (flags & 1) parent = chunk_count, depth++;
        need(flags & 1 || (crc32c(c->crc, file + at, c->size) ^ NONE) == c->sum, c, "its sum is wrong");
        for (at += flags & 1 ? 0 : c->size; at % 16; at++) need(file[at] == 0, c, "its padding is not zero");
    }
}
// Checks a stream: its components, or 0 for any, its elements, or NONE, its allowed types, whether integers may be fractions.
static const Chunk* check_stream(const Chunk* c, uint64_t width, uint64_t rows, const char* types, unsigned forms) {
    uint64_t type = number(c, 0, 1), form = number(c, 1, 1), components = number(c, 2, 2), elements = number(c, 4, 4);
    need(form != 2 && form != 3, c, "this reader does not read boxed and listed streams");
    need(type < 6 && form <= forms && number(c, 12, 4) == 0 && strchr(types, "BbHhIf"[type]), c, "its type does not fit");
    need(components && (!width || width == components) && (rows == NONE || rows == elements), c, "its numbers do not fit");
    need(c->size - 16 == components * elements * (type < 4 ? type / 2 + 1 : 4), c, "its size is wrong");
    return c;
}
static double item(const Chunk* c, uint64_t k) {
    unsigned type = file[c->at], size = type < 4 ? type / 2 + 1 : 4;
    double value = type == 5 ? real(c, 16 + 4 * k) : (double)number(c, 16 + k * size, size);
    return file[c->at + 1] == 1 && size < 4 ? value / (size == 1 ? 255 : 65535) : value;
}
static void read_mesh(Chunk* c) {
    uint64_t vertices = number(one(c, "VINF"), 0, 4), joint = number(one(c, "VINF"), 4, 4);
    need(joint < joint_count || joint == NONE, c, "VINF refers to no joint");
    if (vertices) check_stream(one(c, "POSI"), 3, vertices, "f", 0);  // before anything of that size is allocated
    if (find(c->child, "INDX")) c->left = number(check_stream(one(c, "INDX"), 1, NONE, "HI", 0), 4, 4);
    c->vertices = vertices, c->owners = make(NULL, vertices, sizeof(int64_t));
    for (uint64_t v = 0; v < vertices; v++) c->owners[v] = joint == NONE ? -1 : (int64_t)joint;
    EACH(target, c, "TARG") c->targets++;
    c->weights = make(NULL, c->targets, sizeof(double));
}
static void read_submesh(const Chunk* c, int64_t joint) {
    uint64_t at = number(c, 0, 4), first = number(c, 8, 4), count = number(c, 12, 4), vertex;
    need(at < mesh_count && number(c, 16, 4) < 3 && count <= meshes[at]->left, c, "it has no mesh, or not so many indices are left");
    const Chunk* indices = find(meshes[at]->child, "INDX");
    for (uint64_t k = first; k < first + count; meshes[at]->owners[vertex] = joint, meshes[at]->left--, k++)
        need((vertex = (uint64_t)item(indices, k)) < meshes[at]->vertices, c, "INDX refers to no vertex");
}
// Sets the parts of joints, and the weights of morph targets, that the tracks of a clip animate.
static void play(const Chunk* clip, double t) {
    static const unsigned kPlaces[] = {5, 1, 8}, kWidths[] = {3, 4, 3};
    EACH(table, clip, "TRAK") for (uint64_t at = 0; at < table->size; at += 24) {
        uint64_t target = number(table, at, 4), path = number(table, at + 4, 1), mode = number(table, at + 5, 1);
        uint64_t width = number(table, at + 6, 2), keys = number(table, at + 8, 4), first = number(table, at + 12, 4);
        uint64_t value = number(table, at + 16, 8), part = mode == 2, step = part ? 3 * width : width, low = 0, high = keys;
        const Chunk *values = one(clip, "KEYV"), *info = one(clip, "CINF");
        need(path < 4 && mode < 3 && target < (path == 3 ? mesh_count : joint_count), table, "a track animates nothing");
        need(keys && width && width == (path == 3 ? meshes[target]->targets : kWidths[path]), table, "a track does not fit");
        need(number(info, 12, 4) < 2 && value < 1ull << 48 && (first != NONE || real(info, 8) > 0), table, "keys have no place or rate");
        KEY(keys - 1, 0, step - 1), TIME(keys - 1);  // the last ones must be there
        for (uint64_t m; high - low > 1; *(TIME(m) <= t ? &low : &high) = m) m = low + (high - low) / 2;  // the last key up to t
        high = low + 1 < keys ? low + 1 : low;
        double d = TIME(high) - TIME(low), u = d > 0 ? fmin(fmax((t - TIME(low)) / d, 0), 1) : 0, dot = 0, length = 0, h = 0;
        double q = mode == 0 ? 0 : mode == 1 ? u : 3 * u * u - 2 * u * u * u, p = 1 - q;
        double* to = path == 3 ? meshes[target]->weights : joints[target]->pose + kPlaces[path];
        for (uint64_t i = 0; path == 1 && mode == 1 && i < 4; i++) dot += KEY(low, 0, i) * KEY(high, 0, i);
        if (path == 1 && mode == 1 && (h = acos(fmin(fabs(dot), 1))) > 1e-4) p = sin(p * h) / sin(h), q = sin(q * h) / sin(h);
        for (uint64_t i = 0; i < width; length += to[i] * to[i], i++) {
            to[i] = p * KEY(low, part, i) + (dot < 0 ? -q : q) * KEY(high, part, i);
            if (mode == 2) to[i] += d * u * (1 - u) * ((1 - u) * KEY(low, 2, i) - u * KEY(high, 0, i));
        }
        for (unsigned i = 0; path == 1 && i < 4 && length > 0; i++) to[i] /= sqrt(length);
    }
}
static void multiply(const double* a, const double* b, double* out) {
    for (int k = 0; k < 16; b += ++k % 4 ? 0 : 4)
        out[k] = a[k % 4] * b[0] + a[k % 4 + 4] * b[1] + a[k % 4 + 8] * b[2] + a[k % 4 + 12] * b[3];
}
static void place(const Chunk* joint) {
    const double *r = joint->pose + 1, *t = r + 4, *s = r + 7, *h = r + 10, x = r[0], y = r[1], z = r[2], w = r[3];
    double turn[16] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0, 2 * (x * y - z * w), 1 - 2 * (x * x + z * z),
                       2 * (y * z + x * w), 0, 2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0, t[0], t[1], t[2], 1};
    double grow[16] = {s[0], 0, 0, 0, h[0], s[1], 0, 0, h[1], h[2], s[2], 0, 0, 0, 0, 1}, local[16];
    multiply(turn, grow, local);
    multiply(chunks[joint->parent].number < 0 ? kIdentity : chunks[joint->parent].world, local, joint->world);
}
static void print_line(const char* what, const double* numbers, int count, const Chunk* named) {
    const Chunk* name = named ? find(named->child, "NAME") : NULL;
    printf("%s", what);
    for (int k = 0; k < count; k++) need(isfinite(numbers[k]), named, "a result is not finite"), printf(" %.9g", numbers[k]);
    for (uint64_t k = 0; name && k < name->size; k++) printf("%s%c", k ? "" : " ", file[name->at + k] < 32 ? '?' : file[name->at + k]);
    putchar('\n');
}
// Prints the vertices of a mesh in model space: morph targets first, then the palette.
static void print_skin(const Chunk* c) {
    const Chunk *target = find(c->child, "TARG"), *posi = find(c->child, "POSI"), *palette = find(c->child, "PALT"), *bones = 0, *wght = 0;
    uint64_t vertices = c->vertices, entries = 0, start = 0, gap = 0, n = 1, v;
    double *p = make(NULL, 3 * vertices, sizeof(double)), m[16];
    for (uint64_t k = 0; k < 3 * vertices; k++) p[k] = item(posi, k);
    for (uint64_t t = 0; t < c->targets; t++, target = find(target->next, "TARG")) {
        const Chunk *list = find(target->child, "INDX"), *by = find(target->child, "POSI");
        uint64_t touched = list ? number(check_stream(list, 1, NONE, "HI", 0), 4, 4) : vertices;
        if (by) check_stream(by, 3, touched, "f", 0);
        for (uint64_t k = 0; by && k < 3 * touched; k++) {
            need((v = list ? (uint64_t)item(list, k / 3) : k / 3) < vertices, list, "it refers to no vertex");
            p[3 * v + k % 3] += c->weights[t] * item(by, k);
        }
    }
    if (palette || find(c->child, "BONE") || find(c->child, "WGHT")) {
        palette = one(c, "PALT"), entries = number(palette, 0, 4), start = (4 * entries + 31) / 16 * 16, gap = start - 16 - 4 * entries;
        bones = check_stream(one(c, "BONE"), 0, vertices, "BH", 0), n = number(bones, 2, 2);
        wght = check_stream(one(c, "WGHT"), n, vertices, "BHf", 1);
        need(number(palette, 4, 4) == 0, palette, "this reader does not read derived palettes");
        need(!number(palette, 8, 8) && !number(palette, start - gap, gap / 2) && !number(palette, start - gap / 2, gap / 2) &&
                 palette->size == start + 64 * entries, palette, "its size or a reserved field is wrong");
    }
    for (v = 0; v < vertices; v++) {
        double out[3] = {0, 0, 0};
        for (uint64_t i = n * v; i < n * v + n; i++) {
            uint64_t bone = bones ? (uint64_t)item(bones, i) : 0;
            int64_t joint = bones ? (int64_t)number(palette, 16 + 4 * bone, 4) : c->owners[v];
            need(!bones || (bone < entries && joint < (int64_t)joint_count), c, "BONE or PALT refers to nothing");
            multiply(joint < 0 ? kIdentity : joints[joint]->world, bones ? reals(palette, start + 64 * bone, 16) : kIdentity, m);
            double w = bones ? item(wght, i) : 1;
            for (int k = 0; k < 3; k++) out[k] += w * (m[k] * p[3 * v] + m[k + 4] * p[3 * v + 1] + m[k + 8] * p[3 * v + 2] + m[k + 12]);
        }
        print_line("vertex", out, 3, NULL);
    }
    free(p);
}
static void print_pose(const Chunk* clip, double t) {
    print_line("pose", &t, 1, NULL);
    for (uint64_t j = 0; j < joint_count; j++) memcpy(joints[j]->pose, joints[j]->rest, 14 * sizeof(double));
    for (uint64_t m = 0, k = 0; m < mesh_count; m++, k = 0) EACH(c, meshes[m], "TARG") meshes[m]->weights[k++] = real(one(c, "TINF"), 0);
    if (clip) play(clip, t);
    for (uint64_t j = 0; j < joint_count; j++) place(joints[j]), print_line("world", joints[j]->world, 16, NULL);
    for (uint64_t m = 0; m < mesh_count; m++) print_line("mesh", NULL, 0, meshes[m]), print_skin(meshes[m]);
}
int main(int argc, char** argv) {
    FILE* in = argc > 1 ? fopen(argv[1], "rb") : NULL;
    need(in != NULL, NULL, "it cannot be read; usage: quick_reader FILE [CLIP [TIME ...]]");
    for (size_t got = 1; got; file_size += got)
        file = make(file, file_size + (1 << 20), 1), got = fread(file + file_size, 1, 1 << 20, in);
    read_tree();
    const Chunk *head = &chunks[1], *vers = one(head, "VERS"), *thing = find(head->child, "OBJE") ? one(head, "OBJE") : head, *clip = NULL;
    need(number(vers, 44, 4) == 0 && !memcmp(file + vers->at, "BENDY\r\n\x1a\0", 10), vers, "the version is unknown");
    EACH(c, head, "MATE") print_line("material", reals(one(c, "SURF"), 0, 12), 12, c);
    joints = make(NULL, chunk_count, sizeof(Chunk*)), meshes = make(NULL, chunk_count, sizeof(Chunk*));
    for (Chunk* c = chunks; c < chunks + chunk_count; c++) {
        if (!c->known || strcmp(c->id, "SKIN") || (&chunks[c->parent] != thing && chunks[c->parent].number < 0)) continue;
        const Chunk* rest = one(one(c, "PIVO"), "REST");
        c->rest = make(NULL, 14 + 14 + 16, sizeof(double)), c->pose = c->rest + 14, c->world = c->pose + 14;
        c->rest[0] = (double)chunks[c->parent].number;
        for (unsigned k = 0; k < 13; k++) c->rest[k + 1] = k < 10 || rest->size != 40 ? real(rest, 4 * k) : 0;
        print_line("joint", c->rest, 14, c);
        c->number = (int64_t)joint_count, joints[joint_count++] = c;
    }
    EACH(c, thing, "VECT") read_mesh(meshes[mesh_count++] = &chunks[c - chunks]);
    for (uint64_t j = 0; j < joint_count; j++) EACH(c, joints[j], "POLY") read_submesh(c, (int64_t)j);
    long wanted = argc > 2 ? atol(argv[2]) : -1;
    EACH(c, thing, "CYCL") if (print_line("clip", reals(one(c, "CINF"), 0, 3), 3, c), play(c, 0), wanted-- == 0) clip = c;
    need(argc < 3 || clip, NULL, "there is no such clip");
    for (int k = 3; k < argc || k == 3; k++) print_pose(clip, k < argc ? atof(argv[k]) : 0);
    return 0;
}
