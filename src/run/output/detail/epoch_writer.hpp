/// From an epoch to the messages of one format.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "run/fault/run_observer.hpp"
#include "run/output/output_settings.hpp"

namespace skyloop {

/// Copies what a format needs of an epoch, and makes its messages later, on another thread.
///
/// State: what the format counts from message to message.
class EpochWriter {
public:
    /// Makes the messages; jobs are run one after the other, in the order in which they are to be sent.
    using Job = std::function<std::vector<Bytes>()>;

    virtual ~EpochWriter() = default;
    /// On the thread of the loop. The job outlives the epoch, and not the writer.
    /// @param number of the receiver's epochs, from 0
    virtual Job note(const EpochSeen& seen, const std::string& receiver, std::uint64_t number) = 0;
};

std::unique_ptr<EpochWriter> make_epoch_writer(const OutputSettings& settings);

}  // namespace skyloop
