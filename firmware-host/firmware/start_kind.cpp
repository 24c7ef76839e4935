#include "firmware/start_kind.hpp"

namespace skyloop::firmware {

std::optional<StartKind> start_kind(std::string_view word) {
    if (word == "cold") return StartKind::cold;
    if (word == "warm") return StartKind::warm;
    if (word == "hot") return StartKind::hot;
    return std::nullopt;
}

}  // namespace skyloop::firmware
