/// How a base station finds its own place: survey-in.
/// Where a base station stands.
#pragma once

#include <cstdint>
#include <optional>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "firmware/config/config_store.hpp"
#include "world/flow/fix.hpp"

namespace skyloop::firmware {

/// When a survey is over: CFG-TMODE-SVIN_MIN_DUR and CFG-TMODE-SVIN_ACC_LIMIT.
struct SurveyLimits {
    Seconds least{0};
    Metres accuracy{0};  ///< 3D, 1 σ
    bool operator==(const SurveyLimits&) const = default;
};

/// Nothing unless CFG-TMODE-MODE is 1, and of boards that have no CFG-TMODE.
std::optional<SurveyLimits> survey_limits(const ConfigStore& config);

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

/// Told by CFG-TMODE-MODE 2, or found by a survey that is done.
struct BasePlace {
    Position<Ecef> position;
    Metres accuracy;  ///< 1 σ, CFG-TMODE-FIXED_POS_ACC or that of the survey
};

/// Nothing in the other modes, during a survey, and of boards that have no CFG-TMODE.
std::optional<BasePlace> base_place(const ConfigStore& config, const std::optional<BaseSurvey>& survey);

}  // namespace skyloop::firmware
