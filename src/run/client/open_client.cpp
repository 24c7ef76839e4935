// Clients by their names. The naive ones are as in sketches and hurried drivers: what they do not ask for will happen
// to them.
#include "run/client/open_client.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "base/core/words.hpp"
#include "receiver/protocol/nmea_messages.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "run/client/careful_client.hpp"
#include "run/client/scripted_client.hpp"

namespace skyloop::inline run {
namespace {

/// Asks for MON-VER at 9600 bit/s and waits for it for ever, switches NAV-PVT on once, and takes each NAV-PVT whose
/// fix type is one. Silence, old positions, accuracies and times are nothing to it.
class NaiveUbxClient : public ScriptedClient {
public:
    NaiveUbxClient() : ScriptedClient("naive-ubx") {}

protected:
    void start() override { begun_at_ = now(); }
    void hear(const StreamPiece& piece) override;
    void pass_time() override;

private:
    GpsTime begun_at_{};
    bool asked_ = false, identified_ = false;
};

/// Listens at 9600 bit/s and takes each GGA that has a position, whatever its quality.
class NaiveNmeaClient : public ScriptedClient {
public:
    NaiveNmeaClient() : ScriptedClient("naive-nmea") {}

protected:
    void hear(const StreamPiece& piece) override;
    void pass_time() override {}
};

constexpr Nanoseconds start_up_time = std::chrono::milliseconds(100);  // from its power to its first message

void NaiveUbxClient::pass_time() {
    if (asked_ || now() - begun_at_ < start_up_time) return;
    asked_ = true;
    send(encode_frame(MonVer::message_id, {}));
}

void NaiveUbxClient::hear(const StreamPiece& piece) {
    const auto frame = piece.kind == StreamKind::ubx ? parse_frame(piece.bytes) : std::nullopt;
    if (!frame) return;
    if (!identified_ && frame->id == MonVer::message_id) {
        identified_ = true;
        send(encode_frame(CfgMsgCurrentPort{NavPvt::message_id.message_class, NavPvt::message_id.id, 1}));
    }
    if (!identified_ || frame->id != NavPvt::message_id) return;
    const auto pvt = decode_payload<NavPvt>(frame->payload);
    if (!pvt) return;
    const bool has_fix = pvt->fix_type >= 2 && pvt->fix_type <= 4;
    believe(has_fix, has_fix ? "there is a fix" : "there is no fix");
}

void NaiveNmeaClient::hear(const StreamPiece& piece) {
    if (piece.kind != StreamKind::nmea) return;
    const auto message = decode_nmea(to_string(piece.bytes));
    if (!message) return;
    if (const auto* gga = std::get_if<Gga>(&*message))
        believe(gga->position.has_value(), gga->position ? "there is a position" : "there is no position");
}

constexpr std::array<std::string_view, 4> known_clients{"careful-ubx", "naive-ubx", "careful-nmea", "naive-nmea"};
constexpr std::string_view client_scheme = "client:";

}  // namespace

std::span<const std::string_view> client_names() { return known_clients; }

std::optional<std::string_view> client_of_uri(std::string_view uri) {
    if (!uri.starts_with(client_scheme)) return std::nullopt;
    return uri.substr(client_scheme.size());
}

Result<void> check_client(std::string_view name) {
    if (std::find(known_clients.begin(), known_clients.end(), name) != known_clients.end()) return {};
    return fail(ErrorCode::usage, fmt::format("port 'client:{}': no such client{}; expected one of {}", name,
                                              did_you_mean(name, known_clients), fmt::join(known_clients, ", ")));
}

Result<std::unique_ptr<Transport>> open_client(std::string_view name) {
    if (const auto known = check_client(name); !known) return fail(known.error());
    if (name == "careful-ubx") return std::unique_ptr<Transport>(std::make_unique<CarefulUbxClient>());
    if (name == "naive-ubx") return std::unique_ptr<Transport>(std::make_unique<NaiveUbxClient>());
    if (name == "careful-nmea") return std::unique_ptr<Transport>(std::make_unique<CarefulNmeaClient>());
    return std::unique_ptr<Transport>(std::make_unique<NaiveNmeaClient>());
}

}  // namespace skyloop::inline run
