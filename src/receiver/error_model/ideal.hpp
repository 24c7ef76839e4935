/// A receiver without errors.
#pragma once

#include "receiver/error_model/error_model.hpp"
#include "receiver/error_model/fix_builder.hpp"

namespace skyloop {

/// The fix is the truth, velocity included, with every healthy satellite above the mask, hidden or not (MODELS.md
/// section 6). Its accuracies are 0. At rest its course is the last one.
///
/// State: that course.
class Ideal : public ErrorModel {
public:
    explicit Ideal(const SensorContext& context) : builder_(context, {.hidden_too = true}) {}
    Fix fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) override;

private:
    FixBuilder builder_;
    Angle course_;
};

}  // namespace skyloop
