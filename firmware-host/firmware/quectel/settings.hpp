/// What Quectel's receivers can be set to, beside what all senders of sentences have.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/sentences/sentence_settings.hpp"

namespace skyloop::firmware {

/// Sentences of their own that can be sent, and the version that CFGMSGRATE names; of PL the rate is kept alone.
struct QuectelMessage {
    std::string_view name;
    int version = 1;
};
inline constexpr std::array<QuectelMessage, 7> quectel_messages{{{"PQTMEPE", 2},
                                                                 {"PQTMVEL", 1},
                                                                 {"PQTMPVT", 1},
                                                                 {"PQTMDOP", 1},
                                                                 {"PQTMSVINSTATUS", 1},
                                                                 {"PQTMEOE", 1},
                                                                 {"PQTMPL", 1}}};

inline constexpr std::uint64_t quectel_rover = 1, quectel_base = 2;

inline constexpr std::int64_t quectel_axis_offset_m = 8'000'000, quectel_rests_per_metre = 10'000;
constexpr double quectel_axis_m(std::uint64_t metres, std::uint64_t rest) {
    return static_cast<double>(metres) - static_cast<double>(quectel_axis_offset_m) +
           static_cast<double>(rest) / static_cast<double>(quectel_rests_per_metre);
}

/// Keys of the settings of their own. Coordinates are whole metres from −8,000,000 on and tenths of millimetres.
struct QuectelKeys {
    static constexpr std::uint32_t mode = 5000;  ///< 1 rover, 2 base
    static constexpr std::uint32_t survey = 5001, survey_positions = 5002, survey_accuracy_mm = 5003;
    static constexpr std::uint32_t metres(std::size_t axis) { return 5004 + 2 * static_cast<std::uint32_t>(axis); }
    static constexpr std::uint32_t rest(std::size_t axis) { return 5005 + 2 * static_cast<std::uint32_t>(axis); }
    static constexpr std::uint32_t msm = 5010;      ///< 4, 7, or 0 for none
    static constexpr std::uint32_t station = 5011;  ///< 1005 is sent
    static constexpr std::uint32_t elevation = 5012;
    static constexpr std::uint32_t rate(std::size_t message, PortId port) {
        return 5100 + static_cast<std::uint32_t>(message * port_count) + static_cast<std::uint32_t>(port);
    }
};

OwnSettings quectel_settings(const BoardProfile& board);

/// A sentence of their own, without "$" and checksum; nothing where there is nothing to say.
std::optional<std::string> quectel_sentence(std::string_view name, const ReportContext& context);

}  // namespace skyloop::firmware
