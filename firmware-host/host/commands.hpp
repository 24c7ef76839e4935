/// The subcommands: each adds its options to the command line and gives what to do with them.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string_view>
#include <vector>

namespace skyloop::host {

/// Runs a parsed subcommand; gives the program's exit code.
using Action = std::function<int()>;

Action add_run_command(CLI::App& app);
Action add_simulate_command(CLI::App& app);
Action add_sky_command(CLI::App& app);
Action add_check_command(CLI::App& app);
Action add_compare_command(CLI::App& app);
Action add_solve_command(CLI::App& app);
Action add_boards_command(CLI::App& app);
Action add_decode_command(CLI::App& app);
Action add_devices_command(CLI::App& app);
Action add_faults_command(CLI::App& app);
/// `app` is the whole program, whose commands the pages tell of; it must outlive the action.
Action add_help_pages_command(CLI::App& app);
Action add_schema_command(CLI::App& app);
Action add_scene_command(CLI::App& app);
Action add_ctl_command(CLI::App& app);
Action add_replay_command(CLI::App& app);
Action add_power_command(CLI::App& app);
Action add_trajectory_command(CLI::App& app);
Action add_scenario_from_command(CLI::App& app);
Action add_fit_command(CLI::App& app);
Action add_campaign_command(CLI::App& app);
Action add_fetch_nav_command(CLI::App& app);

}  // namespace skyloop::host
