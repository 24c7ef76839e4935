/// Scripted clients by name.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "base/core/result.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline run {

/// "careful-ubx", "naive-ubx", "careful-nmea", "naive-nmea".
std::span<const std::string_view> client_names();

/// The name in "client:NAME"; nothing for other kinds of wires.
std::optional<std::string_view> client_of_uri(std::string_view uri);

/// Fails with `usage` and a sentence that quotes the name and lists the known ones.
Result<void> check_client(std::string_view name);

/// A new client of that name. Fails as check_client().
Result<std::unique_ptr<Transport>> open_client(std::string_view name);

}  // namespace skyloop::inline run
