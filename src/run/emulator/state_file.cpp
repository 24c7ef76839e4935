#include "run/emulator/state_file.hpp"

#include <system_error>

#include "base/core/replace_file.hpp"
#include "base/core/text_file.hpp"

namespace skyloop {
namespace {

constexpr std::size_t largest_state = std::size_t{1} << 20;
constexpr Nanoseconds pause = std::chrono::seconds(1);

}  // namespace

Result<StateFile> StateFile::open(const std::filesystem::path& path) {
    StateFile file(path);
    std::error_code reason;
    if (!std::filesystem::exists(path, reason) && !reason) return file;
    auto text = read_text_file(path, largest_state);
    if (!text) return fail(text.error());
    file.text_ = std::move(*text);
    return file;
}

bool StateFile::due(GpsTime now) const { return !looked_ || now - *looked_ >= pause; }

void StateFile::keep(const std::string& text, GpsTime now) {
    looked_ = now;
    if (text.empty() || text == text_) return;
    if (const auto replaced = replace_file(path_, text); !replaced) {
        failure_ = replaced.error();
        return;
    }
    failure_.reset();
    text_ = text;
}

}  // namespace skyloop
