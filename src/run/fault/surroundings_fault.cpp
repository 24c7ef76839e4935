#include <algorithm>
#include <memory>

#include "detail/fault_catalogue.hpp"
#include "world/propagation/smooth_noise.hpp"
#include "world/propagation/surroundings.hpp"
#include "world/propagation/surroundings_effect.hpp"

namespace skyloop::inline run {
namespace {

// What is there already gives way in dB and in amplitude; a link budget has been made of it.
void give_way(Arrival& arrival, double share) {
    const Decibels loss = arrival.shadowing_loss * share;
    if (arrival.cn0) *arrival.cn0 += DbHz(loss.value());
    arrival.shadowing_loss -= loss;
    arrival.direct_loss = arrival.direct_loss * (1 - share);
    for (Echo& echo : arrival.echoes)
        echo.amplitude *= 1 - share;
}

void surround(Arrival& arrival, const ChannelSample& sample, Decibels cover, double strength) {
    Arrival met = arrival;
    met.echoes.clear();
    meet_surroundings(met, sample, Decibels(0));
    give_way(arrival, strength);
    const Decibels loss = met.shadowing_loss + cover;
    if (arrival.cn0) *arrival.cn0 -= DbHz(loss.value());
    arrival.shadowing_loss += loss;
    arrival.direct_loss += met.direct_loss + cover;
    arrival.shadowed = strength < 0.5 ? arrival.shadowed : met.shadowed;
    if (!met.line_of_sight) {
        arrival.line_of_sight = false;
        arrival.reflections = met.reflections;
        arrival.excess_path = met.excess_path;
        arrival.excess_rate = met.excess_rate;
    }
    arrival.echoes.insert(arrival.echoes.end(), met.echoes.begin(), met.echoes.end());
    arrival.paths = 1 + static_cast<int>(arrival.echoes.size());
}

Result<Fault> make_surroundings(const Parameters& parameters, const FaultContext& context) {
    const auto at = std::find(std::begin(surroundings_names), std::end(surroundings_names), parameters.text("around"));
    const ChannelParameters numbers = channel_of(static_cast<Surroundings>(at - std::begin(surroundings_names)));
    std::shared_ptr<StateChannel> channel;
    if (numbers.environment)
        channel = std::make_shared<StateChannel>(numbers, noise_key(context.seed, "fault." + context.name));
    return fault_of<&Fault::arrivals>([numbers, channel](Arrivals& arrivals, const FaultMoment& moment) {
        const ChannelPlace place = channel_place(*moment.truth);
        for (Arrival& arrival : arrivals.satellites) {
            if (arrival.paths == 0) continue;
            ChannelSample sample;
            if (channel) sample = between(sample, channel->at(arrival.id, arrival.direction, place), moment.strength);
            surround(arrival, sample, numbers.cover * moment.strength, moment.strength);
        }
    });
}

}  // namespace

constexpr FaultKind surroundings_fault{
    "surroundings",
    "Other surroundings of the antenna: shadowing, fading and echoes of the words of model.modern.surroundings, in "
    "place "
    "of "
    "those that are there.",
    "A drive under trees, between houses, into a tunnel; a vehicle that is carried indoors.",
    ParameterList{word_parameter("around", "", surroundings_names, "what surrounds the antenna").that_is_needed()},
    make_surroundings,
    of_measurements};

}  // namespace skyloop::inline run
