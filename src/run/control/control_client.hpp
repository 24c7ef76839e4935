/// The other end of a ControlServer, for the command line and tests.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "base/core/result.hpp"
#include "run/control/control_request.hpp"
#include "run/control/control_server.hpp"

namespace skyloop::inline run {

/// Asks and waits for the answer; one connection a question. Fails with `outside` when nobody answers in time.
class ControlClient {
public:
    explicit ControlClient(ControlOptions options, std::chrono::milliseconds patience = std::chrono::seconds(5))
        : options_(std::move(options)), patience_(patience) {}

    /// Host and, when there is one, the token are added to the headers; a body is sent as JSON.
    [[nodiscard]] Result<ControlResponse> ask(const ControlRequest& request) const;
    /// Reads the stream of snapshots until `each` gives false or the server hangs up. @param rate a second
    [[nodiscard]] Result<void> watch(double rate, const std::function<bool(std::string_view json)>& each) const;

private:
    ControlOptions options_;
    std::chrono::milliseconds patience_;
};

}  // namespace skyloop::inline run
