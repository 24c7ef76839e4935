/// A vehicle drives north along a wall in a small engine of its own; the receiver sees only the western half of the
/// sky.
#include <cstdio>
#include <exception>

#include "gnss_sensor.hpp"

int main() {
    using namespace engine_example;
    try {
        const std::int64_t step_ns = 10'000'000;  // physics at 100 Hz
        GnssSensor sensor("[run]\nstart = 2026-03-01T12:00:00Z\nseed = 3\n", {46.4774, 30.7326, 77}, 0);
        std::size_t bytes = 0;
        int hidden = 0;
        for (std::int64_t now = 0; now <= 20'000'000'000; now += step_ns) {
            // As Unreal would say it: X north, Y east, centimetres; 5 m/s to the north.
            const double north_cm = 500e-9 * static_cast<double>(now);
            const Pose pose = pose_of_unreal(UnrealNorth::along_x, {north_cm, 0, 150}, {500, 0, 0}, {1, 0, 0, 0});
            bytes += sensor.step(now, pose).size();
            if (now % 1'000'000'000 == 0)
                hidden = sensor.look_around([](const float* direction_ned) { return direction_ned[1] <= 0; });
        }
        const sky_fix fix = sensor.fix();
        std::printf("%zu bytes, fix %d with %d satellites, %d hidden by the wall\n", bytes, fix.type,
                    fix.satellites_used, hidden);
        return bytes > 0 && hidden > 0 ? 0 : 1;
    } catch (const std::exception& refused) {
        std::fprintf(stderr, "engine_demo: %s\n", refused.what());
        return 1;
    }
}
