/// Epochs out of UBX messages of class NAV.
#pragma once

#include "log_parts.hpp"
#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop {

/// Takes frames one after the other. Messages of one time of week are one epoch; its week is the one they say, or the
/// one counted on from the epoch before. Where none says a week, a track counts from the beginning of its first one.
class UbxEpochs {
public:
    explicit UbxEpochs(const LogReading& reading) : for_track_(reading.for_track) {}
    void take(const UbxFrameView& frame);
    /// Everything, as a log; finish_log() has not been called on it.
    ReceiverLog finish();
    [[nodiscard]] bool has_solutions() const { return solutions_ > 0 || (epoch_ && (epoch_->solution || epoch_->llh)); }

private:
    struct Epoch {
        std::uint32_t itow_ms = 0;
        std::optional<std::int64_t> week;
        std::optional<FixType> of_pvt, of_sol, of_status;
        std::optional<Geodetic> precise, pvt, llh, sol;
        std::optional<VelocityNed> velocity;
        std::optional<Attitude> attitude;
        std::optional<int> used;
        std::optional<Metres> h_acc, v_acc;
        bool lists = false, solution = false;
        std::vector<LoggedSatellite> satellites;
    };
    template <class Message, class Taker>
    bool with(const UbxFrameView& frame, Taker&& taker);
    void take_positions(const UbxFrameView& frame);
    void take_attitudes(const UbxFrameView& frame);
    void take_satellites(const UbxFrameView& frame);
    void take_version(const UbxFrameView& frame);
    Epoch& epoch_at(std::uint32_t itow_ms);
    void finish_epoch();
    void count_week();

    bool for_track_;
    ReceiverLog log_;
    std::vector<LogEpoch> weekless_;
    std::optional<Epoch> epoch_;
    std::int64_t week_ = 0;  // counted from the first epoch on until one is told
    bool week_told_ = false;
    std::uint32_t last_itow_ms_ = 0;
    std::size_t solutions_ = 0, senseless_ = 0, placeless_ = 0;
};

}  // namespace skyloop
