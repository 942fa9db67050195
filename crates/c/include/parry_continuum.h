// parry-continuum: exact proximity queries between continuum robots and triangle meshes.
//
// Generated from crates/c/src by cbindgen: `.ci/c header --write`. Do not edit.
//
// Lengths are in one unit of your choice, the same for meshes and robots. Points are three doubles
// each, one after another. A pose is 16 doubles, the rows of a 4x4 matrix, from the robot's frame
// to the mesh's; NULL is the identity. Segments, triangles and robots are counted from 0.
//
// Every function returns `PC_OK` or what is wrong; `pc_error_message` says what to change. A
// pointer that is NULL or misaligned, or a length that does not fit, is an error. Any other pointer
// must point to as many items as its length says. The places of answers overlap neither each other
// nor what the call reads. After an error they are undefined, except that the place of a new handle
// is NULL, and that a batch has answered if it returns `PC_REFUSED` and `pc_error_robot` is not -1.
// A program ends if there is no memory left.
//
// A handle may move from thread to thread. Functions that take it as const may run at the same time
// in any number of threads; any other function needs it alone. `pc_mesh_clone` gives each thread a
// mesh of its own, which shares the triangles. A list belongs to the handle that was asked, until
// that handle is asked again or freed.


#ifndef PARRY_CONTINUUM_H
#define PARRY_CONTINUUM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// The version of this interface. It grows whenever a program must be compiled again.
#define PC_ABI_VERSION 1

// The index that stands for none.
#define PC_NONE UINT32_MAX

// The frame of a mesh is not known, or stays as it is.
#define PC_FRAME_UNKNOWN 0

// Right, anterior, superior: the axes of NIfTI and 3D Slicer.
#define PC_FRAME_RAS 1

// Left, posterior, superior: the axes of DICOM and ITK.
#define PC_FRAME_LPS 2

// Flat tips and steps, filled bends. For `pc_chain_new`.
#define PC_CAPS_FITTED 0

// All ends are round.
#define PC_CAPS_CAPSULES 1

// All ends are flat.
#define PC_CAPS_CYLINDERS 2

// Whether a margin is kept. `PC_CLEAR` and `PC_CONTACT` are proven.
enum pc_decision
#ifdef __cplusplus
  : int32_t
#endif // __cplusplus
 {
  // The margin is not kept.
  PC_CONTACT = -1,
  // The robot comes within the resolution of the margin, or the question takes too much work.
  PC_UNDECIDED = 0,
  // The margin is kept.
  PC_CLEAR = 1,
};
#ifndef __cplusplus
typedef int32_t pc_decision;
#endif // __cplusplus

// On which side of a mesh a point is.
enum pc_side
#ifdef __cplusplus
  : int32_t
#endif // __cplusplus
 {
  // It is proven to be inside.
  PC_INSIDE = -1,
  // It is on the surface within rounding, or the mesh is too open to tell.
  PC_UNDECIDED_SIDE = 0,
  // It is proven to be outside.
  PC_OUTSIDE = 1,
};
#ifndef __cplusplus
typedef int32_t pc_side;
#endif // __cplusplus

// What a function returns.
enum pc_status
#ifdef __cplusplus
  : int32_t
#endif // __cplusplus
 {
  // There is an answer.
  PC_OK = 0,
  // A pointer, a length or an option is wrong.
  PC_BAD_ARGUMENT = 1,
  // The library refuses the numbers. `pc_error_kind` is the same word as in Rust and Python.
  PC_REFUSED = 2,
  // A file cannot be read or written, or contains no mesh.
  PC_FILE = 3,
  // A defect of the library. Free the handles of the call, and report the message.
  PC_DEFECT = 4,
};
#ifndef __cplusplus
typedef int32_t pc_status;
#endif // __cplusplus

// Why it stays open whether a motion keeps a margin.
enum pc_undecided_reason
#ifdef __cplusplus
  : int32_t
#endif // __cplusplus
 {
  // It is decided.
  PC_REASON_NONE = 0,
  // A shape comes within the resolution of the margin.
  PC_REASON_NEAR = 1,
  // The question has reached its limit of work: a coarser resolution helps.
  PC_REASON_WORK = 2,
};
#ifndef __cplusplus
typedef int32_t pc_undecided_reason;
#endif // __cplusplus

// A robot of straight links.
typedef struct pc_chain pc_chain;

// A triangle mesh that is asked how near robots are to it. It remembers its last answers, which
// makes the next question about a similar robot faster and never changes an answer.
typedef struct pc_mesh pc_mesh;

// A robot that changes with time, from 0 to 1. It never changes itself.
typedef struct pc_motion pc_motion;

// Questions about two robots. It remembers its last answers, as a mesh does.
typedef struct pc_pair pc_pair;

// Several meshes, each with its own margin or none. It remembers its last answers, as a mesh does.
typedef struct pc_scene pc_scene;

// Questions about one robot and itself. It remembers its last answers, as a mesh does.
typedef struct pc_self_query pc_self_query;

// A robot with a smooth centreline.
typedef struct pc_tube pc_tube;

// What a mesh is as a surface, and what its file states.
typedef struct {
  // How many vertices it has.
  size_t vertices;
  // How many triangles it has.
  size_t triangles;
  // How many faces of its file are left out because they have no area.
  size_t skipped_faces;
  // How many openings it has, through which a robot can leave.
  size_t openings;
  // How many edges have more than two triangles.
  size_t nonmanifold_edges;
  // How many edges have two triangles that face opposite ways.
  size_t misoriented_edges;
  // Its frame: `PC_FRAME_UNKNOWN`, `PC_FRAME_RAS` or `PC_FRAME_LPS`.
  uint32_t frame;
  // Whether it is closed, and all its triangles face the same way.
  bool is_sound;
} pc_surface;

// Where a robot, or one of its links, is closest to a mesh.
typedef struct {
  // The distance, 0 where they touch or overlap.
  double distance;
  // The robot's closest point.
  double on_robot[3];
  // The mesh's closest point.
  double on_mesh[3];
  // How far along the centreline from the base.
  double arc_length;
  // The segment of the input, from point `segment` to the next.
  uint32_t segment;
  // The closest triangle.
  uint32_t triangle;
} pc_minimum;

// A contact of a robot with a mesh.
typedef struct {
  // The distance, 0 where they touch or overlap.
  double distance;
  // The distance with a sign: negative where they overlap.
  double depth;
  // The unit vector from the wall to the robot, or NaN.
  double normal[3];
  // The robot's closest point.
  double on_robot[3];
  // The mesh's closest point.
  double on_mesh[3];
  // Where along the segment, from 0 to 1.
  double fraction;
  // How far along the centreline from the base.
  double arc_length;
  // The segment of the input.
  uint32_t segment;
  // The triangle.
  uint32_t triangle;
} pc_contact;

// The derivative of the least distance, in the mesh's frame.
typedef struct {
  // The distance, or minus the least translation that separates robot and mesh.
  double value;
  // With respect to the point where the closest segment starts. NaN where neither side of the
  // triangle is the robot's.
  double start[3];
  // With respect to the point where the closest segment ends.
  double end[3];
  // With respect to the radius of the closest segment.
  double radius;
  // The closest segment. The derivative with respect to all other points is 0.
  uint32_t segment;
  // Whether other points are as close, which have another derivative.
  bool kink;
} pc_derivative;

// Whether a robot keeps a margin, and on which side of the mesh it is.
typedef struct {
  // The side of the first point of the centreline.
  pc_side base;
  // The side of the last point of the centreline.
  pc_side tip;
  // Whether every link keeps more than the margin, on either side.
  bool clears;
  // Whether a link touches the lid of an opening of the mesh.
  bool crosses_opening;
  // Whether the whole robot is inside and every link keeps the margin.
  bool holds;
} pc_inside_answer;

// Bounds on the clearance of a tube, or on the least clearance of a motion.
typedef struct {
  // The clearance is at least this.
  double lower;
  // The clearance is at most this: 0 where the tube touches the mesh.
  double upper;
  // The width of the bounds that stated errors cost and no finer tolerance removes.
  double uncertainty;
  // The time of the shape that realises `upper`; 0 for a tube at rest.
  double t;
  // A point of that shape.
  double on_robot[3];
  // A point of the mesh, at most `upper` away.
  double on_mesh[3];
  // How far along that shape's centreline from the base.
  double arc_length;
  // The segment of the input there.
  uint32_t segment;
  // The triangle there.
  uint32_t triangle;
  // Whether the bounds are no farther apart than the tolerance and `uncertainty`.
  bool resolved;
} pc_clearance;

// Whether a motion keeps a margin, until when, and which shape does not.
typedef struct {
  // Whether the margin is kept at every time from 0 to 1.
  pc_decision decision;
  // Why it is undecided.
  pc_undecided_reason reason;
  // The margin is kept before the first time, and may not be kept until the second.
  double interval[2];
  // After a contact: the time of a shape that does not keep the margin; otherwise NaN.
  double t;
  // The clearance of that shape is at most this.
  double upper;
  // A point of that shape.
  double on_robot[3];
  // A point of the mesh.
  double on_mesh[3];
  // How far along that shape's centreline from the base.
  double arc_length;
  // The segment of the input there, or `PC_NONE`.
  uint32_t segment;
  // The triangle there, or `PC_NONE`.
  uint32_t triangle;
} pc_motion_answer;

// Where two robots, or two parts of one, are closest to each other.
typedef struct {
  // The distance, 0 where they touch or overlap, and infinite where no parts of one robot could
  // meet.
  double distance;
  // The closest point of the first.
  double on_first[3];
  // The closest point of the second.
  double on_second[3];
  // How far along the centreline of each from its base.
  double arc_lengths[2];
  // The link of each robot. Segments without length are no links.
  uint32_t links[2];
} pc_robot_proximity;

// Whether two moving robots, or two parts of one, keep a margin, and which shapes do not.
typedef struct {
  // Whether the margin is kept at every time from 0 to 1.
  pc_decision decision;
  // Why it is undecided.
  pc_undecided_reason reason;
  // The margin is kept before the first time, and may not be kept until the second.
  double interval[2];
  // After a contact: the time of two shapes that do not keep the margin; otherwise NaN.
  double t;
  // The clearance of those shapes is at most this.
  double upper;
  // A point of the first robot's shape.
  double on_first[3];
  // A point of the second robot's shape.
  double on_second[3];
  // How far along the centreline of each from its base.
  double arc_lengths[2];
} pc_robot_motion_answer;

// Bounds on how near two tubes are, or on how near two motions come.
typedef struct {
  // The clearance is at least this.
  double lower;
  // The clearance is at most this: 0 where they touch or overlap.
  double upper;
  // The width of the bounds that stated errors cost and no finer tolerance removes.
  double uncertainty;
  // The time of the shapes that realise `upper`; 0 for tubes at rest.
  double t;
  // A point of the first robot.
  double on_first[3];
  // A point of the second robot, at most `upper` away.
  double on_second[3];
  // How far along the centreline of each from its base.
  double arc_lengths[2];
  // Whether the bounds are no farther apart than the tolerance and `uncertainty`.
  bool resolved;
} pc_robot_clearance;

// A place in a scene: of a structure and a robot, of two robots, or of a robot and itself.
typedef struct {
  // A point of the first robot.
  double on_first[3];
  // A point of the structure or the second robot.
  double on_second[3];
  // How far along the centreline of each robot from its base; NaN for a structure.
  double arc_lengths[2];
  // The structure, or `PC_NONE` between robots.
  uint32_t structure;
  // The robot and `PC_NONE`, the two robots, or one robot twice.
  uint32_t robots[2];
  // The triangle of the structure, or `PC_NONE`.
  uint32_t triangle;
} pc_scene_place;

// The least slack in a scene: the distance less the margin.
typedef struct {
  // The least slack; infinite where nothing has a margin.
  double slack;
  // Where it is.
  pc_scene_place place;
} pc_tightest;

// Where robots are closest to one structure of a scene, in the scene's frame.
typedef struct {
  // The distance of the closest robot.
  pc_minimum nearest;
  // The distance less the structure's margin, or NaN where it has none.
  double slack;
  // The structure.
  uint32_t structure;
  // The robot of the list that is closest.
  uint32_t robot;
} pc_structure_proximity;

// A contact of a robot with a structure of a scene.
typedef struct {
  // The contact, in the scene's frame.
  pc_contact contact;
  // The structure.
  uint32_t structure;
  // The robot of the list.
  uint32_t robot;
} pc_scene_contact;

// Bounds on the least slack of tubes or motions in a scene.
typedef struct {
  // Every slack is at least this; infinite where nothing has a margin.
  double lower;
  // The slack there is at most this.
  double upper;
  // The width of the bounds that stated errors cost and no finer tolerance removes.
  double uncertainty;
  // The time of the shapes that realise `upper`; 0 for tubes at rest.
  double t;
  // Where it is.
  pc_scene_place place;
  // Whether the bounds are no farther apart than the tolerance and `uncertainty`.
  bool resolved;
} pc_scene_clearance_answer;

// Whether robots that move in a scene keep all margins, and what does not.
typedef struct {
  // Whether all margins are kept at every time from 0 to 1.
  pc_decision decision;
  // Why it is undecided.
  pc_undecided_reason reason;
  // All margins are kept before the first time, and may not be kept until the second.
  double interval[2];
  // After a contact: the time of shapes that do not keep a margin; otherwise NaN.
  double t;
  // The clearance of those shapes is at most this.
  double upper;
  // Where it is.
  pc_scene_place place;
} pc_scene_motion_answer;

// Where a structure of a scene is at the end of a motion: at a pose, or with other vertices.
typedef struct {
  // The structure.
  size_t structure;
  // The pose to which it moves as a whole, or NULL.
  const double *pose;
  // The places to which its vertices move, in the mesh's frame, or NULL.
  const double *vertices;
  // How many vertices there are; 0 with a pose.
  size_t vertex_count;
} pc_structure_end;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Returns the `PC_ABI_VERSION` of the library that runs. Compare it with that of the header.
uint32_t pc_abi_version(void);

// Returns the version of the library, such as "0.1.0".
const char *pc_version(void);

// Returns the message of this thread's last error, in UTF-8: what is wrong, and what to change. It
// is empty before the first error, and valid until the thread's next one or the thread's end.
const char *pc_error_message(void);

// Returns the kind of this thread's last error, such as "point_not_finite". Programs can compare
// it: it stays the same where a message becomes clearer. It is valid as long as the message.
const char *pc_error_kind(void);

// Returns which robot, motion or set of a list this thread's last error is about, or -1.
int64_t pc_error_robot(void);

// Makes a mesh of `vertex_count` vertices and `triangle_count` triangles, which are three indices
// of vertices each. Both are copied.
pc_status pc_mesh_new(const double *vertices,
                      size_t vertex_count,
                      const uint32_t *triangles,
                      size_t triangle_count,
                      pc_mesh **mesh);

// Reads a mesh from a file: STL, OBJ, PLY, VTK, or the surface of a label map in NIfTI, NRRD or
// MetaImage. `label` is the label of a label map, or -1. `scale` multiplies every coordinate.
// `frame` is the frame that the mesh gets: `PC_FRAME_RAS` or `PC_FRAME_LPS`, a file that states
// the other one is turned; `PC_FRAME_UNKNOWN` leaves it as it is.
pc_status pc_mesh_load(const char *path,
                       int64_t label,
                       double scale,
                       uint32_t frame,
                       pc_mesh **mesh);

// Makes a second handle of a mesh, for another thread. Both share the triangles.
pc_status pc_mesh_clone(const pc_mesh *mesh, pc_mesh **clone);

// Frees a mesh. Its clones stay.
void pc_mesh_free(pc_mesh *mesh);

// Moves the vertices, as many as the mesh has. Clones keep theirs.
pc_status pc_mesh_set_vertices(pc_mesh *mesh, const double *vertices, size_t vertex_count);

// Builds all that later questions need, so that none of them builds anything.
pc_status pc_mesh_prepare(const pc_mesh *mesh);

// Says what the mesh is as a surface, and what its file stated.
pc_status pc_mesh_surface(const pc_mesh *mesh, pc_surface *surface);

// Finds where a robot is closest to the mesh.
pc_status pc_mesh_minimum(pc_mesh *mesh,
                          const pc_chain *robot,
                          const double *pose,
                          pc_minimum *minimum);

// Finds where each of `count` robots is closest, on all cores. `poses` are one for each, or NULL.
// The answer of a refused robot is NaN, and its status is not `PC_OK`; `statuses` may be NULL. The
// first such robot is the error.
pc_status pc_mesh_minimum_batch(pc_mesh *mesh,
                                const pc_chain *const *robots,
                                const double *poses,
                                size_t count,
                                pc_minimum *minima,
                                pc_status *statuses);

// Finds where each link of a robot is closest. A link is a segment that has a length.
pc_status pc_mesh_per_link(pc_mesh *mesh,
                           const pc_chain *robot,
                           const double *pose,
                           const pc_minimum **links,
                           size_t *count);

// Finds where each link of each of `count` robots is closest, on all cores. The links of robot `k`
// are `links[firsts[k]]` to `links[firsts[k + 1] - 1]`; a refused robot has none. `firsts` has
// `count + 1` items. Both lists belong to the mesh.
pc_status pc_mesh_per_link_batch(pc_mesh *mesh,
                                 const pc_chain *const *robots,
                                 const double *poses,
                                 size_t count,
                                 const pc_minimum **links,
                                 const size_t **firsts,
                                 pc_status *statuses);

// Says whether a robot keeps more than the margin away.
pc_status pc_mesh_clears(pc_mesh *mesh,
                         const pc_chain *robot,
                         const double *pose,
                         double margin,
                         bool *clears);

// The same for `count` robots, on all cores, as `pc_mesh_minimum_batch`.
pc_status pc_mesh_clears_batch(pc_mesh *mesh,
                               const pc_chain *const *robots,
                               const double *poses,
                               size_t count,
                               double margin,
                               bool *clears,
                               pc_status *statuses);

// The same for `count` robots of `section_count` sections of constant curvature each, on all
// cores. A section is three numbers: its length, and its curvature towards x and towards y. All
// robots have the same radii: one for each section, or a single one. A section becomes `segments`
// straight links. All bases have the same `pose`.
pc_status pc_mesh_clears_sections_batch(pc_mesh *mesh,
                                        const double *sections,
                                        size_t section_count,
                                        const double *radii,
                                        size_t radius_count,
                                        size_t count,
                                        size_t segments,
                                        const double *pose,
                                        double margin,
                                        bool *clears,
                                        pc_status *statuses);

// Finds every contact within the margin: all local minima of the distance. Contacts
// that rise by less than `prominence` before a nearer one are left out; 0 keeps all.
pc_status pc_mesh_contacts_within(pc_mesh *mesh,
                                  const pc_chain *robot,
                                  const double *pose,
                                  double margin,
                                  double prominence,
                                  const pc_contact **contacts,
                                  size_t *count);

// Finds the derivative of the least distance with respect to the ends and the radius of the
// closest link.
pc_status pc_mesh_derivative(pc_mesh *mesh,
                             const pc_chain *robot,
                             const double *pose,
                             pc_derivative *derivative);

// Says on which side of the mesh each of `count` points is.
pc_status pc_mesh_side(const pc_mesh *mesh, const double *points, size_t count, pc_side *sides);

// Says on which side each link of a robot is.
pc_status pc_mesh_link_sides(pc_mesh *mesh,
                             const pc_chain *robot,
                             const double *pose,
                             const pc_side **sides,
                             size_t *count);

// Says whether a robot keeps the margin, and whether it is inside.
pc_status pc_mesh_clears_inside(pc_mesh *mesh,
                                const pc_chain *robot,
                                const double *pose,
                                double margin,
                                pc_inside_answer *answer);

// Bounds the clearance of a tube. The bounds are at most `tolerance` apart.
pc_status pc_mesh_clearance(pc_mesh *mesh,
                            const pc_tube *tube,
                            const double *pose,
                            double tolerance,
                            pc_clearance *clearance);

// The same for `count` tubes, on all cores, as `pc_mesh_minimum_batch`.
pc_status pc_mesh_clearance_batch(pc_mesh *mesh,
                                  const pc_tube *const *tubes,
                                  const double *poses,
                                  size_t count,
                                  double tolerance,
                                  pc_clearance *clearances,
                                  pc_status *statuses);

// Says whether a tube keeps more than the margin away. It is undecided only within `resolution` of
// the margin.
pc_status pc_mesh_clears_tube(pc_mesh *mesh,
                              const pc_tube *tube,
                              const double *pose,
                              double margin,
                              double resolution,
                              pc_decision *decision);

// The same for `count` tubes, on all cores, as `pc_mesh_minimum_batch`.
pc_status pc_mesh_clears_tube_batch(pc_mesh *mesh,
                                    const pc_tube *const *tubes,
                                    const double *poses,
                                    size_t count,
                                    double margin,
                                    double resolution,
                                    pc_decision *decisions,
                                    pc_status *statuses);

// Says whether a motion keeps more than the margin away at every time from 0 to 1. It is undecided
// only within `resolution` of the margin, or after too much work.
pc_status pc_mesh_clears_motion(pc_mesh *mesh,
                                const pc_motion *motion,
                                double margin,
                                double resolution,
                                pc_motion_answer *answer);

// The same for `count` motions, on all cores, as `pc_mesh_minimum_batch`.
pc_status pc_mesh_clears_motion_batch(pc_mesh *mesh,
                                      const pc_motion *const *motions,
                                      size_t count,
                                      double margin,
                                      double resolution,
                                      pc_motion_answer *answers,
                                      pc_status *statuses);

// Finds the first time at which a motion does not keep the margin, within `resolution`.
pc_status pc_mesh_time_of_contact(pc_mesh *mesh,
                                  const pc_motion *motion,
                                  double margin,
                                  double resolution,
                                  pc_motion_answer *answer);

// Bounds the least clearance of a motion. The bounds are at most `tolerance` apart.
pc_status pc_mesh_clearance_of_motion(pc_mesh *mesh,
                                      const pc_motion *motion,
                                      double tolerance,
                                      pc_clearance *clearance);

// Says whether a motion keeps the margin while the vertices of the mesh move, straight and evenly,
// to `vertices`. The mesh itself stays where it is.
pc_status pc_mesh_clears_motion_while(pc_mesh *mesh,
                                      const double *vertices,
                                      size_t vertex_count,
                                      const pc_motion *motion,
                                      double margin,
                                      double resolution,
                                      pc_motion_answer *answer);

// Says whether a path of `count` shapes keeps the margin. `deviation` is how far the robot may be
// from the straight lines between the shapes.
pc_status pc_mesh_clears_path(pc_mesh *mesh,
                              const pc_chain *const *shapes,
                              size_t count,
                              double deviation,
                              double margin,
                              double resolution,
                              pc_motion_answer *answer);

// Proves that a robot keeps more than the margin away. Writes the proof to `path`, and the mesh
// beside it with the extension `.obj`, for `docs/book/check_proof.py`. Writes nothing, and sets
// `proven` to false, if the margin is not kept, or exceeded by at most rounding.
pc_status pc_mesh_prove(pc_mesh *mesh,
                        const pc_chain *robot,
                        const double *pose,
                        double margin,
                        const char *path,
                        bool *proven);

// The same for a tube. The proof may be missed within `resolution` of the margin.
pc_status pc_mesh_prove_tube(pc_mesh *mesh,
                             const pc_tube *tube,
                             const double *pose,
                             double margin,
                             double resolution,
                             const char *path,
                             bool *proven);

// The same for a motion, at every time from 0 to 1.
pc_status pc_mesh_prove_motion(pc_mesh *mesh,
                               const pc_motion *motion,
                               double margin,
                               double resolution,
                               const char *path,
                               bool *proven);

// Makes a motion whose points move straight and evenly from `start` to `end`, `point_count` points
// each. `caps` is `PC_CAPS_FITTED` or `PC_CAPS_CAPSULES`.
pc_status pc_motion_linear(const double *start,
                           const double *end,
                           size_t point_count,
                           const double *radii,
                           size_t radius_count,
                           uint32_t caps,
                           pc_motion **motion);

// Makes the motion of a robot that keeps its shape and turns the lesser way, evenly from one pose
// to another.
pc_status pc_motion_rigid(const pc_chain *robot,
                          const double *start_pose,
                          const double *end_pose,
                          pc_motion **motion);

// The same for a smooth tube.
pc_status pc_motion_rigid_tube(const pc_tube *tube,
                               const double *start_pose,
                               const double *end_pose,
                               pc_motion **motion);

// Makes the motion of sections of constant curvature, whose lengths and curvatures change evenly.
// A section is three numbers: its length, and its curvature towards x and towards y. `pose` is
// that of the base.
pc_status pc_motion_bending(const double *start,
                            const double *end,
                            size_t section_count,
                            const double *radii,
                            size_t radius_count,
                            const double *pose,
                            pc_motion **motion);

// Makes a motion whose base moves at the same time, evenly from one pose to another.
pc_status pc_motion_moving_base(const pc_motion *moved,
                                const double *start_pose,
                                const double *end_pose,
                                pc_motion **motion);

// Makes a motion of several, one after another. Each begins where the one before ends, and has the
// same share of the time.
pc_status pc_motion_path(const pc_motion *const *motions, size_t count, pc_motion **motion);

// Compares a motion with the speeds that it states, at `steps` times.
pc_status pc_motion_verify(const pc_motion *motion, uint32_t steps);

// Frees a motion. Motions that are made of it stay.
void pc_motion_free(pc_motion *motion);

// Makes a handle for questions about two robots.
pc_status pc_pair_new(pc_pair **pair);

// Frees it.
void pc_pair_free(pc_pair *pair);

// Finds where two robots are closest to each other. Both poses lead into the same frame.
pc_status pc_pair_minimum(pc_pair *pair,
                          const pc_chain *robot_a,
                          const double *pose_a,
                          const pc_chain *robot_b,
                          const double *pose_b,
                          pc_robot_proximity *minimum);

// Finds where each of `count` pairs of robots are closest, on all cores, as
// `pc_mesh_minimum_batch`.
pc_status pc_pair_minimum_batch(const pc_pair *pair,
                                const pc_chain *const *robots_a,
                                const double *poses_a,
                                const pc_chain *const *robots_b,
                                const double *poses_b,
                                size_t count,
                                pc_robot_proximity *minima,
                                pc_status *statuses);

// Says whether each of `count` pairs of robots keep more than the margin apart, on all cores, as
// `pc_mesh_minimum_batch`.
pc_status pc_pair_clears_batch(const pc_pair *pair,
                               const pc_chain *const *robots_a,
                               const double *poses_a,
                               const pc_chain *const *robots_b,
                               const double *poses_b,
                               size_t count,
                               double margin,
                               bool *clears,
                               pc_status *statuses);

// The same for pairs of motions, at every time from 0 to 1.
pc_status pc_pair_clears_motions_batch(const pc_pair *pair,
                                       const pc_motion *const *motions_a,
                                       const pc_motion *const *motions_b,
                                       size_t count,
                                       double margin,
                                       double resolution,
                                       pc_robot_motion_answer *answers,
                                       pc_status *statuses);

// Finds for each link of the first robot the closest link of the second.
pc_status pc_pair_per_link(pc_pair *pair,
                           const pc_chain *robot_a,
                           const double *pose_a,
                           const pc_chain *robot_b,
                           const double *pose_b,
                           const pc_robot_proximity **links,
                           size_t *count);

// Finds every place where two robots are within the margin.
pc_status pc_pair_contacts_within(pc_pair *pair,
                                  const pc_chain *robot_a,
                                  const double *pose_a,
                                  const pc_chain *robot_b,
                                  const double *pose_b,
                                  double margin,
                                  const pc_robot_proximity **contacts,
                                  size_t *count);

// Says whether two robots keep more than the margin apart.
pc_status pc_pair_clears(pc_pair *pair,
                         const pc_chain *robot_a,
                         const double *pose_a,
                         const pc_chain *robot_b,
                         const double *pose_b,
                         double margin,
                         bool *clears);

// Bounds how near two tubes are. The bounds are at most `tolerance` apart.
pc_status pc_pair_clearance(pc_pair *pair,
                            const pc_tube *tube_a,
                            const double *pose_a,
                            const pc_tube *tube_b,
                            const double *pose_b,
                            double tolerance,
                            pc_robot_clearance *clearance);

// Says whether two tubes keep more than the margin apart.
pc_status pc_pair_clears_tubes(pc_pair *pair,
                               const pc_tube *tube_a,
                               const double *pose_a,
                               const pc_tube *tube_b,
                               const double *pose_b,
                               double margin,
                               double resolution,
                               pc_decision *decision);

// Says whether two motions keep more than the margin apart at every time from 0 to 1.
pc_status pc_pair_clears_motions(pc_pair *pair,
                                 const pc_motion *motion_a,
                                 const pc_motion *motion_b,
                                 double margin,
                                 double resolution,
                                 pc_robot_motion_answer *answer);

// Finds the first time at which two motions do not keep the margin, within `resolution`.
pc_status pc_pair_time_of_contact(pc_pair *pair,
                                  const pc_motion *motion_a,
                                  const pc_motion *motion_b,
                                  double margin,
                                  double resolution,
                                  pc_robot_motion_answer *answer);

// Bounds how near two motions come. The bounds are at most `tolerance` apart.
pc_status pc_pair_clearance_of_motion(pc_pair *pair,
                                      const pc_motion *motion_a,
                                      const pc_motion *motion_b,
                                      double tolerance,
                                      pc_robot_clearance *clearance);

// Makes a handle for questions about one robot and itself.
pc_status pc_self_query_new(pc_self_query **query);

// Frees it.
void pc_self_query_free(pc_self_query *query);

// Finds where two parts of a robot that are not neighbours are closest. The distance is infinite
// if no two parts could meet.
pc_status pc_self_query_minimum(pc_self_query *query,
                                const pc_chain *robot,
                                pc_robot_proximity *minimum);

// Says whether a robot keeps more than the margin from itself.
pc_status pc_self_query_clears(pc_self_query *query,
                               const pc_chain *robot,
                               double margin,
                               bool *clears);

// The same for a tube.
pc_status pc_self_query_clears_tube(pc_self_query *query,
                                    const pc_tube *tube,
                                    double margin,
                                    double resolution,
                                    pc_decision *decision);

// The same for a motion, at every time from 0 to 1.
pc_status pc_self_query_clears_motion(pc_self_query *query,
                                      const pc_motion *motion,
                                      double margin,
                                      double resolution,
                                      pc_robot_motion_answer *answer);

// Makes a robot of straight links: `point_count` points from the base to the tip, and one radius
// for each segment, or a single one. `caps` is `PC_CAPS_FITTED`, `PC_CAPS_CAPSULES` or
// `PC_CAPS_CYLINDERS`.
pc_status pc_chain_new(const double *points,
                       size_t point_count,
                       const double *radii,
                       size_t radius_count,
                       uint32_t caps,
                       pc_chain **robot);

// Gives a robot other points and radii. With fitted caps and as many points as before it allocates
// nothing. After an error the robot is as it was.
pc_status pc_chain_set(pc_chain *robot,
                       const double *points,
                       size_t point_count,
                       const double *radii,
                       size_t radius_count);

// Frees a robot.
void pc_chain_free(pc_chain *robot);

// Makes a smooth tube through points, with flat ends and one radius for each segment, or a single
// one. `tangents` are directions of any length: none, 2 for the ends, or one for each point.
// `deviation` is how far a measured point may be from the curve, or 0; the curve is then fitted,
// without tangents. `turn` is the largest angle in rad between the true direction and the curve's
// at flat ends, or NaN if it is not known.
pc_status pc_tube_new(const double *points,
                      size_t point_count,
                      const double *radii,
                      size_t radius_count,
                      const double *tangents,
                      size_t tangent_count,
                      double deviation,
                      double turn,
                      pc_tube **tube);

// Gives a tube other points, radii and end directions, `NULL` or two, in the memory that it has.
// After an error the tube is as it was.
pc_status pc_tube_set(pc_tube *tube,
                      const double *points,
                      size_t point_count,
                      const double *radii,
                      size_t radius_count,
                      const double *end_tangents);

// Frees a tube.
void pc_tube_free(pc_tube *tube);

// Makes an empty scene. `robot_margin` is that between two robots, and `self_margin` that of a
// moving robot and itself; NaN is none.
pc_status pc_scene_new(double robot_margin, double self_margin, pc_scene **scene);

// Frees a scene. The meshes that were added stay.
void pc_scene_free(pc_scene *scene);

// Adds a clone of a mesh as a structure. Each structure has its own `name`, which messages use.
// `margin` NaN is none: the structure is then reported and never tested. `pose` leads from the
// mesh's frame to the scene's. Structures count from 0. After an error the scene is as it was.
pc_status pc_scene_add(pc_scene *scene,
                       const char *name,
                       const pc_mesh *mesh,
                       double margin,
                       const double *pose,
                       size_t *structure);

// Changes the margin of a structure; NaN is none. Margins from single robots stay.
pc_status pc_scene_set_margin(pc_scene *scene, size_t structure, double margin);

// Says how far a robot must be from a structure; NaN is none. `robot` is its place in the lists of
// robots of the questions.
pc_status pc_scene_margin_between(const pc_scene *scene,
                                  size_t structure,
                                  size_t robot,
                                  double *margin);

// Sets the margin between a structure and one robot, in place of the structure's margin. NaN is
// none: the two may touch.
pc_status pc_scene_set_margin_between(pc_scene *scene,
                                      size_t structure,
                                      size_t robot,
                                      double margin);

// Changes the margin between two robots; NaN is none.
pc_status pc_scene_set_robot_margin(pc_scene *scene, double margin);

// Changes the margin of a robot and itself; NaN is none.
pc_status pc_scene_set_self_margin(pc_scene *scene, double margin);

// Sets the pairs of robots that are nested, as a tube in the tube that guides it, in place of
// earlier ones. Nested robots touch, so they are not tested against each other. `pairs` is two
// places in the lists of robots for each pair.
pc_status pc_scene_set_nested(pc_scene *scene, const size_t *pairs, size_t pair_count);

// Says whether a structure is solid.
pc_status pc_scene_is_solid(const pc_scene *scene, size_t structure, bool *is_solid);

// Makes a structure solid, or with 0 a surface, as it is at first. A robot inside of a solid
// structure is in contact with it. Its mesh must be closed, and all triangles face the same way.
pc_status pc_scene_set_solid(pc_scene *scene, size_t structure, uint32_t is_solid);

// Builds all that later questions need, so that none of them builds anything.
pc_status pc_scene_prepare(const pc_scene *scene);

// Moves a structure.
pc_status pc_scene_set_pose(pc_scene *scene, size_t structure, const double *pose);

// Moves the vertices of a structure.
pc_status pc_scene_set_vertices(pc_scene *scene,
                                size_t structure,
                                const double *vertices,
                                size_t vertex_count);

// Says whether `count` robots keep all margins. `poses` are one for each, or NULL.
pc_status pc_scene_clears(pc_scene *scene,
                          const pc_chain *const *robots,
                          const double *poses,
                          size_t count,
                          bool *clears);

// Says whether each of `count` sets of `robot_count` robots keeps all margins, on all cores.
// `robots` has the sets one after another; so has `poses`, or it is NULL. The answer of a refused
// set is false, and its status is not `PC_OK`; `statuses` may be NULL. The first such set is the
// error.
pc_status pc_scene_clears_batch(const pc_scene *scene,
                                const pc_chain *const *robots,
                                const double *poses,
                                size_t robot_count,
                                size_t count,
                                bool *clears,
                                pc_status *statuses);

// Finds the least slack: the least distance less the margin.
pc_status pc_scene_tightest(pc_scene *scene,
                            const pc_chain *const *robots,
                            const double *poses,
                            size_t count,
                            pc_tightest *tightest);

// The same for `count` sets of robots, on all cores, as `pc_scene_clears_batch`. The answer of a
// refused set is NaN.
pc_status pc_scene_tightest_batch(const pc_scene *scene,
                                  const pc_chain *const *robots,
                                  const double *poses,
                                  size_t robot_count,
                                  size_t count,
                                  pc_tightest *tightest,
                                  pc_status *statuses);

// Finds where the robots are closest to each structure.
pc_status pc_scene_per_structure(pc_scene *scene,
                                 const pc_chain *const *robots,
                                 const double *poses,
                                 size_t robot_count,
                                 const pc_structure_proximity **structures,
                                 size_t *count);

// Finds every contact within `reach` of a structure, as `pc_mesh_contacts_within`.
pc_status pc_scene_contacts_within(pc_scene *scene,
                                   const pc_chain *const *robots,
                                   const double *poses,
                                   size_t robot_count,
                                   double reach,
                                   double prominence,
                                   const pc_scene_contact **contacts,
                                   size_t *count);

// Says whether `count` tubes keep all margins.
pc_status pc_scene_clears_tube(pc_scene *scene,
                               const pc_tube *const *tubes,
                               const double *poses,
                               size_t count,
                               double resolution,
                               pc_decision *decision);

// Bounds the least slack of `count` tubes.
pc_status pc_scene_clearance(pc_scene *scene,
                             const pc_tube *const *tubes,
                             const double *poses,
                             size_t count,
                             double tolerance,
                             pc_scene_clearance_answer *clearance);

// Says whether `count` robots that move keep all margins at every time from 0 to 1.
pc_status pc_scene_clears_motion(pc_scene *scene,
                                 const pc_motion *const *motions,
                                 size_t count,
                                 double resolution,
                                 pc_scene_motion_answer *answer);

// The same for `count` sets of `robot_count` motions, on all cores, as `pc_scene_clears_batch`.
pc_status pc_scene_clears_motion_batch(const pc_scene *scene,
                                       const pc_motion *const *motions,
                                       size_t robot_count,
                                       size_t count,
                                       double resolution,
                                       pc_scene_motion_answer *answers,
                                       pc_status *statuses);

// The same while `end_count` structures move too, to their `ends`. A structure that is not listed
// rests. The scene itself stays as it is.
pc_status pc_scene_clears_motion_while(pc_scene *scene,
                                       const pc_structure_end *ends,
                                       size_t end_count,
                                       const pc_motion *const *motions,
                                       size_t count,
                                       double resolution,
                                       pc_scene_motion_answer *answer);

// Finds the first time at which a margin is not kept, within `resolution`.
pc_status pc_scene_time_of_contact(pc_scene *scene,
                                   const pc_motion *const *motions,
                                   size_t count,
                                   double resolution,
                                   pc_scene_motion_answer *answer);

// Bounds the least slack of `count` robots that move.
pc_status pc_scene_clearance_of_motion(pc_scene *scene,
                                       const pc_motion *const *motions,
                                       size_t count,
                                       double tolerance,
                                       pc_scene_clearance_answer *clearance);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PARRY_CONTINUUM_H */
