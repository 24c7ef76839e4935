#include "base/core/spared_file.hpp"

#include <fmt/format.h>

#include <system_error>

namespace skyloop {

Result<void> check_spares(std::string_view writer, const std::filesystem::path& out,
                          const std::vector<std::filesystem::path>& inputs) {
    std::error_code absent;  // what is not there is no input
    for (const std::filesystem::path& input : inputs)
        if (std::filesystem::equivalent(out, input, absent))
            return fail(ErrorCode::usage,
                        fmt::format("{} '{}': this file is read, too, and would be lost; expected another", writer,
                                    out.string()));
    return {};
}

}  // namespace skyloop
