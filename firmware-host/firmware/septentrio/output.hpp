/// What leaves a Septentrio receiver at an epoch, by the streams that its user has set up.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/navigation_state.hpp"
#include "firmware/septentrio/settings.hpp"
#include "skyloop/base/bytes.hpp"

namespace skyloop::firmware {

/// The receiver behind its command line.
struct SeptentrioState {
    SeptentrioSettings settings;
    bool disk_mounted = true;
    std::uint8_t commands = 0;  ///< so many, from 255 on to 1: 0 is none yet
};

/// Blocks and sentences that are due at an epoch on the port of `context`, blocks first. Blocks that this receiver does
/// not make are left out. What several streams ask for leaves once.
std::vector<Bytes> septentrio_output(const SeptentrioState& receiver, const ReportContext& context);

/// Period at which solutions are needed, ms, so that each stream finds its epochs; nothing when none asks for a certain
/// one. @param own period of the receiver by itself, at which streams OnChange send
std::optional<std::uint64_t> wanted_period_ms(const SeptentrioSettings& settings, std::uint64_t own);

/// Whether something is written to the disk: a stream goes there.
bool logs_to_disk(const SeptentrioSettings& settings);

}  // namespace skyloop::firmware
