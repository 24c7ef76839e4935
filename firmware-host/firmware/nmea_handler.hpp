/// From an epoch to the NMEA sentences that a receiver sends of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/board_profile.hpp"
#include "skyloop/flow/epoch.hpp"
#include "skyloop/protocol/nmea_messages.hpp"

namespace skyloop::firmware {

/// Fills a board's sentences from epochs: RMC VTG GGA GSA GSV GLL GST ZDA, in this order (RECEIVER.md 5.1).
///
/// State: whether the receiver has learned the time. Until its first fix it has none, and sends empty fields.
class NmeaHandler {
public:
    explicit NmeaHandler(const BoardProfile& board);

    /// The sentences due at the epoch with this index, counted from 0 at start. Satellites of constellations that the
    /// board has not enabled are neither listed nor counted.
    std::vector<std::string> sentences(const Epoch& epoch, std::uint64_t index);
    /// A TXT sentence of the board's talker.
    [[nodiscard]] std::string text_message(int type, const std::string& text) const;

private:
    struct Report;
    void append(std::vector<std::string>& out, NmeaSentence sentence, const Report& report) const;
    void append_gsa(std::vector<std::string>& out, const Report& report) const;
    void append_gsv(std::vector<std::string>& out, const Report& report) const;
    [[nodiscard]] Report report(const Fix& fix) const;
    [[nodiscard]] Gga gga(const Report& report) const;
    [[nodiscard]] Gst gst(const Report& report) const;

    NmeaFormat format_;
    NmeaNumbering numbering_;
    std::string talker_;
    std::vector<Constellation> constellations_;
    std::vector<NmeaSystem> systems_;  ///< of the enabled constellations, as GSA and GSV list them
    int max_listed_satellites_;
    MetresPerSecond course_min_speed_;
    std::vector<SentenceRate> plan_;  ///< in output order
    bool time_known_ = false;
};

}  // namespace skyloop::firmware
