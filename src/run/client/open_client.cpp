#include "run/client/open_client.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "base/core/spelling.hpp"
#include "run/client/careful_nmea_client.hpp"
#include "run/client/careful_ubx_client.hpp"
#include "run/client/naive_clients.hpp"

namespace skyloop {
namespace {

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

}  // namespace skyloop
