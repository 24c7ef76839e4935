/// How a base station finds its own place: survey-in.
/// Where a base station stands.
#pragma once

#include <cstdint>
#include <optional>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "firmware/core/receiver_config.hpp"
#include "world/flow/fix.hpp"

namespace skyloop::firmware {

/// The weighted mean of all 3D positions so far, until both limits are met; from then on the receiver stands there
/// (ZED-F9P integration manual, UBX-18010802 R09, Survey-in).
class BaseSurvey {
public:
    BaseSurvey(const SurveyLimits& limits, GpsTime begins) : limits_(limits), began_(begins) {}

    /// The next epoch. @param counts it has a 3D position within the receiver's limits
    void take(const Fix& fix, bool counts);
    [[nodiscard]] const SurveyLimits& limits() const { return limits_; }
    /// Since it began; until it was done.
    [[nodiscard]] Seconds time() const { return time_; }
    [[nodiscard]] std::uint64_t positions() const { return positions_; }
    [[nodiscard]] bool done() const { return done_; }
    /// Nothing before the first position.
    [[nodiscard]] std::optional<Position<Ecef>> mean() const;
    /// Of the mean, 3D, 1 σ; only where there is one. No document tells how a receiver finds it: here the errors of
    /// epochs beside each other are the same, and those 100 s apart have nothing in common.
    [[nodiscard]] Metres accuracy() const;

private:
    SurveyLimits limits_;
    GpsTime began_, last_{};
    Seconds time_{0};
    std::uint64_t positions_ = 0;
    double weights_ = 0;                                  // 1/m²
    double information_ = 0;                              // the same of what is independent
    Eigen::Vector3d weighted_ = Eigen::Vector3d::Zero();  // m/m²
    bool done_ = false;
};

/// Where it has been told that it stands, or what a survey that is done found; nothing else, and during a survey.
std::optional<BasePlace> base_place(const std::optional<BasePlace>& given, const std::optional<BaseSurvey>& survey);

}  // namespace skyloop::firmware
