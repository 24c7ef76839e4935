/// Epochs out of NMEA 0183 sentences, at rest or live.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "receiver/observed/observed_log.hpp"
#include "receiver/protocol/nmea_messages.hpp"

namespace skyloop::inline receiver {

/// An epoch before somebody has found out its day. Its `time` says nothing.
struct NmeaEpoch {
    ObservedEpoch told;
    std::optional<Nanoseconds> of_day;  ///< UTC; nothing: no sentence told a time
    std::optional<NmeaDate> date;       ///< by RMC or ZDA
};

/// Takes sentences one after the other. Those of one time of day are one epoch, with the sentences without a time that
/// follow them, and what makers' sentences tell of that time, which may come first. Of several GGA and GNS, as of
/// several talkers, the one with a fix and the most satellites counts; a second one of the same talker and kind begins
/// an epoch, even while the receiver's clock stands. GGA of older versions counts at most 12 satellites: GSA of all
/// systems tell more.
///
/// State: the epoch under way, and makers' sentences of other times.
class NmeaEpochs {
public:
    /// What a sentence tells of the motion, as bits.
    enum Part : unsigned { says_rmc = 1, says_gga = 2, says_gns = 4, says_vtg = 8, says_heading = 16 };
    struct Taken {
        unsigned part = 0;
        std::optional<Error> mistake;    ///< in a sentence that is read here
        std::optional<NmeaEpoch> ended;  ///< the epoch before, when another one begins
    };
    /// @param every_signal signals of one satellite are kept apart, instead of the strongest
    explicit NmeaEpochs(bool every_signal = false) : every_signal_(every_signal) {}
    /// A sentence whose checksum holds.
    Taken take(std::string_view sentence);
    /// The one under way; nothing before the first sentence with a time, a fix or none, and after end().
    [[nodiscard]] std::optional<NmeaEpoch> epoch() const;
    std::optional<NmeaEpoch> end();
    /// By the last GSA: 1 none, 2 2D, 3 3D.
    [[nodiscard]] std::optional<int> fix_mode() const { return fix_mode_; }
    /// Of all sentences so far, in the order of the alphabet.
    [[nodiscard]] const std::vector<std::string>& talkers() const { return talkers_; }

private:
    struct UnderWay {
        NmeaEpoch epoch;
        std::vector<std::string> sources{};  // talkers and kinds of GGA and GNS
        bool two_dimensional = false;
        int listed_used = 0;
    };
    // What a maker's sentence tells of the motion at a time of day.
    struct MakersWord {
        Nanoseconds of_day{0};
        ObservedMotion motion;
    };
    // What GGA and GNS say alike.
    struct FixSentence {
        std::string source;
        std::optional<NmeaTime> time;
        FixType type = FixType::none;
        std::optional<NmeaPosition> position;
        std::optional<Metres> altitude, separation;
        int satellites = 0;
        std::optional<double> hdop;
        std::optional<int> quality{};
    };
    void take_message(const NmeaMessage& message);
    void take_time(const std::optional<NmeaTime>& time);
    void take_rmc(const Rmc& rmc);
    void take_fix(const FixSentence& said);
    void take_gsv(const Gsv& gsv);
    void take_motion(const NmeaMessage& message);
    void take_maker(std::string_view sentence);
    void keep(std::optional<Nanoseconds> of_day, const ObservedMotion& told);
    void begin(std::optional<Nanoseconds> of_day);
    [[nodiscard]] bool is_under_way(Nanoseconds of_day) const;

    bool every_signal_;
    Taken taken_;
    std::optional<UnderWay> under_way_;
    std::vector<MakersWord> words_;      // of times other than the epoch's, whose epochs may begin behind them
    std::vector<ObservedSignal> early_;  // before the first epoch
    std::vector<std::string> talkers_;
    std::optional<int> fix_mode_;
};

}  // namespace skyloop::inline receiver
