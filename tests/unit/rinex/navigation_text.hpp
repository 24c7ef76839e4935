/// Navigation files made of invented numbers, for tests that bend them.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace skyloop::test {

inline constexpr int march_5_2024_week = 2304;  ///< a Tuesday
inline constexpr double tuesday_s = 2 * 86400;

/// A field as Fortran's D19.12 writes it.
inline std::string field(double value, char exponent = 'D') {
    std::string text = fmt::format("{:19.12E}", value);
    text[text.find('E')] = exponent;
    return text;
}

inline std::string header_line(std::string_view content, std::string_view label) {
    return fmt::format("{:<60}{}\n", content, label);
}

inline std::string header_v2(std::string_view more = "") {
    return header_line("     2.11           N: GPS NAV DATA", "RINEX VERSION / TYPE") + std::string(more) +
           header_line("", "END OF HEADER");
}

inline std::string header_v3(std::string_view version, std::string_view more = "") {
    return header_line(fmt::format("{:>9}           N: GNSS NAV DATA    M: MIXED", version), "RINEX VERSION / TYPE") +
           std::string(more) + header_line("", "END OF HEADER");
}

/// What a made-up record says; the rest is the same for all.
struct RecordText {
    std::string first = " 5 24  3  5  2  0  0.0";  ///< satellite and epoch, up to the first clock field
    double toe_tow = tuesday_s + 7200;
    double week = march_5_2024_week;
    double health = 0;
    double sqrt_a = 5153.7;
    char exponent = 'D';
};

/// Eight lines of an LNAV ephemeris; `indent` is 3 in version 2, 4 from version 3 on.
inline std::string record_text(const RecordText& r, int indent = 3) {
    const auto line = [&](std::initializer_list<double> values) {
        std::string text(static_cast<std::size_t>(indent), ' ');
        for (const double v : values)
            text += field(v, r.exponent);
        return text + "\n";
    };
    const char e = r.exponent;
    return r.first + field(1.5e-4, e) + field(-1e-12, e) + field(0, e) + "\n" +  //
           line({55, -20.5, 4.6e-9, 0.7}) +                                      //
           line({-1e-6, 0.011, 7e-6, r.sqrt_a}) +                                //
           line({r.toe_tow, 5e-8, 1.2, -7e-8}) +                                 //
           line({0.96, 250.25, -2.1, -8e-9}) +                                   //
           line({2e-10, 1, r.week, 0}) +                                         //
           line({2.4, r.health, -1e-8, 567}) +                                   //
           line({r.toe_tow - 18, 4});
}

/// The text with the first `from` replaced by `to`.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    return at == std::string::npos ? "nothing to replace" : text.replace(at, from.size(), to);
}

/// Every line end as CR LF.
inline std::string with_crlf(std::string_view text) {
    std::string result;
    for (const char c : text)
        result += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return result;
}

}  // namespace skyloop::test
