/// What `skyloop trajectory` found, as people and as programs read it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "motion/trajectory/path_survey.hpp"

namespace skyloop::host {

/// A path and what is to be told of it.
struct TrajectoryListing {
    std::string name;                  ///< of the file
    std::string kind;                  ///< "track", "waypoints", …
    std::string description;           ///< of a track: its rows and time
    std::vector<std::string> details;  ///< what was found in its file
    std::vector<std::string> notes;    ///< what its user should be told
    std::string vehicle;               ///< name of the class whose limits count; empty: none
    PathSurvey survey;
    std::vector<ExceededLimit> exceeded;
};

std::string trajectory_text(const TrajectoryListing& listing);
/// One object; every number SI, angles in degrees.
std::string trajectory_json(const TrajectoryListing& listing);

}  // namespace skyloop::host
