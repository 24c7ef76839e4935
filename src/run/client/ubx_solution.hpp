/// What a client understands of u-blox's solutions.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_time.hpp"
#include "run/client/configuration_dialogue.hpp"
#include "run/client/heard_solution.hpp"

namespace skyloop {

/// NAV-PVT as a solution, without `heard` and `gps_s`. UTC counts only when the receiver says that it is fully
/// resolved (valid bits 0 to 2), as PX4 asks (RECEIVER.md 6.1).
HeardSolution heard_solution(const NavPvt& pvt);

/// The solution of a receiver before protocol version 14, which has no NAV-PVT: NAV-POSLLH, NAV-SOL, NAV-VELNED and
/// NAV-TIMEUTC of one epoch, in any order. State: the epoch under way.
class SolutionParts {
public:
    /// Takes one of them in, and nothing else; gives the solution, as NAV-PVT would tell it, once with the last of
    /// four.
    std::optional<NavPvt> hear(UbxMessageId id, ByteSpan payload);

private:
    void add(const NavPosllh& position);
    void add(const NavSol& solution);
    void add(const NavVelned& velocity);
    void add(const NavTimeutc& time);
    template <class Message>
    bool take(UbxMessageId id, ByteSpan payload);
    NavPvt& of_epoch(std::uint32_t i_tow);

    NavPvt whole_;
    std::set<UbxMessageId> heard_;
};

/// What the careful client asks and tells: identification, port, rate, dynamic model, messages, and settings read back.
/// Where NAV-PVT is refused it takes the older messages, as PX4 and ArduPilot do.
std::vector<DialogueStep> ubx_configuration();

/// The period of solutions that the careful client asks for, ms: 5 Hz, the default of ArduPilot and INAV.
inline constexpr std::uint16_t ubx_client_period_ms = 200;

}  // namespace skyloop
