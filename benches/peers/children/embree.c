/* Times Embree 3 on the rays that `benches/peers` writes, one thread, and prints a line
 * "name nanoseconds hits" for each query.
 *
 * The file: four 32-bit counts (points, faces, coherent rays, random rays), a ball of four
 * floats, points, faces, and rays of six floats each. Coherent rays come in tiles of 4 by 4,
 * so that sixteen in a row make a packet.
 *
 *     embree FILE normal|robust
 */
#include <embree3/rtcore.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_CROSSINGS = 256 };

/* The crossings of one ray; Embree passes the context through to the filter. */
struct gathering {
    struct RTCIntersectContext context;
    int count;
    float t[MOST_CROSSINGS];
};

static float ball[4];

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return time.tv_sec * 1e9 + time.tv_nsec;
}

static void *take(FILE *file, size_t size)
{
    void *bytes = malloc(size + 16);
    if (!bytes || fread(bytes, 1, size, file) != size) {
        fprintf(stderr, "the file is cut short\n");
        exit(2);
    }
    return bytes;
}

/* Notes a crossing of a single ray and lets the ray go on. */
static void gather(const struct RTCFilterFunctionNArguments *found)
{
    struct gathering *all = (struct gathering *)found->context;
    if (all->count < MOST_CROSSINGS)
        all->t[all->count++] = ((struct RTCRay *)found->ray)->tfar;
    found->valid[0] = 0;
}

static struct RTCRayHit ray_of(const float *numbers)
{
    struct RTCRayHit ray;
    memset(&ray, 0, sizeof ray);
    ray.ray.org_x = numbers[0], ray.ray.org_y = numbers[1], ray.ray.org_z = numbers[2];
    ray.ray.dir_x = numbers[3], ray.ray.dir_y = numbers[4], ray.ray.dir_z = numbers[5];
    ray.ray.tfar = INFINITY;
    ray.ray.mask = -1;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return ray;
}

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* How many stretches of a ray are in the mesh and not in the ball. */
static int stretches(const float *ray, struct gathering *all)
{
    float out[3], a = 0, b = 0, c = -ball[3] * ball[3];
    for (int i = 0; i < 3; i++) {
        out[i] = ray[i] - ball[i];
        a += ray[3 + i] * ray[3 + i], b += out[i] * ray[3 + i], c += out[i] * out[i];
    }
    float root = b * b - a * c, enter = INFINITY, leave = INFINITY;
    if (root > 0) {
        root = sqrtf(root);
        enter = (-b - root) / a, leave = (-b + root) / a;
    }
    if (all->count > 12) {
        qsort(all->t, all->count, sizeof(float), ascending);
    } else {
        for (int i = 1; i < all->count; i++) {
            float t = all->t[i];
            int j = i;
            for (; j > 0 && all->t[j - 1] > t; j--)
                all->t[j] = all->t[j - 1];
            all->t[j] = t;
        }
    }
    int found = 0;
    for (int i = 0; i + 1 < all->count; i += 2) {
        float from = all->t[i], to = all->t[i + 1];
        found += from < fminf(to, enter);
        found += leave < INFINITY && fmaxf(from, leave) < to;
    }
    return found;
}

static void report(const char *name, double start, uint32_t rays, long hits)
{
    printf("%s %.3f %ld\n", name, (now() - start) / rays, hits);
}

static void single(const char *name, RTCScene scene, const float *rays, uint32_t count)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    long hits = 0;
    double start = now();
    for (uint32_t i = 0; i < count; i++) {
        struct RTCRayHit ray = ray_of(rays + 6 * i);
        rtcIntersect1(scene, &context, &ray);
        hits += ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    report(name, start, count, hits);
}

static void packets(RTCScene scene, const float *rays, uint32_t count)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    int valid[16];
    memset(valid, -1, sizeof valid);
    long hits = 0;
    double start = now();
    for (uint32_t i = 0; i + 16 <= count; i += 16) {
        struct RTCRayHit16 packet;
        memset(&packet, 0, sizeof packet);
        for (int k = 0; k < 16; k++) {
            const float *ray = rays + 6 * (i + k);
            packet.ray.org_x[k] = ray[0], packet.ray.org_y[k] = ray[1];
            packet.ray.org_z[k] = ray[2], packet.ray.dir_x[k] = ray[3];
            packet.ray.dir_y[k] = ray[4], packet.ray.dir_z[k] = ray[5];
            packet.ray.tfar[k] = INFINITY;
            packet.ray.mask[k] = -1;
            packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect16(valid, scene, &context, &packet);
        for (int k = 0; k < 16; k++)
            hits += packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
    }
    report("packets", start, count, hits);
}

static void all(RTCScene scene, const float *rays, uint32_t count)
{
    struct gathering found;
    rtcInitIntersectContext(&found.context);
    found.context.filter = gather;
    long spans = 0;
    double start = now();
    for (uint32_t i = 0; i < count; i++) {
        struct RTCRayHit ray = ray_of(rays + 6 * i);
        found.count = 0;
        rtcIntersect1(scene, &found.context, &ray);
        spans += stretches(rays + 6 * i, &found);
    }
    report("all", start, count, spans);
}

int main(int argc, char **argv)
{
    FILE *file = argc == 3 ? fopen(argv[1], "rb") : NULL;
    if (!file) {
        fprintf(stderr, "usage: embree FILE normal|robust\n");
        return 2;
    }
    uint32_t *counts = take(file, 4 * sizeof(uint32_t));
    memcpy(ball, take(file, sizeof ball), sizeof ball);
    float *points = take(file, counts[0] * 3 * sizeof(float));
    uint32_t *faces = take(file, counts[1] * 3 * sizeof(uint32_t));
    float *coherent = take(file, counts[2] * 6 * sizeof(float));
    float *random = take(file, counts[3] * 6 * sizeof(float));
    fclose(file);

    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene scene = rtcNewScene(device);
    double start = now();
    int robust = !strcmp(argv[2], "robust");
    int flags = robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE;
    rtcSetSceneFlags(scene, flags | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    memcpy(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   3 * sizeof(float), counts[0]),
           points, counts[0] * 3 * sizeof(float));
    memcpy(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   3 * sizeof(uint32_t), counts[1]),
           faces, counts[1] * 3 * sizeof(uint32_t));
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcCommitScene(scene);
    report("build", start, 1, counts[1]);

    single("coherent", scene, coherent, counts[2]);
    packets(scene, coherent, counts[2]);
    single("random", scene, random, counts[3]);
    all(scene, coherent, counts[2]);
    return 0;
}
