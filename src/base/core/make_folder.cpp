#include "base/core/make_folder.hpp"

#include <fmt/format.h>

#include <system_error>

namespace skyloop {

Result<bool> make_folder(const std::filesystem::path& folder) {
    std::error_code reason;
    const bool made = std::filesystem::create_directories(folder, reason);
    if (reason)
        return fail(ErrorCode::outside,
                    fmt::format("{}: cannot be made a folder: {}", folder.string(), reason.message()));
    return made;
}

}  // namespace skyloop
