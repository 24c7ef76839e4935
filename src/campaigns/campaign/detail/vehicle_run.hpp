/// A run in real time with a program that is tested.
/// Which files a vehicle's command is made of.
#pragma once

#include <atomic>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/process.hpp"
#include "base/core/result.hpp"
#include "campaigns/campaign/campaign_plan.hpp"
#include "run/emulator/assembly.hpp"
#include "run/verdict/verdict.hpp"

namespace skyloop::inline campaigns {

/// The words of a command for /bin/sh that have a slash and are programs, seen from the working folder: regular files
/// that may be executed, begin with `#!`, or end in .py, .sh or .lua. Not what it writes, with `>` or by an option as a
/// log is named: that is another after each run. Nothing is expanded: $HOME/sitl is no file.
std::vector<std::string> programs_of_command(std::string_view command);

/// Who looks after a vehicle's processes.
struct VehicleWatch {
    const std::atomic<bool>& stop;              ///< true: they are killed
    const ProcessGroupListener& process_group;  ///< may be empty
};

/// Runs the emulator in real time and the vehicle's command beside it, with the pty's path in the environment as
/// SKYLOOP_PTY, until the run is over or the vehicle has ended; what is left of the vehicle's time it then has without
/// a receiver. Its exit code is the verdict, as of vehicle_verdict().
Result<Verdict> run_with_vehicle(Assembly& assembly, const CampaignVehicle& vehicle, const PlannedRun& run,
                                 const VehicleWatch& watch);

/// What becomes of a vehicle's verdict: passed for the exit code 0, failed for any other, for a signal and when its
/// time is over, with the last line that it wrote to its standard error. Fails with `outside` for the codes 126 and
/// 127, by which a shell says that there was no program to run.
Result<Verdict> vehicle_verdict(const ProcessOutcome& outcome, Seconds timeout);

}  // namespace skyloop::inline campaigns
