#include "world/propagation/surroundings.hpp"

namespace skyloop::inline world {
namespace {

// Fitted to one record each by tools/validate: garden, trees, car, nagoya, canyon.
ChannelParameters street_channel_of(bool narrow) {
    ChannelParameters p;
    p.environment = P681Environment::urban;
    if (narrow) {
        p.bad_odds = 0.7;
        p.bad_loss = Decibels(10);
        p.diffuse = Decibels(1);
        p.reach = Angle::degrees(40);
        p.beat = Hertz(0.006);
        p.echo_delay = Metres(40);
        p.echo_length = Metres(10);
    } else {
        p.distance_scale = 4;
        p.bad_odds = 2;
        p.bad_loss = Decibels(12);
        p.diffuse = Decibels(5);
        p.reach = Angle::degrees(90);  // the houses of one side of a street
        p.echo_delay = Metres(150);
        p.echo_length = Metres(7);
    }
    return p;
}

ChannelParameters fitted_channel_of(Surroundings surroundings) {
    ChannelParameters p;
    if (surroundings == Surroundings::residential) {
        p.environment = P681Environment::residential;
        p.bad_odds = 0.5;
        p.diffuse = Decibels(-10);
        p.beat = Hertz(0.001);
        p.echo_delay = Metres(5);
    } else if (surroundings == Surroundings::forest) {
        p.environment = P681Environment::wooded;
        p.bad_odds = 4;
        p.bad_loss = Decibels(2);
        p.diffuse = Decibels(-2.5);
        p.creep = MetresPerSecond(0.02);
        p.beat = Hertz(0.002);
        p.echo_delay = Metres(12);
    } else if (surroundings == Surroundings::suburban_drive) {
        p.environment = P681Environment::suburban;
        p.bad_odds = 0.35;
        p.bad_loss = Decibels(3);
        p.shadowing_scale = 1.5;
        p.echo_length = Metres(30);
    } else {
        return street_channel_of(surroundings == Surroundings::urban_canyon);
    }
    return p;
}

// Under or behind what lets nothing or little through.
ChannelParameters covered_channel_of(Surroundings surroundings) {
    ChannelParameters p;
    if (surroundings == Surroundings::tunnel) {
        p.cover = Decibels(60);
        return p;
    }
    p = fitted_channel_of(Surroundings::urban);
    if (surroundings == Surroundings::garage) {
        p.distance_scale = 0.3;
        p.cover = Decibels(22);
        p.echo_delay = Metres(15);
    } else {  // a room, near its window
        p.bad_odds = 5;
        p.distance_scale = 0.5;
        p.good_loss = Decibels(8);
        p.bad_loss = Decibels(5);
        p.diffuse = Decibels(-6);
        p.reach = Angle::degrees(30);
        p.echo_delay = Metres(10);
    }
    return p;
}

}  // namespace

// The environments are those of P.681-11. The numbers of rural, indoor-window, valley, tunnel and garage are invented:
// held against no record, they follow from the fitted ones and from what the words mean.
ChannelParameters channel_of(Surroundings surroundings) {
    ChannelParameters p;
    switch (surroundings) {
        case Surroundings::open_sky:
            break;
        case Surroundings::rural:
            p.environment = P681Environment::village;
            p.bad_odds = 0.2;
            p.echo_length = Metres(30);
            break;
        case Surroundings::residential:
        case Surroundings::forest:
        case Surroundings::suburban_drive:
        case Surroundings::urban:
        case Surroundings::urban_canyon:
            return fitted_channel_of(surroundings);
        case Surroundings::valley:
            p.environment = P681Environment::village;
            p.bad_loss = Decibels(25);
            p.distance_scale = 5;
            p.wall = Angle::degrees(25);
            p.wall_spread = Angle::degrees(4);
            p.diffuse = Decibels(-8);
            p.echo_delay = Metres(200);
            break;
        case Surroundings::indoor_window:
        case Surroundings::tunnel:
        case Surroundings::garage:
            return covered_channel_of(surroundings);
    }
    return p;
}

}  // namespace skyloop::inline world
