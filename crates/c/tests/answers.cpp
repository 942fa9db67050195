// The answers of C++ to the cases of answers.rs: the same questions in the same order.
#include "parry_continuum.hpp"

#include "numbers.h"

#include <cstring>

using namespace continuum;

namespace {

constexpr double fine = 0.05;

double index_of(std::uint32_t index) { return index == PC_NONE ? NAN : index; }

template <class Found>
void put_place(const Found& found) {
    put_all(found.on_robot, 3);
    put_all(found.on_mesh, 3);
    put(found.arc_length);
    put(index_of(found.segment));
    put(index_of(found.triangle));
}

void put_minimum(const Minimum& found) {
    put(found.distance);
    put_place(found);
}

void put_contact(const Contact& found) {
    put(found.distance);
    put(found.depth);
    put(found.fraction);
    put_all(found.normal, 3);
    put_place(found);
}

void put_clearance(const Clearance& found) {
    put(found.lower);
    put(found.upper);
    put(found.uncertainty);
    put(found.t);
    put_place(found);
    put(found.resolved);
}

void put_motion(const MotionAnswer& found) {
    put(found.decision);
    put(found.reason);
    put_all(found.interval, 2);
    put(found.t);
    put(found.upper);
    put_place(found);
}

void put_scene_motion(const SceneMotionAnswer& found) {
    put(found.decision);
    put(found.reason);
    put_all(found.interval, 2);
    put(found.t);
    put(found.upper);
}

// Writes an answer, or NaN if it is refused.
template <class Ask>
void answer(Ask ask) {
    const std::size_t before = out_count;
    try {
        ask();
    } catch (const Error& error) {
        if (error.status() != PC_REFUSED || out_count != before) throw;
        put(NAN);
    }
}

void ask_everything(Mesh& mesh, RobotPair& pair, SelfQuery& alone, const Chain& robot,
                    const Pose& pose, Caps caps, Points start, Points end, const Radii& radii,
                    double margin, Points vertices) {
    answer([&] {
        const auto links = mesh.per_link(robot, pose);
        put(static_cast<double>(links.size()));
        for (const Minimum& link : links) put_minimum(link);
    });
    answer([&] {
        const auto contacts = mesh.contacts_within(robot, margin, 0, pose);
        put(static_cast<double>(contacts.size()));
        for (const Contact& contact : contacts) put_contact(contact);
    });
    const double* base = start.data();
    put(static_cast<double>(mesh.side({base[0], base[1], base[2]})));
    answer([&] {
        const auto inside = mesh.clears_inside(robot, margin, pose);
        put(inside.base);
        put(inside.tip);
        put(inside.clears);
        put(inside.crosses_opening);
        put(inside.holds);
    });
    answer([&] { put_clearance(mesh.clearance(Tube(start, radii), fine, pose)); });
    answer([&] {
        put(static_cast<double>(mesh.clears_tube(Tube(start, radii), margin, fine, pose)));
    });
    answer([&] {
        const Motion motion = Motion::linear(start, end, radii);
        answer([&] { put_motion(mesh.clears_motion(motion, margin, fine)); });
        answer([&] { put_motion(mesh.time_of_contact(motion, margin, fine)); });
        answer([&] { put_clearance(mesh.clearance_of_motion(motion, fine)); });
    });
    const Chain other(end, radii, caps);
    answer([&] {
        const auto near = pair.minimum(robot, other, pose);
        put(near.distance);
        put_all(near.on_first, 3);
        put_all(near.on_second, 3);
        put_all(near.arc_lengths, 2);
    });
    answer([&] { put(alone.minimum(robot).distance); });
    Scene scene(0.1);
    scene.add("wall", mesh, margin);
    answer([&] {
        const auto tightest = scene.tightest({&robot, &other}, {pose, Pose()});
        put(tightest.slack);
        put(index_of(tightest.place.structure));
    });
    scene.set_margin_between(0, 1, 0.5);
    put(scene.margin_between(0, 0));
    put(scene.margin_between(0, 1));
    answer([&] {
        scene.set_solid(0);
        put(1);
    });
    put(scene.is_solid(0));
    const std::vector<const Chain*> sets{&robot, &other, &other, &robot};
    const std::vector<Pose> set_poses{pose, Pose(), Pose(), pose};
    const auto clears = scene.clears_batch(sets, 2, set_poses);
    for (int k = 0; k < 2; ++k) put(clears.statuses[k] == PC_OK ? clears.answers[k] : NAN);
    const auto slacks = scene.tightest_batch(sets, 2, set_poses);
    for (int k = 0; k < 2; ++k) put(slacks.answers[k].slack);
    scene.set_margin_between(0, 1, none);
    answer([&] { put(scene.clears({&robot, &other}, {pose, Pose()})); });
    scene.set_robot_margin(none);
    answer([&] {
        const Motion motion = Motion::linear(start, end, radii);
        answer([&] {
            put_scene_motion(
                scene.clears_motion_while({StructureEnd::pose(0, pose)}, {&motion}, fine));
        });
        std::vector<double> grown(vertices.data(), vertices.data() + 3 * vertices.size());
        for (double& number : grown) number *= 1.25;
        answer([&] {
            put_scene_motion(
                scene.clears_motion_while({StructureEnd::vertices(0, grown)}, {&motion}, fine));
        });
        const auto twice = scene.clears_motion_batch({&motion, &motion}, 1, fine);
        for (int k = 0; k < 2; ++k)
            twice.statuses[k] == PC_OK ? put_scene_motion(twice.answers[k]) : put(NAN);
    });
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3 || pc_abi_version() != PC_ABI_VERSION) return 2;
    read_numbers(argv[1]);
    std::vector<Mesh> meshes;
    std::vector<Points> vertices;
    for (std::size_t left = count(); left > 0; --left) {
        const std::size_t vertex_count = count();
        const Points points(take(3 * vertex_count), vertex_count);
        vertices.push_back(points);
        std::vector<std::array<std::uint32_t, 3>> faces(count());
        for (auto& face : faces)
            for (auto& corner : face) corner = static_cast<std::uint32_t>(number());
        meshes.emplace_back(points, faces);
    }
    RobotPair pair;
    SelfQuery alone;
    std::vector<Chain> robots;
    std::vector<Pose> poses;
    for (std::size_t left = count(); left > 0; --left) {
        const std::size_t place = count();
        Mesh& mesh = meshes[place];
        const Caps caps = static_cast<Caps>(count());
        const double margin = number();
        const bool everything = number() != 0;
        std::array<double, 16> rows;
        std::memcpy(rows.data(), take(16), sizeof rows);
        const Pose pose(rows);
        const std::size_t points = count();
        const Points start(take(3 * points), points), end(take(3 * points), points);
        const Radii radii(take(points - 1), points - 1);
        answer([&] {
            Chain robot(start, radii, caps);
            answer([&] { put_minimum(mesh.minimum(robot, pose)); });
            answer([&] { put(mesh.clears(robot, margin, pose)); });
            if (everything)
                ask_everything(mesh, pair, alone, robot, pose, caps, start, end, radii, margin,
                               vertices[place]);
            if (&mesh == &meshes.back()) {
                robots.push_back(std::move(robot));
                poses.push_back(pose);
            }
        });
    }
    std::vector<const Chain*> all;
    for (const Chain& robot : robots) all.push_back(&robot);
    const auto batch = meshes.back().minimum_batch(all, poses);
    for (std::size_t k = 0; k < all.size(); ++k)
        batch.statuses[k] == PC_OK ? put_minimum(batch.answers[k]) : put(NAN);
    const auto links = meshes.back().per_link_batch(all, poses);
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (links.statuses[k] != PC_OK) put(NAN);
        for (const Minimum& link : links.links[k]) put_minimum(link);
    }
    const std::vector<const Chain*> shifted(all.begin(), all.end() - 1);
    const auto apart = pair.clears_batch(shifted, shifted, 0.5, {poses.begin(), poses.end() - 1},
                                         {poses.begin() + 1, poses.end()});
    for (std::size_t k = 0; k < apart.answers.size(); ++k)
        put(apart.statuses[k] == PC_OK ? apart.answers[k] : NAN);
    std::vector<double> sections;
    for (int k = 0; k < 1000; ++k)
        for (const double number :
             {k % 97 == 96 ? NAN : 2 + 0.5 * (k % 10), 0.0625 * (k % 7), -0.03125 * (k % 5), 2.0,
              0.5 - 0.125 * (k % 11), 0.25 * (k % 3)})
            sections.push_back(number);
    const auto bent = meshes.back().clears_sections_batch(
        sections, 2, std::vector<double>{0.3, 0.2}, 5, 0.1);
    for (std::size_t k = 0; k < bent.answers.size(); ++k)
        put(bent.statuses[k] == PC_OK ? bent.answers[k] : NAN);
    write_numbers(argv[2]);
}
