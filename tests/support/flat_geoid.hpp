/// A geoid that stands equally high everywhere.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/geo/geoid.hpp"

namespace skyloop::test {

/// A geoid of undulation `metres`, a multiple of 0.25 m in −100 … 100 m, by way of a small grid file.
inline Result<Geoid> flat_geoid(double metres) {
    const auto* running = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("skyloop-") + running->test_suite_name() + "-" + running->name() + ".pgm";
    std::replace(name.begin(), name.end(), '/', '-');  // of a test with parameters
    const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / name;
    constexpr int width = 8;
    constexpr int height = 5;
    const auto level = static_cast<unsigned>((metres + 100) / 0.25);
    {
        std::ofstream file(path, std::ios::binary);
        file << "P5\n# Description a flat geoid for tests\n# DateTime 2000-01-01\n# Offset -100\n# Scale 0.25\n"
             << width << ' ' << height << "\n65535\n";
        for (int i = 0; i < width * height; ++i)
            file.put(static_cast<char>(level >> 8)).put(static_cast<char>(level & 0xff));
    }
    return Geoid::open(path);
}

}  // namespace skyloop::test
