/// From the receiver's state to SBF blocks beside the solution.
#pragma once

#include "firmware/messages/other_protocols.hpp"
#include "receiver/protocol/sbf_status_blocks.hpp"

namespace skyloop::firmware {

/// Of a pair's vector; of the roll nothing is known. Without a pair error 1.
SbfAttCovEuler sbf_attitude_covariance(const NavigationState& state);
/// The vector of a pair, or, with corrections, from where their station says it stands; without either no base.
SbfBaseVectorGeod sbf_base_vector(const NavigationState& state);
SbfEndOfAtt sbf_end_of_attitude(const NavigationState& state);
/// By satellites and their C/N0, by interference and by the age of corrections; the maker's own rule is not published.
SbfQualityInd sbf_quality(const NavigationState& state);
/// A band where interference is noticed, and bit 0 of the flags where spoofing is.
SbfRfStatus sbf_radio_status(const NavigationState& state);
/// OSNMA is switched off.
SbfGalAuthStatus sbf_authentication(const NavigationState& state);
SbfReceiverTime sbf_receiver_time(const NavigationState& state);

}  // namespace skyloop::firmware
