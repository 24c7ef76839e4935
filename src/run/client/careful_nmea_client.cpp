#include "run/client/careful_nmea_client.hpp"

#include <chrono>

namespace skyloop {
namespace {

constexpr Nanoseconds longest_without_pair = std::chrono::seconds(3);

// Quality 6 is dead reckoning, 7 typed in by hand, 8 simulated, 3 military: none is a fix to fly by.
bool is_good_quality(int quality) { return quality == 1 || quality == 2 || quality == 4 || quality == 5; }

}  // namespace

void CarefulNmeaClient::speed_found() {
    epochs_ = NmeaEpochs();
    parts_ = 0;
    solution_at_ = now();
}

void CarefulNmeaClient::watch() {
    if (now() - solution_at_ > longest_without_pair) doubt("no GGA and RMC of the same time for 3 s");
}

void CarefulNmeaClient::hear_message(const StreamPiece& piece) {
    constexpr unsigned pair = NmeaEpochs::says_gga | NmeaEpochs::says_rmc;
    const NmeaEpochs::Taken taken = epochs_.take(to_string(piece.bytes));
    if (taken.ended) parts_ = 0;
    parts_ |= taken.part & pair;
    if (parts_ != pair) return;
    parts_ = 0;
    combine(*epochs_.epoch());
}

void CarefulNmeaClient::combine(const NmeaEpoch& epoch) {
    const ObservedEpoch& told = epoch.told;
    HeardSolution solution = heard_solution(told, now());
    const bool good = is_good_quality(told.quality.value_or(0));
    const bool valid = told.claims_fix.value_or(false);
    solution.valid = good && valid;
    solution.has_place = solution.has_place && told.type != FixType::none;  // RMC's place is not GGA's
    solution.three_dimensional = epochs_.fix_mode().value_or(3) == 3;
    solution.seconds_wrap = to_seconds(std::chrono::hours(24)).value();
    if (epoch.of_day) solution.seconds = to_seconds(*epoch.of_day).value();
    solution_at_ = now();
    judge(solution);
    if (good != valid) doubt("GGA and RMC disagree on whether there is a fix");
}

}  // namespace skyloop
