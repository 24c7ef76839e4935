/// The keys of a run's OSNMA, and the files that tell them to its clients.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "run/scenario/scenario.hpp"
#include "world/osnma/osnma_keys.hpp"

namespace skyloop::inline run {

/// Null where the scenario wants none.
std::shared_ptr<const OsnmaKeys> osnma_keys_of(const Scenario& scenario, GpsTime start);

/// What stands beside the recording of a receiver: osnma_keys.xml with the public keys and the Merkle tree, in the form
/// of the European GNSS Service Centre's, and each public key as PEM. @param keys null: no files
std::map<std::string, std::string> osnma_files(const OsnmaKeys* keys);

}  // namespace skyloop::inline run
