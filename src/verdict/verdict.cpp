#include "skyloop/verdict/verdict.hpp"

#include <algorithm>

namespace skyloop {

std::string_view outcome_name(Outcome outcome) {
    switch (outcome) {
        case Outcome::passed:
            return "passed";
        case Outcome::failed:
            return "failed";
        case Outcome::undecided:
            return "undecided";
        case Outcome::not_run:
            return "not run";
    }
    return "";
}

bool all_met(std::span<const Verdict> verdicts) {
    return std::none_of(verdicts.begin(), verdicts.end(), [](const Verdict& verdict) {
        return verdict.outcome == Outcome::failed || verdict.outcome == Outcome::undecided;
    });
}

}  // namespace skyloop
