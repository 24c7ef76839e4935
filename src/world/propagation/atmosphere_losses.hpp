/// What gases, clouds, rain and trees take from a signal in the modern profile.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "base/geo/geoid.hpp"
#include "world/gnss/constants.hpp"
#include "world/propagation/modern_parameters.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/propagation_parameters.hpp"
#include "world/propagation/specific_attenuation.hpp"

namespace skyloop::inline world {

/// slant_gas_attenuation_p676() from a table, to within 1e-4 dB from 0.5° and heights of 0 … 20 km; the integral itself
/// takes milliseconds. Constant below 0.5° and above 20 km, where what is left at L1 is below 0.03 dB.
///
/// State: the rows of the table, each made when it is first needed.
class GasLossTable {
public:
    explicit GasLossTable(Hertz carrier = Hertz(carrier_frequency_l1));
    /// @param elevation apparent: of the bent ray at the antenna  @param antenna_height above sea level
    Decibels loss(Angle elevation, Metres antenna_height);

private:
    static constexpr std::size_t heights = 41;
    const std::vector<double>& row(std::size_t index);

    Hertz carrier_;
    std::vector<double> abscissae_;                  // of the elevations, on the scale of interpolation
    std::array<std::vector<double>, heights> rows_;  // logarithm of the loss, by elevation
};

/// Writes the gas loss of each arrival: ITU-R P.676-13 through the reference atmosphere (MODELS.md 7.4), along the ray
/// that arrives at the satellite's elevation and refraction_bending().
class GasLoss : public PropagationEffect {
public:
    /// @param geoid must outlive this; without one, the ellipsoidal height stands in
    /// @param table of L1, shared with others of the same thread
    GasLoss(const ErrorTerm& term, const Geoid* geoid,
            std::shared_ptr<GasLossTable> table = std::make_shared<GasLossTable>())
        : factor_(term.factor()), geoid_(geoid), table_(std::move(table)) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    double factor_;
    const Geoid* geoid_;
    std::shared_ptr<GasLossTable> table_;
};

/// Writes the cloud loss: the liquid water of each deck over the straight path through it, ITU-R P.840-8. The water is
/// as warm as the reference atmosphere in the middle of the deck, and not colder than 0 °C, the temperature for which
/// P.840 reckons the liquid of a column (MODELS.md 7.5).
class CloudLoss : public PropagationEffect {
public:
    CloudLoss(const std::vector<CloudDeck>& decks, const ErrorTerm& term, const Geoid* geoid);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    struct Deck {
        Metres base, top;
        DecibelsPerKilometre attenuation;
    };
    std::vector<Deck> decks_;
    double factor_;
    const Geoid* geoid_;
};

/// Writes the rain loss: ITU-R P.838-3 over the straight path up to the rain's top, as far as the cell reaches. Another
/// model of the rain is the sensor models' (MODELS.md D-14).
class RainLoss : public PropagationEffect {
public:
    RainLoss(const Rain& rain, const ModernPropagationParameters& parameters, const Geoid* geoid)
        : rain_(rain), cell_(parameters.loss_model.rain_cell), factor_(parameters.rain.factor()), geoid_(geoid) {
        rain_.model = RainModel::p838;
    }
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    Rain rain_;
    Metres cell_;
    double factor_;
    const Geoid* geoid_;
};

/// Writes the foliage loss: crowns of trees on every side, so many decibels a metre up to a limit.
class FoliageLoss : public PropagationEffect {
public:
    FoliageLoss(const LossParameters& parameters, const ErrorTerm& term)
        : parameters_(parameters), factor_(term.factor()) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    LossParameters parameters_;
    double factor_;
};

}  // namespace skyloop::inline world
