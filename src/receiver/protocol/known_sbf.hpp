/// The one list of the SBF blocks that are known here.
#pragma once

#include "receiver/protocol/sbf_cartesian_blocks.hpp"
#include "receiver/protocol/sbf_raw_blocks.hpp"
#include "receiver/protocol/sbf_status_blocks.hpp"

namespace skyloop::inline receiver {

using KnownSbfBlocks =
    MessageTypes<SbfMeasEpoch, SbfMeasExtra, SbfEndOfMeas, SbfGpsRawCa, SbfGpsRawL2c, SbfGpsRawL5, SbfQzsRawL2c,
                 SbfQzsRawL5, SbfGalRawFnav, SbfGloRawCa, SbfGalRawInav, SbfGeoRawL1, SbfBdsRaw, SbfQzsRawL1Ca,
                 SbfGpsNav, SbfGloNav, SbfGalNav, SbfBdsNav, SbfQzsNav, SbfPvtCartesian, SbfPvtGeodetic,
                 SbfPosCovCartesian, SbfPosCovGeodetic, SbfVelCovCartesian, SbfVelCovGeodetic, SbfDop,
                 SbfBaseVectorCart, SbfBaseVectorGeod, SbfEndOfPvt, SbfAttEuler, SbfAttCovEuler, SbfAuxAntPositions,
                 SbfEndOfAtt, SbfReceiverTime, SbfChannelStatus, SbfReceiverStatus, SbfSatVisibility, SbfQualityInd,
                 SbfRfStatus, SbfGalAuthStatus, SbfReceiverSetup>;

}  // namespace skyloop::inline receiver
