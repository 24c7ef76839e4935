/// NeQuick-G above one place: how dense the electrons are at each height.
#pragma once

#include <array>

#include "world/gnss/nequick_g.hpp"

namespace skyloop::inline world {

/// What is the same along a whole ray: activity, month, time, and the CCIR maps taken there.
class NequickConditions {
public:
    /// @param ionisation effective level Az, solar flux units  @param ut_hours 0 … 24
    NequickConditions(const NequickTables& tables, double ionisation, double ut_hours);

    /// Critical frequency foF2, MHz.
    [[nodiscard]] double critical_frequency_f2(double modip, double latitude, double longitude) const;
    /// M(3000)F2.
    [[nodiscard]] double transmission_factor(double modip, double latitude, double longitude) const;
    /// Critical frequency foE, MHz, of a place, rad.
    [[nodiscard]] double critical_frequency_e(double latitude, double longitude) const;
    [[nodiscard]] double sunspot_number() const { return sunspots_; }
    [[nodiscard]] int month() const { return month_; }

private:
    int month_;
    double ionisation_, sunspots_, ut_hours_;
    double sin_declination_, cos_declination_;
    std::array<double, 76> f2_;
    std::array<double, 49> m3000_;
};

/// Where and when a profile is taken; angles in rad.
struct NequickPlace {
    double modip, latitude, longitude;
};

/// The profile of the NeQuick-G document: three Epstein layers below the F2 peak, one that
/// widens above it.
class NequickProfile {
public:
    NequickProfile(const NequickConditions& conditions, const NequickPlace& place);
    /// Electrons, 1e11 per cubic metre, at a height in km.
    [[nodiscard]] double density(double height_km) const;

private:
    struct Peaks {
        double e, f1, f2;
    };
    void set_heights(double transmission, const Peaks& critical);
    void set_amplitudes(const Peaks& critical, const Peaks& peak);
    void set_topside(const NequickConditions& conditions, double peak_f2);
    [[nodiscard]] double below_peak(double height_km) const;
    [[nodiscard]] double above_peak(double height_km) const;

    double height_f1_ = 0, height_f2_ = 0;                           // of the peaks, km
    double bottom_f2_ = 0, top_f1_ = 0, bottom_f1_ = 0, top_e_ = 0;  // thickness, km
    double amplitude_f2_ = 0, amplitude_f1_ = 0, amplitude_e_ = 0;   // 1e11/m³
    double scale_above_ = 0;                                         // H0, km
};

}  // namespace skyloop::inline world
