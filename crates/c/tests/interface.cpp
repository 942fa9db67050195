// What the header of C++ adds to that of C: moves, exceptions, spans, Eigen, and every class once.
#include "parry_continuum.hpp"

#include <Eigen/Geometry>

#include <cstdio>
#include <cstring>
#include <string>

using namespace continuum;

static int failures = 0;

#define IS_TRUE(truth)                             \
    do {                                           \
        if (!(truth)) {                            \
            std::printf("not so: %s\n", #truth);   \
            ++failures;                            \
        }                                          \
    } while (0)

template <class Call>
static std::string kind_of(Call call) {
    try {
        call();
    } catch (const Error& error) {
        IS_TRUE(std::strlen(error.what()) > 10);
        return error.kind();
    }
    return "";
}

static_assert(!std::is_copy_constructible_v<Mesh> && std::is_nothrow_move_constructible_v<Mesh>);
static_assert(!std::is_copy_assignable_v<Chain> && std::is_nothrow_move_assignable_v<Chain>);

int main(int, char** argv) {
    const std::vector<std::array<double, 3>> floor{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
    Mesh mesh(floor, {{0, 1, 2}});

    // Points of every kind are the same robot.
    Eigen::Matrix3Xd columns(3, 3);
    columns << 0, 1, 2, 0, 0, 0, 2, 2, 3;
    const std::vector<double> flat{0, 0, 2, 1, 0, 2, 2, 0, 3};
    Chain robot(columns, 0.5);
    IS_TRUE(mesh.distance(robot) == 1.5);
    IS_TRUE(Points(columns).data() == columns.data());
    IS_TRUE(mesh.distance(Chain(flat, Eigen::Vector2d(0.5, 0.5))) == 1.5);
    IS_TRUE(mesh.distance(Chain({flat.data(), 3}, std::vector<double>{0.5, 0.5})) == 1.5);
    IS_TRUE(mesh.distance(Chain(Eigen::Map<const Eigen::Matrix3Xd>(flat.data(), 3, 3), 0.5)) ==
            1.5);
    const std::vector<Eigen::Vector3d> vectors{{0, 0, 2}, {1, 0, 2}, {2, 0, 3}};
    IS_TRUE(mesh.distance(Chain(vectors, 0.5)) == 1.5 && Points(vectors).size() == 3);
    const Eigen::MatrixX3d rows = Eigen::MatrixX3d::Zero(5, 3);
    IS_TRUE(kind_of([&] { Chain(rows, 0.5); }) == "bad_shape");
    IS_TRUE(kind_of([&] { Chain(Eigen::Matrix<double, 3, 5, Eigen::RowMajor>(), 0.5); }) ==
            "bad_shape");
    IS_TRUE(kind_of([&] { Chain(std::vector<double>{1, 2}, 0.5); }) == "bad_length");

    // Poses of every kind.
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Eigen::Vector3d(0, 0, 1));
    IS_TRUE(mesh.distance(robot, pose) == 2.5);
    IS_TRUE(mesh.distance(robot, pose.matrix()) == 2.5);
    IS_TRUE(mesh.distance(robot, Pose({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1})) == 2.5);

    // Moves, clones, and a mesh that moves.
    Mesh moved = std::move(mesh);
    Mesh clone = moved.clone();
    moved.set_vertices(std::vector<std::array<double, 3>>{{-9, -9, 1}, {9, -9, 1}, {0, 9, 1}});
    IS_TRUE(moved.distance(robot) == 0.5 && clone.distance(robot) == 1.5);
    IS_TRUE(kind_of([&] { mesh.distance(robot); }) == "null_pointer");
    clone.prepare();
    IS_TRUE(clone.surface().openings == 1 && !clone.surface().is_sound);

    // Questions that answers.cpp does not ask.
    std::vector<Minimum> links;
    clone.per_link(robot, links);
    IS_TRUE(links.size() == 2 && links[0].distance == 1.5);
    IS_TRUE(clone.link_sides(robot).size() == 2);
    IS_TRUE(clone.derivative(robot).value == 1.5 && clone.derivative(robot).radius == -1);
    const Tube tube(columns, 0.5);
    IS_TRUE(clone.clears_tube(tube, 1, 0.01) == Decision::Clear);
    const auto tubes = clone.clearance_batch({&tube, &tube}, 0.01);
    IS_TRUE(tubes.answers[1].lower == clone.clearance(tube, 0.01).lower && tubes.message.empty());
    IS_TRUE(clone.clears_tube_batch({&tube}, 1, 0.01).answers[0] == PC_CLEAR);
    IS_TRUE(clone.clears_batch({&robot, &robot}, 1, {Pose(), pose}).answers[1] == 1);
    Eigen::Isometry3d far = pose;
    far.translation().x() = 1e300;
    const auto refused = clone.clears_batch({&robot, &robot}, 1, {pose, far});
    IS_TRUE(refused.statuses[0] == PC_OK && refused.statuses[1] == PC_REFUSED);
    IS_TRUE(refused.message.find("robot 1: ") == 0);
    // A matrix that is no pose belongs to its robot, too.
    const Eigen::Matrix4d twice = 2 * Eigen::Matrix4d::Identity();
    const auto turned = clone.minimum_batch({&robot, &robot}, {pose, twice});
    IS_TRUE(turned.statuses[0] == PC_OK && turned.statuses[1] == PC_REFUSED);
    IS_TRUE(turned.answers[0].distance == 2.5 && std::isnan(turned.answers[1].distance));
    const auto linked = clone.per_link_batch({&robot, &robot, &robot}, {pose, twice, pose});
    IS_TRUE(linked.links[1].empty() && linked.links[2].size() == 2);
    IS_TRUE(linked.links[2][0].distance == 2.5 && linked.message.find("robot 1: ") == 0);
    IS_TRUE(kind_of([&] {
                clone.clears_sections_batch(flat, 2, 0.5, 4, 0);
            }) == "bad_length");
    IS_TRUE(kind_of([&] { clone.clears_batch({&robot, nullptr}, 1); }) == "null_pointer");
    IS_TRUE(kind_of([&] { clone.clears_batch({&robot}, -1); }) == "negative");

    // Motions.
    const Motion rigid = Motion::rigid(robot, Pose(), pose);
    IS_TRUE(clone.clears_motion(rigid, 1, 0.01).decision == Decision::Clear);
    const Motion moved_tube = Motion::rigid(tube, pose, Pose());
    IS_TRUE(clone.clears_motion(moved_tube, 1, 0.01).decision == Decision::Clear);
    const std::vector<double> straight{3, 0, 0}, bent{3, 0.1, 0};
    const Motion bending = Motion::bending(straight, bent, 0.2, pose);
    const Motion back = Motion::bending(bent, straight, 0.2, pose);
    const Motion path = Motion::path({&bending, &back});
    path.verify(20);
    const auto least = clone.clearance_of_motion(path, 0.01);
    IS_TRUE(least.lower <= 1 && 1 <= least.upper);
    IS_TRUE(clone.clearance_of_motion(Motion::moving_base(path, Pose(), pose), 0.01).resolved);
    const auto kept = clone.clears_motion_batch({&rigid, &path}, 0.5, 0.01);
    IS_TRUE(kept.answers[1].decision == Decision::Clear);
    IS_TRUE(clone.clears_motion_while(floor, rigid, 1, 0.01).decision == Decision::Clear);
    IS_TRUE(clone.clears_path({&robot, &robot}, 0, 1, 0.01).decision == Decision::Clear);
    IS_TRUE(kind_of([&] { Motion::path({}); }) == "no_motions");

    // Two robots, one and itself, several meshes.
    RobotPair pair;
    const Chain other(std::vector<double>{0, 5, 2, 2, 5, 2}, 0.5);
    IS_TRUE(pair.minimum(robot, other).distance == 4);
    IS_TRUE(pair.per_link(robot, other).size() == 2 && pair.clears(robot, other, 3.9));
    IS_TRUE(pair.contacts_within(robot, other, 4.5).size() >= 1);
    const Tube beside(std::vector<double>{0, 5, 2, 2, 5, 2}, 0.5);
    IS_TRUE(pair.clears_tubes(tube, beside, 3, 0.01) == Decision::Clear);
    IS_TRUE(pair.clearance(tube, beside, 0.01).upper <= 4.01);
    const Motion at_rest = Motion::rigid(other, Pose(), Pose());
    IS_TRUE(pair.clears_motions(rigid, at_rest, 3, 0.01).decision == Decision::Clear);
    IS_TRUE(pair.time_of_contact(rigid, at_rest, 5, 0.01).decision == Decision::Contact);
    IS_TRUE(pair.clearance_of_motion(rigid, at_rest, 0.01).upper >= 4);
    const auto nearest = pair.minimum_batch({&robot, &robot}, {&other, &other}, {}, {Pose(), pose});
    IS_TRUE(nearest.answers[0].distance == 4 && nearest.answers[1].distance == 4);
    const auto apart = pair.clears_motions_batch({&rigid}, {&at_rest}, 3, 0.01);
    IS_TRUE(apart.answers[0].decision == Decision::Clear);
    IS_TRUE(kind_of([&] { pair.clears_batch({&robot}, {}, 1); }) == "bad_length");
    SelfQuery alone;
    IS_TRUE(alone.minimum(robot).distance == INFINITY && alone.clears(robot, 1));
    IS_TRUE(alone.clears_tube(tube, 0.1, 0.01) == Decision::Clear);
    IS_TRUE(alone.clears_motion(rigid, 0.1, 0.01).decision == Decision::Clear);
    Scene scene(0.1);
    const std::size_t structure = scene.add("floor", clone, 1);
    IS_TRUE(scene.clears({&robot, &other}) && scene.tightest({&robot}).slack == 0.5);
    IS_TRUE(scene.per_structure({&robot})[0].nearest.distance == 1.5);
    IS_TRUE(!scene.contacts_within({&robot}, 2).empty());
    IS_TRUE(scene.clears_tube({&tube}, 0.01) == Decision::Clear);
    IS_TRUE(scene.clearance({&tube}, 0.01).upper <= 0.51);
    IS_TRUE(scene.clears_motion({&rigid}, 0.01).decision == Decision::Clear);
    IS_TRUE(scene.clearance_of_motion({&rigid}, 0.01).resolved);
    scene.set_margin(structure, 2);
    IS_TRUE(scene.time_of_contact({&rigid}, 0.01).decision == Decision::Contact);
    scene.set_pose(structure, pose);
    IS_TRUE(scene.tightest({&robot}).slack == -1.5);
    scene.set_vertices(structure, floor);
    scene.set_self_margin(none);
    scene.set_nested({{0, 1}});
    scene.prepare();
    IS_TRUE(scene.clears({&robot, &robot}, {Eigen::Isometry3d(pose * pose * pose), pose}) == false);
    scene.set_margin(structure, none);
    IS_TRUE(kind_of([&] { scene.set_solid(structure); }) == "not_solid");
    IS_TRUE(kind_of([&] { scene.add("floor", clone, 1); }) == "name_taken");
    IS_TRUE(kind_of([&] { scene.clears_batch({&robot}, 2); }) == "bad_length");
    const auto at = StructureEnd::pose(structure, pose.matrix());
    IS_TRUE(scene.clears_motion_while({at}, {&rigid}, 0.01).decision == Decision::Clear);

    // Files.
    IS_TRUE(kind_of([&] { Mesh::load("no such file.stl"); }) == "file");
    const std::string folder = argv[1];
    IS_TRUE(clone.prove(robot, 1, folder + "/robot.txt"));
    IS_TRUE(clone.prove_tube(tube, 1, 0.01, folder + "/tube.txt"));
    IS_TRUE(clone.prove_motion(rigid, 1, 0.01, folder + "/motion.txt"));
    IS_TRUE(Mesh::load(folder + "/robot.obj").distance(robot) == 1.5);
    return failures == 0 ? 0 : 1;
}
