/// How the monitors of a receiver's front end move by themselves.
#pragma once

#include <cstdint>
#include <optional>

#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "firmware/core/board_profile.hpp"

namespace skyloop::firmware {

/// What the monitor of a band shows without interference.
struct QuietBand {
    double indicator = 14;  ///< jamInd, 0 … 30
    double gain = 4212;     ///< agcCnt, 0 … 8191
    double noise = 69;      ///< noisePerMS
};

/// Levels of a module by its serial number, and what wanders about them by the seed of the run.
///
/// Levels lie where those of captures do: jamInd 2 to 27, agcCnt 2457 to 4914, noisePerMS 65 to 114 (RECEIVER.md 3.2;
/// records of a GR-701W, a GR-8013, a NEO-F9V and a ZED-F9R). Each wanders as a first-order Gauss-Markov process:
/// jamInd within 0 and 30, agcCnt within 100 and noisePerMS within 5 of its level. Their correlation times are
/// invented: 3, 30 and 15 s; the GR-701W's 21 samples show that noise and gain stay for some seconds, and the indicator
/// does not.
///
/// State: the processes, and how far they have come.
class MonitorDrift {
public:
    /// @param board the serial number is identity.unique_id, without one that of its USB port, without both its name
    /// @param seed of the receiver
    MonitorDrift(const BoardProfile& board, std::uint64_t seed);

    /// Lets time pass until an epoch; a time before the last one changes nothing.
    void advance(GpsTime now);
    [[nodiscard]] QuietBand upper() const { return upper_.now(); }
    [[nodiscard]] QuietBand lower() const { return lower_.now(); }
    /// agcCnt in the steps of the board's generation.
    [[nodiscard]] int gain_count(double gain) const;
    /// °C. Invented but for the level, a captured ZED-F9P's 28: 4 either way by module, 5 less when it has just been
    /// switched on, and half a degree of wandering in 10 min.
    [[nodiscard]] double temperature(Seconds since_boot) const;
    /// Other for each epoch: of what is noise from bin to bin in MON-SPAN.
    [[nodiscard]] std::uint64_t dice() const { return dice_; }

private:
    class Band {
    public:
        Band(std::uint64_t module, std::uint64_t seed, const char* name, double gain_step);
        void advance(Seconds dt);
        [[nodiscard]] QuietBand now() const;

    private:
        QuietBand level_;
        GaussMarkov indicator_, gain_, noise_;
    };

    double gain_step_;
    Band upper_, lower_;
    double warmth_;
    GaussMarkov temperature_;
    RandomStream dice_stream_;
    std::uint64_t dice_ = 0;
    std::optional<GpsTime> last_;
};

}  // namespace skyloop::firmware
