#include "firmware/septentrio/output.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <string>

#include "firmware/config/config_keys.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/messages/reported_fix.hpp"
#include "firmware/messages/sbf_status_messages.hpp"

namespace skyloop::firmware {
namespace {

using BlockMaker = Bytes (*)(const ReportContext&, const SeptentrioState&);
struct MadeBlock {
    std::string_view name;
    BlockMaker make;
};

Bytes receiver_status(const ReportContext& context, const SeptentrioState& receiver) {
    constexpr std::uint32_t disk_activity = 1u << 7, disk_mounted = 1u << 9;
    SbfReceiverStatus block = sbf_receiver_status(context.state);
    if (receiver.disk_mounted) block.rx_state |= disk_mounted | (logs_to_disk(receiver.settings) ? disk_activity : 0);
    block.command_count = receiver.commands;
    return encode_sbf(block);
}

// Those that this receiver makes, in the order in which they leave.
constexpr std::array made_blocks{
    MadeBlock{"PVTGeodetic",
              [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_pvt_geodetic(c)); }},
    MadeBlock{"PosCovGeodetic", [](const ReportContext& c,
                                   const SeptentrioState&) { return encode_sbf(sbf_position_covariance(c.state)); }},
    MadeBlock{"VelCovGeodetic", [](const ReportContext& c,
                                   const SeptentrioState&) { return encode_sbf(sbf_velocity_covariance(c.state)); }},
    MadeBlock{"DOP", [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_dop(c.state)); }},
    MadeBlock{"BaseVectorGeod",
              [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_base_vector(c.state)); }},
    MadeBlock{"AttEuler",
              [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_attitude(c.state)); }},
    MadeBlock{"AttCovEuler", [](const ReportContext& c,
                                const SeptentrioState&) { return encode_sbf(sbf_attitude_covariance(c.state)); }},
    MadeBlock{"AuxAntPositions",
              [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_other_antenna(c.state)); }},
    MadeBlock{"EndOfAtt",
              [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_end_of_attitude(c.state)); }},
    MadeBlock{"EndOfPVT",
              [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_end_of_pvt(c.state)); }},
    MadeBlock{"ReceiverTime",
              [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_receiver_time(c.state)); }},
    MadeBlock{"ChannelStatus",
              [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_channel_status(c.state)); }},
    MadeBlock{"ReceiverStatus", receiver_status},
    MadeBlock{"QualityInd",
              [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_quality(c.state)); }},
    MadeBlock{"RFStatus",
              [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_radio_status(c.state)); }},
    MadeBlock{"GALAuthStatus",
              [](const ReportContext& c, const SeptentrioState&) { return encode_sbf(sbf_authentication(c.state)); }},
};

bool is_due(const std::string& interval, const NavigationState& state) {
    const auto period = interval_ms(interval);
    if (!period) return false;
    return *period == 0 || whole_milliseconds(gps_stamp(state.epoch.fix.time)) % *period == 0;
}

// Words of all streams of a kind that go to a port and are due.
std::set<std::string> due_words(const SeptentrioSettings& settings, std::string_view kind,
                                const ReportContext& context) {
    std::set<std::string> due;
    const std::string_view port = descriptor_of(context.port);
    for (int i = 1; i <= 10; ++i) {
        const auto& stream = settings.values(kind, "Stream" + std::to_string(i));
        if (stream.size() < 3 || stream[0] != port || !is_due(stream[2], context.state)) continue;
        for (const std::string& word : split_words(stream[1], '+')) {
            due.insert(word);
            for (const std::string& member : split_words(blocks_of_group(word), '+'))
                due.insert(member);
        }
    }
    return due;
}

bool lets_through(const SeptentrioSettings& settings, PortId port, std::string_view protocol) {
    const auto& directions = settings.values("DataInOut", descriptor_of(port));
    if (directions.size() < 2) return true;
    const auto outputs = split_words(directions[1], '+');
    return std::any_of(outputs.begin(), outputs.end(), [&](const auto& word) { return same_word(word, protocol); });
}

// Each active stream's period, ms; 0 for OnChange.
std::vector<std::uint64_t> stream_periods(const SeptentrioSettings& settings) {
    std::vector<std::uint64_t> periods;
    for (const std::string_view kind : {"SBFOutput", "NMEAOutput"})
        for (int i = 1; i <= 10; ++i) {
            const auto& stream = settings.values(kind, "Stream" + std::to_string(i));
            if (stream[0] == "none" || stream[1] == "none") continue;
            if (const auto period = interval_ms(stream[2])) periods.push_back(*period);
        }
    return periods;
}

}  // namespace

std::vector<Bytes> septentrio_output(const SeptentrioState& receiver, const ReportContext& context) {
    const SeptentrioSettings& settings = receiver.settings;
    std::vector<Bytes> messages;
    if (lets_through(settings, context.port, "SBF")) {
        const std::set<std::string> due = due_words(settings, "SBFOutput", context);
        for (const MadeBlock& block : made_blocks)
            if (due.contains(std::string(block.name))) messages.push_back(block.make(context, receiver));
    }
    if (!lets_through(settings, context.port, "NMEA")) return messages;
    for (const std::string& word : due_words(settings, "NMEAOutput", context))
        if (const OutputMessage* sentence = find_output_message(word); sentence != nullptr)
            for (Bytes& line : make_message(sentence->id, context))
                messages.push_back(std::move(line));
    return messages;
}

std::optional<std::uint64_t> wanted_period_ms(const SeptentrioSettings& settings, std::uint64_t own) {
    constexpr std::uint64_t longest = 1000;
    std::uint64_t common = 0;
    bool certain = false;
    for (const std::uint64_t period : stream_periods(settings)) {
        certain = certain || period > 0;
        common = std::gcd(common, period == 0 ? own : period);
    }
    return certain ? std::optional(std::gcd(common, longest)) : std::nullopt;
}

bool logs_to_disk(const SeptentrioSettings& settings) {
    for (int i = 1; i <= 10; ++i) {
        const auto& stream = settings.values("SBFOutput", "Stream" + std::to_string(i));
        if (stream[0] == "DSK1" && stream[1] != "none" && stream[2] != "off") return true;
    }
    return false;
}

}  // namespace skyloop::firmware
