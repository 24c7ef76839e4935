#include "receiver/error_model/error_model.hpp"

#include "receiver/error_model/baseline.hpp"
#include "receiver/error_model/simple_models.hpp"

namespace skyloop::inline receiver {

std::unique_ptr<ErrorModel> make_error_model(const ErrorModelSettings& s) {
    switch (s.kind) {
        case ErrorModelKind::ideal:
            return std::make_unique<Ideal>(s.sensor);
        case ErrorModelKind::constant_sigma:
            return std::make_unique<ConstantSigma>(s.constant_sigma, s.sensor);
        case ErrorModelKind::satellite_count:
            return std::make_unique<SatelliteCount>(s.satellite_count, s.sensor);
        case ErrorModelKind::whole_path:
            return std::make_unique<WholePath>(s.baseline, s.sensor);
        case ErrorModelKind::refraction:
            return std::make_unique<Refraction>(s.refraction, s.sensor);
        case ErrorModelKind::baseline:
            break;
    }
    return std::make_unique<Baseline>(s.baseline, s.sensor);
}

}  // namespace skyloop::inline receiver
