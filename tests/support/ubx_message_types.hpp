/// Every UBX message that has a layout: those that a receiver sends, and those that set it.
#pragma once

#include <optional>

#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_cfg_navigation.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_inertial.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_raw.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "receiver/protocol/ubx_services.hpp"
#include "receiver/protocol/ubx_time.hpp"

namespace skyloop {

template <class... Message>
struct UbxTypes {
    /// True for an id that one of the types has.
    static bool names(UbxMessageId id) { return ((Message::message_id == id) || ...); }

    /// The frame as it is written again from what was read from it; nothing when no type of that id can read it.
    static std::optional<Bytes> written_again(const UbxFrameView& frame) {
        std::optional<Bytes> bytes;
        (try_one<Message>(frame, bytes), ...);
        return bytes;
    }

    /// Calls the function with a fresh message of every type.
    template <class Function>
    static void for_each(const Function& function) {
        (function(Message{}), ...);
    }

private:
    template <class M>
    static void try_one(const UbxFrameView& frame, std::optional<Bytes>& bytes) {
        if (bytes || M::message_id != frame.id) return;
        if (const auto message = decode_payload<M>(frame.payload)) bytes = encode_frame(*message);
    }
};

using UbxOutputTypes =
    UbxTypes<NavPosecef, NavPosllh, NavStatus, NavDop, NavAtt, NavPvat, NavSol, NavPvt, NavOdo, NavVelecef, NavVelned,
             NavHpposecef, NavHpposllh, NavTimegps, NavTimeutc, NavClock, NavTimeglo, NavTimebds, NavTimegal, NavTimels,
             NavTimeqzss, NavSvinfo, NavDgps, NavSbas, NavOrb, NavSat, NavCov, NavGeofence, NavSvin, NavRelposned0,
             NavRelposned, NavEell, NavSlas, NavSig, NavAopstatus, NavEoe, NavPl, RxmSfrbx, RxmMeasx, RxmRawx, RxmSvsi,
             RxmRtcm, RxmCor, RxmRlm, InfError, InfWarning, InfNotice, InfTest, InfDebug, AckAck, AckNak, MonIo, MonVer,
             MonMsgpp, MonRxbuf, MonTxbuf, MonHw, MonHwLong, MonHwShort, MonHw2, MonRxr, MonPatch, MonGnss, MonSpan,
             MonComms, MonHw3, MonRf, MonSys, TimTp, TimTm2, TimVrfy, MgaAck, SecUniqid, SecSig1, SecSig2, SecSiglog,
             EsfStatus, HnrPvt, HnrAtt, HnrIns>;

/// Every UBX message of settings that has a layout, questions among them.
using UbxSettingTypes =
    UbxTypes<CfgPrtPoll, CfgPrt, CfgMsgPoll, CfgMsgCurrentPort, CfgMsg, CfgRate, CfgNav5, CfgGnss, CfgCfg, CfgRst,
             CfgTp5, CfgItfm, CfgPms, CfgRxm, CfgAnt, CfgLogfilter, UpdSos, UpdSosStatus, CfgNavx5, CfgSbas, CfgOdo,
             CfgDgnss, CfgTmode3, CfgGeofence, CfgDat, CfgDatSet, CfgPm2, CfgPwr, RxmPmreqShort, RxmPmreq, CfgInf,
             CfgNmeaShort, CfgNmeaV0, CfgNmea, CfgUsb, CfgValset, CfgValgetPoll, CfgValget, CfgValdel>;

}  // namespace skyloop
