// A control loop of 1 kHz that allocates nothing: distance, closest link, margin and tube of a
// robot that bends, in the memory that it has. `control_loop SECONDS`.
#include "vessel.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#ifdef __GLIBC__
// Counts what everything in this program allocates, the library included.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}
static long allocations = 0;
extern "C" void* malloc(std::size_t size) { return ++allocations, __libc_malloc(size); }
extern "C" void* calloc(std::size_t count, std::size_t size) {
    return ++allocations, __libc_calloc(count, size);
}
extern "C" void* realloc(void* memory, std::size_t size) {
    return ++allocations, __libc_realloc(memory, size);
}
extern "C" int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
    ++allocations;
    *memory = __libc_memalign(alignment, size);
    return *memory == nullptr;
}
#else
static long allocations = 0;
#endif

int main(int argc, char** argv) {
    using namespace continuum;
    using Clock = std::chrono::steady_clock;
    const int ticks = static_cast<int>(1000 * (argc > 1 ? std::atof(argv[1]) : 2.0));
    constexpr int links = 30;

    Mesh mesh = vessel(8, 60, 100, 100).mesh();
    mesh.prepare();
    std::vector<std::array<double, 3>> points(links + 1);
    const auto bend = [&](int tick) {
        const double curvature = 0.01 * std::sin(0.002 * tick);
        for (int k = 0; k <= links; ++k) {
            const double s = 50.0 * k / links, angle = curvature * s;
            const double half = angle == 0 ? 1 : std::sin(angle / 2) / (angle / 2);
            points[k] = {s * half * std::sin(angle / 2), 0, s * half * std::cos(angle / 2)};
        }
    };
    bend(0);
    Chain robot(points, 0.8);
    Tube tube(points, 0.8);
    std::vector<Minimum> per_link(links);
    std::vector<double> times(ticks);
    double least = INFINITY;
    int clear = 0;

    const auto step = [&](int tick) {
        bend(tick);
        robot.set(points, 0.8);
        tube.set(points, 0.8);
        const Minimum closest = mesh.minimum(robot);
        mesh.per_link(robot, per_link);
        clear += mesh.clears(robot, 1.0);
        clear += mesh.clears_tube(tube, 1.0, 0.01) == Decision::Clear;
        least = std::min(least, closest.distance);
    };

    // One swing, from one bend to the other and back, fills the memory that the handles keep.
    for (int tick = 0; tick < 3142; ++tick)
        step(tick);
    clear = 0;
    least = INFINITY;
    const long before = allocations;
    auto next = Clock::now();
    for (int tick = 0; tick < ticks; ++tick) {
        next += std::chrono::milliseconds(1);
        const auto start = Clock::now();
        step(tick);
        times[tick] = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
        std::this_thread::sleep_until(next);
    }
    const long allocated = allocations - before;

    std::sort(times.begin(), times.end());
    std::printf("%d ticks, least distance %.3f, %d margins kept\n", ticks, least, clear);
    std::printf("a tick takes %.1f us (p50), %.1f us (p99.9), %.1f us (worst)\n", times[ticks / 2],
                times[ticks * 999 / 1000], times.back());
    std::printf("%ld allocations\n", allocated);
    return allocated == 0 ? 0 : 1;
}
