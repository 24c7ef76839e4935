#include "run/scenario/modern_settings.hpp"

namespace skyloop::inline run {

// The environments are P.681-11's; all other numbers are ours. Those of forest and suburban-drive are fitted to records
// of one place each (tools/validate: trees, car), the others follow from them and from what the words mean.
ChannelParameters channel_of(Surroundings surroundings) {
    ChannelParameters p;
    switch (surroundings) {
        case Surroundings::open_sky:
        case Surroundings::residential:
            break;
        case Surroundings::rural:
            p.environment = P681Environment::village;
            p.bad_odds = 0.4;
            break;
        case Surroundings::forest:
            p.environment = P681Environment::wooded;
            p.bad_odds = 2;
            p.creep = MetresPerSecond(0.02);
            break;
        case Surroundings::suburban_drive:
            p.environment = P681Environment::suburban;
            break;
        case Surroundings::urban:
            p.environment = P681Environment::urban;
            p.echo_delay = Metres(20);
            break;
        case Surroundings::urban_canyon:
            p.environment = P681Environment::urban;
            p.bad_odds = 3;
            p.echo_delay = Metres(30);
            break;
        case Surroundings::indoor_window:
            p.environment = P681Environment::urban;
            p.bad_odds = 8;
            p.distance_scale = 0.2;
            p.good_loss = Decibels(6);
            p.bad_loss = Decibels(6);
            break;
    }
    return p;
}

}  // namespace skyloop::inline run
