// A planner of OMPL's for a tendon robot of two sections, with proven edges.
//
// A state is the length and the curvature of each section. `Validity` asks about a shape, `Edges`
// proves a margin for the whole motion between two shapes. Beside it OMPL's own validator, which
// asks at steps of 1 %: how many of the edges that it accepts touch?
#include "vessel.hpp"

#include <ompl/base/DiscreteMotionValidator.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/RandomNumbers.h>

#include <cstdio>
#include <cstdlib>

namespace ob = ompl::base;
namespace og = ompl::geometric;
using namespace continuum;

constexpr double radius = 0.5, margin = 0.1, resolution = 0.01;

/// Length, curvature towards x and towards y of each section.
using Sections = std::array<std::array<double, 3>, 2>;

static Sections sections(const ob::State* state) {
    const double* x = state->as<ob::RealVectorStateSpace::StateType>()->values;
    return {{{x[0], x[1], x[2]}, {x[3], x[4], x[5]}}};
}

static Motion motion(const ob::State* start, const ob::State* end) {
    const Sections from = sections(start), to = sections(end);
    return Motion::bending(Points(from[0].data(), 2), Points(to[0].data(), 2), radius);
}

class Validity : public ob::StateValidityChecker {
public:
    Validity(const ob::SpaceInformationPtr& space, Mesh& mesh)
        : ob::StateValidityChecker(space), mesh_(mesh) {}
    bool isValid(const ob::State* state) const override {
        // A motion that rests is the shape itself, as a smooth curve.
        const MotionAnswer found = mesh_.clears_motion(motion(state, state), margin, resolution);
        return si_->satisfiesBounds(state) && found.decision == Decision::Clear;
    }

private:
    Mesh& mesh_;
};

class Edges : public ob::MotionValidator {
public:
    Edges(const ob::SpaceInformationPtr& space, Mesh& mesh)
        : ob::MotionValidator(space), mesh_(mesh) {}
    bool checkMotion(const ob::State* start, const ob::State* end) const override {
        const bool clears =
            mesh_.clears_motion(motion(start, end), margin, resolution).decision == Decision::Clear;
        ++(clears ? valid_ : invalid_);
        return clears;
    }
    bool checkMotion(const ob::State* start, const ob::State* end,
                     std::pair<ob::State*, double>& last) const override {
        const MotionAnswer found = mesh_.time_of_contact(motion(start, end), margin, resolution);
        if (found.decision == Decision::Clear)
            return true;
        // The margin is kept until here.
        last.second = found.interval[0];
        if (last.first != nullptr)
            si_->getStateSpace()->interpolate(start, end, last.second, last.first);
        return false;
    }

private:
    Mesh& mesh_;
};

int main() {
    ompl::msg::setLogLevel(ompl::msg::LOG_WARN);
    ompl::RNG::setSeed(69);
    // A vessel with thin strings across it, such as chordae or trabeculae.
    Triangles walls = vessel(9, 50, 40, 40);
    for (int k = 0; k < 5; ++k)
        walls.add_rod({k % 2 ? -1.5 : 2.0, -9.5, 12.0 + 6 * k},
                      {k % 2 ? 2.5 : -2.0, 9.5, 12.0 + 6 * k}, 0.05);
    Mesh mesh = walls.mesh();

    auto space = std::make_shared<ob::RealVectorStateSpace>(6);
    ob::RealVectorBounds bounds(6);
    for (int section = 0; section < 2; ++section) {
        bounds.setLow(3 * section, 4);
        bounds.setHigh(3 * section, 18);
        for (int k = 1; k < 3; ++k) {
            bounds.setLow(3 * section + k, -0.06);
            bounds.setHigh(3 * section + k, 0.06);
        }
    }
    space->setBounds(bounds);
    // Curvatures count as much as lengths.
    og::SimpleSetup setup(space);
    const auto& information = setup.getSpaceInformation();
    information->setStateValidityChecker(std::make_shared<Validity>(information, mesh));
    information->setStateValidityCheckingResolution(0.01);
    information->setMotionValidator(std::make_shared<Edges>(information, mesh));

    ob::ScopedState<> start(space), goal(space);
    const double first[] = {4, 0, 0, 4, 0, 0}, last[] = {17, 0.02, 0.02, 17, 0.0, -0.02};
    for (int k = 0; k < 6; ++k) {
        start[k] = first[k];
        goal[k] = last[k];
    }
    setup.setStartAndGoalStates(start, goal);
    setup.setPlanner(std::make_shared<og::RRTConnect>(information));
    setup.setup();
    const bool is_solved = setup.solve(20.0) == ob::PlannerStatus::EXACT_SOLUTION;
    const auto states = is_solved ? setup.getSolutionPath().getStateCount() : 0;
    std::printf("RRT-Connect: %s, %zu states, each edge proven\n",
                is_solved ? "solved" : "not solved", states);

    // The same random edges for both validators.
    const ob::DiscreteMotionValidator discrete(information.get());
    auto* a = information->allocState();
    auto* b = information->allocState();
    const auto sampler = information->allocValidStateSampler();
    int accepted = 0, touch = 0, proven = 0, undecided = 0, refused_wrongly = 0;
    for (int edge = 0; edge < 2000; ++edge) {
        if (!sampler->sample(a) || !sampler->sampleNear(b, a, 4.0))
            continue;
        const Motion edge_motion = motion(a, b);
        const MotionAnswer found = mesh.clears_motion(edge_motion, 0, resolution);
        const bool keeps =
            mesh.clears_motion(edge_motion, margin, resolution).decision == Decision::Clear;
        const bool accepts = discrete.checkMotion(a, b);
        accepted += accepts;
        proven += keeps;
        touch += accepts && found.decision == Decision::Contact;
        undecided += accepts && found.decision == Decision::Undecided;
        refused_wrongly += keeps && !accepts;
    }
    information->freeState(a);
    information->freeState(b);
    std::printf("OMPL's validator at 1 %% accepts %d edges: %d touch, %d come within %.2f\n",
                accepted, touch, undecided, resolution);
    std::printf("clears_motion accepts %d, each proven; OMPL refuses %d of them\n", proven,
                refused_wrongly);
    return is_solved && refused_wrongly == 0 ? 0 : 1;
}
