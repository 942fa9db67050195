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

    /* So does one bad matrix, and one bad robot of many links. */
    bool truths[2];
    const pc_minimum *links;
    const size_t *firsts;
    poses[16 + 3] = 0;
    poses[16] = 2;
    robots[1] = robot;
    REFUSES(pc_mesh_clears_batch(mesh, robots, poses, 2, 1, truths, statuses), PC_REFUSED,
            "no_rotation");
    IS_TRUE(pc_error_robot() == 1 && statuses[0] == PC_OK && statuses[1] == PC_REFUSED);
    IS_TRUE(truths[0] && !truths[1]);
    REFUSES(pc_mesh_per_link_batch(mesh, robots, poses, 2, &links, &firsts, statuses), PC_REFUSED,
            "no_rotation");
    IS_TRUE(firsts[0] == 0 && firsts[1] == 2 && firsts[2] == 2 && links[0].distance == 1.5);
    REFUSES(pc_mesh_per_link_batch(mesh, robots, NULL, 2, &links, NULL, statuses),
            PC_BAD_ARGUMENT, "null_pointer");
    ANSWERS(pc_mesh_per_link_batch(mesh, robots, NULL, 0, &links, &firsts, NULL));
    IS_TRUE(firsts[0] == 0);
    pc_robot_proximity pairs[2];
    REFUSES(pc_pair_minimum_batch(pair, robots, poses, robots, poses, 2, pairs, statuses),
            PC_REFUSED, "no_rotation");
    IS_TRUE(pc_error_robot() == 1 && pairs[0].distance == 0);
    REFUSES(pc_pair_clears_batch(pair, robots, poses, robots, NULL, 2, -1, truths, statuses),
            PC_REFUSED, "negative");
    IS_TRUE(pc_error_robot() == -1);
    const pc_motion *motions[] = {motion, motion};
    pc_robot_motion_answer apart[2];
    ANSWERS(pc_pair_clears_motions_batch(pair, motions, motions, 2, 0, 0.01, apart, NULL));
    IS_TRUE(apart[1].decision == PC_CONTACT);

    /* Robots of sections. */
    const double sections[] = {3, 0, 0, 3, NAN, 0}, up[] = {1, 0, 0, 0, 0, 1, 0, 0,
                                                           0, 0, 1, 1, 0, 0, 0, 1};
    REFUSES(pc_mesh_clears_sections_batch(mesh, sections, 1, RADII, 1, 2, 4, up, 0.5, truths,
                                          statuses),
            PC_REFUSED, "bad_curvature");
    IS_TRUE(truths[0] && !truths[1] && pc_error_robot() == 1);
    REFUSES(pc_mesh_clears_sections_batch(mesh, sections, 2, RADII, 3, 1, 4, up, 0, truths, NULL),
            PC_BAD_ARGUMENT, "bad_length");
    REFUSES(pc_mesh_clears_sections_batch(mesh, sections, SIZE_MAX, RADII, 1, SIZE_MAX, 4, up, 0,
                                          truths, NULL),
            PC_BAD_ARGUMENT, "bad_length");

    /* Scenes. */
    double between;
    const size_t nested[] = {0, 1};
    size_t second;
    REFUSES(pc_scene_add(scene, "floor", mesh, 1, NULL, &second), PC_REFUSED, "name_taken");
    IS_TRUE(strstr(pc_error_message(), "`floor`") != NULL);
    pose[3] = NAN;
    REFUSES(pc_scene_add(scene, "far", mesh, 1, pose, &second), PC_REFUSED, "not_finite");
    pose[3] = 0;
    /* It has no "far". */
    REFUSES(pc_scene_set_margin(scene, 1, 0), PC_REFUSED, "no_such_structure");
    REFUSES(pc_scene_margin_between(scene, 1, 0, &between), PC_REFUSED, "no_such_structure");
    REFUSES(pc_scene_set_margin_between(scene, 1, 0, 0), PC_REFUSED, "no_such_structure");
    REFUSES(pc_scene_set_margin_between(scene, 0, 0, -1), PC_REFUSED, "negative");
    ANSWERS(pc_scene_set_margin_between(scene, 0, 7, NAN));
    ANSWERS(pc_scene_margin_between(scene, 0, 7, &between));
    IS_TRUE(isnan(between));
    REFUSES(pc_scene_set_solid(scene, 0, 1), PC_REFUSED, "not_solid");
    IS_TRUE(strstr(pc_error_message(), "`floor`") != NULL);
    ANSWERS(pc_scene_is_solid(scene, 0, truths));
    IS_TRUE(!truths[0]);
    REFUSES(pc_scene_is_solid(scene, 1, truths), PC_REFUSED, "no_such_structure");
    ANSWERS(pc_scene_set_solid(scene, 0, 0));
    REFUSES(pc_scene_set_robot_margin(scene, -1), PC_REFUSED, "negative");
    REFUSES(pc_scene_set_self_margin(scene, -1), PC_REFUSED, "negative");
    ANSWERS(pc_scene_prepare(scene));
    ANSWERS(pc_scene_clears(scene, robots, NULL, 2, truths));
    IS_TRUE(!truths[0]); /* the robots are one */
    ANSWERS(pc_scene_set_nested(scene, nested, 1));
    ANSWERS(pc_scene_clears(scene, robots, NULL, 2, truths));
    IS_TRUE(truths[0]);
    ANSWERS(pc_scene_set_nested(scene, NULL, 0));
    pc_tightest slacks[2];
    REFUSES(pc_scene_clears_batch(scene, robots, poses, 1, 2, truths, statuses), PC_REFUSED,
            "no_rotation");
    IS_TRUE(pc_error_robot() == 1 && truths[0] && !truths[1]);
    IS_TRUE(strstr(pc_error_message(), "set 1: robot 0: ") == pc_error_message());
    REFUSES(pc_scene_tightest_batch(scene, robots, poses, 2, 1, slacks, statuses), PC_REFUSED,
            "no_rotation");
    IS_TRUE(pc_error_robot() == 0 && isnan(slacks[0].slack));
    REFUSES(pc_scene_clears_batch(scene, robots, NULL, SIZE_MAX / 2, 4, truths, statuses),
            PC_BAD_ARGUMENT, "bad_length");
    ANSWERS(pc_scene_clears_batch(scene, NULL, NULL, 0, 2, truths, statuses));
    IS_TRUE(truths[0] && truths[1]);
    pc_scene_motion_answer moving[2];
    REFUSES(pc_scene_clears_motion_batch(scene, motions, 1, 2, -1, moving, statuses), PC_REFUSED,
            "negative");
    poses[16] = 1;
    poses[16 + 3] = 1e300;
    REFUSES(pc_scene_clears(scene, robots, poses, 2, truths), PC_REFUSED, "out_of_range");
    IS_TRUE(pc_error_robot() == 1);
    pc_structure_end ends[] = {{0, up, NULL, 0}, {0, NULL, VERTICES, 3}};
    ANSWERS(pc_scene_clears_motion_while(scene, ends, 1, motions, 1, 0.01, moving));
    IS_TRUE(moving[0].decision == PC_CLEAR);
    ANSWERS(pc_scene_clears_motion_while(scene, ends + 1, 1, motions, 1, 0.01, moving));
    REFUSES(pc_scene_clears_motion_while(scene, NULL, 1, motions, 1, 0.01, moving),
            PC_BAD_ARGUMENT, "null_pointer");
    ends[1].vertex_count = 2;
    REFUSES(pc_scene_clears_motion_while(scene, ends + 1, 1, motions, 1, 0.01, moving), PC_REFUSED,
            "vertex_count");
    ends[1].vertices = (const double *)((const char *)VERTICES + 1);
    REFUSES(pc_scene_clears_motion_while(scene, ends + 1, 1, motions, 1, 0.01, moving),
            PC_BAD_ARGUMENT, "misaligned_pointer");
    ends[1].pose = up;
    REFUSES(pc_scene_clears_motion_while(scene, ends, 2, motions, 1, 0.01, moving),
            PC_BAD_ARGUMENT, "bad_structure_end");
    IS_TRUE(strstr(pc_error_message(), "`ends[1]`: ") == pc_error_message());
    ends[0].structure = 1;
    REFUSES(pc_scene_clears_motion_while(scene, ends, 1, motions, 1, 0.01, moving), PC_REFUSED,
            "no_such_structure");

    REFUSES(pc_mesh_prove(mesh, robot, NULL, 1, "proof.obj", &truth), PC_BAD_ARGUMENT, "bad_path");
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
    double any_poses[64];
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
        /* What is about lists. */
        const size_t *firsts;
        bool truths[4];
        pc_status each_status[4];
        pc_scene_motion_answer moved[4];
        pc_robot_motion_answer apart[4];
        const pc_chain *four[] = {one, chain, robot, one};
        const pc_motion *motions[] = {linear, bending, base, path};
        double *const matrices = pose == memory[4] && bits() % 2 ? any_poses : NULL;
        const pc_structure_end ends[] = {{bits() % 3, bits() % 2 ? pose : NULL,
                                          bits() % 2 ? vertices : NULL, bits() % 2 ? points : 0}};
        const size_t width = bits() % 3, sets = width == 0 ? bits() % 5 : bits() % (4 / width + 1);
        if (matrices != NULL)
            for (int k = 0; k < 64; ++k)
                matrices[k] = bits() % 64 == 0 ? any() : pose[k % 16];
        pc_scene *crowd;
        pc_scene_new(any(), any(), &crowd);
        for (size_t k = bits() % 3; k > 0; --k)
            pc_scene_add(crowd, k == 1 ? "one" : "other", asked, any(), bits() % 2 ? pose : NULL,
                         &many);
        pc_scene_set_solid(crowd, bits() % 2, (uint32_t)(bits() % 3));
        pc_scene_set_margin_between(crowd, bits() % 2, bits() % 3, any());
        answers += pc_mesh_per_link_batch(asked, four, matrices, bits() % 5, &links, &firsts,
                                          each_status) == PC_OK;
        answers += pc_mesh_clears_sections_batch(asked, start, points > 1 ? points / 2 : points,
                                                 radius, radius_count, points > 1 ? 2 : bits() % 2,
                                                 bits() % 9, pose, margin, truths, NULL) == PC_OK;
        answers += pc_pair_clears_batch(pair, four, matrices, four + bits() % 2, NULL, bits() % 4,
                                        margin, truths, each_status) == PC_OK;
        answers += pc_pair_clears_motions_batch(pair, motions, motions + 1, bits() % 4, margin, 0.5,
                                                apart, each_status) == PC_OK;
        answers += pc_scene_clears_batch(crowd, four, matrices, width, sets, truths,
                                         each_status) == PC_OK;
        answers += pc_scene_clears_motion_batch(crowd, motions, width, sets, 0.5, moved,
                                                each_status) == PC_OK;
        answers += pc_scene_clears_motion_while(crowd, ends, bits() % 2, motions, bits() % 5, 0.5,
                                                moved) == PC_OK;
        pc_scene_free(crowd);
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
