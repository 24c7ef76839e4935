/// Scenario texts for tests, and what the reader says of them.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "run/scenario/scenario_file.hpp"

namespace skyloop::test {

/// Reads a text that must be a scenario without a mistake.
inline Scenario scenario_of(std::string_view text) {
    const auto scenario = read_scenario(text, "folder/test.toml");
    EXPECT_TRUE(scenario) << scenario.error().message;
    return scenario ? *scenario : Scenario{};
}

/// What the reader says of a text, or "accepted".
inline std::string mistakes_of(std::string_view text) {
    const auto scenario = read_scenario(text, "test.toml");
    if (scenario) return "accepted";
    // That of a file which cannot be read is another.
    EXPECT_TRUE(scenario.error().code == ErrorCode::input || scenario.error().code == ErrorCode::outside)
        << scenario.error().message;
    return scenario.error().message;
}

/// A text in which every key that can stand beside the others has a value that is not its default.
inline constexpr std::string_view every_key_text = R"toml(
[run]
start = "2024-03-05T12:00:00.5Z"
duration_s = 12.5
seed = 42
speed = 2.5

[sky]
navigation = ["a.rnx", "sub/b.rnx.gz"]
rebase_navigation = true
constellations = ["gps", "qzss"]
elevation_mask_deg = 12.5
ephemeris_rule = "nearest"
ephemeris_validity_s = 3600

[frame]
origin = [46.5, 30.75, 50]
yaw_deg = 90
unit_m = 0.01
left_handed = true
reach_m = 1234

[trajectory]
kind = "circle"
centre = [10.5, -20.25, 300]
radius_m = 250
speed_mps = -7
start_azimuth_deg = 45
heading_deg = 30

[model]
name = "whole-path"

[model.baseline]
preset = "calibrated"
snr_cutoff_dbhz = 6.5
max_reflections = 3
reflection_loss_db = 4.5
power_mode = "received_spec"
satellite_power_dbw = 27.5
specified_received_power_dbw = -157.5
thermal_noise_dbw_hz = -203.5
statistic = "rms"
iono_fraction = 0.25
tropo_fraction = 0.75
axes = "covariance"

[model.ideal]

[model.constant-sigma]
horizontal_sigma_m = 1.5
vertical_sigma_m = 2.5

[model.satellite-count]
sigma_m = [13, 9, 6, 5, 4, 3]

[model.whole-path]
oxygen_height_km = 5.5
vapour_height_km = 1.75
vapour_g_m3 = 8.5
oxygen_db_per_km = 0.0075
vapour_db_per_km_per_g_m3 = 0.000025

[model.refraction]
surface_refractivity = 325
scale_height_m = 7250
residual_fraction = 0.125

[atmosphere]
total_electron_content_tecu = 12.5
tec_source = "header"
tec_maps = "day.i"
ionosphere_loss_db = 0.5
riometer_absorption_30mhz_db = 1.5
ionosphere_base_m = 70000
environment_noise_db = 17.5
sea_level_temperature_k = 290.5
oxygen_constant_ghz2 = 0.227
concentration = "midpoint"
fixed_concentration = 0.625
zenith_dry_delay_m = 2.25
zenith_dry_decay_per_m = 0.000125
zenith_wet_delay_m = 0.25
rain_mm_h = 12.5
rain_top_m = 3500
rain_model = "as_vapour"
clouds_apply_concentration = true
gravity_mps2 = 9.75
molar_mass_kg_per_mol = 0.03
gas_constant_j_per_mol_k = 8.25
earth_radius_m = 6372000

[[atmosphere.layer]]
name = "low"
base_m = 10
top_m = 9000
vapour_g_m3 = 6.5
enabled = false
concentration = "fixed"
fixed_concentration = 0.375

[[atmosphere.layer]]
name = "high"
base_m = 9000
top_m = 90000

[[atmosphere.cloud]]
kind = "thunderstorm"
base_m = 750
thickness_m = 8000
density_g_m3 = 1.125

[scene]
buildings = ["a.obj", "demo"]
terrain = "hills.asc"
origin = [48.5, 11.5, 520]
file_origin = [100, -2.5, 3e6]
file_crs = "EPSG:25832+7837"
axes = "y,x,z"
heights = "sea_level"
unit_m = 0.01
material = "brick"
default_height_m = 12
metres_per_level = 3.5
reflections = 5
roofs_reflect = true
ground_reflects = false
diffraction = false
scattering = 0.25
foliage = false
rays = 4096
threads = 0
memory_limit_mb = 100
cache = false

[[receiver]]
board = "ublox-f9p"
port = ["pty:/tmp/gps", "file:out.nmea"]
rate_hz = 7.5
baud = 57600
sentences = ["ZDA", "RMC"]
power_up = true
state_file = "receiver.state"
antenna_offset_m = [1, 0.5, -2]

[[receiver]]
name = "rear"
base = "receiver0"

[[output]]
to = "hil-gps:127.0.0.1:14560"
receiver = "rear"
when = "epoch"
system = 2
component = 3
id = 4
eph = "dop100"
)toml";

}  // namespace skyloop::test
