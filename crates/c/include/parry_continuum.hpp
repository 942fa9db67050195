// parry-continuum for C++17: exact proximity queries between continuum robots and triangle meshes.
//
// Header only, over parry_continuum.h. Every class owns one handle and can be moved, not copied.
// What the library refuses is thrown as `continuum::Error`, with the library's text. The verbs and
// the fields of the answers are those of C, Rust and Python.

#ifndef PARRY_CONTINUUM_HPP
#define PARRY_CONTINUUM_HPP

#include "parry_continuum.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace continuum {

using Minimum = pc_minimum;
using Contact = pc_contact;
using Derivative = pc_derivative;
using InsideAnswer = pc_inside_answer;
using Clearance = pc_clearance;
using MotionAnswer = pc_motion_answer;
using RobotProximity = pc_robot_proximity;
using RobotClearance = pc_robot_clearance;
using RobotMotionAnswer = pc_robot_motion_answer;
using StructureProximity = pc_structure_proximity;
using SceneContact = pc_scene_contact;
using Tightest = pc_tightest;
using SceneClearance = pc_scene_clearance_answer;
using SceneMotionAnswer = pc_scene_motion_answer;
using Surface = pc_surface;

enum class Decision { Contact = PC_CONTACT, Undecided = PC_UNDECIDED, Clear = PC_CLEAR };
// Answers of motions and of batches have the numbers of C: `found.decision == Decision::Clear`.
constexpr bool operator==(pc_decision number, Decision decision) noexcept {
    return number == static_cast<pc_decision>(decision);
}
constexpr bool operator!=(pc_decision number, Decision decision) noexcept {
    return !(number == decision);
}
enum class Side { Inside = PC_INSIDE, Undecided = PC_UNDECIDED_SIDE, Outside = PC_OUTSIDE };
enum class Caps : std::uint32_t {
    Fitted = PC_CAPS_FITTED,
    Capsules = PC_CAPS_CAPSULES,
    Cylinders = PC_CAPS_CYLINDERS
};
enum class Frame : std::uint32_t {
    Unknown = PC_FRAME_UNKNOWN,
    Ras = PC_FRAME_RAS,
    Lps = PC_FRAME_LPS
};

/// A margin that is not set, or an angle that is not known.
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// What the library refuses. `what()` says what to change.
class Error : public std::runtime_error {
public:
    Error(pc_status status, const char* kind, const char* text, std::int64_t robot)
        : std::runtime_error(text), status_(status), kind_(kind), robot_(robot) {}
    pc_status status() const noexcept { return status_; }
    /// Such as "point_not_finite"; it stays the same where a text becomes clearer.
    const std::string& kind() const noexcept { return kind_; }
    /// The robot or motion of a batch, or -1.
    std::int64_t robot() const noexcept { return robot_; }

private:
    pc_status status_;
    std::string kind_;
    std::int64_t robot_;
};

inline void check(pc_status status) {
    if (status != PC_OK)
        throw Error(status, pc_error_kind(), pc_error_message(), pc_error_robot());
}

namespace detail {

template <class T, void (*Free)(T*)>
struct Deleter {
    void operator()(T* handle) const noexcept { Free(handle); }
};

template <class T, void (*Free)(T*)>
using Handle = std::unique_ptr<T, Deleter<T, Free>>;

/// Whether a type is a dense matrix as of Eigen, with columns one after another.
template <class M, class = void>
struct IsMatrix : std::false_type {};
template <class M>
struct IsMatrix<M, std::void_t<decltype(std::declval<const M&>().outerStride()),
                               decltype(std::declval<const M&>().innerStride()),
                               std::enable_if_t<std::is_same_v<
                                   decltype(std::declval<const M&>().data()), const double*>>>>
    : std::true_type {};

/// The raw handles of objects, for a call about several.
template <class T>
auto raw(const std::vector<const T*>& objects) {
    std::vector<decltype(std::declval<const T&>().get())> handles;
    handles.reserve(objects.size());
    for (const T* object : objects)
        handles.push_back(object == nullptr ? nullptr : object->get());
    return handles;
}

}  // namespace detail

/// Points without a copy: a vector of points (`std::array<double, 3>`, `Eigen::Vector3d`), a vector
/// of 3 N numbers, a pointer and a count, or a 3 x N matrix of Eigen's.
class Points {
public:
    Points(const double* data, std::size_t count) : data_(data), count_(count) {}
    Points(const std::vector<std::array<double, 3>>& points)
        : data_(points.empty() ? nullptr : points.front().data()), count_(points.size()) {}
    /// Points of another type with `data()`, such as `Eigen::Vector3d`.
    template <class Point,
              std::enable_if_t<sizeof(Point) == 3 * sizeof(double) &&
                                   std::is_same_v<decltype(std::declval<const Point&>().data()),
                                                  const double*>,
                               int> = 0>
    Points(const std::vector<Point>& points)
        : data_(points.empty() ? nullptr : points.front().data()), count_(points.size()) {}
    Points(const std::vector<double>& numbers) : data_(numbers.data()), count_(numbers.size() / 3) {
        if (numbers.size() % 3 != 0)
            throw Error(PC_BAD_ARGUMENT, "bad_length", "points have three numbers each", -1);
    }
    template <class Matrix, std::enable_if_t<detail::IsMatrix<Matrix>::value, int> = 0>
    Points(const Matrix& matrix)
        : data_(matrix.data()), count_(static_cast<std::size_t>(matrix.cols())) {
        if (matrix.rows() != 3 || Matrix::IsRowMajor || matrix.innerStride() != 1 ||
            (matrix.cols() > 1 && matrix.outerStride() != 3))
            throw Error(PC_BAD_ARGUMENT, "bad_shape",
                        "a matrix of points is 3 x N and column-major, without gaps", -1);
    }
    const double* data() const noexcept { return data_; }
    std::size_t size() const noexcept { return count_; }

private:
    const double* data_;
    std::size_t count_;
};

/// One radius for all segments, or one for each.
class Radii {
public:
    Radii(double radius) : radius_(radius) {}
    Radii(const double* data, std::size_t count) : data_(data), count_(count) {}
    Radii(const std::vector<double>& radii) : Radii(radii.data(), radii.size()) {}
    template <class Matrix, std::enable_if_t<detail::IsMatrix<Matrix>::value, int> = 0>
    Radii(const Matrix& radii) : Radii(radii.data(), static_cast<std::size_t>(radii.size())) {
        if (radii.innerStride() != 1 || (radii.rows() != 1 && radii.cols() != 1))
            throw Error(PC_BAD_ARGUMENT, "bad_shape", "radii are a vector without gaps", -1);
    }
    const double* data() const noexcept { return count_ == 0 && !data_ ? &radius_ : data_; }
    std::size_t size() const noexcept { return count_ == 0 && !data_ ? 1 : count_; }

private:
    double radius_ = 0;
    const double* data_ = nullptr;
    std::size_t count_ = 0;
};

/// From the robot's frame to the mesh's: the identity, the rows of a 4x4 matrix, or what has
/// `matrix()(row, column)`, such as `Eigen::Isometry3d` and `Eigen::Matrix4d`.
class Pose {
public:
    Pose() = default;
    Pose(const std::array<double, 16>& rows) : rows_(rows), is_identity_(false) {}
    template <class M, class = decltype(std::declval<const M&>().matrix()(0, 0))>
    Pose(const M& pose) : is_identity_(false) {
        const auto& matrix = pose.matrix();
        if (matrix.rows() != 4 || matrix.cols() != 4)
            throw Error(PC_BAD_ARGUMENT, "bad_shape", "a pose is a 4 x 4 matrix", -1);
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                rows_[4 * row + column] = matrix(row, column);
    }
    const double* data() const noexcept { return is_identity_ ? nullptr : rows_.data(); }
    const std::array<double, 16>& rows() const noexcept { return rows_; }

private:
    std::array<double, 16> rows_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    bool is_identity_ = true;
};

namespace detail {

/// The matrices of poses: none, or one for each of `count` robots.
inline std::vector<double> matrices(const std::vector<Pose>& poses, std::size_t count) {
    if (!poses.empty() && poses.size() != count)
        throw Error(PC_BAD_ARGUMENT, "bad_length", "give no poses, or one for each robot", -1);
    std::vector<double> numbers;
    numbers.reserve(16 * poses.size());
    for (const Pose& pose : poses)
        numbers.insert(numbers.end(), pose.rows().begin(), pose.rows().end());
    return numbers;
}

inline const double* or_null(const std::vector<double>& numbers) {
    return numbers.empty() ? nullptr : numbers.data();
}

}  // namespace detail

/// A robot of straight links.
class Chain {
public:
    Chain(Points points, const Radii& radii, Caps caps = Caps::Fitted) {
        pc_chain* made = nullptr;
        check(pc_chain_new(points.data(), points.size(), radii.data(), radii.size(),
                           static_cast<std::uint32_t>(caps), &made));
        handle_.reset(made);
    }
    /// Other points and radii, in the memory that it has.
    void set(Points points, const Radii& radii) {
        check(pc_chain_set(handle_.get(), points.data(), points.size(), radii.data(),
                           radii.size()));
    }
    const pc_chain* get() const noexcept { return handle_.get(); }

private:
    detail::Handle<pc_chain, pc_chain_free> handle_;
};

/// A robot with a smooth centreline. `tangents` are none, 2 or one for each point.
class Tube {
public:
    Tube(Points points, const Radii& radii, Points tangents = {nullptr, 0}, double deviation = 0,
         double turn = none) {
        pc_tube* made = nullptr;
        check(pc_tube_new(points.data(), points.size(), radii.data(), radii.size(),
                          tangents.data(), tangents.size(), deviation, turn, &made));
        handle_.reset(made);
    }
    /// Other points and radii, and no or two end tangents, in the memory that it has.
    void set(Points points, const Radii& radii, Points end_tangents = {nullptr, 0}) {
        if (end_tangents.size() != 0 && end_tangents.size() != 2)
            throw Error(PC_BAD_ARGUMENT, "bad_length", "give no end tangents, or two", -1);
        check(pc_tube_set(handle_.get(), points.data(), points.size(), radii.data(), radii.size(),
                          end_tangents.size() == 0 ? nullptr : end_tangents.data()));
    }
    const pc_tube* get() const noexcept { return handle_.get(); }

private:
    detail::Handle<pc_tube, pc_tube_free> handle_;
};

/// A robot that changes with time, from 0 to 1.
class Motion {
public:
    /// Every point moves straight and evenly.
    static Motion linear(Points start, Points end, const Radii& radii, Caps caps = Caps::Fitted) {
        if (start.size() != end.size())
            throw Error(PC_BAD_ARGUMENT, "bad_length", "`start` and `end` have other sizes", -1);
        return made([&](pc_motion** motion) {
            return pc_motion_linear(start.data(), end.data(), start.size(), radii.data(),
                                    radii.size(), static_cast<std::uint32_t>(caps), motion);
        });
    }
    /// A robot keeps its shape and turns the lesser way.
    static Motion rigid(const Chain& robot, const Pose& start, const Pose& end) {
        return made([&](pc_motion** motion) {
            return pc_motion_rigid(robot.get(), start.data(), end.data(), motion);
        });
    }
    static Motion rigid(const Tube& tube, const Pose& start, const Pose& end) {
        return made([&](pc_motion** motion) {
            return pc_motion_rigid_tube(tube.get(), start.data(), end.data(), motion);
        });
    }
    /// Sections of constant curvature: length, curvature towards x and towards y of each.
    static Motion bending(Points start, Points end, const Radii& radii, const Pose& pose = {}) {
        if (start.size() != end.size())
            throw Error(PC_BAD_ARGUMENT, "bad_length", "`start` and `end` have other sizes", -1);
        return made([&](pc_motion** motion) {
            return pc_motion_bending(start.data(), end.data(), start.size(), radii.data(),
                                     radii.size(), pose.data(), motion);
        });
    }
    /// The base of a motion moves at the same time.
    static Motion moving_base(const Motion& moved, const Pose& start, const Pose& end) {
        return made([&](pc_motion** motion) {
            return pc_motion_moving_base(moved.get(), start.data(), end.data(), motion);
        });
    }
    /// Several, one after another.
    static Motion path(const std::vector<const Motion*>& motions) {
        const auto handles = detail::raw(motions);
        return made([&](pc_motion** motion) {
            return pc_motion_path(handles.data(), handles.size(), motion);
        });
    }
    /// Throws if the motion is faster than it states, at one of `steps` times.
    void verify(std::uint32_t steps) const { check(pc_motion_verify(handle_.get(), steps)); }
    const pc_motion* get() const noexcept { return handle_.get(); }

private:
    explicit Motion(pc_motion* handle) : handle_(handle) {}
    template <class Make>
    static Motion made(Make make) {
        pc_motion* motion = nullptr;
        check(make(&motion));
        return Motion(motion);
    }
    detail::Handle<pc_motion, pc_motion_free> handle_;
};

/// The answers of a batch. The answer of a refused item is NaN or 0, and its status is not `PC_OK`.
template <class Answer>
struct Batch {
    std::vector<Answer> answers;
    std::vector<pc_status> statuses;
    /// The message of the first refused item, or empty.
    std::string message;
};

namespace detail {

/// Asks about `count` items. Items that are refused have their own status; what concerns all is
/// thrown.
template <class Answer, class Ask>
Batch<Answer> batch(std::size_t count, Ask ask) {
    Batch<Answer> found;
    found.answers.resize(count);
    found.statuses.assign(count, PC_OK);
    const pc_status status = ask(found.answers.data(), found.statuses.data());
    if (status != PC_OK && (status != PC_REFUSED || pc_error_robot() < 0))
        check(status);
    if (status != PC_OK)
        found.message = pc_error_message();
    return found;
}

/// The same about robots at poses.
template <class Answer, class Robot, class Ask>
Batch<Answer> batch(const std::vector<const Robot*>& robots, const std::vector<Pose>& poses,
                    Ask ask) {
    const auto handles = raw(robots);
    const auto numbers = matrices(poses, robots.size());
    return batch<Answer>(robots.size(), [&](auto answers, auto statuses) {
        return ask(handles.data(), or_null(numbers), answers, statuses);
    });
}

/// Refuses two lists that belong together and have other sizes.
inline void check_sizes(std::size_t one, std::size_t other, const char* text) {
    if (one != other)
        throw Error(PC_BAD_ARGUMENT, "bad_length", text, -1);
}

}  // namespace detail

/// The links of the robots of a batch. A refused robot has none, and its status is not `PC_OK`.
struct LinksBatch {
    std::vector<std::vector<pc_minimum>> links;
    std::vector<pc_status> statuses;
    /// The message of the first refused robot, or empty.
    std::string message;
};

/// A triangle mesh that is asked how near robots are to it. Each thread needs its own `clone`.
class Mesh {
public:
    /// Triangles are three indices of vertices each.
    Mesh(Points vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles)
        : Mesh(vertices, triangles.empty() ? nullptr : triangles.front().data(),
               triangles.size()) {}
    Mesh(Points vertices, const std::uint32_t* triangles, std::size_t triangle_count) {
        pc_mesh* made = nullptr;
        check(pc_mesh_new(vertices.data(), vertices.size(), triangles, triangle_count, &made));
        handle_.reset(made);
    }
    static Mesh load(const std::string& path, std::int64_t label = -1, double scale = 1,
                     Frame frame = Frame::Unknown) {
        pc_mesh* made = nullptr;
        check(pc_mesh_load(path.c_str(), label, scale, static_cast<std::uint32_t>(frame), &made));
        return Mesh(made);
    }
    Mesh clone() const {
        pc_mesh* made = nullptr;
        check(pc_mesh_clone(handle_.get(), &made));
        return Mesh(made);
    }
    void set_vertices(Points vertices) {
        check(pc_mesh_set_vertices(handle_.get(), vertices.data(), vertices.size()));
    }
    /// Builds all that later questions need.
    void prepare() const { check(pc_mesh_prepare(handle_.get())); }
    Surface surface() const {
        Surface found;
        check(pc_mesh_surface(handle_.get(), &found));
        return found;
    }

    Minimum minimum(const Chain& robot, const Pose& pose = {}) {
        Minimum found;
        check(pc_mesh_minimum(handle_.get(), robot.get(), pose.data(), &found));
        return found;
    }
    double distance(const Chain& robot, const Pose& pose = {}) {
        return minimum(robot, pose).distance;
    }
    bool clears(const Chain& robot, double margin, const Pose& pose = {}) {
        bool found;
        check(pc_mesh_clears(handle_.get(), robot.get(), pose.data(), margin, &found));
        return found;
    }
    /// Replaces the items of `links`, so that a loop allocates nothing.
    void per_link(const Chain& robot, std::vector<Minimum>& links, const Pose& pose = {}) {
        const Minimum* found;
        std::size_t count;
        check(pc_mesh_per_link(handle_.get(), robot.get(), pose.data(), &found, &count));
        links.assign(found, found + count);
    }
    std::vector<Minimum> per_link(const Chain& robot, const Pose& pose = {}) {
        std::vector<Minimum> links;
        per_link(robot, links, pose);
        return links;
    }
    void contacts_within(const Chain& robot, double margin, std::vector<Contact>& contacts,
                         double prominence = 0, const Pose& pose = {}) {
        const Contact* found;
        std::size_t count;
        check(pc_mesh_contacts_within(handle_.get(), robot.get(), pose.data(), margin, prominence,
                                      &found, &count));
        contacts.assign(found, found + count);
    }
    std::vector<Contact> contacts_within(const Chain& robot, double margin, double prominence = 0,
                                         const Pose& pose = {}) {
        std::vector<Contact> contacts;
        contacts_within(robot, margin, contacts, prominence, pose);
        return contacts;
    }
    Derivative derivative(const Chain& robot, const Pose& pose = {}) {
        Derivative found;
        check(pc_mesh_derivative(handle_.get(), robot.get(), pose.data(), &found));
        return found;
    }
    Side side(const std::array<double, 3>& point) const {
        pc_side found;
        check(pc_mesh_side(handle_.get(), point.data(), 1, &found));
        return static_cast<Side>(found);
    }
    std::vector<Side> link_sides(const Chain& robot, const Pose& pose = {}) {
        const pc_side* found;
        std::size_t count;
        check(pc_mesh_link_sides(handle_.get(), robot.get(), pose.data(), &found, &count));
        std::vector<Side> sides;
        for (std::size_t k = 0; k < count; ++k)
            sides.push_back(static_cast<Side>(found[k]));
        return sides;
    }
    InsideAnswer clears_inside(const Chain& robot, double margin, const Pose& pose = {}) {
        InsideAnswer found;
        check(pc_mesh_clears_inside(handle_.get(), robot.get(), pose.data(), margin, &found));
        return found;
    }

    Clearance clearance(const Tube& tube, double tolerance, const Pose& pose = {}) {
        Clearance found;
        check(pc_mesh_clearance(handle_.get(), tube.get(), pose.data(), tolerance, &found));
        return found;
    }
    Decision clears_tube(const Tube& tube, double margin, double resolution,
                         const Pose& pose = {}) {
        pc_decision found;
        check(pc_mesh_clears_tube(handle_.get(), tube.get(), pose.data(), margin, resolution,
                                  &found));
        return static_cast<Decision>(found);
    }
    MotionAnswer clears_motion(const Motion& motion, double margin, double resolution) {
        MotionAnswer found;
        check(pc_mesh_clears_motion(handle_.get(), motion.get(), margin, resolution, &found));
        return found;
    }
    MotionAnswer time_of_contact(const Motion& motion, double margin, double resolution) {
        MotionAnswer found;
        check(pc_mesh_time_of_contact(handle_.get(), motion.get(), margin, resolution, &found));
        return found;
    }
    Clearance clearance_of_motion(const Motion& motion, double tolerance) {
        Clearance found;
        check(pc_mesh_clearance_of_motion(handle_.get(), motion.get(), tolerance, &found));
        return found;
    }
    /// While the vertices move to `vertices`.
    MotionAnswer clears_motion_while(Points vertices, const Motion& motion, double margin,
                                     double resolution) {
        MotionAnswer found;
        check(pc_mesh_clears_motion_while(handle_.get(), vertices.data(), vertices.size(),
                                          motion.get(), margin, resolution, &found));
        return found;
    }
    MotionAnswer clears_path(const std::vector<const Chain*>& shapes, double deviation,
                             double margin, double resolution) {
        MotionAnswer found;
        const auto handles = detail::raw(shapes);
        check(pc_mesh_clears_path(handle_.get(), handles.data(), handles.size(), deviation, margin,
                                  resolution, &found));
        return found;
    }

    Batch<Minimum> minimum_batch(const std::vector<const Chain*>& robots,
                                 const std::vector<Pose>& poses = {}) {
        return detail::batch<Minimum>(
            robots, poses, [&](auto handles, auto numbers, auto answers, auto statuses) {
                return pc_mesh_minimum_batch(handle_.get(), handles, numbers, robots.size(),
                                             answers, statuses);
            });
    }
    /// The items of `answers` are 0 or 1.
    Batch<std::uint8_t> clears_batch(const std::vector<const Chain*>& robots, double margin,
                                     const std::vector<Pose>& poses = {}) {
        static_assert(sizeof(bool) == 1, "a bool of C is a byte");
        return detail::batch<std::uint8_t>(
            robots, poses, [&](auto handles, auto numbers, auto answers, auto statuses) {
                return pc_mesh_clears_batch(handle_.get(), handles, numbers, robots.size(), margin,
                                            reinterpret_cast<bool*>(answers), statuses);
            });
    }
    /// Each link of each robot.
    LinksBatch per_link_batch(const std::vector<const Chain*>& robots,
                              const std::vector<Pose>& poses = {}) {
        const Minimum* links = nullptr;
        const std::size_t* firsts = nullptr;
        auto found = detail::batch<char>(
            robots, poses, [&](auto handles, auto numbers, auto, auto statuses) {
                return pc_mesh_per_link_batch(handle_.get(), handles, numbers, robots.size(),
                                              &links, &firsts, statuses);
            });
        LinksBatch answer{{}, std::move(found.statuses), std::move(found.message)};
        for (std::size_t k = 0; k < robots.size(); ++k)
            answer.links.emplace_back(links + firsts[k], links + firsts[k + 1]);
        return answer;
    }
    /// Robots of sections of constant curvature, `section_count` each and one after another:
    /// length, curvature towards x and towards y. A section becomes `segments` straight links. The
    /// items of `answers` are 0 or 1.
    Batch<std::uint8_t> clears_sections_batch(Points sections, std::size_t section_count,
                                              const Radii& radii, std::size_t segments,
                                              double margin, const Pose& pose = {}) {
        const std::size_t count = section_count == 0 ? 0 : sections.size() / section_count;
        detail::check_sizes(count * section_count, sections.size(),
                            "`sections` are no multiple of `section_count`");
        return detail::batch<std::uint8_t>(
            count, [&](auto answers, auto statuses) {
                return pc_mesh_clears_sections_batch(handle_.get(), sections.data(), section_count,
                                                     radii.data(), radii.size(), count, segments,
                                                     pose.data(), margin,
                                                     reinterpret_cast<bool*>(answers), statuses);
            });
    }
    Batch<Clearance> clearance_batch(const std::vector<const Tube*>& tubes, double tolerance,
                                     const std::vector<Pose>& poses = {}) {
        return detail::batch<Clearance>(
            tubes, poses, [&](auto handles, auto numbers, auto answers, auto statuses) {
                return pc_mesh_clearance_batch(handle_.get(), handles, numbers, tubes.size(),
                                               tolerance, answers, statuses);
            });
    }
    /// The items of `answers` compare with `Decision`.
    Batch<pc_decision> clears_tube_batch(const std::vector<const Tube*>& tubes, double margin,
                                         double resolution, const std::vector<Pose>& poses = {}) {
        return detail::batch<pc_decision>(
            tubes, poses, [&](auto handles, auto numbers, auto answers, auto statuses) {
                return pc_mesh_clears_tube_batch(handle_.get(), handles, numbers, tubes.size(),
                                                 margin, resolution, answers, statuses);
            });
    }
    Batch<MotionAnswer> clears_motion_batch(const std::vector<const Motion*>& motions,
                                            double margin, double resolution) {
        return detail::batch<MotionAnswer>(
            motions, {}, [&](auto handles, auto, auto answers, auto statuses) {
                return pc_mesh_clears_motion_batch(handle_.get(), handles, motions.size(), margin,
                                                   resolution, answers, statuses);
            });
    }

    /// Writes a proof to `path`, and the mesh beside it. False if the margin is not kept.
    bool prove(const Chain& robot, double margin, const std::string& path, const Pose& pose = {}) {
        bool proven;
        check(pc_mesh_prove(handle_.get(), robot.get(), pose.data(), margin, path.c_str(),
                            &proven));
        return proven;
    }
    bool prove_tube(const Tube& tube, double margin, double resolution, const std::string& path,
                    const Pose& pose = {}) {
        bool proven;
        check(pc_mesh_prove_tube(handle_.get(), tube.get(), pose.data(), margin, resolution,
                                 path.c_str(), &proven));
        return proven;
    }
    bool prove_motion(const Motion& motion, double margin, double resolution,
                      const std::string& path) {
        bool proven;
        check(pc_mesh_prove_motion(handle_.get(), motion.get(), margin, resolution, path.c_str(),
                                   &proven));
        return proven;
    }
    const pc_mesh* get() const noexcept { return handle_.get(); }

private:
    explicit Mesh(pc_mesh* handle) : handle_(handle) {}
    detail::Handle<pc_mesh, pc_mesh_free> handle_;
};

/// Questions about two robots.
class RobotPair {
public:
    RobotPair() {
        pc_pair* made = nullptr;
        check(pc_pair_new(&made));
        handle_.reset(made);
    }
    RobotProximity minimum(const Chain& robot_a, const Chain& robot_b, const Pose& pose_a = {},
                           const Pose& pose_b = {}) {
        RobotProximity found;
        check(pc_pair_minimum(handle_.get(), robot_a.get(), pose_a.data(), robot_b.get(),
                              pose_b.data(), &found));
        return found;
    }
    std::vector<RobotProximity> per_link(const Chain& robot_a, const Chain& robot_b,
                                         const Pose& pose_a = {}, const Pose& pose_b = {}) {
        const RobotProximity* found;
        std::size_t count;
        check(pc_pair_per_link(handle_.get(), robot_a.get(), pose_a.data(), robot_b.get(),
                               pose_b.data(), &found, &count));
        return {found, found + count};
    }
    std::vector<RobotProximity> contacts_within(const Chain& robot_a, const Chain& robot_b,
                                                double margin, const Pose& pose_a = {},
                                                const Pose& pose_b = {}) {
        const RobotProximity* found;
        std::size_t count;
        check(pc_pair_contacts_within(handle_.get(), robot_a.get(), pose_a.data(), robot_b.get(),
                                      pose_b.data(), margin, &found, &count));
        return {found, found + count};
    }
    bool clears(const Chain& robot_a, const Chain& robot_b, double margin, const Pose& pose_a = {},
                const Pose& pose_b = {}) {
        bool found;
        check(pc_pair_clears(handle_.get(), robot_a.get(), pose_a.data(), robot_b.get(),
                             pose_b.data(), margin, &found));
        return found;
    }
    RobotClearance clearance(const Tube& tube_a, const Tube& tube_b, double tolerance,
                             const Pose& pose_a = {}, const Pose& pose_b = {}) {
        RobotClearance found;
        check(pc_pair_clearance(handle_.get(), tube_a.get(), pose_a.data(), tube_b.get(),
                                pose_b.data(), tolerance, &found));
        return found;
    }
    Decision clears_tubes(const Tube& tube_a, const Tube& tube_b, double margin, double resolution,
                          const Pose& pose_a = {}, const Pose& pose_b = {}) {
        pc_decision found;
        check(pc_pair_clears_tubes(handle_.get(), tube_a.get(), pose_a.data(), tube_b.get(),
                                   pose_b.data(), margin, resolution, &found));
        return static_cast<Decision>(found);
    }
    RobotMotionAnswer clears_motions(const Motion& motion_a, const Motion& motion_b, double margin,
                                     double resolution) {
        RobotMotionAnswer found;
        check(pc_pair_clears_motions(handle_.get(), motion_a.get(), motion_b.get(), margin,
                                     resolution, &found));
        return found;
    }
    RobotMotionAnswer time_of_contact(const Motion& motion_a, const Motion& motion_b,
                                      double margin, double resolution) {
        RobotMotionAnswer found;
        check(pc_pair_time_of_contact(handle_.get(), motion_a.get(), motion_b.get(), margin,
                                      resolution, &found));
        return found;
    }
    RobotClearance clearance_of_motion(const Motion& motion_a, const Motion& motion_b,
                                       double tolerance) {
        RobotClearance found;
        check(pc_pair_clearance_of_motion(handle_.get(), motion_a.get(), motion_b.get(), tolerance,
                                          &found));
        return found;
    }

    Batch<RobotProximity> minimum_batch(const std::vector<const Chain*>& robots_a,
                                        const std::vector<const Chain*>& robots_b,
                                        const std::vector<Pose>& poses_a = {},
                                        const std::vector<Pose>& poses_b = {}) const {
        return batch<RobotProximity>(robots_a, robots_b, poses_a, poses_b, pc_pair_minimum_batch);
    }
    /// The items of `answers` are 0 or 1.
    Batch<std::uint8_t> clears_batch(const std::vector<const Chain*>& robots_a,
                                     const std::vector<const Chain*>& robots_b, double margin,
                                     const std::vector<Pose>& poses_a = {},
                                     const std::vector<Pose>& poses_b = {}) const {
        return batch<std::uint8_t>(
            robots_a, robots_b, poses_a, poses_b,
            [margin](auto pair, auto a, auto at_a, auto b, auto at_b, auto count, auto answers,
                     auto statuses) {
                return pc_pair_clears_batch(pair, a, at_a, b, at_b, count, margin,
                                            reinterpret_cast<bool*>(answers), statuses);
            });
    }
    Batch<RobotMotionAnswer> clears_motions_batch(const std::vector<const Motion*>& motions_a,
                                                  const std::vector<const Motion*>& motions_b,
                                                  double margin, double resolution) const {
        detail::check_sizes(motions_a.size(), motions_b.size(), "give as many motions twice");
        const auto a = detail::raw(motions_a);
        const auto b = detail::raw(motions_b);
        return detail::batch<RobotMotionAnswer>(
            a.size(), [&](auto answers, auto statuses) {
                return pc_pair_clears_motions_batch(handle_.get(), a.data(), b.data(), a.size(),
                                                    margin, resolution, answers, statuses);
            });
    }

private:
    template <class Answer, class Ask>
    Batch<Answer> batch(const std::vector<const Chain*>& robots_a,
                        const std::vector<const Chain*>& robots_b,
                        const std::vector<Pose>& poses_a, const std::vector<Pose>& poses_b,
                        Ask ask) const {
        detail::check_sizes(robots_a.size(), robots_b.size(), "give as many robots twice");
        const auto a = detail::raw(robots_a);
        const auto b = detail::raw(robots_b);
        const auto at_a = detail::matrices(poses_a, a.size());
        const auto at_b = detail::matrices(poses_b, b.size());
        return detail::batch<Answer>(
            a.size(), [&](auto answers, auto statuses) {
                return ask(handle_.get(), a.data(), detail::or_null(at_a), b.data(),
                           detail::or_null(at_b), a.size(), answers, statuses);
            });
    }
    detail::Handle<pc_pair, pc_pair_free> handle_;
};

/// Questions about one robot and itself.
class SelfQuery {
public:
    SelfQuery() {
        pc_self_query* made = nullptr;
        check(pc_self_query_new(&made));
        handle_.reset(made);
    }
    /// The distance is infinite if no two parts could meet.
    RobotProximity minimum(const Chain& robot) {
        RobotProximity found;
        check(pc_self_query_minimum(handle_.get(), robot.get(), &found));
        return found;
    }
    bool clears(const Chain& robot, double margin) {
        bool found;
        check(pc_self_query_clears(handle_.get(), robot.get(), margin, &found));
        return found;
    }
    Decision clears_tube(const Tube& tube, double margin, double resolution) {
        pc_decision found;
        check(pc_self_query_clears_tube(handle_.get(), tube.get(), margin, resolution, &found));
        return static_cast<Decision>(found);
    }
    RobotMotionAnswer clears_motion(const Motion& motion, double margin, double resolution) {
        RobotMotionAnswer found;
        check(pc_self_query_clears_motion(handle_.get(), motion.get(), margin, resolution,
                                          &found));
        return found;
    }

private:
    detail::Handle<pc_self_query, pc_self_query_free> handle_;
};

/// Where a structure of a scene is at the end of a motion.
class StructureEnd {
public:
    /// It moves as a whole.
    static StructureEnd pose(std::size_t structure, const Pose& pose) {
        return {pose, {structure, nullptr, nullptr, 0}, true};
    }
    /// Its vertices move. They are not copied.
    static StructureEnd vertices(std::size_t structure, Points vertices) {
        return {{}, {structure, nullptr, vertices.data(), vertices.size()}, false};
    }
    /// Valid as long as this object.
    pc_structure_end get() const noexcept {
        pc_structure_end end = end_;
        end.pose = has_pose_ ? pose_.rows().data() : nullptr;
        return end;
    }

private:
    StructureEnd(const Pose& pose, pc_structure_end end, bool has_pose)
        : pose_(pose), end_(end), has_pose_(has_pose) {}
    Pose pose_;
    pc_structure_end end_;
    bool has_pose_;
};

/// Several meshes, each with its margin or `none`, and several robots.
class Scene {
public:
    using Chains = std::vector<const Chain*>;
    using Tubes = std::vector<const Tube*>;
    using Motions = std::vector<const Motion*>;

    explicit Scene(double robot_margin = none, double self_margin = none) {
        pc_scene* made = nullptr;
        check(pc_scene_new(robot_margin, self_margin, &made));
        handle_.reset(made);
    }
    std::size_t add(const std::string& name, const Mesh& mesh, double margin,
                    const Pose& pose = {}) {
        std::size_t structure;
        check(pc_scene_add(handle_.get(), name.c_str(), mesh.get(), margin, pose.data(),
                           &structure));
        return structure;
    }
    void set_margin(std::size_t structure, double margin) {
        check(pc_scene_set_margin(handle_.get(), structure, margin));
    }
    /// Between a structure and one robot, by its place in the lists of robots, or `none`.
    double margin_between(std::size_t structure, std::size_t robot) const {
        double margin;
        check(pc_scene_margin_between(handle_.get(), structure, robot, &margin));
        return margin;
    }
    void set_margin_between(std::size_t structure, std::size_t robot, double margin) {
        check(pc_scene_set_margin_between(handle_.get(), structure, robot, margin));
    }
    void set_robot_margin(double margin) {
        check(pc_scene_set_robot_margin(handle_.get(), margin));
    }
    void set_self_margin(double margin) {
        check(pc_scene_set_self_margin(handle_.get(), margin));
    }
    /// Pairs of robots of which one is inside the other.
    void set_nested(const std::vector<std::array<std::size_t, 2>>& pairs) {
        check(pc_scene_set_nested(handle_.get(), pairs.empty() ? nullptr : pairs.front().data(),
                                  pairs.size()));
    }
    bool is_solid(std::size_t structure) const {
        bool solid;
        check(pc_scene_is_solid(handle_.get(), structure, &solid));
        return solid;
    }
    /// A robot inside of a solid structure is in contact with it.
    void set_solid(std::size_t structure, bool is_solid = true) {
        check(pc_scene_set_solid(handle_.get(), structure, is_solid));
    }
    /// Builds all that later questions need.
    void prepare() const { check(pc_scene_prepare(handle_.get())); }
    void set_pose(std::size_t structure, const Pose& pose) {
        check(pc_scene_set_pose(handle_.get(), structure, pose.data()));
    }
    void set_vertices(std::size_t structure, Points vertices) {
        check(pc_scene_set_vertices(handle_.get(), structure, vertices.data(), vertices.size()));
    }
    bool clears(const Chains& robots, const std::vector<Pose>& poses = {}) {
        const auto handles = detail::raw(robots);
        const auto numbers = detail::matrices(poses, robots.size());
        bool found;
        check(pc_scene_clears(handle_.get(), handles.data(), detail::or_null(numbers),
                              handles.size(), &found));
        return found;
    }
    Tightest tightest(const Chains& robots, const std::vector<Pose>& poses = {}) {
        const auto handles = detail::raw(robots);
        const auto numbers = detail::matrices(poses, robots.size());
        Tightest found;
        check(pc_scene_tightest(handle_.get(), handles.data(), detail::or_null(numbers),
                                handles.size(), &found));
        return found;
    }
    std::vector<StructureProximity> per_structure(const Chains& robots,
                                                  const std::vector<Pose>& poses = {}) {
        const auto handles = detail::raw(robots);
        const auto numbers = detail::matrices(poses, robots.size());
        const StructureProximity* found;
        std::size_t count;
        check(pc_scene_per_structure(handle_.get(), handles.data(), detail::or_null(numbers),
                                     handles.size(), &found, &count));
        return {found, found + count};
    }
    std::vector<SceneContact> contacts_within(const Chains& robots, double reach,
                                              double prominence = 0,
                                              const std::vector<Pose>& poses = {}) {
        const auto handles = detail::raw(robots);
        const auto numbers = detail::matrices(poses, robots.size());
        const SceneContact* found;
        std::size_t count;
        check(pc_scene_contacts_within(handle_.get(), handles.data(), detail::or_null(numbers),
                                       handles.size(), reach, prominence, &found, &count));
        return {found, found + count};
    }
    Decision clears_tube(const Tubes& tubes, double resolution,
                         const std::vector<Pose>& poses = {}) {
        const auto handles = detail::raw(tubes);
        const auto numbers = detail::matrices(poses, tubes.size());
        pc_decision found;
        check(pc_scene_clears_tube(handle_.get(), handles.data(), detail::or_null(numbers),
                                   handles.size(), resolution, &found));
        return static_cast<Decision>(found);
    }
    SceneClearance clearance(const Tubes& tubes, double tolerance,
                             const std::vector<Pose>& poses = {}) {
        const auto handles = detail::raw(tubes);
        const auto numbers = detail::matrices(poses, tubes.size());
        SceneClearance found;
        check(pc_scene_clearance(handle_.get(), handles.data(), detail::or_null(numbers),
                                 handles.size(), tolerance, &found));
        return found;
    }
    SceneMotionAnswer clears_motion(const Motions& motions, double resolution) {
        const auto handles = detail::raw(motions);
        SceneMotionAnswer found;
        check(pc_scene_clears_motion(handle_.get(), handles.data(), handles.size(), resolution,
                                     &found));
        return found;
    }
    /// While structures move, too.
    SceneMotionAnswer clears_motion_while(const std::vector<StructureEnd>& ends,
                                          const Motions& motions, double resolution) {
        std::vector<pc_structure_end> raw_ends;
        for (const StructureEnd& end : ends)
            raw_ends.push_back(end.get());
        const auto handles = detail::raw(motions);
        SceneMotionAnswer found;
        check(pc_scene_clears_motion_while(handle_.get(), raw_ends.data(), raw_ends.size(),
                                           handles.data(), handles.size(), resolution, &found));
        return found;
    }
    SceneMotionAnswer time_of_contact(const Motions& motions, double resolution) {
        const auto handles = detail::raw(motions);
        SceneMotionAnswer found;
        check(pc_scene_time_of_contact(handle_.get(), handles.data(), handles.size(), resolution,
                                       &found));
        return found;
    }
    SceneClearance clearance_of_motion(const Motions& motions, double tolerance) {
        const auto handles = detail::raw(motions);
        SceneClearance found;
        check(pc_scene_clearance_of_motion(handle_.get(), handles.data(), handles.size(),
                                           tolerance, &found));
        return found;
    }

    /// Sets of `robot_count` robots, one after another. The items of `answers` are 0 or 1.
    Batch<std::uint8_t> clears_batch(const Chains& robots, std::size_t robot_count,
                                     const std::vector<Pose>& poses = {}) const {
        return batch<std::uint8_t>(robots, robot_count, poses, [&](auto handles, auto numbers,
                                                                   auto count, auto answers,
                                                                   auto statuses) {
            return pc_scene_clears_batch(handle_.get(), handles, numbers, robot_count, count,
                                         reinterpret_cast<bool*>(answers), statuses);
        });
    }
    Batch<Tightest> tightest_batch(const Chains& robots, std::size_t robot_count,
                                   const std::vector<Pose>& poses = {}) const {
        return batch<Tightest>(robots, robot_count, poses, [&](auto handles, auto numbers,
                                                               auto count, auto answers,
                                                               auto statuses) {
            return pc_scene_tightest_batch(handle_.get(), handles, numbers, robot_count, count,
                                           answers, statuses);
        });
    }
    Batch<SceneMotionAnswer> clears_motion_batch(const Motions& motions, std::size_t robot_count,
                                                 double resolution) const {
        return batch<SceneMotionAnswer>(motions, robot_count, {}, [&](auto handles, auto,
                                                                      auto count, auto answers,
                                                                      auto statuses) {
            return pc_scene_clears_motion_batch(handle_.get(), handles, robot_count, count,
                                                resolution, answers, statuses);
        });
    }

private:
    template <class Answer, class Robot, class Ask>
    static Batch<Answer> batch(const std::vector<const Robot*>& robots, std::size_t robot_count,
                               const std::vector<Pose>& poses, Ask ask) {
        const std::size_t count = robot_count == 0 ? 0 : robots.size() / robot_count;
        detail::check_sizes(count * robot_count, robots.size(),
                            "the robots are no multiple of `robot_count`");
        const auto handles = detail::raw(robots);
        const auto numbers = detail::matrices(poses, robots.size());
        return detail::batch<Answer>(
            count, [&](auto answers, auto statuses) {
                return ask(handles.data(), detail::or_null(numbers), count, answers, statuses);
            });
    }
    detail::Handle<pc_scene, pc_scene_free> handle_;
};

}  // namespace continuum

#endif  // PARRY_CONTINUUM_HPP
