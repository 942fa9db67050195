/* The answers of C to the cases of answers.rs: the same questions in the same order. */
#include "parry_continuum.h"

#include "numbers.h"

#define FINE 0.05

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
                           const double *radii, double margin) {
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
    pc_scene_free(scene);
    pc_chain_free(other);
}

int main(int argc, char **argv) {
    if (argc != 3 || pc_abi_version() != PC_ABI_VERSION) return 2;
    read_numbers(argv[1]);
    const size_t mesh_count = count();
    pc_mesh **meshes = (pc_mesh **)calloc(mesh_count, sizeof(pc_mesh *));
    for (size_t k = 0; k < mesh_count; ++k) {
        const size_t vertices = count();
        const double *points = take(3 * vertices);
        const size_t triangles = count();
        const double *indices = take(3 * triangles);
        uint32_t *faces = (uint32_t *)malloc(3 * triangles * sizeof(uint32_t));
        for (size_t i = 0; i < 3 * triangles; ++i) faces[i] = (uint32_t)indices[i];
        if (pc_mesh_new(points, vertices, faces, triangles, meshes + k) != PC_OK) return 3;
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
                           radii, margin);
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
    write_numbers(argv[2]);
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
