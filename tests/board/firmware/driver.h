/// A driver for u-blox receivers as flight controllers have one: hunts for the speed, asks for the version, sets speed,
/// messages and rate, each with its acknowledgement in time and again when it does not come, then listens. Everything
/// that it learns is reported, a line each:
///
/// | report | meaning |
/// |---|---|
/// | `hunt N` | the N-th round through all speeds begins |
/// | `mute SPEED SENTENCES` | sound sentences were heard at this speed, and no answer |
/// | `nobody BYTES` | a round has ended without an answer; bytes heard so far |
/// | `found SPEED PROTOCOL` | the version was answered; protocol version times 100 |
/// | `speed SPEED` | the receiver answers at the speed that it was given |
/// | `ack MESSAGE MS TRY`, `nak …`, `silent MESSAGE` | what became of a setting; MESSAGE is class × 256 + id |
/// | `ready MS` | all is set; since the start |
/// | `pvt …` | a solution of NAV-PVT, raw: iTOW, fixType, flags, numSV, lon, lat, height, hMSL, hAcc, vAcc, velN, velE,
/// velD | | `gga …` | of GGA: UTC of day in 0.01 s, latitude and longitude in 1e-5 minutes, quality, satellites, height
/// in mm | | `fix`, `no_fix` | gnssFixOK with a fix of two or three dimensions began or ended | | `lost MS` | no
/// solution for that long: the hunt begins anew | | `counts …` | sound frames, bad ones, sound sentences, bad ones,
/// bytes heard, bytes lost |
#ifndef DRIVER_H
#define DRIVER_H

/// Never comes back.
_Noreturn void drive(void);

#endif
