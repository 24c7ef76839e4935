/// The line on a terminal that shows how a run is going.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/core/threads.hpp"
#include "run/emulator/emulator.hpp"

namespace skyloop::host {

/// One line that is rewritten in place; silent when stderr is not a terminal.
class Progress {
public:
    /// @param end of the run, for a percentage  @param writer writes the line, and outlives this
    Progress(bool wanted, GpsTime start, std::optional<GpsTime> end, JobThread& writer);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Rewrites the line, at most five times a second of real time.
    void show(const Status& status, const Emulator& emulator);
    /// Wipes the line, so that something else can be printed.
    void clear();

private:
    bool active_;
    GpsTime start_;
    std::optional<GpsTime> end_;
    JobThread& writer_;
    std::vector<std::string> fixes_;  // of each receiver, as last seen
    std::int64_t shown_ns_ = 0;
    bool on_screen_ = false;
};

}  // namespace skyloop::host
