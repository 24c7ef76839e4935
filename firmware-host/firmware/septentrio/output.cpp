#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <numeric>
#include <set>
#include <string>

#include "base/core/number_text.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/sentences/sentence_maker.hpp"
#include "firmware/septentrio/console.hpp"
#include "firmware/septentrio/rover_and_station.hpp"
#include "firmware/septentrio/sbf_messages.hpp"
#include "firmware/septentrio/station_output.hpp"
#include "receiver/protocol/sbf_raw_blocks.hpp"

namespace skyloop::firmware {
namespace {

using BlockMaker = std::vector<Bytes> (*)(const ReportContext&, const SeptentrioState&);
enum class Pace { by_interval, on_change };
struct MadeBlock {
    std::string_view name;
    BlockMaker make;
    Pace pace = Pace::by_interval;
};

template <auto Make>
std::vector<Bytes> of_state(const ReportContext& context, const SeptentrioState&) {
    return {encode_sbf(Make(context.state))};
}
template <auto Make>
std::vector<Bytes> of_context(const ReportContext& context, const SeptentrioState&) {
    return {encode_sbf(Make(context))};
}
template <auto Make>
std::vector<Bytes> of_counts(const ReportContext& context, const SeptentrioState& receiver) {
    return {encode_sbf(Make(context.state, receiver.counts))};
}
template <class Page>
std::vector<Bytes> pages(const ReportContext& context, const SeptentrioState&) {
    return sbf_raw_pages(Page::block_number, context.state);
}

template <class Block>
std::vector<Bytes> records(const ReportContext&, const SeptentrioState& receiver) {
    std::vector<Bytes> blocks;
    for (const Bytes& block : receiver.new_records)
        if (const auto view = parse_sbf(block); view && view->number == Block::block_number) blocks.push_back(block);
    return blocks;
}

std::vector<Bytes> receiver_status(const ReportContext& context, const SeptentrioState& receiver) {
    constexpr std::uint32_t disk_activity = 1u << 7, disk_mounted = 1u << 9;
    SbfReceiverStatus block = sbf_receiver_status(context.state);
    if (receiver.disk_mounted) block.rx_state |= disk_mounted | (logs_to_disk(receiver.settings) ? disk_activity : 0);
    block.command_count = receiver.commands;
    return {encode_sbf(block)};
}

std::vector<Bytes> receiver_setup(const ReportContext& context, const SeptentrioState& receiver) {
    SbfReceiverSetup block = sbf_receiver_setup(receiver.settings, context.board);
    block.time = sbf_time(context.state);
    return {encode_sbf(block)};
}

// Those that this receiver makes, in the order in which they leave.
constexpr std::array made_blocks{
    MadeBlock{"MeasEpoch", of_counts<sbf_measurements>},
    MadeBlock{"MeasExtra", of_counts<sbf_measurement_extra>},
    MadeBlock{"EndOfMeas", of_state<sbf_end_of_measurements>},
    MadeBlock{"PVTCartesian", of_context<sbf_pvt_cartesian>},
    MadeBlock{"PVTGeodetic", of_context<sbf_pvt_geodetic>},
    MadeBlock{"PosCovCartesian", of_state<sbf_position_covariance_cartesian>},
    MadeBlock{"PosCovGeodetic", of_state<sbf_position_covariance>},
    MadeBlock{"VelCovCartesian", of_state<sbf_velocity_covariance_cartesian>},
    MadeBlock{"VelCovGeodetic", of_state<sbf_velocity_covariance>},
    MadeBlock{"DOP", of_state<sbf_dop>},
    MadeBlock{"BaseVectorCart", of_state<sbf_base_vector_cartesian>},
    MadeBlock{"BaseVectorGeod", of_state<sbf_base_vector>},
    MadeBlock{"AttEuler", of_state<sbf_attitude>},
    MadeBlock{"AttCovEuler", of_state<sbf_attitude_covariance>},
    MadeBlock{"AuxAntPositions", of_state<sbf_other_antenna>},
    MadeBlock{"EndOfAtt", of_state<sbf_end_of_attitude>},
    MadeBlock{"EndOfPVT", of_state<sbf_end_of_pvt>},
    MadeBlock{"ReceiverTime", of_state<sbf_receiver_time>},
    MadeBlock{"ChannelStatus", of_state<sbf_channel_status>},
    MadeBlock{"ReceiverStatus", receiver_status},
    MadeBlock{"SatVisibility", of_state<sbf_visible_satellites>},
    MadeBlock{"QualityInd", of_state<sbf_quality>},
    MadeBlock{"RFStatus", of_state<sbf_radio_status>},
    MadeBlock{"GALAuthStatus", of_state<sbf_authentication>},
    MadeBlock{"ReceiverSetup", receiver_setup},
    MadeBlock{"GPSRawCA", pages<SbfGpsRawCa>, Pace::on_change},
    MadeBlock{"GPSRawL2C", pages<SbfGpsRawL2c>, Pace::on_change},
    MadeBlock{"GPSRawL5", pages<SbfGpsRawL5>, Pace::on_change},
    MadeBlock{"GLORawCA", pages<SbfGloRawCa>, Pace::on_change},
    MadeBlock{"GALRawFNAV", pages<SbfGalRawFnav>, Pace::on_change},
    MadeBlock{"GALRawINAV", pages<SbfGalRawInav>, Pace::on_change},
    MadeBlock{"GEORawL1", pages<SbfGeoRawL1>, Pace::on_change},
    MadeBlock{"BDSRaw", pages<SbfBdsRaw>, Pace::on_change},
    MadeBlock{"QZSRawL1CA", pages<SbfQzsRawL1Ca>, Pace::on_change},
    MadeBlock{"QZSRawL2C", pages<SbfQzsRawL2c>, Pace::on_change},
    MadeBlock{"QZSRawL5", pages<SbfQzsRawL5>, Pace::on_change},
    MadeBlock{"GPSNav", records<SbfGpsNav>, Pace::on_change},
    MadeBlock{"GLONav", records<SbfGloNav>, Pace::on_change},
    MadeBlock{"GALNav", records<SbfGalNav>, Pace::on_change},
    MadeBlock{"BDSNav", records<SbfBdsNav>, Pace::on_change},
    MadeBlock{"QZSNav", records<SbfQzsNav>, Pace::on_change},
};

const MadeBlock* made_block(std::string_view name) {
    const auto found =
        std::find_if(made_blocks.begin(), made_blocks.end(), [&](const MadeBlock& b) { return b.name == name; });
    return found == made_blocks.end() ? nullptr : &*found;
}

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

// The words of a stream, those of groups among them.
std::set<std::string> words_of(const ActiveStream& stream) {
    std::set<std::string> words;
    for (const std::string& word : split_words(stream.words, '+')) {
        words.insert(word);
        for (const std::string& member : split_words(blocks_of_group(word), '+'))
            words.insert(member);
    }
    return words;
}

// What comes when it changes has no other interval, and the setup none but those that are asked for.
bool is_due(const std::string& word, const ActiveStream& stream, std::uint32_t tow_ms,
            const SeptentrioState& receiver) {
    const MadeBlock* block = made_block(word);
    if (block != nullptr && block->pace == Pace::on_change) return true;
    if (word == "ReceiverSetup" && stream.period_ms == 0) return receiver.setup_changed;
    return stream.period_ms == 0 || tow_ms % stream.period_ms == 0;
}

// Words of all streams of a kind that go to a port and are due.
std::set<std::string> due_words(const SeptentrioState& receiver, std::string_view kind, const ReportContext& context) {
    std::set<std::string> due;
    const std::string_view port = descriptor_of(context.port);
    const std::uint32_t tow_ms = whole_milliseconds(gps_stamp(context.state.epoch.fix.time));
    for (const ActiveStream& stream : active_streams(receiver.settings, kind)) {
        if (stream.port != port) continue;
        for (const std::string& word : words_of(stream))
            if (is_due(word, stream, tow_ms, receiver)) due.insert(word);
    }
    return due;
}

// Satellites below the mask of tracking are not tracked; of SBAS they are (setElevationMask).
std::set<SatelliteId> satellites_below(Angle mask, const NavigationState& state) {
    std::set<SatelliteId> below;
    for (const SatelliteStatus& s : state.epoch.fix.satellites)
        if (s.cn0 && s.id.constellation != Constellation::sbas && s.elevation < mask && direction_known(s, state))
            below.insert(s.id);
    return below;
}

NavigationState without(const std::set<SatelliteId>& satellites, NavigationState state) {
    const auto left_out = [&](const auto& item) { return satellites.contains(item.satellite); };
    for (SatelliteStatus& s : state.epoch.fix.satellites)
        if (satellites.contains(s.id)) s.cn0.reset();
    std::erase_if(state.epoch.observations.signals, left_out);
    std::erase_if(state.epoch.subframes, left_out);
    return state;
}

RecordIssue issue_of(const Ephemeris& record) {
    const auto* kepler = std::get_if<KeplerEphemeris>(&record);
    return {toe_of(record), iode_of(record), kepler == nullptr ? 0 : kepler->iodc, is_healthy(record)};
}

std::vector<Bytes> due_messages(const SeptentrioState& receiver, const ReportContext& context) {
    std::vector<Bytes> messages;
    const auto append = [&messages](std::vector<Bytes> made) {
        std::move(made.begin(), made.end(), std::back_inserter(messages));
    };
    const std::string_view port = descriptor_of(context.port);
    if (lets_through(receiver.settings, port, "SBF")) {
        const std::set<std::string> due = due_words(receiver, "SBFOutput", context);
        for (const MadeBlock& block : made_blocks)
            if (due.contains(std::string(block.name))) append(block.make(context, receiver));
    }
    if (lets_through(receiver.settings, port, "NMEA"))
        for (const std::string& word : due_words(receiver, "NMEAOutput", context))
            if (const auto sentence = sentence_message(word)) append(make_message(*sentence, context));
    append(station_output(receiver, context));
    return messages;
}

}  // namespace

void follow_epoch(SeptentrioState& receiver, const BoardProfile& board, const NavigationState& state) {
    const GpsTime epoch = state.epoch.fix.time;
    if (receiver.last_epoch && *receiver.last_epoch == epoch) return;
    receiver.last_epoch = epoch;
    receiver.counts.follow(state);
    receiver.new_records.clear();
    for (const Subframe& message : state.epoch.subframes) {
        if (!message.record) continue;
        receiver.records.insert_or_assign({message.satellite, message_of(*message.record)}, *message.record);
        const RecordIssue issue = issue_of(*message.record);
        const auto [known, is_first] = receiver.told_records.emplace(message.satellite, issue);
        if (!is_first && known->second == issue) continue;
        known->second = issue;
        if (Bytes block = sbf_record_block(message, state); !block.empty()) receiver.new_records.push_back(block);
    }
    Bytes setup = encode_sbf(sbf_receiver_setup(receiver.settings, board));
    receiver.setup_changed = receiver.told_setup != setup;
    receiver.told_setup = std::move(setup);
}

std::vector<Bytes> septentrio_output(const SeptentrioState& receiver, const ReportContext& context) {
    const auto mask = number_in<int>(receiver.settings.values("ElevationMask", "Tracking").front());
    const auto below = satellites_below(Angle::degrees(static_cast<double>(mask.value_or(-90))), context.state);
    if (below.empty()) return due_messages(receiver, context);
    const NavigationState above = without(below, context.state);
    return due_messages(receiver, {context.board, context.config, above, context.ports, context.port});
}

bool wants_messages(const SeptentrioSettings& settings) {
    for (const ActiveStream& stream : active_streams(settings, "SBFOutput"))
        for (const std::string& word : words_of(stream))
            if (const MadeBlock* block = made_block(word); block != nullptr && block->pace == Pace::on_change)
                return true;
    return station_wants_records(settings);
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
    const std::uint64_t station = station_period_ms(settings);
    certain = certain || station > 0;
    common = std::gcd(common, station);
    return certain ? std::optional(std::gcd(common, longest)) : std::nullopt;
}

bool logs_to_disk(const SeptentrioSettings& settings) {
    const auto streams = active_streams(settings, "SBFOutput");
    return std::any_of(streams.begin(), streams.end(), [](const auto& stream) { return stream.port == "DSK1"; });
}

namespace {

// Texts keep the quotation marks that they were given with; what is too long is cut.
template <std::size_t N>
std::array<char, N> characters(std::string_view text) {
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    std::array<char, N> result{};
    std::copy_n(text.begin(), std::min(text.size(), N), result.begin());
    return result;
}

float metres(const std::string& text) {
    float value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

std::uint8_t index(const std::string& text) {
    return static_cast<std::uint8_t>(std::clamp(number_in<int>(text).value_or(0), 0, 255));
}

}  // namespace

SbfReceiverSetup sbf_receiver_setup(const SeptentrioSettings& settings, const BoardProfile& board) {
    const std::vector<std::string>& marker = settings.values("MarkerParameters");
    const std::vector<std::string>& observer = settings.values("ObserverParameters");
    const std::vector<std::string>& antenna = settings.values("AntennaOffset", "Main");
    SbfReceiverSetup block;
    block.marker_name = characters<60>(marker[0]);
    block.marker_number = characters<20>(marker[1]);
    block.marker_type = characters<20>(marker[2]);
    block.station_code = characters<10>(marker[3]);
    block.monument_index = index(marker[4]);
    block.receiver_index = index(marker[5]);
    block.country_code = characters<3>(marker[6]);
    block.observer = characters<20>(observer[0]);
    block.agency = characters<40>(observer[1]);
    block.delta_e = metres(antenna[0]);
    block.delta_n = metres(antenna[1]);
    block.delta_h = metres(antenna[2]);
    block.antenna_type = characters<20>(antenna[3]);
    block.antenna_serial_number = characters<20>(antenna[4]);
    block.rx_serial_number = characters<20>(board.usb ? board.usb->serial : "");
    block.rx_name = characters<20>(board.identity.hardware);
    block.rx_version = characters<20>(board.identity.software);
    block.gnss_fw_version = characters<40>(board.identity.software);
    block.product_name = characters<40>(board.identity.hardware);
    return block;
}

}  // namespace skyloop::firmware
