/// A GNSS receiver as a sensor of a game engine or a simulator: what a plugin does with skyloop.h. C++17, no engine.
///
/// The engine calls step() from its physics tick, at a fixed step, with the simulated time (never from the render tick,
/// never with the wall clock), and look_around() once a second with a function that casts a ray.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <skyloop.h>

namespace engine_example {

/// What skyloop wants to know of a vehicle: north, east, down; the quaternion turns forward, right, down into them.
struct Pose {
    std::array<double, 3> ned_m{}, velocity_ned_mps{};
    std::array<double, 4> q_nb{1, 0, 0, 0};  ///< w, x, y, z
};

/// The Hamilton product of two quaternions w, x, y, z.
inline std::array<double, 4> product(const std::array<double, 4>& a, const std::array<double, 4>& b) {
    return {
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

/// Gazebo and ROS: the world's axes are east, north, up, the body's forward, left, up; metres.
inline Pose pose_of_gazebo(const std::array<double, 3>& at, const std::array<double, 3>& velocity,
                           const std::array<double, 4>& q) {
    const double half = std::sqrt(0.5);
    return {{at[1], at[0], -at[2]},
            {velocity[1], velocity[0], -velocity[2]},
            product(product({0, half, half, 0}, q), {0, 1, 0, 0})};
}

/// How an Unreal level lies on the Earth: its axes are left-handed, centimetres, Z up.
enum class UnrealNorth {
    along_x,   ///< X north, Y east (AirSim)
    against_y  ///< X east, Y south (GeoReferencing, Cesium, CARLA)
};

/// An Unreal actor: location, velocity (cm/s) and rotation as FQuat has it, in the order w, x, y, z.
inline Pose pose_of_unreal(UnrealNorth north, const std::array<double, 3>& at, const std::array<double, 3>& velocity,
                           const std::array<double, 4>& q) {
    const auto turned = [&](const std::array<double, 3>& v) -> std::array<double, 3> {
        if (north == UnrealNorth::along_x) return {v[0] / 100, v[1] / 100, -v[2] / 100};
        return {-v[1] / 100, v[0] / 100, -v[2] / 100};
    };
    const std::array<double, 4> mirrored{q[0], -q[1], -q[2], q[3]};
    const double half = std::sqrt(0.5);
    const std::array<double, 4> east_first{half, 0, 0, half};  // a quarter turn about down
    return {turned(at), turned(velocity), north == UnrealNorth::along_x ? mirrored : product(east_first, mirrored)};
}

/// The sensor. Not for several threads; several sensors in several threads are well.
class GnssSensor {
public:
    /// @param origin_lla of the level: degrees, metres above the ellipsoid  @param start_ns simulated time now
    GnssSensor(const std::string& scenario_toml, const std::array<double, 3>& origin_lla, std::int64_t start_ns) {
        std::array<char, 512> why{};
        sky_create_info info{};
        info.struct_size = sizeof info;
        info.abi_major = SKY_ABI_MAJOR;
        info.set = SKY_CREATE_ORIGIN;
        info.scenario_text = scenario_toml.c_str();
        info.start_sim_ns = start_ns;
        std::memcpy(info.origin_lla, origin_lla.data(), sizeof info.origin_lla);
        info.error = why.data();
        info.error_capacity = why.size();
        if (sky_create(&info, &emulator_) != SKY_OK) throw std::runtime_error(why.data());
    }
    ~GnssSensor() { sky_destroy(emulator_); }
    GnssSensor(const GnssSensor&) = delete;
    GnssSensor& operator=(const GnssSensor&) = delete;

    /// One step of the physics. @return what has left the receiver's first port in it: for the autopilot's UART
    const std::vector<std::uint8_t>& step(std::int64_t sim_time_ns, const Pose& pose, bool teleported = false) {
        sky_truth truth{};
        truth.struct_size = sizeof truth;
        truth.fields = SKY_POS_LOCAL_NED | SKY_VEL | SKY_ATT | (teleported ? std::uint32_t{SKY_RESET} : 0U);
        truth.sim_time_ns = sim_time_ns;
        std::memcpy(truth.pos, pose.ned_m.data(), sizeof truth.pos);
        std::memcpy(truth.vel_ned, pose.velocity_ned_mps.data(), sizeof truth.vel_ned);
        std::memcpy(truth.q_nb, pose.q_nb.data(), sizeof truth.q_nb);
        checked(sky_set_truth(emulator_, &truth));
        checked(sky_advance(emulator_, sim_time_ns, nullptr));
        sent_.clear();
        std::array<std::uint8_t, 1024> piece{};
        while (const auto count = checked(sky_read(emulator_, 0, piece.data(), piece.size())))
            sent_.insert(sent_.end(), piece.begin(), piece.begin() + count);
        return sent_;
    }

    /// What the autopilot has written to the receiver.
    void hear(const std::uint8_t* bytes, std::size_t size) { checked(sky_write(emulator_, 0, bytes, size)); }

    /// Casts one ray to each satellite. @param is_free of a direction north, east, down from the antenna
    /// @return how many satellites are hidden
    template <class IsFree>
    int look_around(const IsFree& is_free) {
        std::array<sky_sat, 128> satellites{};
        const auto count =
            checked(sky_get_sats(emulator_, 0, satellites.data(), satellites.size(), sizeof satellites[0]));
        std::vector<sky_los> seen;
        int hidden = 0;
        for (std::int64_t i = 0; i < count && i < static_cast<std::int64_t>(satellites.size()); ++i) {
            const sky_sat& one = satellites[static_cast<std::size_t>(i)];
            sky_los los{};
            los.gnss_id = one.gnss_id;
            los.sv_id = one.sv_id;
            los.state = is_free(one.los_ned) ? SKY_LOS_CLEAR : SKY_LOS_BLOCKED;
            hidden += los.state == SKY_LOS_BLOCKED ? 1 : 0;
            seen.push_back(los);
        }
        checked(sky_set_los(emulator_, 0, seen.data(), seen.size(), sizeof(sky_los)));
        return hidden;
    }

    /// What the receiver reported last, for a display.
    sky_fix fix() {
        sky_fix fix{};
        fix.struct_size = sizeof fix;
        checked(sky_get_fix(emulator_, 0, &fix));
        return fix;
    }

private:
    std::int64_t checked(std::int64_t status) {
        if (status >= 0) return status;
        std::array<char, 512> sentence{};
        sky_last_error(emulator_, sentence.data(), sentence.size());
        throw std::runtime_error(sentence.data());
    }

    sky_emulator* emulator_ = nullptr;
    std::vector<std::uint8_t> sent_;
};

}  // namespace engine_example
