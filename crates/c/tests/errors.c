/* Every kind of error, and random lengths, pointers and numbers: an error or an answer, never a
   crash. `errors ROUNDS FOLDER`; run under AddressSanitizer and valgrind too. */
#include "parry_continuum.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures;

static void expect(pc_status status, pc_status expected, const char *kind, const char *what) {
    if (status == expected && (status == PC_OK || strcmp(pc_error_kind(), kind) == 0)) return;
    printf("%s: %d %s: %s\n", what, status, pc_error_kind(), pc_error_message());
    ++failures;
}

#define REFUSES(call, status, kind) expect(call, status, kind, #call)
#define ANSWERS(call) expect(call, PC_OK, "", #call)
#define IS_TRUE(truth)                          \
    do {                                        \
        if (!(truth)) {                         \
            printf("not so: %s\n", #truth);     \
            ++failures;                         \
        }                                       \
    } while (0)

static const double VERTICES[] = {-9, -9, 0, 9, -9, 0, 0, 9, 0};
static const uint32_t FACES[] = {0, 1, 2};
static const double POINTS[] = {0, 0, 2, 1, 0, 2, 2, 0, 3};
static const double RADII[] = {0.5, 0.5};

static pc_mesh *mesh;
static pc_chain *robot;
static pc_tube *tube;
static pc_motion *motion;
static pc_pair *pair;
static pc_self_query *alone;
static pc_scene *scene;

static void make(void) {
    double lifted[9];
    size_t structure;
    for (int k = 0; k < 9; ++k) lifted[k] = POINTS[k] + (k % 3 == 2);
    ANSWERS(pc_mesh_new(VERTICES, 3, FACES, 1, &mesh));
    ANSWERS(pc_chain_new(POINTS, 3, RADII, 2, PC_CAPS_FITTED, &robot));
    ANSWERS(pc_tube_new(POINTS, 3, RADII, 1, NULL, 0, 0, NAN, &tube));
    ANSWERS(pc_motion_linear(POINTS, lifted, 3, RADII, 2, PC_CAPS_FITTED, &motion));
    ANSWERS(pc_pair_new(&pair));
    ANSWERS(pc_self_query_new(&alone));
    ANSWERS(pc_scene_new(0.1, NAN, &scene));
    ANSWERS(pc_scene_add(scene, "floor", mesh, 0.5, NULL, &structure));
    IS_TRUE(structure == 0);
}

static void free_all(void) {
    pc_mesh_free(mesh);
    pc_chain_free(robot);
    pc_tube_free(tube);
    pc_motion_free(motion);
    pc_pair_free(pair);
    pc_self_query_free(alone);
    pc_scene_free(scene);
    pc_mesh_free(NULL);
    pc_chain_free(NULL);
    pc_tube_free(NULL);
    pc_motion_free(NULL);
    pc_pair_free(NULL);
    pc_self_query_free(NULL);
    pc_scene_free(NULL);
}

static void arguments(const char *folder) {
    pc_minimum minimum;
    bool truth;
    pc_mesh *other = mesh;
    pc_chain *chain;
    pc_tube *curve;
    pc_motion *moved;
    const double nan_points[] = {0, 0, 2, NAN, 0, 2};
    const uint32_t far_face[] = {0, 1, 3};
    double pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    char path[4096];

    IS_TRUE(pc_abi_version() == PC_ABI_VERSION);
    IS_TRUE(strlen(pc_version()) >= 5);
    IS_TRUE(strlen(pc_error_message()) == 0 && pc_error_robot() == -1);

    ANSWERS(pc_mesh_minimum(mesh, robot, NULL, &minimum));
    IS_TRUE(minimum.distance == 1.5 && minimum.triangle == 0);
    REFUSES(pc_mesh_minimum(NULL, robot, NULL, &minimum), PC_BAD_ARGUMENT, "null_pointer");
    REFUSES(pc_mesh_minimum(mesh, NULL, NULL, &minimum), PC_BAD_ARGUMENT, "null_pointer");
    REFUSES(pc_mesh_minimum(mesh, robot, NULL, NULL), PC_BAD_ARGUMENT, "null_pointer");
    IS_TRUE(strcmp(pc_error_message(), "`minimum` is NULL; pass a pointer to it") == 0);
    REFUSES(pc_mesh_minimum(mesh, robot, (double *)((char *)pose + 1), &minimum), PC_BAD_ARGUMENT,
            "misaligned_pointer");
    REFUSES(pc_mesh_minimum((pc_mesh *)((char *)mesh + 1), robot, NULL, &minimum), PC_BAD_ARGUMENT,
            "misaligned_pointer");

    REFUSES(pc_mesh_new(VERTICES, 3, FACES, 0, &other), PC_REFUSED, "empty");
    IS_TRUE(other == NULL);
    REFUSES(pc_mesh_new(VERTICES, 3, far_face, 1, &other), PC_REFUSED, "no_such_vertex");
    REFUSES(pc_mesh_new(VERTICES, SIZE_MAX / 8, FACES, 1, &other), PC_BAD_ARGUMENT, "bad_length");
    REFUSES(pc_mesh_new(NULL, 3, FACES, 1, &other), PC_BAD_ARGUMENT, "null_pointer");
    REFUSES(pc_mesh_set_vertices(mesh, VERTICES, 2), PC_REFUSED, "vertex_count");
    REFUSES(pc_mesh_load("no such file.stl", -1, 1, 0, &other), PC_FILE, "file");
    REFUSES(pc_mesh_load("a.stl", -2, 1, 0, &other), PC_BAD_ARGUMENT, "bad_label");
    REFUSES(pc_mesh_load("a.stl", -1, 1, 3, &other), PC_BAD_ARGUMENT, "bad_frame");
    REFUSES(pc_mesh_load("a.stl", -1, 0, 0, &other), PC_FILE, "file");
    REFUSES(pc_mesh_load("\xff.stl", -1, 1, 0, &other), PC_BAD_ARGUMENT, "bad_text");
    REFUSES(pc_mesh_load(NULL, -1, 1, 0, &other), PC_BAD_ARGUMENT, "null_pointer");

    REFUSES(pc_chain_new(nan_points, 2, RADII, 1, 0, &chain), PC_REFUSED, "point_not_finite");
    REFUSES(pc_chain_new(POINTS, 3, RADII, 2, 3, &chain), PC_BAD_ARGUMENT, "bad_caps");
    REFUSES(pc_chain_new(POINTS, 0, RADII, 1, 0, &chain), PC_REFUSED, "too_few_points");
    REFUSES(pc_chain_new(POINTS, 3, RADII, 0, 0, &chain), PC_REFUSED, "lengths_differ");
    IS_TRUE(strstr(pc_error_message(), "in `radii`") != NULL);
    REFUSES(pc_chain_new(POINTS, 3, NULL, 0, 0, NULL), PC_BAD_ARGUMENT, "null_pointer");
    REFUSES(pc_chain_set(robot, nan_points, 2, RADII, 1), PC_REFUSED, "point_not_finite");
    ANSWERS(pc_mesh_minimum(mesh, robot, NULL, &minimum));
    IS_TRUE(minimum.distance == 1.5); /* it is as it was */
    REFUSES(pc_tube_new(POINTS, 3, RADII, 1, POINTS, 1, 0, NAN, &curve), PC_BAD_ARGUMENT,
            "bad_length");
    REFUSES(pc_tube_new(POINTS, 3, RADII, 1, POINTS, 2, 0.1, NAN, &curve), PC_BAD_ARGUMENT,
            "bad_length");
    REFUSES(pc_tube_new(POINTS, 3, RADII, 1, NULL, 0, -0.1, NAN, &curve), PC_REFUSED, "negative");
    REFUSES(pc_motion_linear(POINTS, POINTS, 3, RADII, 2, PC_CAPS_CYLINDERS, &moved),
            PC_BAD_ARGUMENT, "bad_caps");
    REFUSES(pc_motion_bending(POINTS, POINTS, 3, RADII, 2, NULL, &moved), PC_BAD_ARGUMENT,
            "bad_length");
    REFUSES(pc_motion_path(NULL, 0, &moved), PC_REFUSED, "no_motions");

    pose[3] = 1e300;
    REFUSES(pc_motion_rigid(robot, pose, NULL, &moved), PC_REFUSED, "bad_pose");
    IS_TRUE(strstr(pc_error_message(), "`start_pose`") != NULL);
    pose[3] = 0;
    pose[0] = 2;
    REFUSES(pc_mesh_minimum(mesh, robot, pose, &minimum), PC_REFUSED, "no_rotation");
    pose[0] = 1;
    REFUSES(pc_mesh_clears(mesh, robot, pose, -1, &truth), PC_REFUSED, "negative");
    REFUSES(pc_mesh_clears(mesh, robot, pose, NAN, &truth), PC_REFUSED, "negative");

    /* One bad robot does not fail the batch. */
    const pc_chain *robots[] = {robot, robot};
    double poses[32];
    pc_minimum minima[2];
    pc_status statuses[2];
    memcpy(poses, pose, sizeof pose);
    memcpy(poses + 16, pose, sizeof pose);
    poses[16 + 3] = 1e300;
    REFUSES(pc_mesh_minimum_batch(mesh, robots, poses, 2, minima, statuses), PC_REFUSED,
            "out_of_range");
    IS_TRUE(pc_error_robot() == 1 && statuses[0] == PC_OK && statuses[1] == PC_REFUSED);
    IS_TRUE(minima[0].distance == 1.5 && isnan(minima[1].distance));
    IS_TRUE(minima[1].triangle == PC_NONE);
    robots[1] = NULL;
    REFUSES(pc_mesh_minimum_batch(mesh, robots, NULL, 2, minima, NULL), PC_BAD_ARGUMENT,
            "null_pointer");
    IS_TRUE(pc_error_robot() == 1);

    REFUSES(pc_scene_set_margin(scene, 1, 0), PC_REFUSED, "no_such_structure");
    pc_scene *empty;
    REFUSES(pc_scene_new(-1, NAN, &empty), PC_REFUSED, "negative");
    IS_TRUE(empty == NULL);
    ANSWERS(pc_scene_new(NAN, NAN, &empty));
    REFUSES(pc_scene_clears(empty, robots, NULL, 1, &truth), PC_REFUSED, "no_margin");
    pc_scene_free(empty);

    ANSWERS(pc_mesh_prove(mesh, robot, NULL, 2, "nowhere/proof.txt", &truth));
    IS_TRUE(!truth); /* the margin is not kept, so nothing is written */
    REFUSES(pc_mesh_prove(mesh, robot, NULL, 1, "nowhere/proof.txt", &truth), PC_FILE, "file");
    snprintf(path, sizeof path, "%s/proof.txt", folder);
    ANSWERS(pc_mesh_prove(mesh, robot, NULL, 1, path, &truth));
    IS_TRUE(truth);
}

static uint64_t state = 69;

static uint64_t bits(void) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

static double unit(void) { return (double)(bits() >> 11) / 9007199254740992.0; }

/* A number of any kind. */
static double any(void) {
    switch (bits() % 12) {
    case 0: return NAN;
    case 1: return INFINITY;
    case 2: return -1e300;
    case 3: return 1e-300;
    case 4: return 0;
    case 5: return -unit();
    default: return 4 * unit();
    }
}

/* An aligned pointer to so many numbers, exactly; rarely null or misaligned. The last is a
   pointer that a call must refuse before it reads. */
static double *any_numbers(size_t count, double **to_free) {
    *to_free = (double *)malloc(count * sizeof(double) + 1);
    const int tame = bits() % 2 == 0;
    for (size_t k = 0; k < count; ++k) (*to_free)[k] = tame ? 4 * unit() : any();
    if (bits() % 16 == 0) return NULL;
    if (bits() % 16 == 0) return (double *)((char *)*to_free + 1);
    return *to_free;
}

/* Questions with arguments of any kind. What they answer is not looked at. */
static void fuzz(long rounds) {
    size_t answers = 0;
    for (long round = 0; round < rounds; ++round) {
        const size_t points = bits() % 9, radii = bits() % 3 == 0 ? points : bits() % 3;
        const size_t each = bits() % 2 ? 1 : (points > 0 ? points - 1 : 0);
        const size_t radius_count = bits() % 4 == 0 ? radii : each;
        double *memory[5];
        double *start = any_numbers(3 * points, memory);
        double *end = any_numbers(3 * points, memory + 1);
        double *radius = any_numbers(radius_count, memory + 2);
        double *vertices = any_numbers(3 * points, memory + 3);
        double *pose = any_numbers(16, memory + 4);
        if (pose == memory[4] && bits() % 4 != 0)
            for (int k = 0; k < 16; ++k)
                pose[k] = k % 5 == 0 ? 1 : k % 4 == 3 && k < 12 ? unit() : 0;
        const size_t triangles = bits() % 6;
        uint32_t *faces = (uint32_t *)malloc(triangles * 3 * sizeof(uint32_t) + 1);
        for (size_t k = 0; k < 3 * triangles; ++k)
            faces[k] = (uint32_t)(bits() % 16 == 0 ? bits() : bits() % (points + 1));
        const uint32_t caps = (uint32_t)(bits() % 4);
        const double margin = any(), fine = any();

        pc_mesh *wall;
        pc_chain *chain;
        pc_tube *curve;
        pc_motion *linear, *base, *bending, *path;
        pc_mesh_new(vertices, points, faces, triangles, &wall);
        pc_chain_new(start, points, radius, radius_count, caps, &chain);
        pc_tube_new(start, points, radius, radius_count, end, bits() % 3 == 0 ? points : 0,
                    bits() % 2 ? 0 : any(), bits() % 2 ? NAN : any(), &curve);
        pc_motion_linear(start, end, points, radius, radius_count, caps, &linear);
        pc_motion_bending(start, end, points, radius, radius_count, pose, &bending);
        pc_motion_moving_base(bending, pose, NULL, &base);
        const pc_motion *parts[] = {linear, base};
        pc_motion_path(parts, bits() % 3, &path);

        pc_minimum minimum, minima[2];
        const pc_minimum *links;
        const pc_contact *contacts;
        pc_motion_answer answer;
        pc_clearance clearance;
        pc_decision decision;
        pc_derivative derivative;
        pc_inside_answer inside;
        pc_robot_proximity near;
        pc_status statuses[2];
        pc_tightest tightest;
        pc_surface surface;
        bool truth;
        size_t many;
        pc_mesh *const asked = bits() % 3 == 0 ? wall : mesh;
        const pc_chain *const one = bits() % 3 == 0 ? robot : chain;
        const pc_chain *both[] = {one, chain};
        answers += pc_mesh_minimum(asked, one, pose, &minimum) == PC_OK;
        answers += pc_mesh_clears(asked, one, pose, margin, &truth) == PC_OK;
        answers += pc_mesh_per_link(asked, one, pose, &links, &many) == PC_OK;
        answers += pc_mesh_contacts_within(asked, one, pose, margin, fine, &contacts, &many) ==
                   PC_OK;
        answers += pc_mesh_clears_inside(asked, one, pose, margin, &inside) == PC_OK;
        answers += pc_mesh_derivative(asked, one, pose, &derivative) == PC_OK;
        answers += pc_mesh_minimum_batch(asked, both, NULL, bits() % 3, minima, statuses) == PC_OK;
        answers += pc_mesh_clears_tube(asked, curve, pose, margin, 0.5, &decision) == PC_OK;
        answers += pc_mesh_clearance(asked, curve, pose, 0.5, &clearance) == PC_OK;
        answers += pc_mesh_clears_motion(asked, linear, margin, 0.5, &answer) == PC_OK;
        answers += pc_mesh_time_of_contact(asked, path, margin, 0.5, &answer) == PC_OK;
        answers += pc_pair_minimum(pair, one, pose, chain, NULL, &near) == PC_OK;
        answers += pc_self_query_minimum(alone, chain, &near) == PC_OK;
        answers += pc_scene_tightest(scene, both, NULL, bits() % 3, &tightest) == PC_OK;
        answers += pc_mesh_surface(asked, &surface) == PC_OK;
        pc_mesh_free(wall);
        pc_chain_free(chain);
        pc_tube_free(curve);
        pc_motion_free(linear);
        pc_motion_free(base);
        pc_motion_free(bending);
        pc_motion_free(path);
        for (int k = 0; k < 5; ++k) free(memory[k]);
        free(faces);
    }
    printf("%ld rounds, %zu answers\n", rounds, answers);
    IS_TRUE(rounds < 100 || answers > (size_t)rounds);
    IS_TRUE(strcmp(pc_error_kind(), "defect") != 0);
}

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    make();
    arguments(argv[2]);
    fuzz(atol(argv[1]));
    free_all();
    return failures == 0 ? 0 : 1;
}
