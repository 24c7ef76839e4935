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

// A stream that sends something.
struct ActiveStream {
    const std::string& port;
    const std::string& words;  // by +
    std::uint64_t period_ms;   // 0: at every epoch
};

std::vector<ActiveStream> active_streams(const SeptentrioSettings& settings, std::string_view kind) {
    constexpr int streams = 10;
    std::vector<ActiveStream> active;
    for (int i = 1; i <= streams; ++i) {
        const auto& values = settings.values(kind, "Stream" + std::to_string(i));
        const auto period = interval_ms(values[2]);
        if (values[0] != "none" && values[1] != "none" && period) active.push_back({values[0], values[1], *period});
    }
    return active;
}

// Words of all streams of a kind that go to a port and are due.
std::set<std::string> due_words(const SeptentrioSettings& settings, std::string_view kind,
                                const ReportContext& context) {
    std::set<std::string> due;
    const std::string_view port = descriptor_of(context.port);
    const std::uint32_t tow_ms = whole_milliseconds(gps_stamp(context.state.epoch.fix.time));
    for (const ActiveStream& stream : active_streams(settings, kind)) {
        if (stream.port != port || (stream.period_ms != 0 && tow_ms % stream.period_ms != 0)) continue;
        for (const std::string& word : split_words(stream.words, '+')) {
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
    for (const std::string_view kind : {"SBFOutput", "NMEAOutput"})
        for (const ActiveStream& stream : active_streams(settings, kind)) {
            certain = certain || stream.period_ms > 0;
            common = std::gcd(common, stream.period_ms == 0 ? own : stream.period_ms);
        }
    return certain ? std::optional(std::gcd(common, longest)) : std::nullopt;
}

bool logs_to_disk(const SeptentrioSettings& settings) {
    const auto streams = active_streams(settings, "SBFOutput");
    return std::any_of(streams.begin(), streams.end(), [](const auto& stream) { return stream.port == "DSK1"; });
}

}  // namespace skyloop::firmware
