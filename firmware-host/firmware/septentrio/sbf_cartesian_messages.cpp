#include "firmware/septentrio/sbf_messages.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/geo/local_frame.hpp"
#include "firmware/output_only/other_protocols.hpp"

namespace skyloop::firmware {
namespace {

Eigen::Vector3d along_axes(const NavigationState& state, double east, double north, double up) {
    return LocalFrame(state.epoch.fix.position).to_ecef(Displacement<Enu>(east, north, up)).vector();
}

// Where in a covariance of SBF an element of three rows stands, and what lies in the fourth.
constexpr int element_at[3][3] = {{0, 4, 5}, {4, 1, 7}, {5, 7, 2}};
constexpr int clock_at = 3, with_clock_at[3] = {6, 8, 9};

// North, east, up as x, y, z; nothing where one of them is unknown.
SbfCovariance turned(const SbfCovariance& geodetic, const NavigationState& state) {
    const auto nothing = static_cast<float>(sbf_nothing);
    Eigen::Matrix3d local, axes;
    Eigen::Vector3d local_with_clock;
    for (int row = 0; row < 3; ++row) {
        local_with_clock(row) = geodetic[static_cast<std::size_t>(with_clock_at[row])];
        for (int column = 0; column < 3; ++column) {
            const float element = geodetic[static_cast<std::size_t>(element_at[row][column])];
            if (element == nothing) return no_sbf_covariance;
            local(row, column) = element;
        }
    }
    axes.col(0) = along_axes(state, 0, 1, 0);
    axes.col(1) = along_axes(state, 1, 0, 0);
    axes.col(2) = along_axes(state, 0, 0, 1);
    const Eigen::Matrix3d result = axes * local * axes.transpose();
    const Eigen::Vector3d with_clock = axes * local_with_clock;
    SbfCovariance cartesian = no_sbf_covariance;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            cartesian[static_cast<std::size_t>(element_at[row][column])] = static_cast<float>(result(row, column));
        const auto index = static_cast<std::size_t>(with_clock_at[row]);
        // Added to 0, which stays without a sign.
        cartesian[index] = geodetic[clock_at] == nothing ? nothing : 0 + static_cast<float>(with_clock(row));
    }
    cartesian[clock_at] = geodetic[clock_at];
    return cartesian;
}

}  // namespace

SbfPosCovCartesian sbf_position_covariance_cartesian(const NavigationState& state) {
    const SbfPosCovGeodetic from = sbf_position_covariance(state);
    return {from.time, from.mode, from.error, turned(from.covariance, state)};
}

SbfVelCovCartesian sbf_velocity_covariance_cartesian(const NavigationState& state) {
    const SbfVelCovGeodetic from = sbf_velocity_covariance(state);
    return {from.time, from.mode, from.error, turned(from.covariance, state)};
}

SbfBaseVectorCart sbf_base_vector_cartesian(const NavigationState& state) {
    const SbfBaseVectorGeod from = sbf_base_vector(state);
    SbfBaseVectorCart block;
    block.time = from.time;
    for (const SbfBaseVector& line : from.bases) {
        const Eigen::Vector3d delta = along_axes(state, line.delta_east, line.delta_north, line.delta_up);
        SbfBaseVectorXyz base;
        base.num_sv = line.num_sv;
        base.error = line.error;
        base.mode = line.mode;
        base.misc = line.misc;
        base.delta_x = delta.x();
        base.delta_y = delta.y();
        base.delta_z = delta.z();
        if (line.vel_east != static_cast<float>(sbf_nothing)) {
            const Eigen::Vector3d speed =
                along_axes(state, static_cast<double>(line.vel_east), static_cast<double>(line.vel_north),
                           static_cast<double>(line.vel_up));
            base.vel_x.set(speed.x());
            base.vel_y.set(speed.y());
            base.vel_z.set(speed.z());
        }
        base.azimuth = line.azimuth;
        base.elevation = line.elevation;
        base.reference_id = line.reference_id;
        base.corr_age = line.corr_age;
        base.signal_info = line.signal_info;
        block.bases.push_back(base);
    }
    return block;
}

SbfSatVisibility sbf_visible_satellites(const NavigationState& state) {
    constexpr std::uint8_t by_almanac = 1, by_ephemeris = 2;
    auto block = sbf_block<SbfSatVisibility>(state);
    for (const SatelliteStatus& satellite : state.epoch.fix.satellites) {
        const auto svid = sbf_svid(satellite.id);
        if (!svid || satellite.elevation.deg() < 0 || !direction_known(satellite, state)) continue;
        SbfVisibleSatellite visible;
        visible.svid = *svid;
        visible.freq_nr = sbf_frequency_number(satellite.id, state.epoch.observations);
        visible.azimuth = static_cast<std::uint16_t>(std::lround((satellite.azimuth.deg() + 360) * 100) % 36000);
        visible.elevation.set(satellite.elevation.deg());
        visible.known_by = satellite.has_ephemeris ? by_ephemeris : by_almanac;
        block.satellites.push_back(visible);
    }
    return block;
}

}  // namespace skyloop::firmware
