#include "run/verdict/verdict.hpp"

#include <algorithm>
#include <array>

namespace skyloop::inline run {

std::string_view outcome_name(Outcome outcome) {
    constexpr std::array<std::string_view, 4> names{"passed", "failed", "undecided", "not run"};
    return names[static_cast<std::size_t>(outcome)];
}

std::optional<bool> all_met(std::span<const Verdict> verdicts) {
    const auto any = [&](Outcome outcome) {
        return std::any_of(verdicts.begin(), verdicts.end(),
                           [outcome](const Verdict& v) { return v.outcome == outcome; });
    };
    if (any(Outcome::failed) || any(Outcome::undecided)) return false;
    if (any(Outcome::not_run)) return std::nullopt;
    return true;
}

bool is_success(std::span<const Verdict> verdicts) {
    const bool any_passed = std::any_of(verdicts.begin(), verdicts.end(),
                                        [](const Verdict& verdict) { return verdict.outcome == Outcome::passed; });
    return all_met(verdicts).value_or(any_passed);
}

}  // namespace skyloop::inline run
