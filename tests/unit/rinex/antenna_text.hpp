/// Small ANTEX files.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

namespace skyloop::test {

inline std::string antex_line(std::string_view text, std::string_view label) {
    return fmt::format("{:<60}{}\n", text, label);
}

inline std::string antex_header(std::string_view kind = "A") {
    return antex_line("     1.4            M", "ANTEX VERSION / SYST") + antex_line(kind, "PCV TYPE / REFANT") +
           antex_line("", "END OF HEADER");
}

struct AntexFrequency {
    std::string_view name;       ///< "G01"
    double x = 0, y = 0, z = 0;  ///< mm
    std::vector<double> variations{};
    std::vector<std::vector<double>> by_azimuth{};
};

inline std::string antex_frequency(const AntexFrequency& f) {
    std::string text = antex_line(fmt::format("   {}", f.name), "START OF FREQUENCY") +
                       antex_line(fmt::format("{:10.2f}{:10.2f}{:10.2f}", f.x, f.y, f.z), "NORTH / EAST / UP");
    const auto row = [](std::string_view head, const std::vector<double>& values) {
        std::string line = fmt::format("{:>8}", head);
        for (const double value : values)
            line += fmt::format("{:8.2f}", value);
        return line + "\n";
    };
    text += row("NOAZI", f.variations);
    for (std::size_t i = 0; i < f.by_azimuth.size(); ++i)
        text += row(fmt::format("{:.1f}", 360. * double(i) / double(f.by_azimuth.size() - 1)), f.by_azimuth[i]);
    return text + antex_line(fmt::format("   {}", f.name), "END OF FREQUENCY");
}

struct AntexAntenna {
    std::string_view type, serial{}, codes{};
    std::string_view zenith = "   0.0  80.0   5.0";
    double azimuth_step = 0;
    std::string valid{};  ///< lines VALID FROM and VALID UNTIL
    std::vector<AntexFrequency> frequencies{};
};

inline std::string antex_antenna(const AntexAntenna& a) {
    std::string text = antex_line("", "START OF ANTENNA") +
                       antex_line(fmt::format("{:<20}{:<20}{:<20}", a.type, a.serial, a.codes), "TYPE / SERIAL NO") +
                       antex_line(fmt::format("  {:6.1f}", a.azimuth_step), "DAZI") +
                       antex_line("  " + std::string(a.zenith), "ZEN1 / ZEN2 / DZEN") + a.valid;
    for (const AntexFrequency& f : a.frequencies)
        text += antex_frequency(f);
    return text + antex_line("", "END OF ANTENNA");
}

}  // namespace skyloop::test
