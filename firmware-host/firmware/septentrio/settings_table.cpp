#include "firmware/septentrio/settings.hpp"

#include <algorithm>
#include <array>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::string_view serial_ports = "COM1 COM2";
constexpr std::string_view connections =
    "COM1 COM2 USB1 USB2 IPS1 IPS2 IPS3 IP10 IP11 IP12 IP13 IP14 IP15 IP16 IP17 NTR1";
constexpr std::string_view streams = "Stream1 Stream2 Stream3 Stream4 Stream5 Stream6 Stream7 Stream8 Stream9 Stream10";
constexpr std::string_view every_system = "GPS+GLONASS+GALILEO+SBAS+BEIDOU+QZSS+NAVIC";
constexpr std::string_view correction_paces =
    "RTCM1001|2 RTCM1003|4 RTCM1005|6 RTCM1007|8 RTCM1009|10 RTCM1011|12 RTCM1013 RTCM1019 RTCM1020 RTCM1029 RTCM1033 "
    "RTCM1042 RTCM1044 RTCM1045 RTCM1046 RTCM1230 MSM1 MSM2 MSM3 MSM4 MSM5 MSM6 MSM7";

constexpr SettingGroup setting_group_table[] = {
    {"scs", "gcs", "COMSettings", serial_ports, "Rate DataBits Parity StopBits FlowControl",
     "baud115200,bits8,No,bit1,none"},
    {"sdio", "gdio", "DataInOut", connections, "Input Output+ Show", "auto,SBF+NMEA,(on)"},
    {"sso", "gso", "SBFOutput", streams, "Cd Messages+ Interval", "none,none,off"},
    {"sno", "gno", "NMEAOutput", streams, "Cd Messages+ Interval", "none,none,off"},
    {"snti", "gnti", "NMEATalkerID", "", "TalkerID", "auto"},
    {"spm", "gpm", "PVTMode", "", "Mode RoverMode+ StaticPosition",
     "Rover,StandAlone+SBAS+DGNSS+RTKFloat+RTKFixed,auto"},
    {"sspg", "gspg", "StaticPosGeodetic", "Geodetic1 Geodetic2 Geodetic3 Geodetic4 Geodetic5",
     "Latitude Longitude Altitude Datum", "0.000000000,0.000000000,0.0000,WGS84"},
    {"sspc", "gspc", "StaticPosCartesian", "Cartesian1 Cartesian2 Cartesian3 Cartesian4 Cartesian5", "X Y Z Datum",
     "0.0000,0.0000,0.0000,WGS84"},
    // Real ones send all that a rover needs, once the port lets it out; which messages these are was not to be read.
    {"sr3o", "gr3o", "RTCMv3Output", connections, "Messages+",
     "RTCM1006+RTCM1033+RTCM1074+RTCM1084+RTCM1094+RTCM1124+RTCM1230"},
    {"sr3i", "gr3i", "RTCMv3Interval", correction_paces, "Interval", "1"},
    {"sr3f", "gr3f", "RTCMv3Formatting", "", "ReferenceID Signals+", "0,all"},
    {"srd", "grd", "ReceiverDynamics", "", "Level Motion", "Moderate,Automotive"},
    {"sem", "gem", "ElevationMask", "Tracking PVT", "Mask", "0"},
    {"sst", "gst", "SatelliteTracking", "", "Satellite+", every_system},
    {"ssu", "gsu", "SatelliteUsage", "", "Satellite+", every_system},
    {"snt", "gnt", "SignalTracking", "", "Signal+", "GPSL1CA+GLOL1CA+GALL1BC+GEOL1+BDSB1I"},
    {"snu", "gnu", "SignalUsage", "", "PVT+ NavData+",
     "GPSL1CA+GLOL1CA+GALL1BC+GEOL1+BDSB1I,GPSL1CA+GLOL1CA+GALL1BC+GEOL1+BDSB1I"},
    {"ssbc", "gsbc", "SBASCorrections", "", "Satellite SISMode NavMode DO229Version",
     "auto,Operational,MixedSystems,auto"},
    {"sdcu", "gdcu", "DiffCorrUsage", "", "Mode MaxAge BaseSelection BaseID MovingBase", "LowLatency,20.0,auto,0,off"},
    {"sga", "gga", "GNSSAttitude", "", "Source", "MultiAntenna"},
    {"sto", "gto", "AttitudeOffset", "", "Heading Pitch", "0.000,0.000"},
    {"sal", "gal", "AntennaLocation", "Base Aux1", "Mode DeltaX DeltaY DeltaZ", "auto,0.0000,0.0000,0.0000"},
    {"sao", "gao", "AntennaOffset", "Main Aux1", "DeltaE DeltaN DeltaU Type SerialNr SetupID",
     "0.0000,0.0000,0.0000,Unknown,Unknown,0"},
    {"smp", "gmp", "MarkerParameters", "",
     "MarkerName MarkerNumber MarkerType StationCode MonumentIdx ReceiverIdx CountryCode",
     "SEPT,Unknown,Unknown,,0,0,"},
    {"sop", "gop", "ObserverParameters", "", "Observer Agency", "Unknown,Unknown"},
    {"sgd", "ggd", "GeodeticDatum", "", "TargetDatum", "Default"},
    {"sgu", "ggu", "GeoidUndulation", "", "Mode Undulation", "auto,0.0"},
    {"shm", "ghm", "HealthMask", "Tracking PVT", "Mask", "on"},
    {"scm", "gcm", "CN0Mask", "", "Signal Mask", "all,0"},
    {"srl", "grl", "RAIMLevels", "", "Mode Pfa Pmd Reliability", "on,-4,-4,-3"},
    {"stsy", "gtsy", "TimingSystem", "", "System", "auto"},
    {"sntp", "gntp", "NTPServer", "", "Enable", "off"},
    {"snc", "gnc", "NtpClient", "", "Mode Server", "off,"},
    {"spps", "gpps", "PPSParameters", "", "Interval Polarity Delay TimeScale MaxSyncAge PulseWidth",
     "sec1,Low2High,0.00,GPS,60,5.000000"},
    {"sep", "gep", "EventParameters", "EventA EventB", "Polarity Delay", "Low2High,0.000"},
    {"snts", "gnts", "NtripSettings", "NTR1 NTR2 NTR3", "Mode Caster Port UserName Password MountPoint Version SendGGA",
     "off,,2101,,,,v2,auto"},
    {"sntt", "gntt", "NtripTLSSettings", "NTR1 NTR2 NTR3", "Enable Fingerprint", "off,"},
    {"siss", "giss", "IPServerSettings", "IPS1 IPS2 IPS3", "Port Mode UDPAddress", "0,TCP2Way,255.255.255.255"},
    {"spi", "gpi", "ProjectionParameters", "", "Name", "none"},
    {"snf", "gnf", "NotchFiltering", "Notch1 Notch2 Notch3", "Mode CenterFreq Bandwidth", "auto,1100.000,30"},
    {"swbi", "gwbi", "WBIMitigation", "", "Mode", "off"},
    {"sou", "gou", "GalOSNMAUsage", "", "Mode", "off"},
    {"sdo", "gdo", "DebugOutput", "", "Mode", "off"},
    {"sfn", "gfn", "FileNaming", "DSK1", "NamingType FileName", "FileName,log"},
};

// Their order is that in which blocks leave within an epoch.
constexpr std::string_view blocks =
    "MeasEpoch MeasExtra Meas3Ranges Meas3CN0HiRes Meas3Doppler Meas3PP Meas3MP EndOfMeas PVTCartesian PVTGeodetic "
    "PosCovCartesian PosCovGeodetic VelCovCartesian VelCovGeodetic DOP PosCart PosLocal PosProjected BaseVectorCart "
    "BaseVectorGeod PVTSupport PVTSupportA EndOfPVT AttEuler AttCovEuler AuxAntPositions EndOfAtt ReceiverTime "
    "xPPSOffset ExtEvent ExtEventPVTCartesian ExtEventPVTGeodetic ExtEventBaseVectGeod ExtEventAttEuler DiffCorrIn "
    "BaseStation RTCMDatum ChannelStatus ReceiverStatus InputLink OutputLink NTRIPClientStatus NTRIPServerStatus "
    "IPStatus DynDNSStatus QualityInd DiskStatus LogStatus RFStatus P2PPStatus CosmosStatus GALAuthStatus "
    "FugroAuthorizationStatus SatVisibility ReceiverSetup RxMessage Commands Comment BBSamples ASCIIIn "
    "EncapsulatedOutput GPSRawCA GPSRawL2C GPSRawL5 GPSRawL1C GLORawCA GALRawFNAV GALRawINAV GALRawCNAV GEORawL1 "
    "GEORawL5 "
    "BDSRaw BDSRawB1C BDSRawB2a BDSRawB2b QZSRawL1CA QZSRawL2C QZSRawL5 NAVICRaw GPSNav GPSAlm GPSIon GPSUtc GPSCNav "
    "GLONav GLOAlm GLOTime GALNav GALAlm GALIon GALUtc GALGstGps GALSARRLM BDSNav BDSAlm BDSIon BDSUtc QZSNav QZSAlm "
    "NAVICLNav GEOMT00 GEOPRNMask GEOFastCorr GEOIntegrity GEOFastCorrDegr GEONav GEODegrFactors GEONetworkTime GEOAlm "
    "GEOIGPMask GEOLongTermCorr GEOIonoDelay GEOServiceLevel GEOClockEphCovMatrix";
// Groups, and of their blocks those that this receiver has.
constexpr std::string_view support_blocks =
    "MeasEpoch+MeasExtra+EndOfMeas+GPSRawCA+GLORawCA+GALRawINAV+GEORawL1+BDSRaw+QZSRawL1CA+GPSNav+GLONav+GALNav+BDSNav+"
    "QZSNav+"
    "PVTGeodetic+PosCovGeodetic+BaseVectorGeod+DOP+EndOfPVT+ChannelStatus+ReceiverStatus+ReceiverSetup+QualityInd+"
    "RFStatus+GALAuthStatus";
constexpr std::array<std::pair<std::string_view, std::string_view>, 18> block_groups{{
    {"Measurements", "MeasEpoch+MeasExtra+EndOfMeas"},
    {"RawNavBits",
     "GPSRawCA+GPSRawL2C+GPSRawL5+GLORawCA+GALRawFNAV+GALRawINAV+GEORawL1+BDSRaw+QZSRawL1CA+QZSRawL2C+QZSRawL5"},
    {"GPS", "GPSNav"},
    {"GLO", "GLONav"},
    {"GAL", "GALNav"},
    {"BDS", "BDSNav"},
    {"QZS", "QZSNav"},
    {"PVTCart", "PVTCartesian+PosCovCartesian+VelCovCartesian+BaseVectorCart+EndOfPVT"},
    {"PVTGeod", "PVTGeodetic+PosCovGeodetic+VelCovGeodetic+DOP+BaseVectorGeod+EndOfPVT"},
    {"PVTExtra", "DOP+EndOfPVT"},
    {"Attitude", "AttEuler+AttCovEuler+EndOfAtt"},
    {"Time", "ReceiverTime"},
    {"Status", "ChannelStatus+ReceiverStatus+SatVisibility+QualityInd+RFStatus+GALAuthStatus"},
    {"PostProcess",
     "MeasEpoch+MeasExtra+EndOfMeas+GPSRawCA+GLORawCA+GALRawINAV+GEORawL1+BDSRaw+QZSRawL1CA+GPSNav+GLONav+GALNav+"
     "BDSNav+QZSNav+"
     "BaseVectorGeod+ReceiverSetup"},
    {"Rinex", "MeasEpoch+GPSNav+GLONav+GALNav+BDSNav+QZSNav+ReceiverSetup"},
    {"Rinex3", "MeasEpoch+GPSNav+GLONav+GALNav+BDSNav+QZSNav+ReceiverSetup"},
    {"Support", support_blocks},
}};
constexpr std::string_view group_names =
    "Measurements Meas3 RawNavBits GPS GLO GAL GEO BDS QZS NAVIC PVTCart PVTGeod PVTExtra Attitude Time Event DiffCorr "
    "ExtEventCart ExtEventGeod Status LBand UserGroup1 UserGroup2 UserGroup3 UserGroup4 UserGroup5 UserGroup6 "
    "UserGroup7 UserGroup8 PostProcess Rinex Rinex3 Support";
constexpr std::string_view sentences =
    "GGA RMC GLL GNS GRS GSA GST GSV VTG ZDA HDT ALM DTM GBS HRP LLQ RBP RBV ROT SNC TFM TXTbase AVR GGK HEA LLK PUMRD "
    "THS VLW";
constexpr std::string_view intervals =
    "off OnChange msec10 msec20 msec40 msec50 msec100 msec200 msec500 sec1 sec2 sec5 sec10 sec15 sec30 sec60 min2 min5 "
    "min10 min15 min30 min60";
constexpr std::string_view output_ports =
    "none COM1 COM2 USB1 USB2 IPS1 IPS2 IPS3 IP10 IP11 IP12 IP13 IP14 IP15 IP16 IP17 NTR1 NTR2 NTR3 DSK1";
constexpr std::string_view line_speeds =
    "baud1200 baud2400 baud4800 baud9600 baud19200 baud38400 baud57600 baud115200 baud230400 baud460800 baud500000 "
    "baud576000 baud921600 baud1000000 baud1500000 baud2000000 baud2500000 baud3000000 baud3500000 baud4000000";

constexpr std::string_view signal_words =
    "GPSL1CA GPSL1PY GPSL2PY GPSL2C GPSL5 GPSL1C GLOL1CA GLOL1P GLOL2P GLOL2CA GLOL3 GALL1BC GALE6BC GALE5a GALE5b "
    "GALE5 GEOL1 GEOL5 BDSB1I BDSB2I BDSB3I BDSB1C BDSB2a BDSB2b QZSL1CA QZSL2C QZSL5 QZSL6 QZSL1C QZSL1S QZSL5S "
    "QZSL1CB NAVICL5 all";

constexpr std::string_view reference_places =
    "auto Geodetic1 Geodetic2 Geodetic3 Geodetic4 Geodetic5 Cartesian1 Cartesian2 Cartesian3 Cartesian4 Cartesian5";
constexpr std::string_view correction_messages =
    "none RTCM1001 RTCM1002 RTCM1003 RTCM1004 RTCM1005 RTCM1006 RTCM1007 RTCM1008 RTCM1009 RTCM1010 RTCM1011 RTCM1012 "
    "RTCM1013 RTCM1019 RTCM1020 RTCM1029 RTCM1033 RTCM1042 RTCM1044 RTCM1045 RTCM1046 RTCM1071 RTCM1072 RTCM1073 "
    "RTCM1074 RTCM1075 RTCM1076 RTCM1077 RTCM1081 RTCM1082 RTCM1083 RTCM1084 RTCM1085 RTCM1086 RTCM1087 RTCM1091 "
    "RTCM1092 RTCM1093 RTCM1094 RTCM1095 RTCM1096 RTCM1097 RTCM1101 RTCM1102 RTCM1103 RTCM1104 RTCM1105 RTCM1106 "
    "RTCM1107 RTCM1111 RTCM1112 RTCM1113 RTCM1114 RTCM1115 RTCM1116 RTCM1117 RTCM1121 RTCM1122 RTCM1123 RTCM1124 "
    "RTCM1125 RTCM1126 RTCM1127 RTCM1131 RTCM1132 RTCM1133 RTCM1134 RTCM1135 RTCM1136 RTCM1137 RTCM1230 MSM1 MSM2 MSM3 "
    "MSM4 MSM5 MSM6 MSM7 all";

// Of inputs and outputs all that the guides of mosaic, AsteRx and PolaRx5 know.
constexpr std::string_view input_formats =
    "auto none CMD RTCMv2 RTCMv3 RTCMV CMRv2 DC1 DC2 ASCIIIN LBandBeam1 LBandBeam2 SPARTN SBF NMEA ExtSensor MTI IMU "
    "DMI";
constexpr std::string_view output_formats =
    "none RTCMv2 RTCMv3 RTCMV CMRv2 SBF NMEA ASCIIDisplay DC1 DC2 BINEX Encapsulate LBandBeam1 LBandBeam2 SPARTN all";
constexpr std::string_view pulse_intervals =
    "off msec10 msec20 msec50 msec100 msec200 msec250 msec500 sec1 sec2 sec4 sec5 sec10 sec30 sec60";

constexpr std::pair<WordKind, std::string_view> words_of_kinds[] = {
    {WordKind::block, blocks},
    {WordKind::block_group, group_names},
    {WordKind::sentence, sentences},
    {WordKind::interval, intervals},
    {WordKind::port, output_ports},
    {WordKind::line_speed, line_speeds},
    {WordKind::pvt_mode, "Rover Static"},
    {WordKind::rover_mode, "StandAlone SBAS DGNSS DGPS RTKFloat RTKFixed RTK PPP all"},
    {WordKind::level, "Max High Moderate Low"},
    {WordKind::motion, "Static Quasistatic Pedestrian Automotive RaceCar HeavyMachinery UAV Unlimited EarthquakeMon"},
    {WordKind::signal, signal_words},
    {WordKind::place, reference_places},
    {WordKind::datum, "WGS84 ETRS89 NAD83 NAD83_PA NAD83_MA GDA94 GDA2020 User1 User2 Other"},
    {WordKind::correction, correction_messages},
    {WordKind::on_off, "on off"},
    {WordKind::system, "GPS GLONASS GALILEO SBAS BEIDOU QZSS NAVIC none all"},
    {WordKind::input, input_formats},
    {WordKind::output, output_formats},
    {WordKind::shown, "(on) (off) (waiting)"},
    {WordKind::data_bits, "bits7 bits8"},
    {WordKind::parity, "No Even Odd"},
    {WordKind::stop_bits, "bit1 bit2"},
    {WordKind::flow_control, "none off RTS|CTS"},
    {WordKind::pulse_interval, pulse_intervals},
    {WordKind::polarity, "Low2High High2Low"},
    {WordKind::time_scale, "GPS Galileo BeiDou GLONASS UTC RxClock"},
    {WordKind::reset_level, "Soft Hard Upgrade"},
    {WordKind::erased_memory, "none Config PVTData SatData BaseStations WiFiAccess all"},
    {WordKind::configuration, "Current Boot User1 User2 RxDefault"},
    {WordKind::kept_configuration, "Current Boot User1 User2"},
    {WordKind::disk, "DSK1"},
    {WordKind::disk_action, "Mount Unmount Format"},
    {WordKind::talker, "auto GP GL GN"},
};

std::string_view words_of(WordKind kind) {
    const auto* const found = std::find_if(std::begin(words_of_kinds), std::end(words_of_kinds),
                                           [&](const auto& words) { return words.first == kind; });
    return found == std::end(words_of_kinds) ? std::string_view() : found->second;
}

}  // namespace

std::span<const SettingGroup> setting_groups() { return setting_group_table; }

bool same_word(std::string_view a, std::string_view b) { return lower_case(a) == lower_case(b); }

std::optional<std::string_view> known_word(WordKind kind, std::string_view word) {
    for (std::string_view rest = words_of(kind); !rest.empty();) {
        const std::string_view one = rest.substr(0, rest.find(' '));
        if (same_word(one, word)) return one;
        rest.remove_prefix(std::min(rest.size(), one.size() + 1));
    }
    return std::nullopt;
}

std::string_view blocks_of_group(std::string_view group) {
    for (const auto& [name, members] : block_groups)
        if (same_word(name, group)) return members;
    return {};
}

std::optional<std::uint64_t> interval_ms(std::string_view interval) {
    if (interval == "OnChange") return 0;
    constexpr std::array<std::pair<std::string_view, std::uint64_t>, 3> units{
        {{"msec", 1}, {"sec", 1000}, {"min", 60'000}}};
    for (const auto& [unit, milliseconds] : units) {
        if (!interval.starts_with(unit)) continue;
        const auto count = number_in<int>(interval.substr(unit.size()));
        if (count && *count > 0) return static_cast<std::uint64_t>(*count) * milliseconds;
    }
    return std::nullopt;
}

std::string_view descriptor_of(PortId port) {
    switch (port) {
        case PortId::uart1:
            return "COM1";
        case PortId::uart2:
            return "COM2";
        case PortId::usb:
            return "USB1";
        case PortId::i2c:
        case PortId::spi:
        case PortId::uart3:
            break;
    }
    return {};
}

}  // namespace skyloop::firmware
