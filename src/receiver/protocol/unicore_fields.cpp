#include "receiver/protocol/unicore_fields.hpp"

#include <fmt/format.h>

namespace skyloop::inline receiver::unicore_fields {

std::string fixed_text(double value, int decimals) { return fmt::format("{:.{}f}", value, decimals); }
std::string mantissa_text(double value, int decimals) { return fmt::format("{:.{}e}", value, decimals); }
std::string digits_text(std::uint64_t value, int digits) { return fmt::format("{:0{}x}", value, digits); }

}  // namespace skyloop::inline receiver::unicore_fields
