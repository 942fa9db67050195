// A vessel for the examples: a tube of triangles around the z axis that bends and narrows.
#pragma once

#include "parry_continuum.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

struct Triangles {
    std::vector<std::array<double, 3>> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;

    continuum::Mesh mesh() const { return continuum::Mesh(vertices, faces); }

    /// A thin rod from `start` to `end`: a triangular prism without ends.
    void add_rod(const std::array<double, 3>& start, const std::array<double, 3>& end,
                 double thickness) {
        const std::uint32_t first = static_cast<std::uint32_t>(vertices.size());
        for (const auto& place : {start, end})
            for (int corner = 0; corner < 3; ++corner) {
                const double angle = 2.0943951023931953 * corner;
                vertices.push_back({place[0] + thickness * std::cos(angle), place[1],
                                    place[2] + thickness * std::sin(angle)});
            }
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t next = (k + 1) % 3;
            faces.push_back({first + k, first + next, first + 3 + k});
            faces.push_back({first + next, first + 3 + next, first + 3 + k});
        }
    }
};

inline Triangles vessel(double radius, double length, std::uint32_t around, std::uint32_t along) {
    Triangles made;
    for (std::uint32_t ring = 0; ring <= along; ++ring)
        for (std::uint32_t k = 0; k < around; ++k) {
            const double s = static_cast<double>(ring) / along;
            const double angle = 6.283185307179586 * k / around;
            const double here = radius * (1 + 0.15 * std::sin(9 * s) + 0.05 * std::cos(5 * angle));
            made.vertices.push_back({here * std::cos(angle) + 6 * s * s, here * std::sin(angle),
                                     length * s - 0.1 * length});
        }
    for (std::uint32_t ring = 0; ring < along; ++ring)
        for (std::uint32_t k = 0; k < around; ++k) {
            const std::uint32_t a = ring * around + k, b = ring * around + (k + 1) % around;
            made.faces.push_back({a, b, a + around});
            made.faces.push_back({b, b + around, a + around});
        }
    return made;
}
