#include "firmware/casic/casic.hpp"

#include <algorithm>
#include <array>

#include "firmware/casic/commands.hpp"
#include "firmware/casic/messages.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::uint16_t eight_bits_no_parity = 0x08C0;
constexpr std::uint8_t casic_this_port = 0xFF;

// The item of a message that CFG-MSG names; nothing for one that is not sent.
std::optional<std::uint32_t> casic_rate_item(CasicMessageId message, PortId port) {
    if (message.message_class == casic_class_nmea) {
        constexpr std::array<std::string_view, 9> by_number{"GGA", "GLL", "GSA", "GSV", "RMC", "VTG", "", "GST", "ZDA"};
        return message.id < by_number.size() ? SentenceSettings::rate(by_number[message.id], port) : std::nullopt;
    }
    const auto* const found = std::ranges::find(casic_periodic, message);
    if (found == casic_periodic.end()) return std::nullopt;
    return CasicKeys::rate(static_cast<std::size_t>(found - casic_periodic.begin()), port);
}

CasicCfgPrt casic_port(const SentenceSettings& store, PortId port, std::size_t number) {
    CasicCfgPrt m;
    m.port = static_cast<std::uint8_t>(number);
    m.protocols = static_cast<std::uint8_t>(store.value(CasicKeys::protocols(port)));
    m.mode = eight_bits_no_parity;
    m.baud = static_cast<std::uint32_t>(store.value(SentenceSettings::baud(port)));
    return m;
}

CasicCfgNavx casic_navigation(const SentenceSettings& store) {
    CasicCfgNavx m;
    m.dynamic_model = static_cast<std::uint8_t>(casic_motion(store));
    m.fix_mode = static_cast<std::uint8_t>(store.value(CasicKeys::fix_mode));
    m.least_satellites = static_cast<std::uint8_t>(store.value(CasicKeys::least_satellites));
    m.most_satellites = static_cast<std::uint8_t>(store.value(CasicKeys::most_satellites));
    m.least_cno = static_cast<std::uint8_t>(store.value(CasicKeys::least_cn0));
    m.least_elevation = static_cast<std::int8_t>(store.value(CasicKeys::least_elevation));
    m.systems = static_cast<std::uint8_t>(casic_systems(store));
    constexpr float cm_per_m = 100;
    m.static_hold = static_cast<float>(store.value(SentenceSettings::held_below_cmps)) / cm_per_m;
    return m;
}

}  // namespace

CommandOutcome CasicMaker::receive(const StreamPiece& piece, const Situation& asked) {
    if (piece.kind == StreamKind::nmea) {
        const std::string text = to_string(piece.bytes);
        const auto sentence = parse_sentence(text);
        return sentence ? execute_pcas(*sentence, board(), settings(), asked.from) : CommandOutcome{};
    }
    CommandOutcome outcome;
    const auto frame = piece.kind == StreamKind::casic ? parse_casic_frame(piece.bytes) : std::nullopt;
    if (!frame) return outcome;
    const bool is_version = frame->id == CasicMonVer::message_id && frame->payload.empty();
    if (is_version && board().polled.contains({CasicMonVer::message_id.message_class, CasicMonVer::message_id.id})) {
        CasicMonVer version;
        std::copy_n(board().identity.software.begin(), std::min<std::size_t>(32, board().identity.software.size()),
                    version.software.begin());
        std::copy_n(board().identity.hardware.begin(), std::min<std::size_t>(32, board().identity.hardware.size()),
                    version.hardware.begin());
        outcome.answers.push_back(encode_casic(version));
    }
    if (frame->id.message_class == CasicCfgPrt::message_id.message_class) configure_by({*frame, asked, outcome});
    return outcome;
}

// Each is answered by a verdict, but one that starts the receiver anew.
void CasicMaker::configure_by(const Request& request) {
    const bool done = request.frame.payload.empty() ? poll(request) : set(request);
    if (request.outcome.reset) return;
    const CasicMessageId id = request.frame.id;
    const auto verdict = [&]<class Verdict>(Verdict answer) {
        answer.message_class = id.message_class;
        answer.id = id.id;
        request.outcome.verdict = encode_casic(answer);
    };
    if (done)
        verdict(CasicAckAck{});
    else
        verdict(CasicAckNack{});
}

bool CasicMaker::poll(const Request& request) {
    std::vector<Bytes>& answers = request.outcome.answers;
    const CasicMessageId id = request.frame.id;
    const std::vector<PortId> uarts = uarts_of(board());
    if (id == CasicCfgPrt::message_id) {
        for (std::size_t i = 0; i < uarts.size(); ++i)
            answers.push_back(encode_casic(casic_port(settings(), uarts[i], i)));
    } else if (id == CasicCfgRate::message_id) {
        CasicCfgRate rate;
        rate.interval = static_cast<std::uint16_t>(settings().value(SentenceSettings::fix_interval_ms));
        answers.push_back(encode_casic(rate));
    } else if (id == CasicCfgNavx::message_id) {
        answers.push_back(encode_casic(casic_navigation(settings())));
    } else if (id == CasicCfgMsg::message_id) {
        std::vector<CasicMessageId> messages(casic_periodic.begin(), casic_periodic.end());
        for (const int sentence : {0, 1, 2, 3, 4, 5, 7, 8})
            messages.push_back({casic_class_nmea, static_cast<std::uint8_t>(sentence)});
        for (const CasicMessageId message : messages) {
            CasicCfgMsg rate;
            rate.message_class = message.message_class;
            rate.id = message.id;
            rate.rate = static_cast<std::uint16_t>(settings().value(*casic_rate_item(message, request.asked.from)));
            answers.push_back(encode_casic(rate));
        }
    }
    return !answers.empty();
}

bool CasicMaker::set(const Request& request) {
    const CasicMessageId id = request.frame.id;
    if (id == CasicCfgPrt::message_id) return set_port(request);
    if (id == CasicCfgMsg::message_id) return set_rate_of(request);
    if (id == CasicCfgRst::message_id) return restart_by(request);
    if (id == CasicCfgRate::message_id) return set_interval(request);
    if (id == CasicCfgCfg::message_id) return use_stored(request);
    return id == CasicCfgNavx::message_id && set_navigation(request);
}

bool CasicMaker::set_port(const Request& request) {
    const auto wanted = decode_payload<CasicCfgPrt>(request.frame.payload);
    const std::vector<PortId> uarts = uarts_of(board());
    if (!wanted || wanted->mode != eight_bits_no_parity || (wanted->protocols & ~casic_all_protocols) != 0)
        return false;
    if (wanted->port != casic_this_port && wanted->port >= uarts.size()) return false;
    const PortId port = wanted->port == casic_this_port ? request.asked.from : uarts[wanted->port];
    if (!set_casic_speed(settings(), board(), port, wanted->baud)) return false;
    settings().set(in_ram, CasicKeys::protocols(port), wanted->protocols);
    return true;
}

bool CasicMaker::set_rate_of(const Request& request) {
    constexpr std::uint16_t once = 0xFFFF;
    const auto wanted = decode_payload<CasicCfgMsg>(request.frame.payload);
    if (!wanted) return false;
    const CasicMessageId message{wanted->message_class, wanted->id};
    const auto item = casic_rate_item(message, request.asked.from);
    if (!item) return false;
    if (wanted->rate == once) return send_once(request, message);
    settings().set(in_ram, *item, wanted->rate);
    return true;
}

bool CasicMaker::send_once(const Request& request, CasicMessageId wanted) {
    if (const auto frame = casic_frame(wanted, request.asked.report)) {
        request.outcome.answers.push_back(*frame);
        return true;
    }
    EpochMessages made(request.asked.report);
    for (const Bytes& sentence : made.of({class_nmea, wanted.id}, request.asked.from, {}))
        request.outcome.answers.push_back(sentence);
    return true;
}

bool CasicMaker::set_interval(const Request& request) {
    const auto wanted = decode_payload<CasicCfgRate>(request.frame.payload);
    return wanted && set_casic_interval(settings(), board(), wanted->interval);
}

// Nothing changes where one of the values that `apply` names cannot be.
bool CasicMaker::set_navigation(const Request& request) {
    const auto wanted = decode_payload<CasicCfgNavx>(request.frame.payload);
    if (!wanted) return false;
    const auto applies = [&](int bit) { return (wanted->apply >> bit & 1U) != 0; };
    constexpr int motion = 0, mode = 1, satellites = 2, strength = 3, elevation = 6, systems = 8, hold = 13;
    constexpr std::uint8_t last_motion = 7, last_mode = 3;
    constexpr std::int8_t highest = 90;
    constexpr float fastest_held_mps = 100;
    if (applies(motion) && wanted->dynamic_model > last_motion) return false;
    if (applies(mode) && (wanted->fix_mode == 0 || wanted->fix_mode > last_mode)) return false;
    if (applies(elevation) && (wanted->least_elevation < 0 || wanted->least_elevation > highest)) return false;
    if (applies(hold) && !(wanted->static_hold >= 0 && wanted->static_hold <= fastest_held_mps)) return false;
    if (applies(systems) && !set_casic_systems(settings(), wanted->systems)) return false;
    SentenceSettings& store = settings();
    if (applies(motion)) set_casic_motion(store, wanted->dynamic_model);
    if (applies(mode)) store.set(in_ram, CasicKeys::fix_mode, wanted->fix_mode);
    if (applies(satellites)) {
        store.set(in_ram, CasicKeys::least_satellites, wanted->least_satellites);
        store.set(in_ram, CasicKeys::most_satellites, wanted->most_satellites);
    }
    if (applies(strength)) store.set(in_ram, CasicKeys::least_cn0, wanted->least_cno);
    if (applies(elevation))
        store.set(in_ram, CasicKeys::least_elevation, static_cast<std::uint64_t>(wanted->least_elevation.raw));
    if (applies(hold))
        store.set(in_ram, SentenceSettings::held_below_cmps,
                  static_cast<std::uint64_t>(std::lround(wanted->static_hold * 100)));
    return true;
}

bool CasicMaker::use_stored(const Request& request) {
    const auto wanted = decode_payload<CasicCfgCfg>(request.frame.payload);
    constexpr std::uint8_t clear = 0, save = 1, load = 2;
    if (!wanted || wanted->mode > load) return false;
    if (wanted->mode == clear) settings().clear(in_flash);
    if (wanted->mode == save) save_casic(settings());
    if (wanted->mode == load) settings().reload();
    return true;
}

bool CasicMaker::restart_by(const Request& request) {
    const auto wanted = decode_payload<CasicCfgRst>(request.frame.payload);
    constexpr std::uint8_t navigation_alone = 2, last_mode = 4, warm = 1, factory = 3;
    constexpr std::uint16_t settings_too = 1 << 9;
    if (!wanted || wanted->mode > last_mode || wanted->start > factory) return false;
    const StartKind start = wanted->start == 0      ? StartKind::hot
                            : wanted->start == warm ? StartKind::warm
                                                    : StartKind::cold;
    Forgotten forgotten = Forgotten::of(start);
    if (wanted->start == 0) forgotten = Forgotten::by_mask(wanted->forget & (settings_too - 1));
    if (wanted->start == factory || (wanted->forget & settings_too) != 0) settings().clear(in_battery | in_flash);
    const bool parts = wanted->mode == navigation_alone;
    request.outcome.reset = Reset{parts               ? Reset::Kind::navigation
                                  : wanted->mode == 1 ? Reset::Kind::software
                                                      : Reset::Kind::hardware,
                                  forgotten};
    return true;
}

void CasicMaker::adjust(ReceiverConfig& config) const {
    const SentenceSettings& store = settings();
    for (const PortId port : board().ports) {
        const std::uint64_t bits = store.value(CasicKeys::protocols(port));
        PortConfig& one = config.ports[static_cast<std::size_t>(port)];
        one.in = {.ubx = (bits & casic_binary_in) != 0, .nmea = (bits & casic_text_in) != 0, .rtcm3 = false};
        one.out = {.ubx = (bits & casic_binary_out) != 0, .nmea = (bits & casic_text_out) != 0, .rtcm3 = false};
        one.nmea_texts = 0;  // u-blox's own; that about the antenna is a sentence of the epoch
    }
    const std::uint64_t version = store.value(CasicKeys::sentence_version);
    if (version != store.stored(ConfigLayer::factory, CasicKeys::sentence_version))
        config.nmea.version = version == casic_nmea_4_10  ? NmeaVersion::v4_10
                              : version == casic_nmea_4_0 ? NmeaVersion::v4_0
                                                          : NmeaVersion::v2_3;
    config.nmea.gps_only = version == casic_nmea_2_2;
    constexpr std::array<FixMode, 4> modes{FixMode::automatic, FixMode::only_2d, FixMode::only_3d, FixMode::automatic};
    config.limits.mode = modes[std::min<std::uint64_t>(store.value(CasicKeys::fix_mode), 3)];
    const auto changed = [&](std::uint32_t key) { return store.stored(ConfigLayer::factory, key) != store.value(key); };
    if (changed(CasicKeys::least_elevation))
        config.elevation_mask = config.settings.elevation_mask =
            Angle::degrees(static_cast<double>(store.value(CasicKeys::least_elevation)));
    if (changed(CasicKeys::least_cn0))
        config.settings.minimum_cn0 = DbHz(static_cast<double>(store.value(CasicKeys::least_cn0)));
}

// Sentences, the text about the antenna, binary messages.
DueMessages CasicMaker::due(PortId port, EpochMessages& made, const FirmwareFaults& faults) {
    DueMessages due = SentenceMaker::due(port, made, faults);
    const PortConfig& of_port = config().port(port);
    const auto is_now = [&](std::uint32_t item) {
        const std::uint64_t every = settings().value(item);
        return every != 0 && made.state().epoch_index % every == 0;
    };
    std::vector<Bytes> own;
    if (of_port.out.nmea && is_now(CasicKeys::antenna_text(port)))
        own.push_back(casic_antenna_text(made.context(port)));
    for (std::size_t i = 0; i < casic_periodic.size() && of_port.out.ubx; ++i)
        if (is_now(CasicKeys::rate(i, port))) own.push_back(*casic_frame(casic_periodic[i], made.context(port)));
    due.add(std::move(own));
    return due;
}

std::unique_ptr<Maker> make_casic(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<CasicMaker>(board, options);
}

Abilities casic_abilities(const BoardProfile&) {
    return {.choice = Abilities::MessageChoice::rates,
            .accuracies = true,
            .weeks = true,
            .time = true,
            .calendar = true,
            .more = {"TXT", "CASIC"},
            .own_prefix = "CASIC-"};
}

}  // namespace skyloop::firmware
