#include "base/core/say.hpp"

#include <cstdio>

namespace skyloop {

void say(std::string_view text) { static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr)); }

}  // namespace skyloop
