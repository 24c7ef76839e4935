#include "firmware/septentrio/rover_and_station.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "base/core/number_text.hpp"
#include "firmware/core/port_id.hpp"

namespace skyloop::firmware {
namespace {

bool is_rover_mode(const SeptentrioSettings& settings, std::string_view mode) {
    return lists(settings.values("PVTMode")[1], mode);
}

bool allows(const SeptentrioSettings& settings, CorrectionState state) {
    switch (state) {
        case CorrectionState::none:
            return true;
        case CorrectionState::differential:
            return is_rover_mode(settings, "DGNSS") || is_rover_mode(settings, "DGPS");
        case CorrectionState::rtk_float:
            return is_rover_mode(settings, "RTKFloat") || is_rover_mode(settings, "RTK");
        case CorrectionState::rtk_fixed:
            return is_rover_mode(settings, "RTKFixed") || is_rover_mode(settings, "RTK");
    }
    return true;
}

constexpr std::array named_signals{NamedSignal{{Constellation::gps, Signal::l1}, "GPSL1CA"},
                                   NamedSignal{{Constellation::gps, Signal::l2}, "GPSL2C"},
                                   NamedSignal{{Constellation::gps, Signal::l5}, "GPSL5"},
                                   NamedSignal{{Constellation::sbas, Signal::l1}, "GEOL1"},
                                   NamedSignal{{Constellation::galileo, Signal::l1}, "GALL1BC"},
                                   NamedSignal{{Constellation::galileo, Signal::l5}, "GALE5a"},
                                   NamedSignal{{Constellation::galileo, Signal::e5b}, "GALE5b"},
                                   NamedSignal{{Constellation::beidou, Signal::b1i}, "BDSB1I"},
                                   NamedSignal{{Constellation::beidou, Signal::e5b}, "BDSB2I"},
                                   NamedSignal{{Constellation::beidou, Signal::b3i}, "BDSB3I"},
                                   NamedSignal{{Constellation::qzss, Signal::l1}, "QZSL1CA"},
                                   NamedSignal{{Constellation::qzss, Signal::l2}, "QZSL2C"},
                                   NamedSignal{{Constellation::qzss, Signal::l5}, "QZSL5"},
                                   NamedSignal{{Constellation::glonass, Signal::g1}, "GLOL1CA"},
                                   NamedSignal{{Constellation::glonass, Signal::g2}, "GLOL2CA"},
                                   NamedSignal{{Constellation::navic, Signal::l5}, "NAVICL5"},
                                   NamedSignal{{Constellation::beidou, Signal::l5}, "BDSB2a"}};

}  // namespace

bool lists(std::string_view words, std::string_view word) {
    const std::vector<std::string> list = split_words(words, '+');
    return std::any_of(list.begin(), list.end(),
                       [&](const std::string& one) { return same_word(one, word) || same_word(one, "all"); });
}

CorrectionState allowed_corrections(const SeptentrioSettings& settings, CorrectionState at_hand) {
    for (const CorrectionState state :
         {CorrectionState::rtk_fixed, CorrectionState::rtk_float, CorrectionState::differential})
        if (state <= at_hand && allows(settings, state)) return state;
    return CorrectionState::none;
}

void withhold_forbidden(const SeptentrioSettings& settings, NavigationState& state) {
    const bool alone = state.epoch.fix.type == FixType::fix_2d || state.epoch.fix.type == FixType::fix_3d;
    const bool forbidden =
        alone ? !is_rover_mode(settings, "StandAlone")
              : state.epoch.fix.type == FixType::rtk_float && !allows(settings, CorrectionState::rtk_float);
    if (!forbidden) return;
    state.fix_ok = false;
    state.kind_forbidden = true;
}

std::optional<std::uint64_t> model_of_motion(std::string_view motion) {
    constexpr std::uint64_t stationary = 2, pedestrian = 3, automotive = 4, airborne_4g = 8;
    constexpr std::array<std::pair<std::string_view, std::uint64_t>, 9> models{{{"Static", stationary},
                                                                                {"Quasistatic", stationary},
                                                                                {"EarthquakeMon", stationary},
                                                                                {"Pedestrian", pedestrian},
                                                                                {"Automotive", automotive},
                                                                                {"HeavyMachinery", automotive},
                                                                                {"RaceCar", airborne_4g},
                                                                                {"UAV", airborne_4g},
                                                                                {"Unlimited", airborne_4g}}};
    for (const auto& [name, model] : models)
        if (same_word(name, motion)) return model;
    return std::nullopt;
}

std::span<const NamedSignal> septentrio_signals() { return named_signals; }

bool lets_through(const SeptentrioSettings& settings, std::string_view port, std::string_view protocol) {
    const auto& directions = settings.values("DataInOut", port);
    if (directions.size() < 2) return true;
    const auto outputs = split_words(directions[1], '+');
    return std::any_of(outputs.begin(), outputs.end(), [&](const auto& word) { return same_word(word, protocol); });
}

std::optional<Position<Ecef>> told_place(const SeptentrioSettings& settings) {
    const auto& mode = settings.values("PVTMode");
    if (mode[0] != "Static") return std::nullopt;
    const bool geodetic = mode[2].starts_with("Geodetic");
    const auto& place = settings.values(geodetic ? "StaticPosGeodetic" : "StaticPosCartesian", mode[2]);
    if (place.empty()) return std::nullopt;
    std::array<double, 3> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = number_in<double>(place[i]).value_or(0);
    if (numbers == std::array<double, 3>{}) return std::nullopt;
    if (geodetic) return to_ecef(Geodetic::degrees(numbers[0], numbers[1], numbers[2]));
    return Position<Ecef>(numbers[0], numbers[1], numbers[2]);
}

}  // namespace skyloop::firmware
