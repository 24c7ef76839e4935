/// Epochs out of UBX messages of class NAV, at rest or live.
#pragma once

#include "receiver/observed/observed_log.hpp"
#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::inline receiver {

/// Takes frames one after the other. Messages of one time of week are one epoch; its week is the one they say, or the
/// one counted on from the epoch before, at first from 0. Of several places and types of fix the best told is taken:
/// places of NAV-HPPOSLLH, NAV-PVT and NAV-PVAT, NAV-POSLLH, NAV-SOL in this order; types of NAV-PVT and NAV-PVAT,
/// NAV-SOL, NAV-STATUS. Without a type a place counts as a fix.
///
/// Scales and flags: u-blox M8 interface description (UBX-13003221), chapter "UBX-NAV", NAV-PVAT that of the M9 with
/// inertial sensors. State: the epoch under way and the week.
class UbxEpochs {
public:
    /// What a message tells of the motion, as bits.
    enum Part : unsigned {
        says_solution = 1,  ///< all of it
        says_place = 2,
        says_velocity = 4,
        says_precise_place = 8,
        says_old_solution = 16,  ///< NAV-SOL
        says_utc = 32
    };
    struct Taken {
        unsigned part = 0;
        bool is_senseless = false;           ///< of a wrong length or time of week
        std::optional<ObservedEpoch> ended;  ///< the epoch before, when another one begins
    };
    /// @param every_signal those of NAV-SIG are kept apart from the satellites of NAV-SAT, instead of the strongest
    explicit UbxEpochs(bool every_signal = false) : every_signal_(every_signal) {}
    Taken take(const UbxFrameView& frame);
    /// The one under way; nothing before the first message and after end().
    [[nodiscard]] std::optional<ObservedEpoch> epoch() const;
    std::optional<ObservedEpoch> end();
    /// Epochs ended without a message that tells whether their places are fixes.
    [[nodiscard]] std::size_t untyped() const { return untyped_; }

private:
    struct UnderWay {
        std::uint32_t itow_ms = 0;
        std::optional<std::int64_t> week;
        int place_rank = 0, type_rank = 0;
        bool single_numbers = false;  // the signals are those of NAV-SVINFO
        std::optional<int> listed_used;
        ObservedEpoch told;

        void take_type(int rank, FixType type);
        void take_place(int rank, double latitude_deg, double longitude_deg, double height_m);
        template <class Message>
        void take_solution(const Message& message, const VelocityNed& velocity);
        void take_week(std::int64_t number);
        void list_satellites(std::size_t used);
    };
    template <class Message, class Taker>
    void with(const UbxFrameView& frame, unsigned part, Taker&& taker);
    void take_positions(const UbxFrameView& frame);
    void take_times(const UbxFrameView& frame);
    void take_satellites(const UbxFrameView& frame);
    [[nodiscard]] std::int64_t week_under_way() const;

    bool every_signal_;
    std::optional<UnderWay> under_way_;
    Taken taken_;
    std::int64_t week_ = 0;
    bool week_told_ = false;
    std::uint32_t last_itow_ms_ = 0;
    std::size_t untyped_ = 0;
};

}  // namespace skyloop::inline receiver
