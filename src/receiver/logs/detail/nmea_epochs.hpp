/// Epochs out of NMEA 0183 sentences.
#pragma once

#include "log_parts.hpp"
#include "receiver/protocol/nmea_messages.hpp"

namespace skyloop {

/// Takes sentences one after the other. Those of one time of day are one epoch, with the sentences without a time that
/// follow them, and what makers' sentences tell of that time, which may come first. The date is that of RMC or ZDA,
/// counted on over midnight; epochs before the first date are dated by it.
class NmeaEpochs {
public:
    explicit NmeaEpochs(const LogReading& reading) : geoid_(reading.geoid), for_track_(reading.for_track) {}
    /// A sentence whose checksum holds.
    void take(std::string_view sentence);
    /// Everything, as a log; finish_log() has not been called on it.
    Result<ReceiverLog> finish(const std::string& name);
    [[nodiscard]] std::size_t fixes() const { return rows_.size() + (row_ ? 1 : 0); }

private:
    struct Row {
        double seconds = 0;  // of the day
        std::optional<NmeaDate> date;
        LogEpoch epoch;
        bool has_gga = false, two_dimensional = false;
        std::optional<NmeaPosition> position;
        std::optional<Metres> altitude, separation;
        int listed_used = 0;
    };
    // What a maker's sentence tells of the motion at a time of day.
    struct MakersWord {
        double seconds = 0;
        LogMotion motion;
    };
    void take_time(const std::optional<NmeaTime>& time);
    void take_rmc(const Rmc& rmc);
    void take_gga(const Gga& gga);
    void take_gns(const Gns& gns);
    void take_gsv(const Gsv& gsv);
    void take_motion(const NmeaMessage& message);
    void take_maker(std::string_view sentence);
    void keep(std::optional<double> seconds, const LogMotion& told);
    void share_words(std::optional<double> next_seconds);
    void take_ground(const std::optional<NmeaPosition>& position);
    void finish_row();
    void place(Row& row);
    [[nodiscard]] std::vector<int> days_of_rows() const;
    bool date_rows();

    const Geoid* geoid_;
    bool for_track_;
    ReceiverLog log_;
    std::optional<Row> row_;
    std::vector<Row> rows_;
    std::vector<MakersWord> words_;  // of times other than the row's, whose epochs may begin behind them
    std::vector<std::string> talkers_;
    std::size_t senseless_ = 0, without_separation_ = 0, without_height_ = 0;
};

}  // namespace skyloop
