/* The gateway of MATLAB and Octave: `continuum_mex(command, arguments..., name, value, ...)`.
 *
 * Users call the functions of +continuum. Arrays are N x 3, as MATLAB has them, and indices count
 * from 1. Only MATLAB's C MEX API is used. Handles are numbers of a table, so a number that is no
 * handle is an error. Memory of mxMalloc is MATLAB's to free, also after an error; handles of the
 * library are freed before an error is raised. */
#include "mex.h"

#include "parry_continuum.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Handles */

typedef enum { MESH, MOTION, SCENE, FREED } kind_t;

static const char *const KINDS[] = {"mesh", "motion", "scene"};

typedef struct {
    kind_t kind;
    void *handle;
} entry_t;

static entry_t *table;
static size_t table_count, table_room;
static pc_pair *the_pair;
static pc_self_query *the_self;

static void free_entry(entry_t *entry) {
    switch (entry->kind) {
    case MESH: pc_mesh_free((pc_mesh *)entry->handle); break;
    case MOTION: pc_motion_free((pc_motion *)entry->handle); break;
    case SCENE: pc_scene_free((pc_scene *)entry->handle); break;
    case FREED: break;
    }
    entry->kind = FREED;
}

static void free_all(void) {
    size_t k;
    for (k = 0; k < table_count; ++k) free_entry(table + k);
    mxFree(table);
    table = NULL;
    table_count = table_room = 0;
    pc_pair_free(the_pair);
    pc_self_query_free(the_self);
    the_pair = NULL;
    the_self = NULL;
}

static void fail(const char *kind, const char *text) {
    char id[128];
    snprintf(id, sizeof id, "continuum:%s", kind);
    mexErrMsgIdAndTxt(id, "%s", text);
}

static void check(pc_status status) {
    if (status != PC_OK) fail(pc_error_kind(), pc_error_message());
}

static mxArray *new_entry(kind_t kind, void *handle) {
    mxArray *number = mxCreateNumericMatrix(1, 1, mxUINT64_CLASS, mxREAL);
    if (table_count == table_room) {
        table_room = 2 * table_room + 16;
        table = (entry_t *)mxRealloc(table, table_room * sizeof(entry_t));
        mexMakeMemoryPersistent(table);
    }
    table[table_count].kind = kind;
    table[table_count].handle = handle;
    ++table_count; /* handles count from 1 */
    *(uint64_t *)mxGetData(number) = table_count;
    return number;
}

static entry_t *entry_at(const mxArray *array, size_t index) {
    if (mxIsUint64(array) && index < mxGetNumberOfElements(array)) {
        const uint64_t number = ((const uint64_t *)mxGetData(array))[index];
        if (number >= 1 && number <= table_count && table[number - 1].kind != FREED)
            return table + (number - 1);
    }
    fail("no_such_handle", "this is no handle, or it has been freed; make a new one");
    return NULL;
}

static void *handle_at(const mxArray *array, size_t index, kind_t kind) {
    entry_t *entry = entry_at(array, index);
    char text[128];
    if (entry->kind != kind) {
        snprintf(text, sizeof text, "a %s is given where a %s is needed", KINDS[entry->kind],
                 KINDS[kind]);
        fail("wrong_handle", text);
    }
    return entry->handle;
}

static pc_mesh *mesh_of(const mxArray *array) { return (pc_mesh *)handle_at(array, 0, MESH); }

static pc_pair *pair(void) {
    if (the_pair == NULL) check(pc_pair_new(&the_pair));
    return the_pair;
}

static pc_self_query *self_query(void) {
    if (the_self == NULL) check(pc_self_query_new(&the_self));
    return the_self;
}

/* Arrays */

/* The transposed rows of an array of doubles, rows x columns x batch. */
typedef struct {
    double *data;
    size_t rows, batch;
} rows_t;

static void check_double(const mxArray *array, const char *name) {
    char text[128];
    if (!mxIsDouble(array) || mxIsComplex(array) || mxIsSparse(array)) {
        snprintf(text, sizeof text, "`%s` must be a full array of real doubles", name);
        fail("bad_type", text);
    }
}

static rows_t rows_of(const mxArray *array, size_t columns, const char *name) {
    rows_t rows;
    const mwSize *shape = mxGetDimensions(array);
    const mwSize dimensions = mxGetNumberOfDimensions(array);
    const double *given;
    size_t robot, row, column;
    char text[160];
    check_double(array, name);
    if (dimensions > 3 || shape[1] != columns) {
        snprintf(text, sizeof text,
                 "`%s` must be N x %d, or N x %d x B; transpose it if it is %d x N", name,
                 (int)columns, (int)columns, (int)columns);
        fail("bad_shape", text);
    }
    rows.rows = shape[0];
    rows.batch = dimensions == 3 ? shape[2] : 1;
    rows.data = (double *)mxMalloc(rows.rows * columns * rows.batch * sizeof(double) + 1);
    given = mxGetPr(array);
    for (robot = 0; robot < rows.batch; ++robot)
        for (column = 0; column < columns; ++column)
            for (row = 0; row < rows.rows; ++row)
                rows.data[(robot * rows.rows + row) * columns + column] = *given++;
    return rows;
}

static char *text_of(const mxArray *array, const char *name) {
    char *text = mxIsChar(array) ? mxArrayToString(array) : NULL;
    char message[128];
    if (text == NULL) {
        snprintf(message, sizeof message, "`%s` must be a text in single quotes", name);
        fail("bad_type", message);
    }
    return text;
}

/* Options: pairs of a name and a value */

typedef struct {
    double margin, resolution, tolerance, prominence, deviation, turn, label, scale;
    double robot_margin, self_margin, segments;
    const mxArray *pose, *pose_a, *pose_b, *start_pose, *end_pose, *tangents;
    const char *caps, *frame, *file;
} options_t;

/* Whether two names are equal but for upper and lower case, as those of MATLAB's options are. */
static bool is_same(const char *name, const char *given) {
    for (; *name != '\0' && *name == (*given | (*given >= 'A' && *given <= 'Z' ? 32 : 0)); ++name)
        ++given;
    return *name == '\0' && *given == '\0';
}

static options_t options_of(int count, const mxArray *const *given) {
    options_t options;
    struct {
        const char *name;
        double *number;
        const mxArray **array;
        const char **text;
    } known[20];
    size_t names = 0, k;
    char text[160];
    const double none = mxGetNaN();
    memset(&options, 0, sizeof options);
    options.margin = options.resolution = options.tolerance = options.turn = none;
    options.robot_margin = options.self_margin = none;
    options.segments = 1;
    options.label = -1;
    options.scale = 1;
#define KNOWN(field, slot) \
    (memset(known + names, 0, sizeof *known), known[names].name = #field, \
     known[names++].slot = &options.field)
    KNOWN(margin, number), KNOWN(resolution, number), KNOWN(tolerance, number);
    KNOWN(prominence, number), KNOWN(deviation, number), KNOWN(turn, number);
    KNOWN(label, number), KNOWN(scale, number), KNOWN(robot_margin, number);
    KNOWN(self_margin, number), KNOWN(segments, number), KNOWN(pose, array);
    KNOWN(pose_a, array), KNOWN(pose_b, array);
    KNOWN(start_pose, array), KNOWN(end_pose, array), KNOWN(tangents, array);
    KNOWN(caps, text), KNOWN(frame, text), KNOWN(file, text);
#undef KNOWN
    if (count % 2 != 0) fail("bad_options", "options are pairs of a name and a value, such as 'margin', 1");
    for (; count > 0; count -= 2, given += 2) {
        const char *name = text_of(given[0], "the name of an option");
        for (k = 0; k < names && !is_same(known[k].name, name); ++k) {
        }
        if (k == names) {
            snprintf(text, sizeof text, "there is no option `%.60s`; see the help of this function",
                     name);
            fail("bad_options", text);
        } else if (known[k].text != NULL) {
            *known[k].text = text_of(given[1], name);
        } else if (known[k].array != NULL) {
            *known[k].array = given[1];
        } else {
            check_double(given[1], name);
            if (mxGetNumberOfElements(given[1]) != 1) {
                snprintf(text, sizeof text, "`%s` must be one number", name);
                fail("bad_shape", text);
            }
            *known[k].number = mxGetScalar(given[1]);
        }
    }
    return options;
}

static double needed(double number, const char *name) {
    char text[128];
    if (mxIsNaN(number)) {
        snprintf(text, sizeof text, "`%s` is missing; give '%s' and a number", name, name);
        fail("missing_option", text);
    }
    return number;
}

static uint32_t choice(const char *given, const char *name, const char *const *names,
                       uint32_t count) {
    uint32_t k;
    char text[160];
    if (given == NULL) return 0;
    for (k = 0; k < count; ++k)
        if (strcmp(given, names[k]) == 0) return k;
    snprintf(text, sizeof text, "`%s` is '%.40s'; see the help of this function", name, given);
    fail("bad_options", text);
    return 0;
}

static uint32_t caps_of(const options_t *options) {
    static const char *const names[] = {"fitted", "capsules", "cylinders"};
    return choice(options->caps, "caps", names, 3);
}

/* The rows of `count` poses, one for all or one for each; NULL if there are none. */
static double *poses_of(const mxArray *array, size_t count, const char *name) {
    rows_t rows;
    double *poses;
    size_t robot;
    char text[128];
    if (array == NULL) return NULL;
    rows.rows = rows.batch = 0;
    if (mxGetDimensions(array)[0] == 4 && mxGetDimensions(array)[1] == 4)
        rows = rows_of(array, 4, name);
    if (rows.rows != 4 || (rows.batch != 1 && rows.batch != count)) {
        snprintf(text, sizeof text, "`%s` must be 4 x 4, or 4 x 4 x %lu", name,
                 (unsigned long)count);
        fail("bad_shape", text);
    }
    if (rows.batch == count) return rows.data;
    poses = (double *)mxMalloc(16 * count * sizeof(double));
    for (robot = 0; robot < count; ++robot)
        memcpy(poses + 16 * robot, rows.data, 16 * sizeof(double));
    return poses;
}

/* Robots */

typedef struct {
    rows_t points;
    const double *radii;
    size_t radius_count;
    pc_chain **chains;
} robots_t;

static robots_t points_of(const mxArray *points, const mxArray *radii) {
    robots_t robots;
    robots.points = rows_of(points, 3, "points");
    check_double(radii, "radii");
    robots.radii = mxGetPr(radii);
    robots.radius_count = mxGetNumberOfElements(radii);
    robots.chains = NULL;
    return robots;
}

static void free_chains(robots_t *robots) {
    size_t k;
    for (k = 0; k < robots->points.batch; ++k) pc_chain_free(robots->chains[k]);
}

/* Robots with their chains, which `free_chains` frees before the next error. */
static robots_t robots_of(const mxArray *points, const mxArray *radii, uint32_t caps) {
    robots_t robots = points_of(points, radii);
    pc_status status = PC_OK;
    size_t k;
    char text[512];
    robots.chains = (pc_chain **)mxCalloc(robots.points.batch, sizeof(pc_chain *));
    for (k = 0; k < robots.points.batch && status == PC_OK; ++k)
        status = pc_chain_new(robots.points.data + 3 * k * robots.points.rows, robots.points.rows,
                              robots.radii, robots.radius_count, caps, robots.chains + k);
    if (status != PC_OK) free_chains(&robots);
    if (status != PC_OK && robots.points.batch > 1) {
        /* Which robot of a batch, counted as the library does. */
        snprintf(text, sizeof text, "robot %lu: %s", (unsigned long)(k - 1), pc_error_message());
        fail(pc_error_kind(), text);
    }
    check(status);
    return robots;
}

static void only_one(const robots_t *robots) {
    if (robots->points.batch != 1)
        fail("bad_shape", "this question is about one robot; give N x 3 points");
}

static pc_tube *tube_of(const mxArray *points, const mxArray *radii, const options_t *options) {
    const robots_t robots = points_of(points, radii);
    pc_tube *tube;
    rows_t tangents = {NULL, 0, 0};
    only_one(&robots);
    if (options->tangents != NULL) tangents = rows_of(options->tangents, 3, "tangents");
    check(pc_tube_new(robots.points.data, robots.points.rows, robots.radii, robots.radius_count,
                      tangents.data, tangents.rows, options->deviation, options->turn, &tube));
    return tube;
}

/* Answers: a table of fields for each */

typedef struct {
    const char *name;
    /* d: doubles, u: an index, b: a truth, e: an enumeration, c: whether it is PC_CLEAR */
    char type;
    size_t offset, columns;
} field_t;

#define FIELD(answer, field, type, columns) {#field, type, offsetof(answer, field), columns}
#define END {NULL, 0, 0, 0}

#define PLACE(answer)                                                                     \
    FIELD(answer, on_robot, 'd', 3), FIELD(answer, on_mesh, 'd', 3),                      \
        FIELD(answer, segment, 'u', 1), FIELD(answer, arc_length, 'd', 1),                \
        FIELD(answer, triangle, 'u', 1), END
static const field_t MINIMUM[] = {FIELD(pc_minimum, distance, 'd', 1), PLACE(pc_minimum)};
static const field_t CONTACT[] = {
    FIELD(pc_contact, distance, 'd', 1), FIELD(pc_contact, depth, 'd', 1),
    FIELD(pc_contact, fraction, 'd', 1), FIELD(pc_contact, normal, 'd', 3), PLACE(pc_contact)};
static const field_t CLEARANCE[] = {
    FIELD(pc_clearance, lower, 'd', 1), FIELD(pc_clearance, upper, 'd', 1),
    FIELD(pc_clearance, resolved, 'b', 1), FIELD(pc_clearance, uncertainty, 'd', 1),
    FIELD(pc_clearance, t, 'd', 1), PLACE(pc_clearance)};
static const field_t MOTION_ANSWER[] = {
    {"is_clear", 'c', offsetof(pc_motion_answer, decision), 1},
    FIELD(pc_motion_answer, decision, 'e', 1), FIELD(pc_motion_answer, reason, 'e', 1),
    FIELD(pc_motion_answer, interval, 'd', 2), FIELD(pc_motion_answer, t, 'd', 1),
    FIELD(pc_motion_answer, upper, 'd', 1), PLACE(pc_motion_answer)};
static const field_t INSIDE[] = {
    FIELD(pc_inside_answer, holds, 'b', 1), FIELD(pc_inside_answer, clears, 'b', 1),
    FIELD(pc_inside_answer, base, 'e', 1), FIELD(pc_inside_answer, tip, 'e', 1),
    FIELD(pc_inside_answer, crosses_opening, 'b', 1), END};
static const field_t ROBOT_PROXIMITY[] = {
    FIELD(pc_robot_proximity, distance, 'd', 1), FIELD(pc_robot_proximity, on_first, 'd', 3),
    FIELD(pc_robot_proximity, on_second, 'd', 3), FIELD(pc_robot_proximity, links, 'u', 2),
    FIELD(pc_robot_proximity, arc_lengths, 'd', 2), END};
#define SCENE_PLACE(answer)                                      \
    {"structure", 'u', offsetof(answer, place.structure), 1},        \
        {"robots", 'u', offsetof(answer, place.robots), 2},          \
        {"on_first", 'd', offsetof(answer, place.on_first), 3},      \
        {"on_second", 'd', offsetof(answer, place.on_second), 3},    \
        {"arc_lengths", 'd', offsetof(answer, place.arc_lengths), 2}, \
        {"triangle", 'u', offsetof(answer, place.triangle), 1}, END
static const field_t TIGHTEST[] = {FIELD(pc_tightest, slack, 'd', 1), SCENE_PLACE(pc_tightest)};
static const field_t SCENE_MOTION_ANSWER[] = {
    {"is_clear", 'c', offsetof(pc_scene_motion_answer, decision), 1},
    FIELD(pc_scene_motion_answer, decision, 'e', 1),
    FIELD(pc_scene_motion_answer, reason, 'e', 1),
    FIELD(pc_scene_motion_answer, interval, 'd', 2),
    FIELD(pc_scene_motion_answer, t, 'd', 1),
    FIELD(pc_scene_motion_answer, upper, 'd', 1),
    SCENE_PLACE(pc_scene_motion_answer)};
static const field_t STRUCTURE[] = {
    FIELD(pc_structure_proximity, structure, 'u', 1),
    FIELD(pc_structure_proximity, robot, 'u', 1),
    FIELD(pc_structure_proximity, slack, 'd', 1),
    {"distance", 'd', offsetof(pc_structure_proximity, nearest.distance), 1},
    {"on_robot", 'd', offsetof(pc_structure_proximity, nearest.on_robot), 3},
    {"on_mesh", 'd', offsetof(pc_structure_proximity, nearest.on_mesh), 3},
    {"segment", 'u', offsetof(pc_structure_proximity, nearest.segment), 1},
    {"arc_length", 'd', offsetof(pc_structure_proximity, nearest.arc_length), 1},
    {"triangle", 'u', offsetof(pc_structure_proximity, nearest.triangle), 1},
    END};
static const field_t SURFACE[] = {
    FIELD(pc_surface, is_sound, 'b', 1),          FIELD(pc_surface, vertices, 's', 1),
    FIELD(pc_surface, triangles, 's', 1),         FIELD(pc_surface, skipped_faces, 's', 1),
    FIELD(pc_surface, openings, 's', 1),          FIELD(pc_surface, nonmanifold_edges, 's', 1),
    FIELD(pc_surface, misoriented_edges, 's', 1), END};

static double value_at(const char *place, char type, size_t column) {
    switch (type) {
    case 'd': return ((const double *)place)[column];
    case 'b': return *(const bool *)place;
    case 'e': return *(const int32_t *)place;
    case 'c': return *(const int32_t *)place == PC_CLEAR;
    case 's': return (double)*(const size_t *)place;
    default: break;
    }
    {
        const uint32_t index = ((const uint32_t *)place)[column];
        return index == PC_NONE ? mxGetNaN() : (double)index + 1;
    }
}

/* A structure whose fields have a row for each of `count` answers. */
static mxArray *answers(const field_t *fields, const void *items, size_t stride, size_t count) {
    mxArray *found = mxCreateStructMatrix(1, 1, 0, NULL);
    size_t row, column;
    for (; fields->name != NULL; ++fields) {
        const bool is_truth = fields->type == 'b' || fields->type == 'c';
        mxArray *array = is_truth ? mxCreateLogicalMatrix(count, fields->columns)
                                  : mxCreateDoubleMatrix(count, fields->columns, mxREAL);
        for (row = 0; row < count; ++row)
            for (column = 0; column < fields->columns; ++column) {
                const char *place = (const char *)items + row * stride + fields->offset;
                const double value = value_at(place, fields->type, column);
                if (is_truth)
                    mxGetLogicals(array)[column * count + row] = value != 0;
                else
                    mxGetPr(array)[column * count + row] = value;
            }
        mxAddField(found, fields->name);
        mxSetField(found, 0, fields->name, array);
    }
    return found;
}

#define ONE(fields, answer) answers(fields, &(answer), sizeof(answer), 1)

/* Commands. `given` begins after the command; `left` counts what follows the arrays. */

#define COMMAND(name) static mxArray *name(int count, const mxArray *const *given)
#define NEEDS(least, text) \
    do {                   \
        if (count < (least)) fail("bad_call", "give " text); \
    } while (0)

COMMAND(mesh) {
    rows_t vertices, faces;
    uint32_t *indices;
    size_t k;
    pc_mesh *made;
    NEEDS(2, "vertices and faces");
    vertices = rows_of(given[0], 3, "vertices");
    faces = rows_of(given[1], 3, "faces");
    indices = (uint32_t *)mxMalloc(3 * faces.rows * sizeof(uint32_t) + 1);
    for (k = 0; k < 3 * faces.rows; ++k) {
        const double index = faces.data[k];
        if (!(index >= 1 && index <= 4294967295.0 && index == floor(index)))
            fail("bad_index", "`faces` must have whole numbers from 1, the rows of `vertices`");
        indices[k] = (uint32_t)(index - 1);
    }
    check(pc_mesh_new(vertices.data, vertices.rows, indices, faces.rows, &made));
    return new_entry(MESH, made);
}

COMMAND(load_mesh) {
    static const char *const frames[] = {"", "RAS", "LPS"};
    options_t options;
    pc_mesh *made;
    NEEDS(1, "the name of a file");
    options = options_of(count - 1, given + 1);
    if (!(options.label >= -1 && options.label <= 4294967295.0))
        fail("bad_label", "`label` must be a label of the file");
    check(pc_mesh_load(text_of(given[0], "file"), (int64_t)options.label, options.scale,
                       choice(options.frame, "frame", frames, 3), &made));
    return new_entry(MESH, made);
}

COMMAND(free_handle) {
    NEEDS(1, "a handle");
    free_entry(entry_at(given[0], 0));
    return NULL;
}

COMMAND(surface) {
    pc_surface found;
    NEEDS(1, "a mesh");
    check(pc_mesh_surface(mesh_of(given[0]), &found));
    return ONE(SURFACE, found);
}

COMMAND(minimum) {
    pc_mesh *mesh;
    options_t options;
    robots_t robots;
    double *poses;
    pc_minimum *found;
    pc_status status;
    NEEDS(3, "a mesh, points and radii");
    mesh = mesh_of(given[0]);
    options = options_of(count - 3, given + 3);
    robots = points_of(given[1], given[2]);
    poses = poses_of(options.pose, robots.points.batch, "pose");
    found = (pc_minimum *)mxMalloc(robots.points.batch * sizeof(pc_minimum) + 1);
    robots = robots_of(given[1], given[2], caps_of(&options));
    status = pc_mesh_minimum_batch(mesh, (const pc_chain *const *)robots.chains, poses,
                                   robots.points.batch, found, NULL);
    free_chains(&robots);
    check(status);
    return answers(MINIMUM, found, sizeof *found, robots.points.batch);
}

COMMAND(clears) {
    pc_mesh *mesh;
    options_t options;
    robots_t robots;
    double *poses;
    double margin;
    pc_status status;
    mxArray *found;
    NEEDS(3, "a mesh, points and radii");
    mesh = mesh_of(given[0]);
    options = options_of(count - 3, given + 3);
    margin = needed(options.margin, "margin");
    robots = points_of(given[1], given[2]);
    poses = poses_of(options.pose, robots.points.batch, "pose");
    found = mxCreateLogicalMatrix(robots.points.batch, 1);
    robots = robots_of(given[1], given[2], caps_of(&options));
    status = pc_mesh_clears_batch(mesh, (const pc_chain *const *)robots.chains, poses,
                                  robots.points.batch, margin, (bool *)mxGetLogicals(found), NULL);
    free_chains(&robots);
    check(status);
    return found;
}

/* What the questions about one robot have in common. */
typedef struct {
    pc_mesh *mesh;
    options_t options;
    robots_t robots;
    double *pose;
    const pc_chain *chain;
} one_t;

static one_t one_of(int count, const mxArray *const *given) {
    one_t one;
    NEEDS(3, "a mesh, points and radii");
    one.mesh = mesh_of(given[0]);
    one.options = options_of(count - 3, given + 3);
    one.pose = poses_of(one.options.pose, 1, "pose");
    one.robots = points_of(given[1], given[2]);
    only_one(&one.robots);
    one.robots = robots_of(given[1], given[2], caps_of(&one.options));
    one.chain = one.robots.chains[0];
    return one;
}

static void done(one_t *one, pc_status status) {
    free_chains(&one->robots);
    check(status);
}

/* The same, of a question that needs a margin. */
static one_t one_with_margin(int count, const mxArray *const *given) {
    NEEDS(3, "a mesh, points and radii");
    needed(options_of(count - 3, given + 3).margin, "margin");
    return one_of(count, given);
}

COMMAND(per_link) {
    pc_mesh *mesh;
    options_t options;
    robots_t robots;
    double *poses;
    const pc_minimum *links;
    const size_t *firsts;
    pc_status status;
    mxArray *found, *which;
    size_t robot, link;
    NEEDS(3, "a mesh, points and radii");
    mesh = mesh_of(given[0]);
    options = options_of(count - 3, given + 3);
    robots = points_of(given[1], given[2]);
    poses = poses_of(options.pose, robots.points.batch, "pose");
    robots = robots_of(given[1], given[2], caps_of(&options));
    status = pc_mesh_per_link_batch(mesh, (const pc_chain *const *)robots.chains, poses,
                                    robots.points.batch, &links, &firsts, NULL);
    free_chains(&robots);
    check(status);
    found = answers(MINIMUM, links, sizeof *links, firsts[robots.points.batch]);
    which = mxCreateDoubleMatrix(firsts[robots.points.batch], 1, mxREAL);
    for (robot = 0; robot < robots.points.batch; ++robot)
        for (link = firsts[robot]; link < firsts[robot + 1]; ++link)
            mxGetPr(which)[link] = (double)robot + 1;
    mxAddField(found, "robot");
    mxSetField(found, 0, "robot", which);
    return found;
}

COMMAND(clears_sections) {
    pc_mesh *mesh;
    options_t options;
    rows_t sections;
    double *pose;
    mxArray *found;
    NEEDS(3, "a mesh, sections and radii");
    mesh = mesh_of(given[0]);
    sections = rows_of(given[1], 3, "sections");
    check_double(given[2], "radii");
    options = options_of(count - 3, given + 3);
    needed(options.margin, "margin");
    if (!(options.segments >= 1 && options.segments <= 1e6))
        fail("bad_options", "`segments` must be a number of links, from 1 to 1000000");
    pose = poses_of(options.pose, 1, "pose");
    found = mxCreateLogicalMatrix(sections.batch, 1);
    check(pc_mesh_clears_sections_batch(
        mesh, sections.data, sections.rows, mxGetPr(given[2]), mxGetNumberOfElements(given[2]),
        sections.batch, (size_t)options.segments, pose, options.margin,
        (bool *)mxGetLogicals(found), NULL));
    return found;
}

COMMAND(contacts_within) {
    one_t one = one_with_margin(count, given);
    const pc_contact *contacts;
    size_t many;
    done(&one, pc_mesh_contacts_within(one.mesh, one.chain, one.pose, one.options.margin,
                                       one.options.prominence, &contacts, &many));
    return answers(CONTACT, contacts, sizeof *contacts, many);
}

COMMAND(clears_inside) {
    one_t one = one_with_margin(count, given);
    pc_inside_answer found;
    done(&one,
         pc_mesh_clears_inside(one.mesh, one.chain, one.pose, one.options.margin, &found));
    return ONE(INSIDE, found);
}

COMMAND(prove) {
    one_t one;
    bool proven;
    NEEDS(3, "a mesh, points and radii");
    if (options_of(count - 3, given + 3).file == NULL)
        fail("missing_option", "`file` is missing; give 'file' and a name");
    one = one_with_margin(count, given);
    done(&one, pc_mesh_prove(one.mesh, one.chain, one.pose, one.options.margin, one.options.file,
                             &proven));
    return mxCreateLogicalScalar(proven);
}

/* The derivative with respect to all points, in the robot's frame, and to all radii. */
COMMAND(distance_and_gradient) {
    static const char *names[] = {"value", "points", "radii", "kink"};
    one_t one = one_of(count, given);
    pc_derivative found;
    mxArray *answer, *points, *radii;
    size_t rows = one.robots.points.rows, axis, end, k;
    done(&one, pc_mesh_derivative(one.mesh, one.chain, one.pose, &found));
    answer = mxCreateStructMatrix(1, 1, 4, names);
    points = mxCreateDoubleMatrix(rows, 3, mxREAL);
    radii = mxCreateDoubleMatrix(rows - 1, 1, mxREAL);
    for (end = 0; end < 2; ++end) {
        const double *rate = end == 0 ? found.start : found.end;
        for (axis = 0; axis < 3; ++axis) {
            /* The rotation of the pose, transposed. */
            double turned = one.pose == NULL ? rate[axis] : 0;
            for (k = 0; k < 3 && one.pose != NULL; ++k) turned += one.pose[4 * k + axis] * rate[k];
            mxGetPr(points)[axis * rows + found.segment + end] = turned;
        }
    }
    mxGetPr(radii)[found.segment] = found.radius;
    mxSetField(answer, 0, "value", mxCreateDoubleScalar(found.value));
    mxSetField(answer, 0, "points", points);
    mxSetField(answer, 0, "radii", radii);
    mxSetField(answer, 0, "kink", mxCreateLogicalScalar(found.kink));
    return answer;
}

COMMAND(side) {
    pc_mesh *mesh;
    rows_t points;
    pc_side *sides;
    mxArray *found;
    size_t k;
    NEEDS(2, "a mesh and points");
    mesh = mesh_of(given[0]);
    points = rows_of(given[1], 3, "points");
    sides = (pc_side *)mxMalloc(points.rows * sizeof(pc_side) + 1);
    check(pc_mesh_side(mesh, points.data, points.rows, sides));
    found = mxCreateDoubleMatrix(points.rows, 1, mxREAL);
    for (k = 0; k < points.rows; ++k) mxGetPr(found)[k] = sides[k];
    return found;
}

COMMAND(clearance) {
    options_t options;
    double *pose;
    pc_mesh *mesh;
    pc_tube *tube;
    pc_clearance found;
    pc_status status;
    NEEDS(3, "a mesh, points and radii");
    mesh = mesh_of(given[0]);
    options = options_of(count - 3, given + 3);
    needed(options.tolerance, "tolerance");
    pose = poses_of(options.pose, 1, "pose");
    tube = tube_of(given[1], given[2], &options);
    status = pc_mesh_clearance(mesh, tube, pose, options.tolerance, &found);
    pc_tube_free(tube);
    check(status);
    return ONE(CLEARANCE, found);
}

COMMAND(clears_tube) {
    options_t options;
    double *pose;
    pc_mesh *mesh;
    pc_tube *tube;
    pc_decision found;
    pc_status status;
    NEEDS(3, "a mesh, points and radii");
    mesh = mesh_of(given[0]);
    options = options_of(count - 3, given + 3);
    needed(options.margin, "margin");
    needed(options.resolution, "resolution");
    pose = poses_of(options.pose, 1, "pose");
    tube = tube_of(given[1], given[2], &options);
    status = pc_mesh_clears_tube(mesh, tube, pose, options.margin, options.resolution, &found);
    pc_tube_free(tube);
    check(status);
    return mxCreateDoubleScalar(found);
}

COMMAND(linear_motion) {
    rows_t start, end;
    options_t options;
    pc_motion *made;
    NEEDS(3, "start, end and radii");
    start = rows_of(given[0], 3, "start");
    end = rows_of(given[1], 3, "end");
    check_double(given[2], "radii");
    options = options_of(count - 3, given + 3);
    if (start.rows != end.rows || start.batch != 1 || end.batch != 1)
        fail("bad_shape", "`start` and `end` must be N x 3, with as many rows");
    check(pc_motion_linear(start.data, end.data, start.rows, mxGetPr(given[2]),
                           mxGetNumberOfElements(given[2]), caps_of(&options), &made));
    return new_entry(MOTION, made);
}

COMMAND(rigid_motion) {
    options_t options;
    double *start, *end;
    robots_t robots;
    pc_motion *made;
    pc_status status;
    NEEDS(2, "points and radii");
    options = options_of(count - 2, given + 2);
    start = poses_of(options.start_pose, 1, "start_pose");
    end = poses_of(options.end_pose, 1, "end_pose");
    robots = points_of(given[0], given[1]);
    only_one(&robots);
    robots = robots_of(given[0], given[1], caps_of(&options));
    status = pc_motion_rigid(robots.chains[0], start, end, &made);
    free_chains(&robots);
    check(status);
    return new_entry(MOTION, made);
}

COMMAND(bending_motion) {
    rows_t start, end;
    options_t options;
    pc_motion *made;
    NEEDS(3, "start, end and radii");
    start = rows_of(given[0], 3, "start");
    end = rows_of(given[1], 3, "end");
    check_double(given[2], "radii");
    options = options_of(count - 3, given + 3);
    if (start.rows != end.rows || start.batch != 1 || end.batch != 1)
        fail("bad_shape", "`start` and `end` must be S x 3, with as many rows");
    check(pc_motion_bending(start.data, end.data, start.rows, mxGetPr(given[2]),
                            mxGetNumberOfElements(given[2]), poses_of(options.pose, 1, "pose"),
                            &made));
    return new_entry(MOTION, made);
}

COMMAND(moving_base) {
    options_t options;
    const pc_motion *moved;
    pc_motion *made;
    NEEDS(1, "a motion");
    moved = (const pc_motion *)handle_at(given[0], 0, MOTION);
    options = options_of(count - 1, given + 1);
    check(pc_motion_moving_base(moved, poses_of(options.start_pose, 1, "start_pose"),
                                poses_of(options.end_pose, 1, "end_pose"), &made));
    return new_entry(MOTION, made);
}

/* The motions of an array of handles. */
static const pc_motion **motions_of(const mxArray *array, size_t *many) {
    const pc_motion **motions;
    size_t k;
    *many = mxGetNumberOfElements(array);
    motions = (const pc_motion **)mxMalloc(*many * sizeof(pc_motion *) + 1);
    for (k = 0; k < *many; ++k) motions[k] = (const pc_motion *)handle_at(array, k, MOTION);
    return motions;
}

COMMAND(motion_path) {
    const pc_motion **motions;
    size_t many;
    pc_motion *made;
    NEEDS(1, "an array of motions");
    motions = motions_of(given[0], &many);
    check(pc_motion_path(motions, many, &made));
    return new_entry(MOTION, made);
}

static mxArray *ask_motion(int count, const mxArray *const *given,
                           pc_status (*ask)(pc_mesh *, const pc_motion *, double, double,
                                            pc_motion_answer *)) {
    options_t options;
    const pc_motion *motion;
    pc_mesh *mesh;
    pc_motion_answer found;
    NEEDS(2, "a mesh and a motion");
    mesh = mesh_of(given[0]);
    motion = (const pc_motion *)handle_at(given[1], 0, MOTION);
    options = options_of(count - 2, given + 2);
    check(ask(mesh, motion, needed(options.margin, "margin"),
              needed(options.resolution, "resolution"), &found));
    return ONE(MOTION_ANSWER, found);
}

COMMAND(clears_motion) { return ask_motion(count, given, pc_mesh_clears_motion); }

COMMAND(time_of_contact) { return ask_motion(count, given, pc_mesh_time_of_contact); }

COMMAND(clears_motion_while) {
    options_t options;
    rows_t vertices;
    const pc_motion *motion;
    pc_mesh *mesh;
    pc_motion_answer found;
    NEEDS(3, "a mesh, vertices and a motion");
    mesh = mesh_of(given[0]);
    vertices = rows_of(given[1], 3, "vertices");
    motion = (const pc_motion *)handle_at(given[2], 0, MOTION);
    options = options_of(count - 3, given + 3);
    check(pc_mesh_clears_motion_while(mesh, vertices.data, vertices.rows, motion,
                                      needed(options.margin, "margin"),
                                      needed(options.resolution, "resolution"), &found));
    return ONE(MOTION_ANSWER, found);
}

COMMAND(clearance_of_motion) {
    options_t options;
    const pc_motion *motion;
    pc_mesh *mesh;
    pc_clearance found;
    NEEDS(2, "a mesh and a motion");
    mesh = mesh_of(given[0]);
    motion = (const pc_motion *)handle_at(given[1], 0, MOTION);
    options = options_of(count - 2, given + 2);
    check(pc_mesh_clearance_of_motion(mesh, motion, needed(options.tolerance, "tolerance"),
                                      &found));
    return ONE(CLEARANCE, found);
}

/* Two robots, whose chains are freed before the next error. */
typedef struct {
    robots_t a, b;
    double *pose_a, *pose_b;
    options_t options;
} two_t;

static two_t two_of(int count, const mxArray *const *given) {
    two_t two;
    robots_t b;
    pc_status status;
    NEEDS(4, "points_a, radii_a, points_b and radii_b");
    two.options = options_of(count - 4, given + 4);
    two.pose_a = poses_of(two.options.pose_a, 1, "pose_a");
    two.pose_b = poses_of(two.options.pose_b, 1, "pose_b");
    two.a = points_of(given[0], given[1]);
    b = points_of(given[2], given[3]);
    only_one(&two.a);
    only_one(&b);
    two.a = robots_of(given[0], given[1], caps_of(&two.options));
    b.chains = (pc_chain **)mxCalloc(1, sizeof(pc_chain *));
    status = pc_chain_new(b.points.data, b.points.rows, b.radii, b.radius_count,
                          caps_of(&two.options), b.chains);
    if (status != PC_OK) free_chains(&two.a);
    check(status);
    two.b = b;
    return two;
}

COMMAND(pair_minimum) {
    two_t two = two_of(count, given);
    pc_robot_proximity found;
    const pc_status status = pc_pair_minimum(pair(), two.a.chains[0], two.pose_a,
                                             two.b.chains[0], two.pose_b, &found);
    free_chains(&two.a);
    free_chains(&two.b);
    check(status);
    return ONE(ROBOT_PROXIMITY, found);
}

COMMAND(pair_clears) {
    two_t two;
    bool found;
    pc_status status;
    NEEDS(4, "points_a, radii_a, points_b and radii_b");
    needed(options_of(count - 4, given + 4).margin, "margin");
    two = two_of(count, given);
    status = pc_pair_clears(pair(), two.a.chains[0], two.pose_a, two.b.chains[0], two.pose_b,
                            two.options.margin, &found);
    free_chains(&two.a);
    free_chains(&two.b);
    check(status);
    return mxCreateLogicalScalar(found);
}

COMMAND(self_minimum) {
    options_t options;
    robots_t robots;
    pc_robot_proximity found;
    pc_status status;
    NEEDS(2, "points and radii");
    options = options_of(count - 2, given + 2);
    robots = points_of(given[0], given[1]);
    only_one(&robots);
    robots = robots_of(given[0], given[1], caps_of(&options));
    status = pc_self_query_minimum(self_query(), robots.chains[0], &found);
    free_chains(&robots);
    check(status);
    return ONE(ROBOT_PROXIMITY, found);
}

COMMAND(scene) {
    const options_t options = options_of(count, given);
    pc_scene *made;
    check(pc_scene_new(options.robot_margin, options.self_margin, &made));
    return new_entry(SCENE, made);
}

COMMAND(scene_add) {
    options_t options;
    pc_scene *scene;
    size_t structure;
    NEEDS(3, "a scene, a name and a mesh");
    scene = (pc_scene *)handle_at(given[0], 0, SCENE);
    options = options_of(count - 3, given + 3);
    check(pc_scene_add(scene, text_of(given[1], "name"), mesh_of(given[2]), options.margin,
                       poses_of(options.pose, 1, "pose"), &structure));
    return mxCreateDoubleScalar((double)structure + 1);
}

static pc_scene *scene_of(const mxArray *array) { return (pc_scene *)handle_at(array, 0, SCENE); }

/* A number from 1, as the library counts it. */
static size_t index_of(const mxArray *array, const char *name) {
    char text[128];
    double index;
    check_double(array, name);
    index = mxGetNumberOfElements(array) == 1 ? mxGetScalar(array) : 0;
    if (!(index >= 1 && index <= 4294967295.0 && index == floor(index))) {
        snprintf(text, sizeof text, "`%s` must be one whole number from 1", name);
        fail("bad_index", text);
    }
    return (size_t)index - 1;
}

/* A margin; [] is none. */
static double margin_of(const mxArray *array) {
    check_double(array, "margin");
    if (mxIsEmpty(array)) return mxGetNaN();
    if (mxGetNumberOfElements(array) != 1) fail("bad_shape", "`margin` must be one number, or []");
    return mxGetScalar(array);
}

COMMAND(scene_set_margin) {
    NEEDS(3, "a scene, a structure and a margin");
    check(pc_scene_set_margin(scene_of(given[0]), index_of(given[1], "structure"),
                              margin_of(given[2])));
    return NULL;
}

COMMAND(scene_margin_between) {
    double margin;
    NEEDS(3, "a scene, a structure and a robot");
    check(pc_scene_margin_between(scene_of(given[0]), index_of(given[1], "structure"),
                                  index_of(given[2], "robot"), &margin));
    return mxCreateDoubleScalar(margin);
}

COMMAND(scene_set_margin_between) {
    NEEDS(4, "a scene, a structure, a robot and a margin");
    check(pc_scene_set_margin_between(scene_of(given[0]), index_of(given[1], "structure"),
                                      index_of(given[2], "robot"), margin_of(given[3])));
    return NULL;
}

COMMAND(scene_is_solid) {
    bool is_solid;
    NEEDS(2, "a scene and a structure");
    check(pc_scene_is_solid(scene_of(given[0]), index_of(given[1], "structure"), &is_solid));
    return mxCreateLogicalScalar(is_solid);
}

COMMAND(scene_set_solid) {
    NEEDS(2, "a scene and a structure");
    if (count > 2 && !mxIsLogicalScalar(given[2])) fail("bad_type", "give true or false");
    check(pc_scene_set_solid(scene_of(given[0]), index_of(given[1], "structure"),
                             count < 3 || mxIsLogicalScalarTrue(given[2])));
    return NULL;
}

COMMAND(scene_set_pose) {
    NEEDS(3, "a scene, a structure and a pose");
    check(pc_scene_set_pose(scene_of(given[0]), index_of(given[1], "structure"),
                            poses_of(given[2], 1, "pose")));
    return NULL;
}

COMMAND(scene_set_vertices) {
    rows_t vertices;
    NEEDS(3, "a scene, a structure and vertices");
    vertices = rows_of(given[2], 3, "vertices");
    check(pc_scene_set_vertices(scene_of(given[0]), index_of(given[1], "structure"),
                                vertices.data, vertices.rows));
    return NULL;
}

/* The robots of a scene: a cell array with points, radii and a pose or [] in each row. Of N x 3 x B
   points and 4 x 4 x B poses there are B sets of robots. */
typedef struct {
    pc_scene *scene;
    pc_chain **chains; /* one set after another */
    double *poses;
    size_t many, sets;
} cast_t;

static void free_cast(cast_t *cast) {
    size_t k;
    for (k = 0; k < cast->many * cast->sets; ++k) pc_chain_free(cast->chains[k]);
}

static void more_sets(cast_t *cast, size_t batch) {
    if (batch == 1 || batch == cast->sets) return;
    if (cast->sets != 1)
        fail("bad_shape", "robots are N x 3, or N x 3 x B with the same B; so are poses");
    cast->sets = batch;
}

static cast_t cast_of(int count, const mxArray *const *given) {
    cast_t cast;
    options_t options;
    robots_t *robots;
    rows_t *poses;
    uint32_t caps;
    pc_status status = PC_OK;
    size_t columns, k, set, axis;
    NEEDS(2, "a scene and robots");
    cast.scene = scene_of(given[0]);
    options = options_of(count - 2, given + 2);
    caps = caps_of(&options);
    columns = mxGetN(given[1]);
    if (!mxIsCell(given[1]) || (columns != 2 && columns != 3))
        fail("bad_shape", "`robots` must be a cell array with points and radii in each row");
    cast.many = mxGetM(given[1]);
    cast.sets = 1;
    robots = (robots_t *)mxMalloc((cast.many + 1) * sizeof(robots_t));
    poses = (rows_t *)mxCalloc(cast.many + 1, sizeof(rows_t));
    for (k = 0; k < cast.many; ++k) {
        const mxArray *pose = columns == 3 ? mxGetCell(given[1], k + 2 * cast.many) : NULL;
        const mxArray *points = mxGetCell(given[1], k), *radii = mxGetCell(given[1], k + cast.many);
        if (points == NULL || radii == NULL)
            fail("bad_shape", "a robot of `robots` has no points or no radii");
        robots[k] = points_of(points, radii);
        more_sets(&cast, robots[k].points.batch);
        if (pose == NULL || mxIsEmpty(pose)) continue;
        poses[k] = rows_of(pose, 4, "pose");
        if (poses[k].rows != 4) fail("bad_shape", "`pose` must be 4 x 4, or 4 x 4 x B");
        more_sets(&cast, poses[k].batch);
    }
    cast.chains = (pc_chain **)mxCalloc(cast.many * cast.sets + 1, sizeof(pc_chain *));
    cast.poses = (double *)mxCalloc(16 * cast.many * cast.sets + 1, sizeof(double));
    for (set = 0; set < cast.sets; ++set)
        for (k = 0; k < cast.many && status == PC_OK; ++k) {
            const size_t place = set * cast.many + k;
            const rows_t *points = &robots[k].points, *pose = poses + k;
            const double *given_pose = pose->data + (pose->batch > 1 ? 16 * set : 0);
            if (pose->data != NULL)
                memcpy(cast.poses + 16 * place, given_pose, 16 * sizeof(double));
            for (axis = 0; axis < 4 && pose->data == NULL; ++axis)
                cast.poses[16 * place + 5 * axis] = 1;
            status = pc_chain_new(
                points->data + (points->batch > 1 ? 3 * set * points->rows : 0), points->rows,
                robots[k].radii, robots[k].radius_count, caps, cast.chains + place);
        }
    if (status != PC_OK) free_cast(&cast);
    check(status);
    return cast;
}

COMMAND(scene_clears) {
    cast_t cast = cast_of(count, given);
    mxArray *found = mxCreateLogicalMatrix(cast.sets, 1);
    const pc_chain *const *chains = (const pc_chain *const *)cast.chains;
    bool *clears = (bool *)mxGetLogicals(found);
    const pc_status status =
        cast.sets == 1 ? pc_scene_clears(cast.scene, chains, cast.poses, cast.many, clears)
                       : pc_scene_clears_batch(cast.scene, chains, cast.poses, cast.many,
                                               cast.sets, clears, NULL);
    free_cast(&cast);
    check(status);
    return found;
}

COMMAND(scene_tightest) {
    cast_t cast = cast_of(count, given);
    pc_tightest *found = (pc_tightest *)mxMalloc(cast.sets * sizeof(pc_tightest) + 1);
    const pc_chain *const *chains = (const pc_chain *const *)cast.chains;
    const pc_status status =
        cast.sets == 1 ? pc_scene_tightest(cast.scene, chains, cast.poses, cast.many, found)
                       : pc_scene_tightest_batch(cast.scene, chains, cast.poses, cast.many,
                                                 cast.sets, found, NULL);
    free_cast(&cast);
    check(status);
    return answers(TIGHTEST, found, sizeof *found, cast.sets);
}

COMMAND(scene_per_structure) {
    cast_t cast = cast_of(count, given);
    const pc_structure_proximity *found;
    pc_status status;
    size_t many;
    if (cast.sets != 1) {
        free_cast(&cast);
        fail("bad_shape", "this question is about one set of robots; give N x 3 points");
    }
    status = pc_scene_per_structure(cast.scene, (const pc_chain *const *)cast.chains, cast.poses,
                                    cast.many, &found, &many);
    free_cast(&cast);
    check(status);
    return answers(STRUCTURE, found, sizeof *found, many);
}

/* Each row of `motions` is a set of robots. */
COMMAND(scene_clears_motion) {
    options_t options;
    pc_scene *scene;
    const pc_motion **motions, **sets;
    size_t many, rows, columns, row, column;
    pc_scene_motion_answer *found;
    NEEDS(2, "a scene and an array of motions");
    scene = scene_of(given[0]);
    motions = motions_of(given[1], &many);
    options = options_of(count - 2, given + 2);
    needed(options.resolution, "resolution");
    rows = mxGetM(given[1]);
    columns = mxGetN(given[1]);
    found = (pc_scene_motion_answer *)mxMalloc(rows * sizeof *found + 1);
    if (rows == 1) {
        check(pc_scene_clears_motion(scene, motions, many, options.resolution, found));
    } else {
        sets = (const pc_motion **)mxMalloc(many * sizeof(pc_motion *) + 1);
        for (row = 0; row < rows; ++row)
            for (column = 0; column < columns; ++column)
                sets[row * columns + column] = motions[column * rows + row];
        check(pc_scene_clears_motion_batch(scene, sets, columns, rows, options.resolution, found,
                                           NULL));
    }
    return answers(SCENE_MOTION_ANSWER, found, sizeof *found, rows);
}

COMMAND(scene_time_of_contact) {
    options_t options;
    pc_scene *scene;
    const pc_motion **motions;
    size_t many;
    pc_scene_motion_answer found;
    NEEDS(2, "a scene and an array of motions");
    scene = scene_of(given[0]);
    motions = motions_of(given[1], &many);
    options = options_of(count - 2, given + 2);
    check(pc_scene_time_of_contact(scene, motions, many,
                                   needed(options.resolution, "resolution"), &found));
    return ONE(SCENE_MOTION_ANSWER, found);
}

/* `ends` is a cell array with a structure, and its pose or vertices in each row. */
COMMAND(scene_clears_motion_while) {
    options_t options;
    pc_scene *scene;
    pc_structure_end *ends;
    const pc_motion **motions;
    size_t many, moving, k;
    pc_scene_motion_answer found;
    NEEDS(3, "a scene, where structures move to, and an array of motions");
    scene = scene_of(given[0]);
    if (!mxIsCell(given[1]) || mxGetN(given[1]) != 2)
        fail("bad_shape", "`ends` must be a cell array with a structure, and its pose or vertices "
                          "in each row");
    moving = mxGetM(given[1]);
    ends = (pc_structure_end *)mxCalloc(moving + 1, sizeof *ends);
    for (k = 0; k < moving; ++k) {
        const mxArray *structure = mxGetCell(given[1], k), *to = mxGetCell(given[1], k + moving);
        if (structure == NULL || to == NULL)
            fail("bad_shape", "a row of `ends` has no structure, or no pose and no vertices");
        ends[k].structure = index_of(structure, "structure");
        if (mxGetN(to) == 4) {
            ends[k].pose = poses_of(to, 1, "pose");
        } else {
            const rows_t vertices = rows_of(to, 3, "vertices");
            ends[k].vertices = vertices.data;
            ends[k].vertex_count = vertices.rows;
        }
    }
    motions = motions_of(given[2], &many);
    options = options_of(count - 3, given + 3);
    check(pc_scene_clears_motion_while(scene, ends, moving, motions, many,
                                       needed(options.resolution, "resolution"), &found));
    return ONE(SCENE_MOTION_ANSWER, found);
}

COMMAND(version) {
    (void)count;
    (void)given;
    return mxCreateString(pc_version());
}

static const struct {
    const char *name;
    mxArray *(*run)(int, const mxArray *const *);
} COMMANDS[] = {{"mesh", mesh},
                {"load_mesh", load_mesh},
                {"free", free_handle},
                {"surface", surface},
                {"minimum", minimum},
                {"per_link", per_link},
                {"clears", clears},
                {"clears_sections", clears_sections},
                {"contacts_within", contacts_within},
                {"side", side},
                {"clears_inside", clears_inside},
                {"distance_and_gradient", distance_and_gradient},
                {"clearance", clearance},
                {"clears_tube", clears_tube},
                {"linear_motion", linear_motion},
                {"rigid_motion", rigid_motion},
                {"bending_motion", bending_motion},
                {"moving_base", moving_base},
                {"motion_path", motion_path},
                {"clears_motion", clears_motion},
                {"clears_motion_while", clears_motion_while},
                {"time_of_contact", time_of_contact},
                {"clearance_of_motion", clearance_of_motion},
                {"pair_minimum", pair_minimum},
                {"pair_clears", pair_clears},
                {"self_minimum", self_minimum},
                {"scene", scene},
                {"scene_add", scene_add},
                {"scene_clears", scene_clears},
                {"scene_tightest", scene_tightest},
                {"scene_per_structure", scene_per_structure},
                {"scene_clears_motion", scene_clears_motion},
                {"scene_clears_motion_while", scene_clears_motion_while},
                {"scene_time_of_contact", scene_time_of_contact},
                {"scene_set_margin", scene_set_margin},
                {"scene_margin_between", scene_margin_between},
                {"scene_set_margin_between", scene_set_margin_between},
                {"scene_is_solid", scene_is_solid},
                {"scene_set_solid", scene_set_solid},
                {"scene_set_pose", scene_set_pose},
                {"scene_set_vertices", scene_set_vertices},
                {"prove", prove},
                {"version", version}};

void mexFunction(int nlhs, mxArray *plhs[], int nrhs, const mxArray *prhs[]) {
    size_t k;
    const char *name;
    mxArray *found;
    (void)nlhs;
    if (nrhs < 1) fail("bad_call", "call the functions of the package continuum");
    if (pc_abi_version() != PC_ABI_VERSION)
        fail("abi_version", "the library is of another version; compile continuum_mex again");
    mexAtExit(free_all);
    name = text_of(prhs[0], "command");
    for (k = 0; k < sizeof COMMANDS / sizeof *COMMANDS; ++k)
        if (strcmp(name, COMMANDS[k].name) == 0) {
            found = COMMANDS[k].run(nrhs - 1, prhs + 1);
            if (found != NULL) plhs[0] = found;
            return;
        }
    fail("bad_call", "there is no such command; call the functions of the package continuum");
}
