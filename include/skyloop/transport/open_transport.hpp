/// From what a user types after --port to a wire.
#pragma once

#include <memory>
#include <string_view>

#include "skyloop/base/result.hpp"
#include "skyloop/transport/transport.hpp"

namespace skyloop {

/// Opens `pty`, `pty:LINK`, `file:PATH` or `-` (standard output). Fails with `usage` for anything else, with `outside`
/// when the system refuses; the sentence names the URI or the path.
Result<std::unique_ptr<Transport>> open_transport(std::string_view uri);

}  // namespace skyloop
