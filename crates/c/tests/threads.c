/* 8 threads ask clones of one mesh about robots of their own, and each answer is that of one
   thread. `threads CALLS`; run under ThreadSanitizer too. */
#include "parry_continuum.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 8, SHAPES = 64, RINGS = 24, AROUND = 24 };

static pc_mesh *mesh;
static pc_chain *robots[SHAPES];
static double distances[SHAPES];
static long calls_each;

static void make(void) {
    static double vertices[RINGS * AROUND * 3];
    static uint32_t faces[(RINGS - 1) * AROUND * 6];
    size_t face = 0;
    for (int ring = 0; ring < RINGS; ++ring)
        for (int k = 0; k < AROUND; ++k) {
            double *vertex = vertices + 3 * (ring * AROUND + k);
            const double angle = 6.283185307179586 * k / AROUND;
            vertex[0] = (3 + 0.2 * (k % 3)) * cos(angle);
            vertex[1] = (3 + 0.2 * (ring % 2)) * sin(angle);
            vertex[2] = 0.5 * ring;
        }
    for (int ring = 0; ring + 1 < RINGS; ++ring)
        for (int k = 0; k < AROUND; ++k) {
            const uint32_t a = ring * AROUND + k, b = ring * AROUND + (k + 1) % AROUND;
            const uint32_t corners[] = {a, b, a + AROUND, b, b + AROUND, a + AROUND};
            memcpy(faces + 3 * face, corners, sizeof corners);
            face += 2;
        }
    if (pc_mesh_new(vertices, RINGS * AROUND, faces, face, &mesh) != PC_OK) exit(2);
    for (int k = 0; k < SHAPES; ++k) {
        double points[30];
        const double radius = 0.2;
        for (int i = 0; i < 10; ++i) {
            points[3 * i] = 0.02 * k * i * i / 10.0;
            points[3 * i + 1] = 0.1 * (k % 7);
            points[3 * i + 2] = i;
        }
        pc_minimum found;
        if (pc_chain_new(points, 10, &radius, 1, 0, robots + k) != PC_OK ||
            pc_mesh_minimum(mesh, robots[k], NULL, &found) != PC_OK)
            exit(2);
        distances[k] = found.distance;
    }
}

/* A thread that ends has no last error any more; a call says what is wrong all the same. */
static pthread_key_t at_end;
static _Atomic size_t ended;

static void end(void *unused) {
    (void)unused;
    ended += pc_mesh_minimum(NULL, NULL, NULL, NULL) == PC_BAD_ARGUMENT &&
             pc_error_message() != NULL && pc_error_robot() == -1;
}

static void *ask(void *number) {
    pc_mesh *own;
    pthread_setspecific(at_end, &ended);
    pc_minimum found;
    long wrong = pc_mesh_clone(mesh, &own) != PC_OK;
    for (long k = 0; k < calls_each; ++k) {
        const int shape = (int)((k * 5 + (long)(size_t)number) % SHAPES);
        if (k % 100 == 99) { /* an error of one thread is not another's */
            wrong += pc_mesh_minimum(own, NULL, NULL, &found) != PC_BAD_ARGUMENT;
            wrong += strcmp(pc_error_kind(), "null_pointer") != 0;
        }
        wrong += pc_mesh_minimum(own, robots[shape], NULL, &found) != PC_OK;
        wrong += found.distance != distances[shape];
    }
    pc_mesh_free(own);
    return (void *)(size_t)wrong;
}

int main(int argc, char **argv) {
    pthread_t threads[THREADS];
    size_t wrong = 0;
    if (argc != 2) return 2;
    calls_each = atol(argv[1]) / THREADS;
    make();
    if (pthread_key_create(&at_end, end) != 0) return 2;
    for (size_t k = 0; k < THREADS; ++k)
        if (pthread_create(threads + k, NULL, ask, (void *)k) != 0) return 2;
    for (int k = 0; k < THREADS; ++k) {
        void *found;
        pthread_join(threads[k], &found);
        wrong += (size_t)found;
    }
    for (int k = 0; k < SHAPES; ++k) pc_chain_free(robots[k]);
    pc_mesh_free(mesh);
    printf("%ld calls on %d threads, %zu wrong\n", calls_each * THREADS, THREADS, wrong);
    return wrong == 0 && ended == THREADS ? 0 : 1;
}
