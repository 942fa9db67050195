/* The answers of C to the cases of answers.rs: the same questions in the same order. */
#include "parry_continuum.h"

#include "numbers.h"

#define FINE 0.05
enum { SECTIONED = 1000 };

static double index_of(uint32_t index) { return index == PC_NONE ? NAN : (double)index; }

static void put_minimum(const pc_minimum *found) {
    put(found->distance);
    put_all(found->on_robot, 3);
    put_all(found->on_mesh, 3);
    put(found->arc_length);
    put(index_of(found->segment));
    put(index_of(found->triangle));
}

static void put_contact(const pc_contact *found) {
    put(found->distance);
    put(found->depth);
    put(found->fraction);
    put_all(found->normal, 3);
    put_all(found->on_robot, 3);
    put_all(found->on_mesh, 3);
    put(found->arc_length);
    put(index_of(found->segment));
    put(index_of(found->triangle));
}

static void put_clearance(const pc_clearance *found) {
    put(found->lower);
    put(found->upper);
    put(found->uncertainty);
    put(found->t);
    put_all(found->on_robot, 3);
    put_all(found->on_mesh, 3);
    put(found->arc_length);
    put(index_of(found->segment));
    put(index_of(found->triangle));
    put(found->resolved);
}

static void put_motion(const pc_motion_answer *found) {
    put(found->decision);
    put(found->reason);
    put_all(found->interval, 2);
    put(found->t);
    put(found->upper);
    put_all(found->on_robot, 3);
    put_all(found->on_mesh, 3);
    put(found->arc_length);
    put(index_of(found->segment));
    put(index_of(found->triangle));
}

static void put_scene_motion(const pc_scene_motion_answer *found) {
    put(found->decision);
    put(found->reason);
    put_all(found->interval, 2);
    put(found->t);
    put(found->upper);
}

/* Writes an answer, or NaN if there is none. */
#define ANSWER(call, ...)        \
    do {                         \
        if ((call) == PC_OK) {   \
            __VA_ARGS__;         \
        } else {                 \
            put(NAN);            \
        }                        \
    } while (0)

/* What is asked of some robots only. */
static void ask_everything(pc_mesh *mesh, pc_pair *pair, pc_self_query *alone,
                           const pc_chain *robot, const double *pose, uint32_t caps,
                           const double *start, const double *end, size_t points,
                           const double *radii, double margin, const double *vertices,
                           size_t vertex_count) {
    const pc_minimum *links;
    const pc_contact *contacts;
    size_t many;
    ANSWER(pc_mesh_per_link(mesh, robot, pose, &links, &many), {
        put((double)many);
        for (size_t k = 0; k < many; ++k) put_minimum(links + k);
    });
    ANSWER(pc_mesh_contacts_within(mesh, robot, pose, margin, 0, &contacts, &many), {
        put((double)many);
        for (size_t k = 0; k < many; ++k) put_contact(contacts + k);
    });
    pc_side side;
    ANSWER(pc_mesh_side(mesh, start, 1, &side), put(side));
    pc_inside_answer inside;
    ANSWER(pc_mesh_clears_inside(mesh, robot, pose, margin, &inside), {
        put(inside.base);
        put(inside.tip);
        put(inside.clears);
        put(inside.crosses_opening);
        put(inside.holds);
    });
    pc_tube *tube;
    pc_clearance clearance;
    pc_decision decision;
    /* Without a tube both questions are refused. */
    if (pc_tube_new(start, points, radii, points - 1, NULL, 0, 0, NAN, &tube) != PC_OK)
        tube = NULL;
    ANSWER(pc_mesh_clearance(mesh, tube, pose, FINE, &clearance), put_clearance(&clearance));
    ANSWER(pc_mesh_clears_tube(mesh, tube, pose, margin, FINE, &decision), put(decision));
    pc_tube_free(tube);
    pc_motion *motion;
    pc_motion_answer answer;
    ANSWER(pc_motion_linear(start, end, points, radii, points - 1, PC_CAPS_FITTED, &motion), {
        ANSWER(pc_mesh_clears_motion(mesh, motion, margin, FINE, &answer), put_motion(&answer));
        ANSWER(pc_mesh_time_of_contact(mesh, motion, margin, FINE, &answer), put_motion(&answer));
        ANSWER(pc_mesh_clearance_of_motion(mesh, motion, FINE, &clearance),
               put_clearance(&clearance));
    });
    pc_motion_free(motion);
    pc_chain *other;
    pc_robot_proximity near;
    if (pc_chain_new(end, points, radii, points - 1, caps, &other) != PC_OK) exit(3);
    ANSWER(pc_pair_minimum(pair, robot, pose, other, NULL, &near), {
        put(near.distance);
        put_all(near.on_first, 3);
        put_all(near.on_second, 3);
        put_all(near.arc_lengths, 2);
    });
    ANSWER(pc_self_query_minimum(alone, robot, &near), put(near.distance));
    pc_scene *scene;
    size_t structure;
    if (pc_scene_new(0.1, NAN, &scene) != PC_OK ||
        pc_scene_add(scene, "wall", mesh, margin, NULL, &structure) != PC_OK)
        exit(3);
    const pc_chain *both[] = {robot, other};
    double poses[32];
    memcpy(poses, pose, 16 * sizeof(double));
    for (int k = 0; k < 16; ++k) poses[16 + k] = k % 5 == 0;
    pc_tightest tightest;
    ANSWER(pc_scene_tightest(scene, both, poses, 2, &tightest), {
        put(tightest.slack);
        put(index_of(tightest.place.structure));
    });
    double between;
    pc_status solid;
    bool truths[2];
    pc_tightest slacks[2];
    pc_status statuses[2];
    if (pc_scene_set_margin_between(scene, 0, 1, 0.5) != PC_OK) exit(3);
    for (size_t k = 0; k < 2; ++k)
        ANSWER(pc_scene_margin_between(scene, 0, k, &between), put(between));
    solid = pc_scene_set_solid(scene, 0, 1);
    ANSWER(solid, put(1));
    ANSWER(pc_scene_is_solid(scene, 0, truths), put(truths[0]));
    const pc_chain *sets[] = {robot, other, other, robot};
    double set_poses[64];
    memcpy(set_poses, poses, 32 * sizeof(double));
    memcpy(set_poses + 32, poses + 16, 16 * sizeof(double));
    memcpy(set_poses + 48, poses, 16 * sizeof(double));
    pc_scene_clears_batch(scene, sets, set_poses, 2, 2, truths, statuses);
    for (int k = 0; k < 2; ++k) ANSWER(statuses[k], put(truths[k]));
    pc_scene_tightest_batch(scene, sets, set_poses, 2, 2, slacks, statuses);
    for (int k = 0; k < 2; ++k) ANSWER(statuses[k], put(slacks[k].slack));
    if (pc_scene_set_margin_between(scene, 0, 1, NAN) != PC_OK) exit(3);
    ANSWER(pc_scene_clears(scene, both, poses, 2, truths), put(truths[0]));
    if (pc_scene_set_robot_margin(scene, NAN) != PC_OK) exit(3);
    ANSWER(pc_motion_linear(start, end, points, radii, points - 1, PC_CAPS_FITTED, &motion), {
        const pc_motion *twice[] = {motion, motion};
        pc_scene_motion_answer found[2];
        const pc_structure_end at_pose = {0, pose, NULL, 0};
        ANSWER(pc_scene_clears_motion_while(scene, &at_pose, 1, twice, 1, FINE, found),
               put_scene_motion(found));
        double *grown = (double *)malloc(3 * vertex_count * sizeof(double));
        for (size_t k = 0; k < 3 * vertex_count; ++k) grown[k] = vertices[k] * 1.25;
        const pc_structure_end grows = {0, NULL, grown, vertex_count};
        ANSWER(pc_scene_clears_motion_while(scene, &grows, 1, twice, 1, FINE, found),
               put_scene_motion(found));
        free(grown);
        pc_scene_clears_motion_batch(scene, twice, 1, 2, FINE, found, statuses);
        for (int k = 0; k < 2; ++k) ANSWER(statuses[k], put_scene_motion(found + k));
    });
    pc_motion_free(motion);
    pc_scene_free(scene);
    pc_chain_free(other);
}

int main(int argc, char **argv) {
    if (argc != 3 || pc_abi_version() != PC_ABI_VERSION) return 2;
    read_numbers(argv[1]);
    const size_t mesh_count = count();
    pc_mesh **meshes = (pc_mesh **)calloc(mesh_count, sizeof(pc_mesh *));
    const double **vertices = (const double **)calloc(mesh_count, sizeof(double *));
    size_t *vertex_counts = (size_t *)calloc(mesh_count, sizeof(size_t));
    for (size_t k = 0; k < mesh_count; ++k) {
        const size_t vertex_count = vertex_counts[k] = count();
        const double *points = vertices[k] = take(3 * vertex_count);
        const size_t triangles = count();
        const double *indices = take(3 * triangles);
        uint32_t *faces = (uint32_t *)malloc(3 * triangles * sizeof(uint32_t));
        for (size_t i = 0; i < 3 * triangles; ++i) faces[i] = (uint32_t)indices[i];
        if (pc_mesh_new(points, vertex_count, faces, triangles, meshes + k) != PC_OK) return 3;
        free(faces);
    }
    pc_pair *pair;
    pc_self_query *alone;
    if (pc_pair_new(&pair) != PC_OK || pc_self_query_new(&alone) != PC_OK) return 3;
    const size_t case_count = count();
    pc_chain **robots = (pc_chain **)calloc(case_count, sizeof(pc_chain *));
    double *poses = (double *)calloc(case_count, 16 * sizeof(double));
    size_t many = 0;
    for (size_t k = 0; k < case_count; ++k) {
        const size_t place = count();
        const uint32_t caps = (uint32_t)count();
        const double margin = number();
        const int everything = number() != 0;
        const double *pose = take(16);
        const size_t points = count();
        const double *start = take(3 * points), *end = take(3 * points);
        const double *radii = take(points - 1);
        pc_chain *robot;
        pc_minimum minimum;
        bool clears;
        if (pc_chain_new(start, points, radii, points - 1, caps, &robot) != PC_OK) {
            if (robot != NULL) return 3;
            put(NAN);
            continue;
        }
        ANSWER(pc_mesh_minimum(meshes[place], robot, pose, &minimum), put_minimum(&minimum));
        ANSWER(pc_mesh_clears(meshes[place], robot, pose, margin, &clears), put(clears));
        if (everything)
            ask_everything(meshes[place], pair, alone, robot, pose, caps, start, end, points,
                           radii, margin, vertices[place], vertex_counts[place]);
        if (place == mesh_count - 1) {
            memcpy(poses + 16 * many, pose, 16 * sizeof(double));
            robots[many++] = robot;
        } else {
            pc_chain_free(robot);
        }
    }
    pc_minimum *minima = (pc_minimum *)malloc(many * sizeof(pc_minimum));
    pc_status *statuses = (pc_status *)malloc(many * sizeof(pc_status));
    pc_mesh_minimum_batch(meshes[mesh_count - 1], (const pc_chain *const *)robots, poses, many,
                          minima, statuses);
    for (size_t k = 0; k < many; ++k) ANSWER(statuses[k], put_minimum(minima + k));
    const pc_minimum *links;
    const size_t *firsts;
    pc_mesh_per_link_batch(meshes[mesh_count - 1], (const pc_chain *const *)robots, poses, many,
                           &links, &firsts, statuses);
    for (size_t k = 0; k < many; ++k)
        ANSWER(statuses[k], {
            for (size_t i = firsts[k]; i < firsts[k + 1]; ++i) put_minimum(links + i);
        });
    bool *clears = (bool *)malloc(many + SECTIONED);
    pc_pair_clears_batch(pair, (const pc_chain *const *)robots, poses,
                         (const pc_chain *const *)robots, poses + 16, many - 1, 0.5, clears,
                         statuses);
    for (size_t k = 0; k + 1 < many; ++k) ANSWER(statuses[k], put(clears[k]));
    double sections[SECTIONED][6];
    const double two_radii[] = {0.3, 0.2};
    for (int k = 0; k < SECTIONED; ++k) {
        const double bent[] = {k % 97 == 96 ? NAN : 2 + 0.5 * (k % 10),
                               0.0625 * (k % 7),
                               -0.03125 * (k % 5),
                               2,
                               0.5 - 0.125 * (k % 11),
                               0.25 * (k % 3)};
        memcpy(sections[k], bent, sizeof bent);
    }
    pc_mesh_clears_sections_batch(meshes[mesh_count - 1], sections[0], 2, two_radii, 2, SECTIONED,
                                  5, NULL, 0.1, clears, statuses);
    for (int k = 0; k < SECTIONED; ++k) ANSWER(statuses[k], put(clears[k]));
    write_numbers(argv[2]);
    free(clears);
    free(vertices);
    free(vertex_counts);
    for (size_t k = 0; k < many; ++k) pc_chain_free(robots[k]);
    for (size_t k = 0; k < mesh_count; ++k) pc_mesh_free(meshes[k]);
    pc_pair_free(pair);
    pc_self_query_free(alone);
    free(meshes);
    free(robots);
    free(poses);
    free(minima);
    free(statuses);
    return 0;
}
