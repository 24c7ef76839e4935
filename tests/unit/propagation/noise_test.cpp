#include "world/propagation/antenna_and_noise.hpp"

#include <gtest/gtest.h>

#include <map>

#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

const std::map<std::string, NoiseEnvironment> noise_environments{{"city", NoiseEnvironment::city},
                                                                 {"residential", NoiseEnvironment::residential},
                                                                 {"rural", NoiseEnvironment::rural},
                                                                 {"quiet_rural", NoiseEnvironment::quiet_rural}};

TEST(ManMadeNoise, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("noise_p372_manmade.csv")) {
        SCOPED_TRACE(row.id());
        const Decibels noise =
            man_made_noise_p372(noise_environments.at(row.text("environment")), Hertz(row.number("f_MHz") * 1e6));
        EXPECT_NEAR(noise.value(), row.number("Fam_dB_above_kT0B"), row.number("tol_dB"));
    }
}

TEST(SystemTemperature, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("noise_system_temperature.csv")) {
        SCOPED_TRACE(row.id());
        const double tolerance = row.number("tol");
        const Kelvin system = system_temperature({Kelvin(row.number("T_ant_K")), Decibels(row.number("line_loss_dB")),
                                                  Decibels(row.number("noise_figure_dB"))});
        const double expected = row.number("T_sys_K");
        EXPECT_NEAR(system.value() / expected, 1, tolerance);
        // The table prints densities with eight decimals.
        EXPECT_NEAR(noise_density(system).value(), row.number("N0_dBW_Hz"), tolerance + 5e-9);
        EXPECT_NEAR(noise_density(Kelvin(290)).value(), row.number("info_kT0_dBW_Hz"), tolerance);
    }
}

TEST(SystemTemperature, OfTheDefaultsIsTwoHundredAndFiftyKelvin) {
    EXPECT_NEAR(system_temperature({}).value(), 250, 1);
    EXPECT_NEAR(noise_density(system_temperature({})).value(), -204.6, 0.05);
}

}  // namespace
}  // namespace skyloop
