// The same distances by FCL and by parry-continuum: capsules and cylinders near one mesh.
#include "vessel.hpp"

#include <fcl/fcl.h>

#include <algorithm>
#include <cstdio>
#include <random>

int main() {
    using namespace continuum;
    const Triangles walls = vessel(8, 60, 40, 40);
    Mesh mesh = walls.mesh();
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    model->beginModel();
    for (const auto& face : walls.faces) {
        fcl::Vector3d corners[3];
        for (int k = 0; k < 3; ++k)
            corners[k] = fcl::Vector3d(walls.vertices[face[k]].data());
        model->addTriangle(corners[0], corners[1], corners[2]);
    }
    model->endModel();
    fcl::CollisionObjectd wall(model);

    std::mt19937 random(69);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::printf("shape      FCL        here       difference\n");
    double worst[2] = {0, 0};
    for (int k = 0; k < 200; ++k) {
        const bool is_cylinder = k % 2 == 1;
        const double radius = 0.5 + 0.2 * unit(random), length = 4;
        const Eigen::Vector3d centre(3 * unit(random), 3 * unit(random), 20 + 10 * unit(random));
        const Eigen::Vector3d axis =
            Eigen::Vector3d(unit(random), unit(random), unit(random)).normalized();
        // Here: a robot of one link.
        Eigen::Matrix3Xd points(3, 2);
        points << centre - length / 2 * axis, centre + length / 2 * axis;
        const Chain robot(points, radius, is_cylinder ? Caps::Cylinders : Caps::Capsules);
        const double here = mesh.distance(robot);
        // FCL: a shape along z, and a transform.
        std::shared_ptr<fcl::CollisionGeometryd> shape;
        if (is_cylinder)
            shape = std::make_shared<fcl::Cylinderd>(radius, length);
        else
            shape = std::make_shared<fcl::Capsuled>(radius, length);
        fcl::Transform3d place = fcl::Transform3d::Identity();
        place.linear() =
            Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
        place.translation() = centre;
        fcl::CollisionObjectd object(shape, place);
        fcl::DistanceRequestd request;
        fcl::DistanceResultd result;
        const double theirs = std::max(0.0, fcl::distance(&object, &wall, request, result));
        const double difference = theirs - here;
        worst[is_cylinder] = std::max(worst[is_cylinder], std::abs(difference));
        if (k < 10)
            std::printf("%-9s  %.7f  %.7f  %+.1e\n", is_cylinder ? "cylinder" : "capsule", theirs,
                        here, difference);
    }
    std::printf("largest difference of 100 each: capsules %.1e, cylinders %.1e\n", worst[0],
                worst[1]);
    // FCL iterates: its answers are near the exact ones, not equal.
    return worst[0] < 0.05 && worst[1] < 0.05 ? 0 : 1;
}
